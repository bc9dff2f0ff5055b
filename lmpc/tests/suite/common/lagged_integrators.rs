//! Loops to design for.

use lmpc::{Augmented, Discretization, Dlqr, LaguerreBasis, StabilizedDesign, StateSpace, Weights};
use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

/// A double integrator behind a lag on each of some channels: what the loops of a vehicle look like.
#[derive(Clone, Debug)]
pub struct Case {
    pub sample_time_s: f64,
    pub lag_s: f64,
    pub increment_weight: f64,
    /// How much slower the stabilizing feedback is: its increments cost so many times more.
    pub slower: f64,
    pub terms: usize,
    pub scale: f64,
}

pub fn case() -> impl Strategy<Value = Case> {
    (0.02..0.1, 0.02..0.3, -2.0..2.0, 0.5..3.0, 1_usize..7, 0.2..0.9).prop_map(
        |(sample_time_s, lag_s, increment, slower, terms, scale)| Case {
            sample_time_s,
            lag_s,
            increment_weight: 10_f64.powf(increment),
            slower: 10_f64.powf(slower),
            terms,
            scale,
        },
    )
}

impl Case {
    pub fn plant(&self, channels: usize) -> StateSpace {
        let a = dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 0.0, 0.0, -1.0 / self.lag_s];
        let b = dmatrix![0.0; 0.0; 1.0 / self.lag_s];
        let c = dmatrix![1.0, 0.0, 0.0];
        let of_all = |block: &DMatrix<f64>| DMatrix::<f64>::identity(channels, channels).kronecker(block);
        let hold = Discretization::ZeroOrderHold;
        StateSpace::from_continuous(&of_all(&a), &of_all(&b), &of_all(&c), self.sample_time_s, hold).unwrap()
    }

    pub fn design(&self, channels: usize) -> StabilizedDesign {
        let model = Augmented::new(&self.plant(channels));
        let weights = Weights::output(&model, 1.0, self.increment_weight).unwrap();
        let slow = Dlqr::new(model.a(), model.b(), weights.q(), &(weights.r() * self.slower), 1.0).unwrap();
        let bases = vec![LaguerreBasis::new(self.terms, self.scale).unwrap(); channels];
        StabilizedDesign::new(&model, &weights, slow.gain(), &bases, 1.0).unwrap()
    }
}
