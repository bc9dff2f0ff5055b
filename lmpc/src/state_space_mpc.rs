//! Linear state-space MPC (28)–(34) under limits, at run time.

use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::bounds::Bounds;
use crate::controller_state::Decision;
use crate::dense::add_product;
use crate::limit_row::limit_rows;
use crate::moves_walk::MovesWalk;
use crate::precision::converted;
use crate::relaxable::RelaxableProgram;
use crate::{
    Controller, ControllerState, DesignError, Limit, Precision, Sample, StateSpaceMpcDesign, Step, validate,
};

/// State-space MPC for a plant of N states, P inputs and Q outputs, with E ≥ P N_c + 1 unknowns: the moves of all
/// inputs and one slack.
///
/// It goes by the deviation from the reference trajectory, and limits of the state bound that deviation. It has no
/// integral action of its own: what disturbs the plant must be estimated and told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct StateSpaceMpc<const N: usize, const P: usize, const Q: usize, const E: usize, T = f64> {
    gradient_state: SMatrix<T, E, N>,
    gradient_input: SMatrix<T, E, P>,
    /// One block per previewed sample, from y(k) on.
    gradient_reference: Vec<SMatrix<T, E, Q>>,
    program: RelaxableProgram<E, T>,
    known: Vec<Known<N, P, T>>,
}

/// What of a limit is known before the moves are chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
struct Known<const N: usize, const P: usize, T> {
    state: SVector<T, N>,
    driving: SVector<T, P>,
    input: SVector<T, P>,
    step: SVector<T, P>,
    bound: usize,
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> StateSpaceMpc<N, P, Q, E> {
    /// The controller of a design under some limits.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics or E is too small.
    pub fn new(design: &StateSpaceMpcDesign, limits: &[Limit]) -> Result<Self, DesignError> {
        let plant = &design.plant;
        validate::shape("A", plant.a(), (N, N))?;
        validate::shape("B", plant.b(), (N, P))?;
        validate::shape("C", plant.c(), (Q, N))?;
        let unknowns = P * design.moves;
        let rows = limit_rows(limits, MovesWalk::new(plant, design.moves))?;
        let program = RelaxableProgram::new(&design.hessian, &rows)?;
        let padded =
            |matrix: &DMatrix<f64>, i: usize, j: usize| if i < unknowns { matrix[(i, j)] } else { 0.0 };
        let previewed = design.gradient_reference.ncols() / Q;
        Ok(Self {
            gradient_state: SMatrix::from_fn(|i, j| padded(&design.gradient_state, i, j)),
            gradient_input: SMatrix::from_fn(|i, j| padded(&design.gradient_input, i, j)),
            gradient_reference: (0..previewed)
                .map(|sample| SMatrix::from_fn(|i, j| padded(&design.gradient_reference, i, sample * Q + j)))
                .collect(),
            program,
            known: rows
                .iter()
                .map(|row| Known {
                    state: SVector::from_fn(|i, _| row.known[i]),
                    driving: SVector::from_fn(|i, _| row.known[N + i]),
                    input: SVector::from_fn(|i, _| row.known[N + P + i]),
                    step: SVector::from_fn(|i, _| row.known[N + 2 * P + i]),
                    bound: row.bound,
                })
                .collect(),
        })
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, T: Precision>
    StateSpaceMpc<N, P, Q, E, T>
{
    /// The same controller in another precision.
    pub fn to_precision<U: Precision>(&self) -> StateSpaceMpc<N, P, Q, E, U> {
        let known = |known: &Known<N, P, T>| Known {
            state: converted(&known.state),
            driving: converted(&known.driving),
            input: converted(&known.input),
            step: converted(&known.step),
            bound: known.bound,
        };
        StateSpaceMpc {
            gradient_state: converted(&self.gradient_state),
            gradient_input: converted(&self.gradient_input),
            gradient_reference: self.gradient_reference.iter().map(converted).collect(),
            program: self.program.to_precision(),
            known: self.known.iter().map(known).collect(),
        }
    }
}

impl<
    const N: usize,
    const P: usize,
    const Q: usize,
    const E: usize,
    const W: usize,
    T: Precision,
    const K: usize,
> Controller<N, P, Q, W, T, K> for StateSpaceMpc<N, P, Q, E, T>
{
    fn step(
        &self,
        state: &mut ControllerState<N, P, W, T, K>,
        sample: &Sample<'_, N, P, Q, T>,
    ) -> Step<P, T> {
        let feedback = state.feedback();
        let driving = feedback + sample.disturbance;
        let input = sample.input_reference + feedback;
        let reference_step = sample.input_reference - state.input_reference();

        let mut f = SVector::<T, E>::zeros();
        let sum = f.as_mut_slice();
        add_product(sum, self.gradient_state.as_slice(), sample.deviation.as_slice());
        add_product(sum, self.gradient_input.as_slice(), driving.as_slice());
        for (index, gradient) in self.gradient_reference.iter().enumerate() {
            if let Some(reference) = sample.preview.get(index).or(sample.preview.last()) {
                add_product(sum, gradient.as_slice(), (-reference).as_slice());
            }
        }
        let rooms =
            Rooms { sample, rows: &self.known, driving: &driving, input: &input, step: &reference_step };
        let (solution, status) = self.program.solve(&f, &rooms, &mut state.warm_start);
        let first_move = SVector::from_fn(|i, _| solution.x[i]);
        state.take(sample, &Decision::solved(feedback, first_move, &solution, status))
    }
}

/// What the limits leave for the moves at one sample.
struct Rooms<'a, const N: usize, const P: usize, const Q: usize, T> {
    rows: &'a [Known<N, P, T>],
    sample: &'a Sample<'a, N, P, Q, T>,
    driving: &'a SVector<T, P>,
    input: &'a SVector<T, P>,
    step: &'a SVector<T, P>,
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> Rooms<'_, N, P, Q, T> {
    /// The bound, and what of the left-hand side is known.
    fn terms(&self, row: usize) -> [T; 5] {
        let known = &self.rows[row];
        [
            self.sample.upper.get(known.bound).copied().unwrap_or(T::INFINITY),
            -known.state.dot(&self.sample.deviation),
            -known.driving.dot(self.driving),
            -known.input.dot(self.input),
            -known.step.dot(self.step),
        ]
    }
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> Bounds<T> for Rooms<'_, N, P, Q, T> {
    fn bound(&self, row: usize) -> T {
        self.terms(row).into_iter().sum()
    }

    fn size(&self, row: usize) -> T {
        self.terms(row).into_iter().map(|term| term.abs()).sum()
    }
}
