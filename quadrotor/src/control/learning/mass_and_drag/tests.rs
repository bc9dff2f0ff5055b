//! Mass and drag from flights that are made up.

extern crate std;

use alloc::vec::Vec;
use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::MassAndDrag;
use crate::control::learning::averaging::SampledAveraging;
use crate::control::learning::flight_sample::FlightSample;
use crate::control::learning::motion_equation::MeasuredMotion;
use crate::{Configuration, GRAVITY_M_S2};

/// Of samples every 10 ms.
static AVERAGING: LazyLock<SampledAveraging> =
    LazyLock::new(|| SampledAveraging::new(&Configuration::default().controllers.attitude));

/// One instant of a flight, as it would be recorded.
#[derive(Clone, Copy)]
struct Recorded {
    velocity_m_s: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    rotor_speed_rad_s: [f64; 4],
    time_us: u64,
}

impl Recorded {
    fn sample(&self) -> FlightSample<'_> {
        FlightSample {
            motion: MeasuredMotion::Velocity(self.velocity_m_s),
            velocity_m_s: self.velocity_m_s,
            is_clear: true,
            attitude: self.attitude,
            rotor_speed_rad_s: &self.rotor_speed_rad_s,
            rotor_command_rad_s: &self.rotor_speed_rad_s,
            time_us: self.time_us,
            averaging: &AVERAGING,
        }
    }
}

/// A flight of 20 s to and fro and up and down, of a vehicle with a mass, kg, and drag, N·s/m, under a constant force, N:
/// velocities are chosen, thrust and attitude follow from m v̇ = m g e₃ − F b₃ − c v + f.
fn flight(mass_kg: f64, drag_n_s_m: f64, force_n: &Vector3<f64>) -> Vec<Recorded> {
    let k1 = Configuration::default().airframe.thrust_coefficient_n_s2;
    (0..2_000_u64)
        .map(|sample| {
            let t = sample as f64 * 0.01;
            let wave = |amplitude: f64, omega: f64| {
                (amplitude * (omega * t).sin(), amplitude * omega * (omega * t).cos())
            };
            let axes = [wave(4.0, 0.7), wave(3.0, 0.9), wave(1.5, 1.3)];
            let velocity_m_s = Vector3::from(axes.map(|(velocity, _)| velocity));
            let acceleration = Vector3::from(axes.map(|(_, acceleration)| acceleration));
            let weight = Vector3::z() * (GRAVITY_M_S2 * mass_kg);
            let thrust_n = weight + force_n - velocity_m_s * drag_n_s_m - acceleration * mass_kg;
            let attitude =
                UnitQuaternion::rotation_between(&Vector3::z(), &thrust_n).expect("never upside down");
            let speed = (thrust_n.norm() / (4.0 * k1)).sqrt();
            Recorded { velocity_m_s, attitude, rotor_speed_rad_s: [speed; 4], time_us: 10_000 * sample }
        })
        .collect()
}

fn learned(configuration: &Configuration, flight: &[Recorded]) -> MassAndDrag {
    let mut learner = MassAndDrag::new(configuration);
    for instant in flight {
        learner.observe(configuration, &instant.sample());
    }
    learner
}

fn believing(mass_factor: f64) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.controllers.mass_factor = mass_factor;
    configuration
}

/// Mass, drag and force of the analytic flight, from a belief that is wrong by half.
#[test]
fn it_converges_to_the_truth() {
    for (mass_kg, drag, belief) in [(0.7, 0.2, 0.5), (0.7, 0.0, 1.5), (1.2, 0.3, 1.0), (0.4, 0.1, 1.0)] {
        let configuration = believing(belief);
        let force_n = Vector3::new(0.4, -0.3, 0.0);
        let learner = learned(&configuration, &flight(mass_kg, drag, &force_n));
        let found_kg = learner.mass_kg(&configuration);
        assert!((found_kg / mass_kg - 1.0).abs() < 0.03, "{found_kg} of {mass_kg} kg");
        let found = learner.drag_n_s_m(&configuration);
        // Mostly along the axes that it moved on fast.
        assert!((found.xy() - Vector3::repeat(drag).xy()).norm() < 0.05, "{found} of {drag} N·s/m");
    }
}

/// From hover the thrust falls to 0.6 weights with the rotors' lag, and the vehicle with it while it leans: v̇ = g e₃ − F b₃/m. The mass is
/// found before it has fallen a decimetre, and the lean, which turns the upright force that stood for the error of the mass across the
/// thrust, is no gust.
#[test]
fn a_fall_shows_the_mass_at_once() {
    const STEP_US: u64 = 10_000;
    const FINE_S: f64 = 1e-4;
    for (belief, slowest) in [(0.5, 0.4), (0.7, 0.25), (1.4, 0.25)] {
        let configuration = believing(belief);
        let airframe = &configuration.airframe;
        let share = |time_s: f64| 0.6 + 0.4 * (-time_s / 0.05).exp();
        let attitude = |time_s: f64| UnitQuaternion::from_euler_angles(0.0, -(1.5 * time_s).min(0.5), 0.0);
        let (mut learner, mut velocity_m_s) = (MassAndDrag::new(&configuration), Vector3::zeros());
        for time_us in (0..1_000_000).step_by(STEP_US as usize) {
            let time_s = time_us as f64 * 1e-6;
            let thrust_n = share(time_s) * airframe.weight_n();
            let speed = (thrust_n / (4.0 * airframe.thrust_coefficient_n_s2)).sqrt();
            let (attitude_now, rotor_speed_rad_s) = (attitude(time_s), [speed; 4]);
            let instant = Recorded { velocity_m_s, attitude: attitude_now, rotor_speed_rad_s, time_us };
            learner.observe(&configuration, &instant.sample());
            let off = (learner.mass_factor() - 1.0).abs();
            assert!(time_s < slowest || off < 0.15, "{belief}: off by {off} at {time_s} s");
            for fine in 0..100 {
                let at_s = time_s + FINE_S * (f64::from(fine) + 0.5);
                let thrust = attitude(at_s) * Vector3::z() * (GRAVITY_M_S2 * share(at_s));
                velocity_m_s += (Vector3::z() * GRAVITY_M_S2 - thrust) * FINE_S;
            }
        }
        assert!(learner.gusts_m_s2 == 0.0, "{belief}: {} m/s²", learner.gusts_m_s2);
        assert!((learner.mass_factor() - 1.0).abs() < 0.1, "{belief}: {}", learner.mass_factor());
    }
}

/// At each sample while the flight settles, later at every second one of 10 ms.
#[test]
fn a_flight_that_has_settled_is_learned_from_less_often() {
    let configuration = believing(1.0);
    let mut learner = MassAndDrag::new(&configuration);
    let record = flight(configuration.airframe.mass_kg, 0.0, &Vector3::zeros());
    let learned: Vec<bool> =
        record.iter().map(|instant| learner.observe(&configuration, &instant.sample())).collect();
    let count =
        |instants: core::ops::Range<usize>| learned[instants].iter().filter(|learned| **learned).count();
    assert_eq!((count(50..100), count(1_900..2_000)), (50, 50));
}

/// Batch least squares over the differences of a recorded flight, which knows nothing of filters, priors or forgetting.
#[test]
fn it_agrees_with_batch_least_squares() {
    let configuration = believing(1.0);
    let airframe = &configuration.airframe;
    let record = flight(0.9, 0.25, &Vector3::new(0.2, 0.1, -0.1));
    let mut rows = DMatrix::zeros(3 * (record.len() - 1), 7);
    let mut values = DVector::zeros(rows.nrows());
    for (pair, at) in record.windows(2).zip((0..).step_by(3)) {
        let thrust = |instant: &Recorded| {
            let speed = instant.rotor_speed_rad_s[0];
            let newton = 4.0 * airframe.thrust_coefficient_n_s2 * speed * speed;
            instant.attitude * Vector3::z() * (newton / airframe.mass_kg)
        };
        let t = (thrust(&pair[0]) + thrust(&pair[1])) / 2.0;
        let v = (pair[0].velocity_m_s + pair[1].velocity_m_s) / 2.0;
        let a = (pair[1].velocity_m_s - pair[0].velocity_m_s) / 0.01;
        for axis in 0..3 {
            (rows[(at + axis, 0)], rows[(at + axis, 1 + axis)], rows[(at + axis, 4 + axis)]) =
                (-t[axis], -v[axis], 1.0);
            values[at + axis] = a[axis] - if axis == 2 { GRAVITY_M_S2 } else { 0.0 };
        }
    }
    let batch = rows.svd(true, true).solve(&values, 1e-12).expect("solvable");
    let learner = learned(&configuration, &record);
    let mass_kg = airframe.mass_kg / batch[0];
    assert!((learner.mass_kg(&configuration) / mass_kg - 1.0).abs() < 0.02, "{mass_kg}");
    let drag = batch.fixed_rows::<3>(1) * mass_kg;
    assert!((learner.drag_n_s_m(&configuration) - drag).xy().norm() < 0.05, "{drag}");
}

/// What shows nothing changes nothing: standing, near the ground, in free fall, saturated, switched off, or hovering under a
/// force that grows slowly.
#[test]
fn nothing_is_learned_where_nothing_shows() {
    let record = flight(1.0, 0.2, &Vector3::zeros());
    let mut configuration = believing(1.0);
    let fresh = MassAndDrag::new(&configuration);
    let unchanged = |configuration: &Configuration, change: &dyn Fn(&mut FlightSample<'_>)| {
        let mut learner = fresh;
        for instant in &record {
            let mut sample = instant.sample();
            change(&mut sample);
            learner.observe(configuration, &sample);
        }
        (learner.mass_factor(), learner.drag_n_s_m(configuration)) == (1.0, Vector3::zeros())
    };
    const SLOWEST: &[f64; 4] = &[50.0, 300.0, 300.0, 300.0];
    assert!(!unchanged(&configuration, &|sample| sample.rotor_command_rad_s = SLOWEST), "a slow rotor obeys");
    assert!(!unchanged(&configuration, &|_| ()), "the flight itself is learned from");
    let still = MeasuredMotion::Velocity(Vector3::zeros());
    assert!(unchanged(&configuration, &|sample| sample.motion = still), "at rest");
    assert!(unchanged(&configuration, &|sample| sample.is_clear = false), "on the ground");
    assert!(unchanged(&configuration, &|sample| sample.rotor_speed_rad_s = &[60.0; 4]), "in free fall");
    const FASTEST: &[f64; 4] = &[450.0, 300.0, 300.0, 300.0];
    assert!(unchanged(&configuration, &|sample| sample.rotor_command_rad_s = FASTEST), "saturated");
    let nan = MeasuredMotion::Velocity(Vector3::repeat(f64::NAN));
    assert!(unchanged(&configuration, &|sample| sample.motion = nan), "not finite");
    configuration.controllers.learning = false;
    assert!(unchanged(&configuration, &|_| ()), "switched off");
}

/// A side force of a third of the weight comes and goes: it is not taken for mass.
#[test]
fn a_steady_side_force_is_no_mass() {
    let configuration = believing(1.0);
    let calm = flight(0.7, 0.0, &Vector3::zeros());
    let pushed = flight(0.7, 0.0, &Vector3::new(0.0, 2.3, 0.0));
    let record: Vec<_> = calm[..1_000].iter().chain(&pushed[1_000..]).copied().collect();
    let factor = learned(&configuration, &record).mass_factor();
    assert!((factor - 1.0).abs() < 0.08, "{factor}");
}

/// A load of 30 % of the mass comes or goes in the middle of the flight.
#[test]
fn a_load_is_found() {
    for mass_kg in [0.49, 0.91] {
        let configuration = believing(1.0);
        let (before, after) = (flight(0.7, 0.0, &Vector3::zeros()), flight(mass_kg, 0.0, &Vector3::zeros()));
        let record: Vec<_> = before[..1_000].iter().chain(&after[1_000..1_500]).copied().collect();
        let found_kg = learned(&configuration, &record).mass_kg(&configuration);
        assert!((found_kg / mass_kg - 1.0).abs() < 0.06, "{found_kg} of {mass_kg} kg within 5 s");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Whatever it is fed, mass and drag stay within their bounds, and the state is one that can be restored.
    #[test]
    fn bounds_are_never_left(
        belief in 0.5..1.5,
        samples in prop::collection::vec(
            ([any::<f64>(), any::<f64>(), any::<f64>()], any::<bool>(), -3.2..3.2, 0.0..600.0, 0_u64..50_000),
            1..300,
        ),
        tame in any::<bool>(),
    ) {
        let configuration = believing(belief);
        let mut learner = MassAndDrag::new(&configuration);
        let mut time_us = 0;
        for (motion, by_position, tilt, speed, interval_us) in samples {
            time_us += interval_us;
            let scaled = |number: f64| if tame && number.is_finite() { 30.0 * number.sin() } else { number };
            let motion = Vector3::from(motion.map(scaled));
            let rotors = [speed; 4];
            learner.observe(&configuration, &FlightSample {
                motion: if by_position { MeasuredMotion::Position(motion) } else { MeasuredMotion::Velocity(motion) },
                velocity_m_s: motion,
                is_clear: true,
                attitude: UnitQuaternion::from_euler_angles(tilt, 0.3 * tilt, 0.0),
                rotor_speed_rad_s: &rotors,
                rotor_command_rad_s: &rotors,
                time_us,
                averaging: &AVERAGING,
            });
            prop_assert!((0.4 - 1e-12..=2.5 + 1e-12).contains(&learner.mass_factor()));
            let drag_1_s = learner.drag_n_s_m(&configuration) / learner.mass_kg(&configuration);
            prop_assert!(drag_1_s.iter().all(|drag| (0.0..=2.0 + 1e-12).contains(drag)));
            prop_assert!(learner.is_possible(&configuration));
        }
    }
}
