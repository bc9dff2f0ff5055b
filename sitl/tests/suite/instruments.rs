//! The instruments' errors against the figures of their data sheets.

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::GRAVITY_M_S2;
use vehicle::estimation::{TrueMotion, Vibration, barometer, gps, inertial, magnetometer};
use vehicle::world::{atmospheric_pressure_pa, pressure_altitude_m};

fn at_rest(time_us: u64) -> TrueMotion {
    TrueMotion {
        time_us,
        position_m: Vector3::new(3.0, -4.0, -10.0),
        velocity_m_s: Vector3::zeros(),
        attitude: UnitQuaternion::identity(),
        body_rate_rad_s: Vector3::zeros(),
        specific_force_m_s2: Vector3::new(0.0, 0.0, -GRAVITY_M_S2),
    }
}

/// Allan variance of samples over groups of `group`, with the number of differences that it was made from.
fn allan_variance(samples: &[f64], group: usize) -> (f64, f64) {
    let means: Vec<f64> =
        samples.chunks_exact(group).map(|chunk| chunk.iter().sum::<f64>() / group as f64).collect();
    let differences = means.windows(2).map(|pair| (pair[1] - pair[0]).powi(2) / 2.0);
    let count = (means.len() - 1) as f64;
    (differences.sum::<f64>() / count, count)
}

/// White noise of one-sided density n and a walk of rate K: σ²(τ) = n²/(2τ) + K² τ/3 (IEEE 952).
#[test]
fn inertial_noise_has_the_allan_deviation_of_the_data_sheet() {
    const SECONDS: u64 = 400;
    let mut unit = inertial::InertialUnit::new(5);
    let readings: Vec<_> =
        (0..SECONDS * 1000).map(|tick| unit.sample(&at_rest(tick * inertial::PERIOD_US))).collect();
    let channels = [
        (0, inertial::GYROSCOPE_NOISE_RAD_S_RTHZ, inertial::GYROSCOPE_WALK_RAD_S_RTS),
        (1, inertial::ACCELEROMETER_NOISE_M_S2_RTHZ, inertial::ACCELEROMETER_WALK_M_S2_RTS),
    ];
    // 2.8 mdps/√Hz and 70 µg/√Hz, written out again.
    assert!((channels[0].1 - 4.886_921_905_584e-5).abs() < 1e-15);
    assert!((channels[1].1 - 6.864_655e-4).abs() < 1e-15);
    for (kind, density, walk) in channels {
        for axis in 0..3 {
            let samples: Vec<f64> = readings
                .iter()
                .map(|r| if kind == 0 { r.body_rate_rad_s[axis] } else { r.specific_force_m_s2[axis] })
                .collect();
            for group in [1, 10, 100, 1000] {
                let tau = group as f64 / 1000.0;
                let expected = density * density / (2.0 * tau) + walk * walk * tau / 3.0;
                let (measured, count) = allan_variance(&samples, group);
                // Neighbouring differences share a mean: the variance of the estimate is 3/count.
                let bound = 5.0 * (3.0 / count).sqrt();
                assert!(
                    (measured / expected - 1.0).abs() < bound,
                    "{kind} {axis} τ {tau}: {measured} {expected}"
                );
            }
        }
    }
}

#[test]
fn inertial_offsets_stay_within_their_tolerances() {
    let mut outside = 0;
    for seed in 0..400 {
        let mut unit = inertial::InertialUnit::new(seed);
        let mut mean = (Vector3::zeros(), Vector3::zeros());
        for tick in 0..50 {
            let reading = unit.sample(&at_rest(tick * 1000));
            mean.0 += reading.body_rate_rad_s / 50.0;
            mean.1 += (reading.specific_force_m_s2 - at_rest(0).specific_force_m_s2) / 50.0;
        }
        // ±0.5 dps and ±20 mg.
        outside += mean.0.iter().filter(|rate| rate.abs() > 0.5_f64.to_radians()).count();
        outside += mean.1.iter().filter(|force| force.abs() > 0.02 * GRAVITY_M_S2).count();
    }
    // Three standard deviations: 0.27 % of 2400.
    assert!((1..=16).contains(&outside), "{outside}");
}

#[test]
fn a_crash_clips_the_accelerometers() {
    let mut unit = inertial::InertialUnit::new(1);
    let hit = TrueMotion { specific_force_m_s2: Vector3::new(0.0, 0.0, -400.0), ..at_rest(0) };
    let reading = unit.sample(&hit);
    assert_eq!(reading.specific_force_m_s2.z, -16.0 * GRAVITY_M_S2);
    assert_eq!(unit.clipped(), [0, 0, 1]);
}

/// A sine of 50 Hz and amplitude 2: RMS √2, of which the 5 Hz low-pass takes off a part of 1/√(1 + 10²); one of 0.2 Hz
/// counts as flight.
#[test]
fn vibration_is_what_shakes_faster_than_flight() {
    let level = |frequency: f64| {
        let mut vibration = Vibration::default();
        for tick in 0..10_000 {
            let phase = core::f64::consts::TAU * frequency * tick as f64 / 1000.0;
            vibration.update(&inertial::InertialReading {
                time_us: tick * 1000,
                body_rate_rad_s: Vector3::zeros(),
                specific_force_m_s2: Vector3::new(2.0 * phase.sin(), 0.0, -GRAVITY_M_S2),
            });
        }
        vibration.level_m_s2()
    };
    let fast = level(50.0);
    assert!((fast.x - 2.0_f64.sqrt()).abs() < 0.06 && fast.y == 0.0 && fast.z == 0.0, "{fast}");
    assert!(level(0.2).x < 0.1, "{}", level(0.2));
}

/// Fixes of many receivers: half of them within 2.5 m and within 0.05 m/s, their errors correlated over a minute.
#[test]
fn gps_fixes_are_as_wide_as_the_data_sheet_says() {
    const RECEIVERS: usize = 2000;
    let (mut near, mut slow, mut together, mut heights) = (0, 0, 0.0, 0.0);
    for seed in 0..RECEIVERS {
        let mut receiver = gps::GpsReceiver::new(seed as u64, gps::LATENCY_US);
        let mut fixes = (0..612).filter_map(|step| receiver.sample(&at_rest(step * gps::PERIOD_US)));
        let first = fixes.next().expect("a fix");
        assert_eq!(first.time_us, 1_000_000);
        let later = fixes.last().expect("more of them");
        assert_eq!(later.time_us, 61_000_000);
        let error = first.position_m - at_rest(0).position_m;
        let error_later = later.position_m - at_rest(0).position_m;
        near += usize::from(error.xy().norm() < 2.5);
        slow += usize::from(first.velocity_m_s.xy().norm() < 0.05);
        together += error.xy().dot(&error_later.xy()) / 2.0 / gps::HORIZONTAL_M.powi(2);
        heights += error.z.powi(2) / gps::VERTICAL_M.powi(2);
    }
    let count = RECEIVERS as f64;
    let half = 5.0 * (0.25 / count).sqrt();
    assert!((near as f64 / count - 0.5).abs() < half, "{near}");
    assert!((slow as f64 / count - 0.5).abs() < half, "{slow}");
    assert!((together / count - (-1.0_f64).exp()).abs() < 5.0 / count.sqrt(), "{}", together / count);
    assert!((heights / count - 1.0).abs() < 5.0 * (2.0 / count).sqrt(), "{}", heights / count);
}

#[test]
fn gps_fixes_come_ten_times_a_second_and_late() {
    let mut receiver = gps::GpsReceiver::new(1, gps::LATENCY_US);
    let arrivals: Vec<(u64, u64)> = (0..3000)
        .filter_map(|tick| receiver.sample(&at_rest(tick * 1000)).map(|fix| (tick * 1000, fix.time_us)))
        .collect();
    assert_eq!(arrivals.first(), Some(&(1_100_000, 1_000_000)));
    assert_eq!(arrivals.len(), 19);
    assert!(arrivals.iter().all(|(now, taken)| now - taken == gps::LATENCY_US));
}

/// A receiver of another rate and latency (SIM_GPS1_HZ, SIM_GPS1_LAG_MS): three fixes are under way at once.
#[test]
fn gps_fixes_come_as_often_and_as_late_as_they_are_to() {
    let mut receiver = gps::GpsReceiver::new(1, gps::LATENCY_US);
    receiver.set(20, 170_000);
    let arrivals: Vec<(u64, u64)> = (0..3000)
        .filter_map(|tick| receiver.sample(&at_rest(tick * 1000)).map(|fix| (tick * 1000, fix.time_us)))
        .collect();
    assert_eq!(arrivals.first(), Some(&(1_170_000, 1_000_000)));
    assert_eq!(arrivals.len(), 37);
    assert!(arrivals.iter().all(|(now, taken)| now - taken == 170_000));
    assert!(arrivals.windows(2).all(|pair| pair[1].1 - pair[0].1 == 50_000));
}

#[test]
fn the_barometer_is_as_noisy_and_drifts_as_the_data_sheet_says() {
    let altitude_m = 488.0;
    let truth = atmospheric_pressure_pa(altitude_m);
    assert!((pressure_altitude_m(truth) - altitude_m).abs() < 1e-6);
    // International Standard Atmosphere: 899 hPa at 1000 m.
    assert!((atmospheric_pressure_pa(1000.0) - 89_875.0).abs() < 5.0);
    const INSTRUMENTS: usize = 300;
    let (mut noise, mut drift, mut outside) = (0.0, 0.0, 0);
    for seed in 0..INSTRUMENTS {
        let mut instrument = barometer::Barometer::new(seed as u64);
        let readings: Vec<f64> = (0..=30_000)
            .filter_map(|step| instrument.sample(step * barometer::PERIOD_US, altitude_m))
            .map(|reading| reading.pressure_pa - truth)
            .collect();
        assert_eq!(readings.len(), 30_001, "50 Hz for ten minutes");
        noise += readings.windows(2).take(1000).map(|pair| (pair[1] - pair[0]).powi(2) / 2.0).sum::<f64>()
            / 1000.0;
        drift += (readings[30_000] - readings[0]).powi(2);
        // ±1.5 mbar; what noise adds is little.
        outside += usize::from(readings[0].abs() > 150.0);
    }
    let count = INSTRUMENTS as f64;
    // 0.012 mbar, and what the walk adds from one reading to the next.
    let white = (noise / count).sqrt();
    assert!((white - 1.2).abs() < 0.03, "{white}");
    // 250 Pa over 52.5 K, for 10 K.
    let drift = (drift / count).sqrt();
    assert!((drift / 47.6 - 1.0).abs() < 5.0 / (2.0 * count).sqrt(), "{drift}");
    assert!(outside <= 6, "{outside}");
}

#[test]
fn the_magnetometer_sees_the_field_in_its_own_axes_with_15_nt_of_noise() {
    let field = Vector3::new(0.21, 0.0, 0.43);
    // Heading east and level: north is to the left.
    let attitude = UnitQuaternion::from_euler_angles(0.0, 0.0, core::f64::consts::FRAC_PI_2);
    let mut instrument = magnetometer::Magnetometer::new(3);
    let readings: Vec<_> = (0..20_000)
        .filter_map(|step| instrument.sample(step * magnetometer::PERIOD_US, &attitude, || field))
        .map(|reading| reading.field_gauss)
        .collect();
    let count = readings.len() as f64;
    let mean = readings.iter().sum::<Vector3<f64>>() / count;
    assert!((mean - Vector3::new(0.0, -0.21, 0.43)).norm() < 1e-5, "{mean}");
    for axis in 0..3 {
        let variance = readings.iter().map(|r| (r[axis] - mean[axis]).powi(2)).sum::<f64>() / count;
        // 15 nT are 1.5e-4 gauss.
        assert!((variance.sqrt() / 1.5e-4 - 1.0).abs() < 5.0 / (2.0 * count).sqrt(), "{variance}");
    }
}

/// The same seed repeats every bit, another does not, and the numbers are those of every platform: frozen once.
#[test]
fn a_seed_repeats_on_every_platform() {
    let flight = |seed| {
        let mut unit = inertial::InertialUnit::new(seed);
        let mut bits = 0_u64;
        for tick in 0..2000 {
            let reading = unit.sample(&at_rest(tick * 1000));
            for value in reading.body_rate_rad_s.iter().chain(&reading.specific_force_m_s2) {
                bits = bits.rotate_left(7) ^ value.to_bits();
            }
        }
        bits
    };
    assert_eq!(flight(1), flight(1));
    assert_ne!(flight(1), flight(2));
    assert_eq!(flight(1), 0x1293_620f_b897_d607, "{:#x}", flight(1));
}
