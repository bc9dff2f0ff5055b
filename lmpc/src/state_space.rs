//! The discrete plant model x(k+1) = A x(k) + B u(k), y(k) = C x(k).

use nalgebra::DMatrix;

use crate::exponential::exponential;
use crate::{DesignError, validate};

/// How a continuous model is turned into a discrete one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Discretization {
    /// A = I + A_c T, B = B_c T: the paper's choice, (9), (15), (23).
    ForwardEuler,
    /// Exact for an input that is constant between samples: \[A B; 0 I\] = exp(\[A_c B_c; 0 0\] T).
    ZeroOrderHold,
}

/// A discrete linear plant with n states, p inputs and q outputs: A_m, B_m, C_m of (35), without the
/// disturbance.
///
/// # The direct term D
///
/// (24), (26), (29) and (33) have a term D u(k) in the output; (35) and this type have none. The outputs of the
/// paper's plants (9), (15), (23) are positions and angles, and C picks them from the states: a force needs two
/// integrations to move a position, so that D = 0. Nor could a law that computes u(k) from y(k) have it, because y(k)
/// would depend on what it decides.
///
/// For a plant that has a direct term:
/// * A law measures y(k) before it applies u(k): [`StateSpace::with_direct_term`] makes y(k) = C x(k) + D u(k−1) of it.
/// * A [`KalmanPredictor`](crate::KalmanPredictor) knows u(k): give it y(k) − D u(k) as the measurement, which is (26). K and P
///   of (27) do not depend on D.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
}

impl StateSpace {
    /// From the discrete matrices A (n×n), B (n×p) and C (q×n).
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the shapes do not fit or one is empty, [`DesignError::ElementNotFinite`].
    pub fn new(a: DMatrix<f64>, b: DMatrix<f64>, c: DMatrix<f64>) -> Result<Self, DesignError> {
        let states = a.nrows().max(1);
        validate::shape("A", &a, (states, states))?;
        validate::shape("B", &b, (states, b.ncols().max(1)))?;
        validate::shape("C", &c, (c.nrows().max(1), states))?;
        Ok(Self { a, b, c })
    }

    /// From A, B, C and the direct term D, q×p, of an output that is measured just before the input changes:
    /// y(k) = C x(k) + D u(k−1). The states are \[x(k); u(k−1)\]:
    ///
    /// ```text
    /// A_m = [A 0]   B_m = [B]   C_m = [C D]
    ///       [0 0]         [I]
    /// ```
    ///
    /// # Errors
    /// As [`StateSpace::new`].
    pub fn with_direct_term(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        c: &DMatrix<f64>,
        d: &DMatrix<f64>,
    ) -> Result<Self, DesignError> {
        let plant = Self::new(a.clone(), b.clone(), c.clone())?;
        let (n, p, q) = (plant.states(), plant.inputs(), plant.outputs());
        validate::shape("D", d, (q, p))?;
        let mut b_m = b.clone().resize_vertically(n + p, 0.0);
        b_m.view_mut((n, 0), (p, p)).fill_with_identity();
        let mut c_m = c.clone().resize_horizontally(n + p, 0.0);
        c_m.view_mut((0, n), (q, p)).copy_from(d);
        Self::new(a.clone().resize(n + p, n + p, 0.0), b_m, c_m)
    }

    /// From continuous matrices, ẋ = A_c x + B_c u, y = C x, sampled every `sample_time_s`.
    ///
    /// # Errors
    /// [`DesignError::SampleTime`] unless it is positive and finite, and those of [`StateSpace::new`].
    pub fn from_continuous(
        a_c: &DMatrix<f64>,
        b_c: &DMatrix<f64>,
        c: &DMatrix<f64>,
        sample_time_s: f64,
        discretization: Discretization,
    ) -> Result<Self, DesignError> {
        if !(sample_time_s > 0.0 && sample_time_s.is_finite()) {
            return Err(DesignError::SampleTime { value: sample_time_s });
        }
        // Checks the shapes before they are used below.
        let continuous = Self::new(a_c.clone(), b_c.clone(), c.clone())?;
        let (n, p) = (continuous.states(), continuous.inputs());
        let (a, b) = match discretization {
            Discretization::ForwardEuler => {
                // A = I + A_c T,  B = B_c T
                (DMatrix::identity(n, n) + a_c * sample_time_s, b_c * sample_time_s)
            }
            Discretization::ZeroOrderHold => {
                // [A B; 0 I] = exp([A_c B_c; 0 0] T)
                let mut block = DMatrix::zeros(n + p, n + p);
                block.view_mut((0, 0), (n, n)).copy_from(&(a_c * sample_time_s));
                block.view_mut((0, n), (n, p)).copy_from(&(b_c * sample_time_s));
                let exponential = exponential(&block);
                (exponential.view((0, 0), (n, n)).into_owned(), exponential.view((0, n), (n, p)).into_owned())
            }
        };
        Self::new(a, b, c.clone())
    }

    /// A_m, n×n.
    pub fn a(&self) -> &DMatrix<f64> {
        &self.a
    }

    /// B_m, n×p.
    pub fn b(&self) -> &DMatrix<f64> {
        &self.b
    }

    /// C_m, q×n.
    pub fn c(&self) -> &DMatrix<f64> {
        &self.c
    }

    /// Number of states n.
    pub fn states(&self) -> usize {
        self.a.nrows()
    }

    /// Number of inputs p.
    pub fn inputs(&self) -> usize {
        self.b.ncols()
    }

    /// Number of outputs q.
    pub fn outputs(&self) -> usize {
        self.c.nrows()
    }
}
