//! The minimum of a quadratic cost as a linear function of the state, and how far rounding may be in it.

use nalgebra::{DMatrix, DVector};

use crate::{DesignError, condition_number};

/// Largest accepted share of a gain that rounding may have changed. Far less than what a plant's own parameters are
/// uncertain by, and far more than what a design loses whose unknowns are independent of one another.
const ALLOWED_ERROR: f64 = 1e-4;

/// η = −H⁻¹G x minimises ½ ηᵀHη + ηᵀG x; the first move S η is −S H⁻¹G x.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OptimalGain {
    /// H⁻¹G.
    pub(crate) unknowns: DMatrix<f64>,
    /// S H⁻¹G.
    pub(crate) first_move: DMatrix<f64>,
    /// Condition number of H, finite.
    pub(crate) condition: f64,
    /// What share of the first move's gain rounding may have changed, at most.
    pub(crate) error: f64,
}

impl OptimalGain {
    /// For H, symmetric, called `name`, G and S.
    ///
    /// Condition numbers of H tell little: the first move often depends on what is well determined. The estimate follows
    /// rounding to it instead. Sums such as H and G have errors of about ε √(H_ii H_jj) and ε |G_ij|, so that the gain has
    /// errors of ε |S H⁻¹| (|G| + d dᵀ|H⁻¹G|) with d_i = √H_ii, as Skeel (1979) has it, element by element: the scales of
    /// unknowns, states and inputs make no difference.
    ///
    /// # Errors
    /// [`DesignError::IllConditioned`] when that is more than 10⁻⁴ of the gain, or when H is singular.
    pub(crate) fn new(
        name: &'static str,
        h: &DMatrix<f64>,
        g: &DMatrix<f64>,
        s: &DMatrix<f64>,
    ) -> Result<Self, DesignError> {
        let condition = condition_number(h);
        let refused = |error: f64| DesignError::IllConditioned {
            name,
            condition,
            // A NaN too.
            error: if error < 1.0 { error } else { 1.0 },
            allowed: ALLOWED_ERROR,
        };
        // A singular H leaves the moves after the first undetermined, which limits are about.
        let factor = h.clone().cholesky().filter(|_| condition.is_finite()).ok_or_else(|| refused(1.0))?;
        let unknowns = factor.solve(g);
        let first_move = s * &unknowns;
        let sizes = h.diagonal().map(libm::sqrt);
        let to_first_move = factor.solve(&s.transpose()).transpose().abs();
        let errors =
            &to_first_move * g.abs() + (&to_first_move * &sizes) * (sizes.transpose() * unknowns.abs());

        // The states in units in which each drives the cost alike.
        let units = DVector::from_fn(g.ncols(), |j, _| {
            let drive = g.column(j).component_div(&sizes).norm();
            if drive > 0.0 { 1.0 / drive } else { 0.0 }
        });
        let largest = |matrix: &DMatrix<f64>, input: usize| {
            (0..g.ncols()).map(|j| libm::fabs(matrix[(input, j)]) * units[j]).fold(0.0, f64::max)
        };
        let mut error = 0.0_f64;
        for input in 0..s.nrows() {
            let (rounding, gain) = (f64::EPSILON * largest(&errors, input), largest(&first_move, input));
            // An input that nothing drives has no gain to be wrong.
            let share = if rounding > 0.0 { rounding / gain } else { 0.0 };
            error = if share > error || share.is_nan() { share } else { error };
        }
        if error <= ALLOWED_ERROR {
            Ok(Self { unknowns, first_move, condition, error })
        } else {
            Err(refused(error))
        }
    }
}
