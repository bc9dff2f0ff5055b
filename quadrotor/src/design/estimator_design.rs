//! The gains of the stationary Kalman predictor (26).

use lmpc::{DesignError, KalmanDesign, KalmanPredictor, NoiseCovariance, StateSpace};
use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector1, Vector2, Vector3};

use crate::{Configuration, Sensors};

/// Smallest standard deviations that the design counts with, m and rad: without noise the predictor would
/// follow each rounding.
const SMALLEST_NOISE: (f64, f64) = (1e-3, 1e-3);
/// The same of the velocity, m/s.
const SMALLEST_VELOCITY_NOISE_M_S: f64 = 1e-3;
/// The longest memory of positions beside a measured velocity, s. The more exact the velocity, the longer its integral would stand for
/// the position, with the error of the first reading in it.
const LONGEST_MEMORY_S: f64 = 1.0;
/// Standard deviation of the acceleration that the model misses from sample to sample, m/s² and rad/s².
const MODEL_NOISE: (f64, f64) = (0.3, 3.0);
/// The same beside a measured velocity, m/s²: a model that is trusted more lags behind while the vehicle is not what it is taken for.
const MODEL_NOISE_BESIDE_VELOCITY: f64 = 1.0;
/// How fast disturbances wander, m/s² and rad/s² per √s.
const WANDERING: (f64, f64) = (0.3, 3.0);

/// One axis: position or angle, its rate, and the acceleration that the model does not explain.
pub(crate) type Axis = KalmanPredictor<3, 1, 1>;

/// One axis of translation, by what is measured of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TranslationAxis {
    /// The position alone is read.
    ByPosition(Axis),
    /// Position and velocity are.
    ByMotion(KalmanPredictor<3, 1, 2>),
}

impl TranslationAxis {
    fn new(sensors: &Sensors, sample_time_s: f64) -> Result<Self, DesignError> {
        let position_m = sensors.position_noise_m.max(SMALLEST_NOISE.0);
        if sensors.filters_motion() {
            let velocity_m_s = sensors.velocity_noise_m_s.max(SMALLEST_VELOCITY_NOISE_M_S);
            let deviations = [position_m, velocity_m_s];
            let drift = position_m / LONGEST_MEMORY_S;
            axis(sample_time_s, deviations, MODEL_NOISE_BESIDE_VELOCITY, WANDERING.0, drift)
                .map(Self::ByMotion)
        } else {
            axis(sample_time_s, [position_m], MODEL_NOISE.0, WANDERING.0, 0.0).map(Self::ByPosition)
        }
    }

    /// How far it lags behind an acceleration that the model does not explain, s. An error fades with e⁺ = (A − K C) e: after a step of d its
    /// third element is T Σ (A − K C)ᵏ long, which is T (I − A + K C)⁻¹.
    fn disturbance_lag_s(&self, sample_time_s: f64) -> Result<f64, DesignError> {
        // Without input and measurement, an estimate fades as an error does.
        let faded = Matrix3::from_columns(
            &[Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|error| self.predict(&error.into(), 0.0, [0.0; 2])),
        );
        let lasting = (Matrix3::identity() - faded).try_inverse();
        let lasting = lasting.ok_or(DesignError::NotFinite { name: "(I − A + K C)⁻¹" })?;
        Ok(sample_time_s * lasting[(2, 2)])
    }

    /// Position, m, velocity, m/s, and unexplained acceleration, m/s², at the next sample, from those at this one, the acceleration
    /// by the model until then, m/s², and the measured position and velocity.
    // The estimate stays in registers.
    #[inline(always)]
    pub(crate) fn predict(
        &self,
        estimate: &[f64; 3],
        modelled_m_s2: f64,
        [position_m, velocity_m_s]: [f64; 2],
    ) -> SVector<f64, 3> {
        let (estimate, input) = (SVector::from(*estimate), Vector1::new(modelled_m_s2));
        match self {
            Self::ByPosition(axis) => axis.predict(&estimate, &input, &Vector1::new(position_m)),
            Self::ByMotion(axis) => axis.predict(&estimate, &input, &Vector2::new(position_m, velocity_m_s)),
        }
    }
}

/// The predictors of one axis of translation and of one of rotation, at the attitude controller's sample
/// time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EstimatorDesign {
    pub(crate) translation: TranslationAxis,
    pub(crate) rotation: Axis,
    /// How far the predictor lags behind an acceleration that the model does not explain, s: sooner, noise does not tell one. Zero where
    /// velocities are measured exactly.
    pub(crate) disturbance_lag_s: f64,
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
        let translation = TranslationAxis::new(sensors, sample_time_s)?;
        let estimates = sensors.estimates_motion();
        Ok(Self {
            translation,
            rotation: axis(
                sample_time_s,
                [sensors.attitude_noise_rad.max(SMALLEST_NOISE.1)],
                MODEL_NOISE.1,
                WANDERING.1,
                0.0,
            )?,
            disturbance_lag_s: if estimates { translation.disturbance_lag_s(sample_time_s)? } else { 0.0 },
            sample_time_s,
        })
    }
}

/// The predictor of \[p; v; d\]: p⁺ = p + T v + T²/2 (u + d), v⁺ = v + T (u + d), d⁺ = d, measuring the first Q of them under noise
/// of these standard deviations. By `drift` T in a sample p moves beside v.
fn axis<const Q: usize>(
    t: f64,
    noise: [f64; Q],
    model_noise: f64,
    wandering: f64,
    drift: f64,
) -> Result<KalmanPredictor<3, 1, Q>, DesignError> {
    let half = t * t / 2.0;
    let a = DMatrix::from_row_slice(3, 3, &[1.0, t, half, 0.0, 1.0, t, 0.0, 0.0, 1.0]);
    let b = DMatrix::from_column_slice(3, 1, &[half, t, 0.0]);
    // w = [T²/2; T; 0] a + [0; 0; √T] b + [T; 0; 0] c
    let missed = &b * model_noise;
    let plant = StateSpace::new(a, b, DMatrix::identity(Q, 3))?;
    let mut w = &missed * missed.transpose();
    w[(2, 2)] = wandering * wandering * t;
    w[(0, 0)] += drift * t * drift * t;
    let v = DMatrix::from_diagonal(&DVector::from_iterator(Q, noise.map(|deviation| deviation * deviation)));
    let covariance = NoiseCovariance::uncorrelated(w, v);
    KalmanPredictor::new(&plant, &KalmanDesign::new(&plant, &covariance)?)
}

#[cfg(test)]
mod tests {
    use super::EstimatorDesign;
    use crate::{Configuration, Sensors};

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
