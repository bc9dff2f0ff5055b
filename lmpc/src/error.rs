//! What can be wrong with a design.

use core::fmt::{Display, Formatter, Result as FormatResult};

use thiserror::Error;

/// A number of any size, for a person.
struct Magnitude(f64);

impl Display for Magnitude {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> FormatResult {
        let Self(value) = self;
        if value.is_finite() { write!(formatter, "{value:.0e}") } else { formatter.write_str("above 1e16") }
    }
}

/// A number without an exponent where that is short.
struct Shown(f64);

impl Display for Shown {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> FormatResult {
        let Self(value) = self;
        let is_short = *value == 0.0 || (1e-3..1e6).contains(&value.max(-*value));
        if is_short { write!(formatter, "{value}") } else { write!(formatter, "{value:e}") }
    }
}

/// An eigenvalue, from its real and its imaginary part: `1`, `0.9 + 0.2i`.
struct Mode(f64, f64);

impl Display for Mode {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> FormatResult {
        let Self(re, im) = *self;
        Shown(re).fmt(formatter)?;
        if im == 0.0 {
            return Ok(());
        }
        formatter.write_str(if im < 0.0 { " - " } else { " + " })?;
        Shown(im.max(-im)).fmt(formatter)?;
        formatter.write_str("i")
    }
}

/// A violated precondition of a design, one variant each, with the numbers that show it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DesignError {
    /// A matrix has the wrong shape.
    #[error("{name} is {}×{}, expected {}×{}", actual.0, actual.1, expected.0, expected.1)]
    Dimension {
        /// The matrix, by the name the documentation uses.
        name: &'static str,
        /// Expected (rows, columns).
        expected: (usize, usize),
        /// Given (rows, columns).
        actual: (usize, usize),
    },
    /// What follows from the given numbers contains NaN or an infinity.
    #[error("{name} contains a value that is not finite")]
    NotFinite {
        /// The matrix or number.
        name: &'static str,
    },
    /// A given matrix contains NaN or an infinity.
    #[error("{name} contains a value that is not finite: element ({row}, {column}) is {value}")]
    ElementNotFinite {
        /// The matrix.
        name: &'static str,
        /// Row of the first such element, counted from 0.
        row: usize,
        /// Its column.
        column: usize,
        /// The element.
        value: f64,
    },
    /// A matrix must be symmetric and is not.
    #[error(
        "{name} is not symmetric: elements ({row}, {column}) and ({column}, {row}) differ by {}",
        Shown(*difference)
    )]
    NotSymmetric {
        /// The matrix.
        name: &'static str,
        /// Row of the worst pair.
        row: usize,
        /// Column of the worst pair.
        column: usize,
        /// By how much it differs.
        difference: f64,
    },
    /// R must be positive definite.
    #[error("{name} is not positive definite: it has the eigenvalue {}", Shown(*eigenvalue))]
    NotPositiveDefinite {
        /// The matrix.
        name: &'static str,
        /// Its smallest eigenvalue.
        eigenvalue: f64,
    },
    /// A slack must cost something, so that limits give way only where they have to.
    #[error("cost of the slack c = {value} is outside (0, ∞)")]
    SlackCost {
        /// Given cost.
        value: f64,
    },
    /// Q must be positive semidefinite.
    #[error("{name} is not positive semidefinite: it has the eigenvalue {}", Shown(*eigenvalue))]
    NotPositiveSemidefinite {
        /// The matrix.
        name: &'static str,
        /// Its smallest eigenvalue.
        eigenvalue: f64,
    },
    /// The sample time must be positive.
    #[error("sample time {value} s is outside (0, ∞)")]
    SampleTime {
        /// Given sample time, s.
        value: f64,
    },
    /// A Laguerre basis needs at least one term.
    #[error("the number of Laguerre terms N must be at least 1")]
    NoLaguerreTerms,
    /// The Laguerre scaling factor must lie in [0, 1).
    #[error("Laguerre scaling factor a = {value} is outside [0, 1)")]
    LaguerreScale {
        /// Given scaling factor.
        value: f64,
    },
    /// With a degree of stability λ the costs of later samples grow, and those of the Laguerre functions must decay faster: a < λ.
    #[error("Laguerre scaling factor a = {scale} is not below the degree of stability lambda = {lambda}")]
    LaguerreDecay {
        /// Given scaling factor.
        scale: f64,
        /// Given degree of stability.
        lambda: f64,
    },
    /// The control horizon must be positive for a ≈ e^(−N/N_c) to lie in [0, 1).
    #[error("control horizon N_c = {value} is outside (0, ∞)")]
    ControlHorizon {
        /// Given control horizon, samples.
        value: f64,
    },
    /// There must be one Laguerre basis for each input.
    #[error("{actual} Laguerre {} given; expected {expected}, one for each input", if *actual == 1 { "basis" } else { "bases" })]
    BasisCount {
        /// Number of inputs.
        expected: usize,
        /// Number of bases given.
        actual: usize,
    },
    /// N samples cannot determine more than N coefficients.
    #[error("prediction horizon N_p = {horizon} is shorter than the {terms} terms of a Laguerre basis")]
    HorizonTooShort {
        /// Given prediction horizon, samples.
        horizon: usize,
        /// Number of terms of the longest basis.
        terms: usize,
    },
    /// A state-space MPC's moves end before its horizon does.
    #[error(
        "control horizon N_c = {moves} must be at least 1 and below the prediction horizon N_p = {horizon}"
    )]
    MovesBeyondHorizon {
        /// Given prediction horizon, samples.
        horizon: usize,
        /// Given control horizon, samples.
        moves: usize,
    },
    /// The exponential weight must be at least 1.
    #[error("exponential weight α = {value} is outside [1, ∞)")]
    Alpha {
        /// Given weight.
        value: f64,
    },
    /// The degree of stability must lie in (0, 1].
    #[error("degree of stability λ = {value} is outside (0, 1]")]
    Lambda {
        /// Given degree.
        value: f64,
    },
    /// A mode on or outside the circle of radius λ cannot be moved by the inputs.
    #[error("the mode at {} is not controllable, so no gain stabilizes it", Mode(*re, *im))]
    Uncontrollable {
        /// Real part of the eigenvalue.
        re: f64,
        /// Imaginary part of the eigenvalue.
        im: f64,
    },
    /// A mode on or outside the circle of radius λ does not show in the cost.
    #[error("the mode at {} is not detectable through Q, so the optimum need not stabilize it", Mode(*re, *im))]
    Undetectable {
        /// Real part of the eigenvalue.
        re: f64,
        /// Imaginary part of the eigenvalue.
        im: f64,
    },
    /// The Riccati iteration did not reach a solution.
    #[error(
        "the Riccati equation was not solved: relative residual {residual:e} after {iterations} iterations"
    )]
    Riccati {
        /// ‖residual‖ / ‖P‖.
        residual: f64,
        /// Doubling steps made.
        iterations: usize,
    },
    /// The unknowns of the quadratic cost depend on one another so much that the gain is not right.
    #[error(
        "the matrix {name} is ill-conditioned (condition number {}): rounding can change the gain by {error:.0e} of its size, at most {allowed:.0e} is allowed; use fewer terms or moves, a smaller scale, lambda = 1, or exponential weighting (alpha > 1)",
        Magnitude(*condition)
    )]
    IllConditioned {
        /// The matrix of the quadratic cost: Omega of a Laguerre MPC, H of a state-space MPC.
        name: &'static str,
        /// Its condition number.
        condition: f64,
        /// Share of the gain that rounding can change, 1 at most.
        error: f64,
        /// Largest share that is accepted.
        allowed: f64,
    },
    /// An eigenvalue iteration did not converge.
    #[error("the eigenvalues of {name} were not found")]
    Eigenvalues {
        /// The matrix.
        name: &'static str,
    },
    /// The closed loop of this design is not stable.
    #[error(
        "the closed loop is not stable: its largest eigenvalue has magnitude {spectral_radius}, and only below 1 is allowed"
    )]
    Unstable {
        /// Largest magnitude of the closed-loop eigenvalues.
        spectral_radius: f64,
    },
}
