//! The gains of the stationary Kalman predictors (26).

use lmpc::DesignError;
use nalgebra::Vector3;

use crate::design::axis_predictor::{AxisPredictor, Missed};
use crate::{Configuration, Sensors};

/// Smallest standard deviations that the design counts with, m and rad: without noise the predictor would
/// follow each rounding.
const SMALLEST_NOISE: (f64, f64) = (1e-3, 1e-3);
/// The same of the velocity, m/s, and of body rates, rad/s: that of a gyroscope.
const SMALLEST_RATE_NOISE: (f64, f64) = (1e-3, 5e-3);
/// The longest memory of positions beside a measured velocity, s. The more exact the velocity, the longer its integral would stand for
/// the position, with the error of the first reading in it.
const LONGEST_MEMORY_S: f64 = 1.0;
/// What models of translation miss where positions alone are read.
const BESIDE_POSITIONS: Missed = Missed { acceleration: 0.3, wandering: 0.3, drift: 0.0 };
/// Acceleration that is missed beside a measured velocity, m/s²: a model that is trusted more lags behind while the vehicle is not what it
/// is taken for.
const BESIDE_VELOCITY_M_S2: f64 = 1.0;
/// What the model of rotation misses where angles alone are read: a torque about roll and pitch is found within 0.07 s. Faster, a
/// milliradian of noise would pass for torques that shake the vehicle.
const BESIDE_LEAN: Missed = Missed { acceleration: 3.0, wandering: 10.0, drift: 0.0 };
/// The same beside measured body rates: a torque is found within three samples.
const BESIDE_LEAN_RATES: Missed = Missed { wandering: 30.0, ..BESIDE_LEAN };
/// The same about yaw, with and without its rate, within 0.14 s: rotors make little torque about yaw, and that noise would pass for more than
/// they can make. What they do while they spin up is known less well than what their thrust does, too.
const BESIDE_HEADING: Missed = Missed { wandering: 3.0, ..BESIDE_LEAN };
/// So many deviations of its noise an unexplained angular acceleration must be away from what was answered last to have changed.
const SURE_DEVIATIONS: f64 = 4.0;

/// The predictors of one axis of translation and of rotation, at the attitude controller's sample time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EstimatorDesign {
    pub(crate) translation: AxisPredictor,
    /// Of roll, pitch and yaw.
    pub(crate) rotation: [AxisPredictor; 3],
    /// How far the predictor lags behind an acceleration that the model does not explain, s: sooner, noise does not tell one. Zero where
    /// velocities are measured exactly.
    pub(crate) disturbance_lag_s: f64,
    /// By so much the unexplained angular acceleration may be off by noise alone, FRD, rad/s².
    pub(crate) unsure_rad_s2: Vector3<f64>,
    pub(crate) sample_time_s: f64,
}

impl EstimatorDesign {
    /// For the noise and the sample time of a configuration.
    ///
    /// # Errors
    /// Those of [`KalmanDesign::new`](lmpc::KalmanDesign::new).
    pub(crate) fn new(configuration: &Configuration) -> Result<Self, DesignError> {
        let sensors = &configuration.sensors;
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        let translation = translation(sensors, sample_time_s)?;
        let lean = rotation(sensors, sample_time_s, [&BESIDE_LEAN, &BESIDE_LEAN_RATES])?;
        let turn = rotation(sensors, sample_time_s, [&BESIDE_HEADING; 2])?;
        let rotation = [lean, lean, turn];
        let estimates = sensors.estimates_motion();
        let turning = [sensors.attitude_noise_rad, sensors.body_rate_noise_rad_s];
        Ok(Self {
            translation,
            rotation,
            disturbance_lag_s: if estimates { translation.disturbance_lag_s(sample_time_s)? } else { 0.0 },
            unsure_rad_s2: Vector3::from(rotation.map(|axis| axis.disturbance_noise(turning)))
                * SURE_DEVIATIONS,
            sample_time_s,
        })
    }
}

fn translation(sensors: &Sensors, sample_time_s: f64) -> Result<AxisPredictor, DesignError> {
    let position_m = sensors.position_noise_m.max(SMALLEST_NOISE.0);
    if !sensors.filters_motion() {
        return AxisPredictor::by_place(sample_time_s, position_m, &BESIDE_POSITIONS);
    }
    let velocity_m_s = sensors.velocity_noise_m_s.max(SMALLEST_RATE_NOISE.0);
    let missed = Missed {
        acceleration: BESIDE_VELOCITY_M_S2,
        drift: position_m / LONGEST_MEMORY_S,
        ..BESIDE_POSITIONS
    };
    AxisPredictor::by_motion(sample_time_s, [position_m, velocity_m_s], &missed)
}

/// With what its model misses beside angles alone, and beside angles and their rates.
fn rotation(
    sensors: &Sensors,
    sample_time_s: f64,
    [beside_angle, beside_rate]: [&Missed; 2],
) -> Result<AxisPredictor, DesignError> {
    let angle_rad = sensors.attitude_noise_rad.max(SMALLEST_NOISE.1);
    if sensors.output_feedback {
        return AxisPredictor::by_place(sample_time_s, angle_rad, beside_angle);
    }
    let rate_rad_s = sensors.body_rate_noise_rad_s.max(SMALLEST_RATE_NOISE.1);
    AxisPredictor::by_motion(sample_time_s, [angle_rad, rate_rad_s], beside_rate)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::EstimatorDesign;
    use crate::{Configuration, Sensors};

    /// A torque is found within three samples by body rates, within 0.07 s by angles alone, and later under noise, of which it must
    /// stick out.
    #[test]
    fn torques_are_found_as_soon_as_noise_lets_them() {
        let of = |sensors: Sensors| {
            EstimatorDesign::new(&Configuration { sensors, ..Configuration::default() }).unwrap()
        };
        let lag_s = |design: &EstimatorDesign| design.rotation[0].disturbance_lag_s(0.01).unwrap();
        let exact = of(Sensors::default());
        let angles = of(Sensors { output_feedback: true, ..Sensors::default() });
        assert!(lag_s(&exact) < 0.03 && lag_s(&angles) < 0.07, "{} {}", lag_s(&exact), lag_s(&angles));
        assert_eq!((exact.unsure_rad_s2, angles.unsure_rad_s2), (Vector3::zeros(), Vector3::zeros()));
        let noisy = Sensors { attitude_noise_rad: 0.01, body_rate_noise_rad_s: 0.1, ..Sensors::default() };
        let noisy = of(noisy);
        assert!(lag_s(&noisy) > lag_s(&exact) && noisy.unsure_rad_s2.min() > 1.0, "{noisy:?}");
    }

    /// After a step of an acceleration that the model does not explain, what is missing of its estimate adds up to the lag.
    #[test]
    fn the_lag_is_that_of_a_step() {
        let noisy = Sensors { position_noise_m: 0.02, velocity_noise_m_s: 0.05, ..Sensors::default() };
        for sensors in [
            noisy,
            Sensors { output_feedback: true, ..noisy },
            Sensors { output_feedback: true, ..Sensors::default() },
        ] {
            let design =
                EstimatorDesign::new(&Configuration { sensors, ..Configuration::default() }).unwrap();
            let t = design.sample_time_s;
            let ([mut position, mut velocity], mut estimate) = ([0.0; 2], [0.0; 3]);
            let mut missing_s = 0.0;
            for _ in 0..2_000 {
                missing_s += (1.0 - estimate[2]) * t;
                estimate = design.translation.predict(&estimate, 0.0, [position, velocity]).into();
                position += velocity * t + t * t / 2.0;
                velocity += t;
            }
            assert!(
                (missing_s - design.disturbance_lag_s).abs() < 1e-6,
                "{missing_s} s, {}",
                design.disturbance_lag_s
            );
            assert!((0.1..0.6).contains(&missing_s), "{missing_s} s");
        }
        let exact = EstimatorDesign::new(&Configuration::default()).unwrap();
        assert_eq!(exact.disturbance_lag_s, 0.0);
    }
}
