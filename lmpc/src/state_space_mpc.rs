//! Linear state-space MPC (28)–(34) under limits, at run time.

use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};

use crate::bounds::Bounds;
use crate::controller_state::Decision;
use crate::limit_row::limit_rows;
use crate::moves_walk::MovesWalk;
use crate::relaxable::RelaxableProgram;
use crate::{Controller, ControllerState, DesignError, Limit, Sample, StateSpaceMpcDesign, Step, validate};

/// State-space MPC for a plant of N states, P inputs and Q outputs, with E ≥ P N_c + 1 unknowns: the moves of all
/// inputs and one slack.
///
/// It goes by the deviation from the reference trajectory, and limits of the state bound that deviation. It has no
/// integral action of its own: what disturbs the plant must be estimated and told.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceMpc<const N: usize, const P: usize, const Q: usize, const E: usize> {
    gradient_state: SMatrix<f64, E, N>,
    gradient_input: SMatrix<f64, E, P>,
    /// One block per previewed sample, from y(k) on.
    gradient_reference: Vec<SMatrix<f64, E, Q>>,
    program: RelaxableProgram<E>,
    known: Vec<Known<N, P>>,
}

/// What of a limit is known before the moves are chosen.
#[derive(Clone, Debug, PartialEq)]
struct Known<const N: usize, const P: usize> {
    state: SVector<f64, N>,
    driving: SVector<f64, P>,
    input: SVector<f64, P>,
    step: SVector<f64, P>,
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

impl<const N: usize, const P: usize, const Q: usize, const E: usize, const W: usize> Controller<N, P, Q, W>
    for StateSpaceMpc<N, P, Q, E>
{
    fn step(&self, state: &mut ControllerState<N, P, W>, sample: &Sample<'_, N, P, Q>) -> Step<P> {
        let feedback = state.feedback();
        let driving = feedback + sample.disturbance;
        let input = sample.input_reference + feedback;
        let reference_step = sample.input_reference - state.input_reference();

        let mut f = self.gradient_state * sample.deviation + self.gradient_input * driving;
        for (index, gradient) in self.gradient_reference.iter().enumerate() {
            if let Some(reference) = sample.preview.get(index).or(sample.preview.last()) {
                f -= gradient * reference;
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
struct Rooms<'a, const N: usize, const P: usize, const Q: usize> {
    rows: &'a [Known<N, P>],
    sample: &'a Sample<'a, N, P, Q>,
    driving: &'a SVector<f64, P>,
    input: &'a SVector<f64, P>,
    step: &'a SVector<f64, P>,
}

impl<const N: usize, const P: usize, const Q: usize> Rooms<'_, N, P, Q> {
    /// The bound, and what of the left-hand side is known.
    fn terms(&self, row: usize) -> [f64; 5] {
        let known = &self.rows[row];
        [
            self.sample.upper.get(known.bound).copied().unwrap_or(f64::INFINITY),
            -known.state.dot(&self.sample.deviation),
            -known.driving.dot(self.driving),
            -known.input.dot(self.input),
            -known.step.dot(self.step),
        ]
    }
}

impl<const N: usize, const P: usize, const Q: usize> Bounds for Rooms<'_, N, P, Q> {
    fn bound(&self, row: usize) -> f64 {
        self.terms(row).into_iter().sum()
    }

    fn size(&self, row: usize) -> f64 {
        self.terms(row).into_iter().map(libm::fabs).sum()
    }
}
