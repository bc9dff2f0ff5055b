//! What a Laguerre MPC predicts, sample by sample.

use nalgebra::DMatrix;

use crate::laguerre::InputBasis;
use crate::limit_row::{Affine, PredictionWalk};
use crate::{LmpcDesign, Quantity};

/// The predictions of a design as functions of η and of the known
/// \[Δx_m; y − r; u_r(k) + v(k−1); u_r(k) − u_r(k−1); x_m(k)\].
#[derive(Clone, Debug)]
pub(crate) struct LaguerreWalk<'a> {
    design: &'a LmpcDesign,
    basis: InputBasis<'a>,
    m: usize,
    alpha_m: f64,
    /// Σ Δu(k+i), i ≤ m, as a function of η.
    moves: DMatrix<f64>,
    /// x(k+m), augmented, as a function of η and of x(k).
    phi_t: DMatrix<f64>,
    a_m: DMatrix<f64>,
    /// Σ Δx_m(k+i), 1 ≤ i ≤ m, as a function of η and of x(k).
    motion: DMatrix<f64>,
    drift: DMatrix<f64>,
}

impl<'a> LaguerreWalk<'a> {
    pub(crate) fn new(design: &'a LmpcDesign) -> Self {
        let model = design.model();
        let (n, states) = (model.plant().states(), model.states());
        let basis = InputBasis::new(design.bases());
        let moves = basis.row();
        let terms = basis.terms();
        Self {
            design,
            basis,
            m: 0,
            alpha_m: 1.0,
            moves,
            phi_t: DMatrix::zeros(states, terms),
            a_m: DMatrix::identity(states, states),
            motion: DMatrix::zeros(n, terms),
            drift: DMatrix::zeros(n, states),
        }
    }

    /// Δu(k+m) = αᵐ L(m)ᵀ η
    fn increment(&self) -> DMatrix<f64> {
        self.basis.row() * self.alpha_m
    }
}

impl PredictionWalk for LaguerreWalk<'_> {
    fn size(&self, quantity: Quantity) -> usize {
        let plant = self.design.model().plant();
        if quantity == Quantity::State { plant.states() } else { plant.inputs() }
    }

    fn predicted(&self, quantity: Quantity) -> Affine {
        let model = self.design.model();
        let (n, p, states) = (model.plant().states(), model.plant().inputs(), model.states());
        let mut known = DMatrix::zeros(self.size(quantity), states + 2 * p + n);
        let decision = match quantity {
            Quantity::Increment => {
                // u(k) − u(k−1) has the step of the feed-forward too
                if self.m == 0 {
                    known.view_mut((0, states + p), (p, p)).fill_with_identity();
                }
                self.increment()
            }
            Quantity::Input => {
                // u(k+m) = u_r(k) + v(k−1) + Σ Δv
                known.view_mut((0, states), (p, p)).fill_with_identity();
                self.moves.clone()
            }
            Quantity::State => {
                // x_m(k+m) = x_m(k) + Σ Δx_m
                known.view_mut((0, 0), (n, states)).copy_from(&self.drift);
                known.view_mut((0, states + 2 * p), (n, n)).fill_with_identity();
                self.motion.clone()
            }
        };
        Affine { decision, known }
    }

    fn advance(&mut self) {
        let model = self.design.model();
        let n = model.plant().states();
        // x(k+m+1) = A x(k+m) + B Δu(k+m)
        self.phi_t = model.a() * &self.phi_t + model.b() * self.increment();
        self.a_m = model.a() * &self.a_m;
        self.motion += self.phi_t.rows(0, n);
        self.drift += self.a_m.rows(0, n);
        self.m += 1;
        self.alpha_m *= self.design.alpha();
        self.basis.advance();
        self.moves += self.increment();
    }
}
