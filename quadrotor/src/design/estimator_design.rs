//! The gains of the stationary Kalman predictor (26).

use lmpc::{DesignError, KalmanDesign, KalmanPredictor, NoiseCovariance, StateSpace};
use nalgebra::DMatrix;

use crate::Configuration;

/// Smallest standard deviations that the design counts with, m and rad: without noise the predictor would
/// follow each rounding.
const SMALLEST_NOISE: (f64, f64) = (1e-3, 1e-3);
/// Standard deviation of the acceleration that the model misses from sample to sample, m/s² and rad/s².
const MODEL_NOISE: (f64, f64) = (0.3, 3.0);
/// How fast disturbances wander, m/s² and rad/s² per √s.
const WANDERING: (f64, f64) = (0.3, 3.0);

/// One axis: position or angle, its rate, and the acceleration that the model does not explain.
pub(crate) type Axis = KalmanPredictor<3, 1, 1>;

/// The predictors of one axis of translation and of one of rotation, at the attitude controller's sample
/// time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EstimatorDesign {
    pub(crate) translation: Axis,
    pub(crate) rotation: Axis,
    pub(crate) sample_time_s: f64,
}

impl EstimatorDesign {
    /// For the noise and the sample time of a configuration.
    ///
    /// # Errors
    /// Those of [`KalmanDesign::new`].
    pub(crate) fn new(configuration: &Configuration) -> Result<Self, DesignError> {
        let sensors = &configuration.sensors;
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        Ok(Self {
            translation: axis(
                sample_time_s,
                sensors.position_noise_m.max(SMALLEST_NOISE.0),
                MODEL_NOISE.0,
                WANDERING.0,
            )?,
            rotation: axis(
                sample_time_s,
                sensors.attitude_noise_rad.max(SMALLEST_NOISE.1),
                MODEL_NOISE.1,
                WANDERING.1,
            )?,
            sample_time_s,
        })
    }
}

/// The predictor of \[p; v; d\]: p⁺ = p + T v + T²/2 (u + d), v⁺ = v + T (u + d), d⁺ = d, measuring p.
fn axis(t: f64, noise: f64, model_noise: f64, wandering: f64) -> Result<Axis, DesignError> {
    let half = t * t / 2.0;
    let a = DMatrix::from_row_slice(3, 3, &[1.0, t, half, 0.0, 1.0, t, 0.0, 0.0, 1.0]);
    let b = DMatrix::from_column_slice(3, 1, &[half, t, 0.0]);
    // w = [T²/2; T; 0] a + [0; 0; √T] b
    let missed = &b * model_noise;
    let plant = StateSpace::new(a, b, DMatrix::from_row_slice(1, 3, &[1.0, 0.0, 0.0]))?;
    let mut w = &missed * missed.transpose();
    w[(2, 2)] = wandering * wandering * t;
    let covariance = NoiseCovariance::uncorrelated(w, DMatrix::from_element(1, 1, noise * noise));
    KalmanPredictor::new(&plant, &KalmanDesign::new(&plant, &covariance)?)
}
