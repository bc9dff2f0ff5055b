//! The stationary Kalman predictor.

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::precision::converted;
use crate::validate::{self, symmetrized};
use crate::{DesignError, Precision, StateSpace, solve_riccati};

/// Covariances of the noise in x⁺ = A x + B u + w, y = C x + D u + v (24)–(25).
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseCovariance {
    /// W, of the state noise, n×n.
    pub state: DMatrix<f64>,
    /// V, of the measurement noise, q×q, positive definite.
    pub measurement: DMatrix<f64>,
    /// Z = E\[w vᵀ\], n×q.
    pub cross: DMatrix<f64>,
}

impl NoiseCovariance {
    /// Without correlation between the two: Z = 0.
    pub fn uncorrelated(state: DMatrix<f64>, measurement: DMatrix<f64>) -> Self {
        let cross = DMatrix::zeros(state.nrows(), measurement.nrows());
        Self { state, measurement, cross }
    }
}

/// Design of the stationary predictor (26)–(27).
#[derive(Clone, Debug, PartialEq)]
pub struct KalmanDesign {
    gain: DMatrix<f64>,
    covariance: DMatrix<f64>,
}

impl KalmanDesign {
    /// Solves (27) for a plant and its noise.
    ///
    /// # Errors
    /// [`DesignError::Dimension`], [`DesignError::ElementNotFinite`], [`DesignError::NotPositiveDefinite`] (V),
    /// [`DesignError::NotPositiveSemidefinite`] (\[W Z; Zᵀ V\]), [`DesignError::Undetectable`] for a mode
    /// that is not stable and not measured, [`DesignError::Uncontrollable`] for one on or outside the unit
    /// circle that no noise excites, [`DesignError::Riccati`].
    pub fn new(plant: &StateSpace, noise: &NoiseCovariance) -> Result<Self, DesignError> {
        let (n, q) = (plant.states(), plant.outputs());
        let (w, v, z) = (&noise.state, &noise.measurement, &noise.cross);
        validate::shape("W", w, (n, n))?;
        validate::shape("V", v, (q, q))?;
        validate::shape("Z", z, (n, q))?;
        validate::positive_definite("V", v)?;
        let mut joint = DMatrix::zeros(n + q, n + q);
        joint.view_mut((0, 0), (n, n)).copy_from(w);
        joint.view_mut((0, n), (n, q)).copy_from(z);
        joint.view_mut((n, 0), (q, n)).copy_from(&z.transpose());
        joint.view_mut((n, n), (q, q)).copy_from(v);
        validate::positive_semidefinite("[W Z; Zᵀ V]", &joint)?;

        // Without the part of w that y gives away, w̄ = w − Z V⁻¹ v, the two noises are uncorrelated:
        // Ā = A − Z V⁻¹ C,  W̄ = W − Z V⁻¹ Zᵀ
        let (a, c) = (plant.a(), plant.c());
        let z_t = z.transpose();
        let v_factor = validate::cholesky("V", v)?;
        let a_bar = a - z * v_factor.solve(c);
        let w_bar = symmetrized(&(w - z * v_factor.solve(&z_t)));

        // The filter's equation is the regulator's of the transposed plant.
        let covariance =
            solve_riccati(&a_bar.transpose(), &c.transpose(), &w_bar, v).map_err(|error| match error {
                DesignError::Uncontrollable { re, im } => DesignError::Undetectable { re, im },
                DesignError::Undetectable { re, im } => DesignError::Uncontrollable { re, im },
                other => other,
            })?;
        // K = (A P Cᵀ + Z)(C P Cᵀ + V)⁻¹
        let innovation = symmetrized(&(c * &covariance * c.transpose() + v));
        let innovation_factor = validate::cholesky("C P Cᵀ + V", &innovation)?;
        let gain = innovation_factor.solve(&(c * &covariance * a.transpose() + z_t)).transpose();
        Ok(Self { gain, covariance })
    }

    /// K, n×q.
    pub fn gain(&self) -> &DMatrix<f64> {
        &self.gain
    }

    /// P, n×n: the covariance of x(k) − x̂(k|k−1).
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }
}

/// The run-time predictor (26) for N states, P inputs and Q outputs: no allocation. A
/// [direct term](StateSpace#the-direct-term-d) D u(k) is subtracted from the measurement by the caller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct KalmanPredictor<const N: usize, const P: usize, const Q: usize, T = f64> {
    a: SMatrix<T, N, N>,
    b: SMatrix<T, N, P>,
    c: SMatrix<T, Q, N>,
    gain: SMatrix<T, N, Q>,
}

impl<const N: usize, const P: usize, const Q: usize> KalmanPredictor<N, P, Q> {
    /// The predictor of a design.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the plant's sizes differ from the const generics.
    pub fn new(plant: &StateSpace, design: &KalmanDesign) -> Result<Self, DesignError> {
        validate::shape("A", plant.a(), (N, N))?;
        validate::shape("B", plant.b(), (N, P))?;
        validate::shape("C", plant.c(), (Q, N))?;
        validate::shape("K", design.gain(), (N, Q))?;
        Ok(Self {
            a: SMatrix::from_fn(|i, j| plant.a()[(i, j)]),
            b: SMatrix::from_fn(|i, j| plant.b()[(i, j)]),
            c: SMatrix::from_fn(|i, j| plant.c()[(i, j)]),
            gain: SMatrix::from_fn(|i, j| design.gain()[(i, j)]),
        })
    }
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> KalmanPredictor<N, P, Q, T> {
    /// The same predictor in another precision.
    pub fn to_precision<U: Precision>(&self) -> KalmanPredictor<N, P, Q, U> {
        KalmanPredictor {
            a: converted(&self.a),
            b: converted(&self.b),
            c: converted(&self.c),
            gain: converted(&self.gain),
        }
    }

    /// x̂(k+1|k) from x̂(k|k−1), the input u(k) and the measurement y(k). A result that is not finite is
    /// replaced by the prediction without the measurement, or by the old estimate.
    // Few numbers, which stay in registers.
    #[inline(always)]
    pub fn predict(
        &self,
        estimate: &SVector<T, N>,
        input: &SVector<T, P>,
        measurement: &SVector<T, Q>,
    ) -> SVector<T, N> {
        // x̂(k+1|k) = A x̂(k|k−1) + B u(k) + K (y(k) − C x̂(k|k−1))
        let open_loop = self.a * estimate + self.b * input;
        let corrected = open_loop + self.gain * (measurement - self.c * estimate);
        let is_finite =
            |estimate: &SVector<T, N>| estimate.iter().fold(true, |all, value| all & value.is_finite());
        if is_finite(&corrected) {
            corrected
        } else if is_finite(&open_loop) {
            open_loop
        } else {
            *estimate
        }
    }
}
