//! The stationary Kalman predictor (26) of one axis of the motion.

use lmpc::{DesignError, KalmanDesign, KalmanPredictor, NoiseCovariance, StateSpace};
use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector1, Vector2, Vector3};

/// How often the time is doubled over which noise adds up: to the longest that numbers can tell from for ever.
const DOUBLINGS: usize = 40;

/// The predictor of one axis: place or angle, its rate, and the acceleration that the model does not explain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum AxisPredictor {
    /// Position or angle alone are read.
    ByPlace(KalmanPredictor<3, 1, 1>),
    /// Their rates are, too.
    ByMotion(KalmanPredictor<3, 1, 2>),
}

/// What the model of an axis does not know of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Missed {
    /// Standard deviation of the acceleration that is missed from sample to sample, m/s² or rad/s².
    pub(crate) acceleration: f64,
    /// How fast disturbances wander, m/s² or rad/s² per √s.
    pub(crate) wandering: f64,
    /// How fast the place is let move beside the rate, m/s or rad/s.
    pub(crate) drift: f64,
}

impl AxisPredictor {
    /// From readings of position or angle under noise of this standard deviation, m or rad.
    pub(crate) fn by_place(sample_time_s: f64, noise: f64, missed: &Missed) -> Result<Self, DesignError> {
        predictor(sample_time_s, [noise], missed).map(Self::ByPlace)
    }

    /// From those and from readings of the rate, m/s or rad/s.
    pub(crate) fn by_motion(
        sample_time_s: f64,
        noise: [f64; 2],
        missed: &Missed,
    ) -> Result<Self, DesignError> {
        predictor(sample_time_s, noise, missed).map(Self::ByMotion)
    }

    /// Place, rate and unexplained acceleration at the next sample, from those at this one, the acceleration by the model until then, and the
    /// readings of place and rate: m, m/s, m/s² or rad, rad/s, rad/s².
    // The estimate stays in registers.
    #[inline(always)]
    pub(crate) fn predict(
        &self,
        estimate: &[f64; 3],
        modelled: f64,
        [place, rate]: [f64; 2],
    ) -> SVector<f64, 3> {
        let (estimate, input) = (SVector::from(*estimate), Vector1::new(modelled));
        match self {
            Self::ByPlace(predictor) => predictor.predict(&estimate, &input, &Vector1::new(place)),
            Self::ByMotion(predictor) => predictor.predict(&estimate, &input, &Vector2::new(place, rate)),
        }
    }

    /// A − K C, by which an error of the estimate goes on: without input and readings, an estimate does as an error.
    fn fading(&self) -> Matrix3<f64> {
        let units = [Vector3::x(), Vector3::y(), Vector3::z()];
        Matrix3::from_columns(&units.map(|error| self.predict(&error.into(), 0.0, [0.0; 2])))
    }

    /// How far it lags behind an acceleration that the model does not explain, s. An error fades with e⁺ = (A − K C) e: after a step of d its
    /// third element is T Σ (A − K C)ᵏ long, which is T (I − A + K C)⁻¹.
    pub(crate) fn disturbance_lag_s(&self, sample_time_s: f64) -> Result<f64, DesignError> {
        let lasting = (Matrix3::identity() - self.fading()).try_inverse();
        let lasting = lasting.ok_or(DesignError::NotFinite { name: "(I − A + K C)⁻¹" })?;
        Ok(sample_time_s * lasting[(2, 2)])
    }

    /// Standard deviation of the unexplained acceleration that white noise of these standard deviations makes of nothing, m/s² or rad/s²:
    /// that of S = F S Fᵀ + K V Kᵀ with F = A − K C, doubled in time by S ← S + F S Fᵀ, F ← F F.
    pub(crate) fn disturbance_noise(&self, noise: [f64; 2]) -> f64 {
        let gain = |reading: [f64; 2]| self.predict(&[0.0; 3], 0.0, reading);
        let [by_place, by_rate] = [gain([noise[0], 0.0]), gain([0.0, noise[1]])];
        let mut spread = by_place * by_place.transpose() + by_rate * by_rate.transpose();
        let mut fading = self.fading();
        for _ in 0..DOUBLINGS {
            spread += fading * spread * fading.transpose();
            fading *= fading;
        }
        libm::sqrt(spread[(2, 2)].max(0.0))
    }
}

/// The predictor of \[p; v; d\]: p⁺ = p + T v + T²/2 (u + d), v⁺ = v + T (u + d), d⁺ = d, measuring the first Q of them under noise
/// of these standard deviations. By the drift times T in a sample p moves beside v.
fn predictor<const Q: usize>(
    t: f64,
    noise: [f64; Q],
    missed: &Missed,
) -> Result<KalmanPredictor<3, 1, Q>, DesignError> {
    let half = t * t / 2.0;
    let a = DMatrix::from_row_slice(3, 3, &[1.0, t, half, 0.0, 1.0, t, 0.0, 0.0, 1.0]);
    let b = DMatrix::from_column_slice(3, 1, &[half, t, 0.0]);
    // w = [T²/2; T; 0] a + [0; 0; √T] b + [T; 0; 0] c
    let accelerated = &b * missed.acceleration;
    let plant = StateSpace::new(a, b, DMatrix::identity(Q, 3))?;
    let mut w = &accelerated * accelerated.transpose();
    w[(2, 2)] = missed.wandering * missed.wandering * t;
    w[(0, 0)] += missed.drift * t * missed.drift * t;
    let v = DMatrix::from_diagonal(&DVector::from_iterator(Q, noise.map(|deviation| deviation * deviation)));
    let covariance = NoiseCovariance::uncorrelated(w, v);
    KalmanPredictor::new(&plant, &KalmanDesign::new(&plant, &covariance)?)
}

#[cfg(test)]
mod tests {
    use super::{AxisPredictor, Missed};

    const MISSED: Missed = Missed { acceleration: 3.0, wandering: 30.0, drift: 0.0 };

    /// A minute of noise, which a hash of the sample's number makes white and even, by which its deviation is 1/√3 of its bound.
    #[test]
    fn noise_makes_as_much_of_nothing_as_is_said() {
        let by_place = AxisPredictor::by_place(0.01, 1e-3, &MISSED).unwrap();
        let by_motion = AxisPredictor::by_motion(0.01, [1e-3, 5e-3], &MISSED).unwrap();
        for (predictor, noise) in [(by_place, [2e-3, 0.0]), (by_motion, [2e-3, 1e-2])] {
            let (mut estimate, mut sum) = ([0.0; 3], 0.0);
            for sample in 0..60_000_u64 {
                let white = |channel: u64| {
                    let hash = (2 * sample + channel + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
                    let hash = (hash ^ (hash >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
                    ((hash >> 11) as f64 / (1_u64 << 52) as f64 - 1.0) * 3.0_f64.sqrt()
                };
                let reading = [0, 1].map(|channel| noise[channel] * white(channel as u64));
                estimate = predictor.predict(&estimate, 0.0, reading).into();
                sum += estimate[2] * estimate[2];
            }
            let (found, said) = ((sum / 60_000.0_f64).sqrt(), predictor.disturbance_noise(noise));
            assert!((found / said - 1.0).abs() < 0.05, "{found} and {said} rad/s²");
        }
        assert_eq!(by_motion.disturbance_noise([0.0; 2]), 0.0);
    }
}
