//! What a state-space MPC predicts, sample by sample.

use nalgebra::DMatrix;

use crate::limit_row::{Affine, PredictionWalk};
use crate::{Quantity, StateSpace};

/// The predictions of a plant as functions of N_c moves Δv and of the known
/// \[x(k); v(k−1) + d(k); u_r(k) + v(k−1); u_r(k) − u_r(k−1)\], where x is the deviation from a reference
/// trajectory under u_r.
#[derive(Clone, Debug)]
pub(crate) struct MovesWalk<'a> {
    plant: &'a StateSpace,
    moves: usize,
    m: usize,
    /// x(k+m) as a function of x(k), of v(k−1) + d(k) and of the moves.
    by_state: DMatrix<f64>,
    by_input: DMatrix<f64>,
    by_moves: DMatrix<f64>,
    /// v(k+m) − v(k−1) as a function of the moves.
    input_by_moves: DMatrix<f64>,
}

impl<'a> MovesWalk<'a> {
    pub(crate) fn new(plant: &'a StateSpace, moves: usize) -> Self {
        let (n, p) = (plant.states(), plant.inputs());
        let mut walk = Self {
            plant,
            moves,
            m: 0,
            by_state: DMatrix::identity(n, n),
            by_input: DMatrix::zeros(n, p),
            by_moves: DMatrix::zeros(n, p * moves),
            input_by_moves: DMatrix::zeros(p, p * moves),
        };
        walk.input_by_moves = walk.increment();
        walk
    }

    /// Δv(k+m), 0 from m = N_c on.
    fn increment(&self) -> DMatrix<f64> {
        let p = self.plant.inputs();
        let mut increment = DMatrix::zeros(p, p * self.moves);
        if self.m < self.moves {
            increment.view_mut((0, self.m * p), (p, p)).fill_with_identity();
        }
        increment
    }
}

impl PredictionWalk for MovesWalk<'_> {
    fn size(&self, quantity: Quantity) -> usize {
        if quantity == Quantity::State { self.plant.states() } else { self.plant.inputs() }
    }

    fn predicted(&self, quantity: Quantity) -> Affine {
        let (n, p) = (self.plant.states(), self.plant.inputs());
        let mut known = DMatrix::zeros(self.size(quantity), n + 3 * p);
        let decision = match quantity {
            Quantity::Increment => {
                // u(k) − u(k−1) has the step of the feed-forward too
                if self.m == 0 {
                    known.view_mut((0, n + 2 * p), (p, p)).fill_with_identity();
                }
                self.increment()
            }
            Quantity::Input => {
                known.view_mut((0, n + p), (p, p)).fill_with_identity();
                self.input_by_moves.clone()
            }
            Quantity::State => {
                known.view_mut((0, 0), (n, n)).copy_from(&self.by_state);
                known.view_mut((0, n), (n, p)).copy_from(&self.by_input);
                self.by_moves.clone()
            }
        };
        Affine { decision, known }
    }

    fn advance(&mut self) {
        // x(k+m+1) = A x(k+m) + B (v(k+m) + d)
        self.by_state = self.plant.a() * &self.by_state;
        self.by_input = self.plant.a() * &self.by_input + self.plant.b();
        self.by_moves = self.plant.a() * &self.by_moves + self.plant.b() * &self.input_by_moves;
        self.m += 1;
        self.input_by_moves += self.increment();
    }
}
