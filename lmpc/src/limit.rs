//! Limits on predicted inputs and states, as rows of a quadratic program in η.

use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::{DMatrix, RowDVector};

use crate::laguerre::InputBasis;
use crate::{DesignError, LmpcDesign, validate};

/// What a limit bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Δu(k+m), the move at sample m = 0, 1, …
    Increment,
    /// u(k+m), the input at sample m = 0, 1, …
    Input,
    /// x_m(k+m), the plant state at sample m = 1, 2, …
    State,
}

/// D · quantity ≤ upper at some future samples; the values of `upper` are given at run time.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// What is bounded.
    pub quantity: Quantity,
    /// D: one row per bound, one column per input or state.
    pub directions: DMatrix<f64>,
    /// The samples m at which it holds.
    pub samples: Range<usize>,
    /// Whether it gives way first when not all limits can be kept.
    pub soft: bool,
}

impl Limit {
    /// Upper and lower bounds on each of `count` inputs or states: D = \[I; −I\], so that `upper` is
    /// \[largest…; −smallest…\].
    pub fn range(quantity: Quantity, count: usize, samples: Range<usize>) -> Self {
        let mut directions = DMatrix::zeros(2 * count, count);
        for i in 0..count {
            directions[(i, i)] = 1.0;
            directions[(count + i, i)] = -1.0;
        }
        Self { quantity, directions, samples, soft: false }
    }

    /// A joint bound on two inputs: the regular polygon of `sides` sides. With `upper` =
    /// r cos(π/`sides`) it lies inside the circle of radius r and touches it with its corners.
    pub fn polygon(quantity: Quantity, sides: usize, samples: Range<usize>) -> Self {
        let angle = |side: usize| core::f64::consts::TAU * side as f64 / sides as f64;
        let directions = DMatrix::from_fn(sides, 2, |side, axis| {
            if axis == 0 { libm::cos(angle(side)) } else { libm::sin(angle(side)) }
        });
        Self { quantity, directions, samples, soft: false }
    }

    /// The same limit, to give way first.
    pub fn soft(self) -> Self {
        Self { soft: true, ..self }
    }
}

/// One row g η ≤ upper − (known part), where the known part is
/// `augmented`·\[Δx_m; y − r\] + `input`·(u_r(k) + v(k−1)) + `step`·(u_r(k) − u_r(k−1)) + `measured`·x_m(k).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LimitRow {
    pub(crate) eta: RowDVector<f64>,
    pub(crate) augmented: RowDVector<f64>,
    pub(crate) input: RowDVector<f64>,
    pub(crate) step: RowDVector<f64>,
    pub(crate) measured: RowDVector<f64>,
    pub(crate) soft: bool,
    /// Which of the run-time values bounds it.
    pub(crate) bound: usize,
}

/// All rows of some limits on the predictions of a design.
pub(crate) fn limit_rows(design: &LmpcDesign, limits: &[Limit]) -> Result<Vec<LimitRow>, DesignError> {
    let plant = design.model().plant();
    let (n, p) = (plant.states(), plant.inputs());
    let mut first_bound = 0;
    let mut rows = Vec::new();
    for limit in limits {
        let columns = if limit.quantity == Quantity::State { n } else { p };
        validate::shape("directions of a limit", &limit.directions, (limit.directions.nrows(), columns))?;
        rows_of(design, limit, first_bound, &mut rows);
        first_bound += limit.directions.nrows();
    }
    Ok(rows)
}

/// Walks the prediction up to the last sample of a limit and collects its rows.
fn rows_of(design: &LmpcDesign, limit: &Limit, first_bound: usize, rows: &mut Vec<LimitRow>) {
    let model = design.model();
    let plant = model.plant();
    let (n, p, states) = (plant.states(), plant.inputs(), model.states());
    let mut basis = InputBasis::new(design.bases());
    let terms = basis.terms();

    let mut alpha_m = 1.0;
    let mut moves = DMatrix::<f64>::zeros(p, terms); // Σ Δu(k+i), i ≤ m, as a function of η
    let mut phi_t = DMatrix::<f64>::zeros(states, terms); // x(k+m) as a function of η
    let mut a_m = DMatrix::<f64>::identity(states, states); // … and of x(k)
    let mut motion = DMatrix::<f64>::zeros(n, terms); // Σ Δx_m(k+i), i ≤ m, as a function of η
    let mut drift = DMatrix::<f64>::zeros(n, states); // … and of x(k)
    for m in 0..limit.samples.end {
        // Δu(k+m) = αᵐ L(m)ᵀ η
        let increment = basis.row() * alpha_m;
        moves += &increment;
        if limit.samples.contains(&m) {
            let zero = |columns: usize| DMatrix::zeros(limit.directions.nrows(), columns);
            let d = &limit.directions;
            let (eta, augmented, input, step, measured) = match limit.quantity {
                Quantity::Increment => {
                    // u(k) − u(k−1) has the step of the feed-forward too
                    let step = if m == 0 { d.clone() } else { zero(p) };
                    (d * &increment, zero(states), zero(p), step, zero(n))
                }
                // u(k+m) = u_r(k) + v(k−1) + Σ Δv
                Quantity::Input => (d * &moves, zero(states), d.clone(), zero(p), zero(n)),
                // x_m(k+m) = x_m(k) + Σ Δx_m
                Quantity::State => (d * &motion, d * &drift, zero(p), zero(p), d.clone()),
            };
            for row in 0..d.nrows() {
                rows.push(LimitRow {
                    eta: eta.row(row).into_owned(),
                    augmented: augmented.row(row).into_owned(),
                    input: input.row(row).into_owned(),
                    step: step.row(row).into_owned(),
                    measured: measured.row(row).into_owned(),
                    soft: limit.soft,
                    bound: first_bound + row,
                });
            }
        }
        // x(k+m+1) = A x(k+m) + B Δu(k+m)
        phi_t = model.a() * phi_t + model.b() * increment;
        a_m = model.a() * a_m;
        motion += phi_t.rows(0, n);
        drift += a_m.rows(0, n);
        basis.advance();
        alpha_m *= design.alpha();
    }
}
