//! The estimator against motion that is known exactly.

use nalgebra::{SMatrix, SVector, UnitQuaternion, Vector3};
use quadrotor::GRAVITY_M_S2;
use vehicle::estimation::aiding::Aiding;
use vehicle::estimation::{Estimate, Navigation, SensorErrors, TrueMotion};
use vehicle::fault::Faults;
use vehicle::world::{Geodetic, LocalFrame};

/// It stands this long, s, before it moves.
const REST_S: f64 = 5.0;

fn frame() -> LocalFrame {
    LocalFrame::new(Geodetic::default())
}

/// A sum of sines that begins at rest: amplitude (1 − cos ωt) and two derivatives.
fn swing(amplitude: f64, omega: f64, t: f64) -> [f64; 3] {
    [
        amplitude * (1.0 - (omega * t).cos()),
        amplitude * omega * (omega * t).sin(),
        amplitude * omega * omega * (omega * t).cos(),
    ]
}

/// Closed-form motion: paths and Euler angles are sines of time, everything else follows from them.
fn motion(time_us: u64) -> TrueMotion {
    // The start is smooth: time runs slowly at first, 1 s to its full speed.
    let (t, speed, surge) = runs(time_us as f64 / 1e6 - REST_S);
    let along = |amplitude, omega| {
        let [p, v, a] = swing(amplitude, omega, t);
        [p, v * speed, a * speed * speed + v * surge]
    };
    let axes = [along(6.0, 0.5), along(4.0, 0.7), along(-3.0, 0.4)];
    let angles = [along(0.15, 1.1), along(0.12, 0.9), along(0.8, 0.3)];
    let [phi, theta, psi] = angles.map(|[angle, ..]| angle);
    let [phi_rate, theta_rate, psi_rate] = angles.map(|[_, rate, _]| rate);
    let attitude = UnitQuaternion::from_euler_angles(phi, theta, psi);
    // p, q, r of the rates of ZYX angles.
    let body_rate = Vector3::new(
        phi_rate - psi_rate * theta.sin(),
        theta_rate * phi.cos() + psi_rate * phi.sin() * theta.cos(),
        -theta_rate * phi.sin() + psi_rate * phi.cos() * theta.cos(),
    );
    let acceleration = Vector3::from(axes.map(|[_, _, a]| a));
    TrueMotion {
        time_us,
        position_m: Vector3::from(axes.map(|[p, ..]| p)),
        velocity_m_s: Vector3::from(axes.map(|[_, v, _]| v)),
        attitude,
        body_rate_rad_s: body_rate,
        specific_force_m_s2: attitude.inverse_transform_vector(&(acceleration - Vector3::z() * GRAVITY_M_S2)),
    }
}

/// Time of the motion, its speed and its surge, s after the start: 0 before, then t²/2, then t − 1/2.
fn runs(since_s: f64) -> (f64, f64, f64) {
    match since_s {
        ..0.0 => (0.0, 0.0, 0.0),
        ..1.0 => (since_s * since_s / 2.0, since_s, 1.0),
        _ => (since_s - 0.5, 1.0, 0.0),
    }
}

fn fly(seed: u64, seconds: f64, mut look: impl FnMut(&Navigation, &TrueMotion)) -> Navigation {
    let mut navigation = Navigation::new(seed, Estimate::unaligned(Vector3::zeros(), 0.0));
    for tick in 1..=(seconds * 1000.0) as u64 {
        let motion = motion(tick * 1000);
        let resting = motion.time_us as f64 / 1e6 <= REST_S;
        let (errors, aiding) = (SensorErrors::default(), Aiding::default());
        navigation.step(&motion, &frame(), &Faults::default(), &errors, &aiding, resting);
        look(&navigation, &motion);
    }
    navigation
}

/// Errors of position, velocity (NED) and attitude (FRD).
fn errors(navigation: &Navigation, motion: &TrueMotion) -> [Vector3<f64>; 3] {
    let body = &navigation.estimate().body;
    [
        motion.position_m - body.position_m,
        motion.velocity_m_s - body.velocity_m_s,
        (body.rotation().inverse() * motion.attitude).scaled_axis(),
    ]
}

/// eᵀ P⁻¹ e of one of the blocks of three.
fn normalised(navigation: &Navigation, error: &Vector3<f64>, block: usize) -> f64 {
    let rows = navigation.estimator().covariance().to_rows();
    let p = SMatrix::<f64, 3, 3>::from_fn(|i, j| f64::from(rows[3 * block + i][3 * block + j]));
    let error = SVector::<f64, 3>::from(*error);
    (error.transpose() * p.try_inverse().expect("a covariance") * error)[0]
}

#[test]
fn it_aligns_at_rest_and_is_valid_with_the_first_fixes() {
    let mut aligned_us = None;
    let navigation = fly(1, 4.0, |navigation, motion| {
        if navigation.estimate().validity.all() {
            aligned_us.get_or_insert(motion.time_us);
        }
    });
    let aligned_s = aligned_us.expect("valid") as f64 / 1e6;
    assert!((2.0..2.3).contains(&aligned_s), "{aligned_s}");
    assert!(navigation.estimate().validity.all());
    let health = navigation.health();
    assert!(
        health.gyroscope && health.accelerometer && health.magnetometer && health.barometer && health.gps
    );
}

/// Over seeds the errors are as wide as the covariance says: the mean of eᵀP⁻¹e over 3 degrees of freedom and 24 seeds
/// is χ² with 72 degrees of freedom over 72, below 1.59 in 999 of 1000 cases. Below 1 the filter is cautious: its noise
/// has a margin.
#[test]
fn errors_are_consistent_with_the_covariance() {
    const SEEDS: u64 = 24;
    const UPPER: f64 = 1.59;
    let times = [10_000_000, 30_000_000, 60_000_000];
    let mut sums = [[0.0; 3]; 3];
    for seed in 0..SEEDS {
        fly(seed, 60.0, |navigation, motion| {
            let Some(at) = times.iter().position(|time_us| *time_us == motion.time_us) else { return };
            for (block, error) in errors(navigation, motion).iter().enumerate() {
                sums[at][block] += normalised(navigation, error, block) / (3.0 * SEEDS as f64);
            }
        });
    }
    for (time_us, means) in times.iter().zip(sums) {
        for mean in means {
            assert!((0.05..UPPER).contains(&mean), "at {time_us}: {sums:?}");
        }
    }
}

/// Innovations over their variances: mean 1 if the filter is right about its measurements, less as it is cautious; and
/// hardly any is rejected.
#[test]
fn innovations_are_consistent_with_their_variances() {
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..6 {
        let navigation = fly(seed, 60.0, |navigation, motion| {
            if !motion.time_us.is_multiple_of(500_000) || motion.time_us < 10_000_000 {
                return;
            }
            let innovation = navigation.estimator().diagnostics().gnss_velocity.innovation.expect("fixes");
            for (value, variance) in innovation.values().iter().zip(innovation.variances()) {
                sum += f64::from(value * value / variance);
                count += 1.0;
            }
        });
        let diagnostics = navigation.estimator().diagnostics();
        for source in [&diagnostics.gnss_position, &diagnostics.gnss_velocity, &diagnostics.mag_heading] {
            assert!(source.accepted > 500 && source.rejected * 100 < source.accepted, "{source:?}");
        }
        assert_eq!(navigation.estimate().resets, 0);
    }
    let mean: f64 = sum / count;
    assert!((0.5..1.4).contains(&mean), "{mean}");
}

/// What the errors are, in the units that a pilot feels.
#[test]
fn errors_stay_small() {
    let mut squares = [0.0; 3];
    let mut worst_tilt: f64 = 0.0;
    let mut count = 0.0;
    for seed in 0..8 {
        fly(seed, 60.0, |navigation, motion| {
            if motion.time_us < 10_000_000 || !motion.time_us.is_multiple_of(100_000) {
                return;
            }
            let errors = errors(navigation, motion);
            for (square, error) in squares.iter_mut().zip(&errors) {
                *square += error.norm_squared();
            }
            worst_tilt = worst_tilt.max(errors[2].xy().norm());
            count += 1.0;
        });
    }
    let [position, velocity, attitude] = squares.map(|square: f64| (square / count).sqrt());
    assert!(
        position < 1.0 && velocity < 0.1 && attitude < 0.01 && worst_tilt < 0.01,
        "{position} {velocity} {attitude}"
    );
}

#[test]
fn a_seed_repeats_bit_for_bit() {
    let end = |seed| *fly(seed, 15.0, |_, _| {}).estimate();
    assert_eq!(end(3), end(3));
    assert_ne!(end(3), end(4));
}
