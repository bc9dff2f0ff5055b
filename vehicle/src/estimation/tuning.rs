//! What the estimator believes of its instruments.

use fusion_nav::{
    AltitudeNoise, Config, Correlation, Gate, Gates, HeadingNoise, ImuNoise, Initialization, Meters,
    MetersPerSecond, MetersPerSecond2, Radians, Seconds,
};
use quadrotor::GRAVITY_M_S2;

use super::{barometer, gps, inertial};
use crate::world::pressure_altitude_m;

/// What the model of the motion leaves out (turning within a step of 5 ms) counts as inertial noise: the estimator
/// believes in this multiple of what the data sheet says.
const INERTIAL_MARGIN: f64 = 3.0;
/// How far the place where the vehicle stands is from where it is told to stand, m.
pub const START_M: f32 = 0.1;
/// How still it stands, m/s.
pub const STILL_M_S: f32 = 0.02;
/// A compass that has been calibrated keeps this much of the vehicle's own field, rad.
const HEADING_RAD: f32 = 0.02;

/// A heading is levelled by the estimated tilt, whose error lasts until the vehicle has accelerated, s.
const LEVELLING_S: f32 = 15.0;

/// Standard deviations of a start in flight, after seconds in which the receiver was not believed: position, m, velocity, m/s,
/// attitude, rad, offsets of accelerometers, m/s², and of gyroscopes, rad/s. Offsets are more likely than a wrong tilt.
pub const DOUBTS: [f32; 15] =
    [5.0, 5.0, 3.0, 0.5, 0.5, 0.5, 0.05, 0.05, 0.05, 1.0, 1.0, 1.0, 0.05, 0.05, 0.05];

/// How many standard deviations estimates from outside may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutsideGates {
    /// Positions.
    pub position: f64,
    /// Velocities.
    pub velocity: f64,
}

/// The filter's settings while it fuses estimates from outside, whose errors do not last, or as without them.
pub fn configuration_for(outside: Option<OutsideGates>) -> Config {
    let usual = configuration();
    let Some(gates) = outside else { return usual };
    let threshold = |deviations: f64| (deviations * deviations) as f32;
    let (position, velocity) = (threshold(gates.position), threshold(gates.velocity));
    Config {
        gates: Gates {
            gnss_position: Gate::new(position).unwrap_or(usual.gates.gnss_position),
            gnss_height: Gate::new(position).unwrap_or(usual.gates.gnss_height),
            gnss_velocity: Gate::new(velocity).unwrap_or(usual.gates.gnss_velocity),
            ..usual.gates
        },
        correlation: Correlation {
            gnss_position: None,
            gnss_height: None,
            gnss_velocity: None,
            ..usual.correlation
        },
        ..usual
    }
}

/// What an error that lasts, s, makes of the standard deviation of each of the measurements that come every `period_s`: as many of
/// them as come while it lasts say no more than one.
pub fn lasting(deviation: f64, lasts_s: f64, period_s: f64) -> f64 {
    let changed = -libm::expm1(-period_s / lasts_s);
    deviation * libm::sqrt((2.0 - changed) / changed)
}

/// The filter's settings.
pub fn configuration() -> Config {
    // A one-sided density n is white noise of √(n²/2) in the time domain.
    let white = |density: f64| (INERTIAL_MARGIN * density / core::f64::consts::SQRT_2) as f32;
    let walk = |rate: f64| (INERTIAL_MARGIN * rate) as f32;
    Config {
        imu: ImuNoise {
            gyro_white: white(inertial::GYROSCOPE_NOISE_RAD_S_RTHZ),
            accel_white: white(inertial::ACCELEROMETER_NOISE_M_S2_RTHZ),
            gyro_bias_walk: walk(inertial::GYROSCOPE_WALK_RAD_S_RTS),
            accel_bias_walk: walk(inertial::ACCELEROMETER_WALK_M_S2_RTS),
        },
        correlation: Correlation {
            gnss_position: Some(Seconds::from_secs(gps::POSITION_CORRELATION_S as f32)),
            gnss_height: Some(Seconds::from_secs(gps::POSITION_CORRELATION_S as f32)),
            gnss_velocity: Some(Seconds::from_secs(gps::VELOCITY_CORRELATION_S as f32)),
            mag_heading: Some(Seconds::from_secs(LEVELLING_S)),
            ..Correlation::WHITE
        },
        init: Initialization {
            sigma_position: Meters::from_meters(START_M),
            sigma_velocity: MetersPerSecond::from_m_per_s(STILL_M_S),
            sigma_yaw: Radians::from_radians(2.0 * HEADING_RAD),
            sigma_accel_bias: MetersPerSecond2::from_m_per_s2(inertial::ACCELEROMETER_OFFSET_M_S2 as f32),
            ..Initialization::default()
        },
        gravity: GRAVITY_M_S2 as f32,
        // A vehicle in flight does not stay where it was when the receiver fell silent.
        hold: None,
        baro_offset_walk: metres(barometer::WALK_PA_RTS, 1013e2) as f32,
        ..Config::default()
    }
}

/// Noise of a barometric altitude.
pub fn altitude_noise(pressure_pa: f64) -> AltitudeNoise {
    AltitudeNoise::from_sigma(metres(barometer::NOISE_PA, pressure_pa) as f32)
}

/// Noise of a magnetic heading.
pub fn heading_noise() -> HeadingNoise {
    HeadingNoise::from_sigma(HEADING_RAD)
}

/// Height that a difference of pressure is at some pressure.
fn metres(difference_pa: f64, pressure_pa: f64) -> f64 {
    pressure_altitude_m(pressure_pa - difference_pa) - pressure_altitude_m(pressure_pa)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_filter_takes_its_settings() {
        assert!(fusion_nav::Eskf::new(super::configuration()).is_ok());
        // 1.2 Pa near the ground: 10 cm, as the barometer's data sheet says.
        assert!((super::altitude_noise(101_325.0).variance().sqrt() - 0.10).abs() < 0.005);
        let gates = super::OutsideGates { position: 5.0, velocity: 3.0 };
        assert!(fusion_nav::Eskf::new(super::configuration_for(Some(gates))).is_ok());
        assert_eq!(super::configuration_for(None), super::configuration());
    }

    #[test]
    fn a_lasting_error_does_not_average_out() {
        // 600 fixes within a minute: 2τ/dt times the variance of one.
        assert!((super::lasting(2.0, 60.0, 0.1) - 2.0 * libm::sqrt(1200.0)).abs() < 0.01);
        assert!((super::lasting(2.0, 0.001, 10.0) - 2.0).abs() < 1e-9);
    }
}
