//! A controller of `lmpc` with its state, whatever its sizes.

use lmpc::{Controller, ControllerState, DesignError, Reference, Sample, Status};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// What a controller is told at a sample, for a plant of any size.
pub struct Told {
    /// x(k).
    pub measured: DVector<f64>,
    /// x_r(k).
    pub reference: DVector<f64>,
    /// Δx_r(k).
    pub reference_increment: DVector<f64>,
    /// u_r(k).
    pub input_reference: DVector<f64>,
    /// d(k).
    pub disturbance: DVector<f64>,
    /// The values of all bounds.
    pub upper: Vec<f64>,
    /// r(k), r(k+1), … as deviations from the reference trajectory.
    pub preview: Vec<DVector<f64>>,
}

/// What it answers.
pub struct Answer {
    pub input: Vec<f64>,
    pub increment: Vec<f64>,
    pub integral: Vec<f64>,
    pub status: &'static str,
    pub iterations: u32,
    pub active: usize,
}

/// A controller with its state.
pub trait Law: Send + Sync {
    /// One sample.
    fn step(&mut self, told: &Told) -> Answer;
    /// Takes over a plant whose last state and input these were.
    fn take_over(&mut self, measured: &DVector<f64>, applied: &DVector<f64>, input_reference: &DVector<f64>);
    /// Reports the input that was applied in truth.
    fn apply(&mut self, applied: &DVector<f64>);
    /// The state as bytes.
    fn save(&self) -> Result<Vec<u8>, postcard::Error>;
    /// Goes on from a saved state.
    fn restore(&mut self, saved: &[u8]) -> Result<(), postcard::Error>;
}

/// What a law is made of: makes it in a size.
pub trait Recipe {
    /// A law for N states, P inputs and Q outputs with room for E unknowns.
    fn make<const N: usize, const P: usize, const Q: usize, const E: usize>(
        &self,
    ) -> Result<Box<dyn Law>, DesignError>;
}

/// Largest number of states.
pub const MOST_STATES: usize = 16;
/// Largest number of unknowns: Laguerre terms or moves of all inputs, and one slack.
pub const MOST_UNKNOWNS: usize = 65;
/// Sizes that most plants have.
const FEW_STATES: usize = 4;
const FEW_UNKNOWNS: usize = 17;
/// Largest number of inputs, and of outputs.
pub const MOST_INPUTS: usize = 4;

/// The number of states that a law of a plant has room for.
fn is_small(states: usize, unknowns: usize) -> bool {
    states <= FEW_STATES && unknowns <= FEW_UNKNOWNS
}

/// Makes a law for a plant with so many states, inputs, outputs and unknowns; `None` when there is none of that size.
pub fn make(
    recipe: &impl Recipe,
    states: usize,
    (inputs, outputs): (usize, usize),
    unknowns: usize,
) -> Option<Result<Box<dyn Law>, DesignError>> {
    if states > MOST_STATES || unknowns > MOST_UNKNOWNS {
        return None;
    }
    let small = is_small(states, unknowns);
    macro_rules! sized {
        ($inputs:literal, $outputs:literal) => {
            if small {
                recipe.make::<FEW_STATES, $inputs, $outputs, FEW_UNKNOWNS>()
            } else {
                recipe.make::<MOST_STATES, $inputs, $outputs, MOST_UNKNOWNS>()
            }
        };
    }
    // More outputs than inputs cannot be held: their integrators would not be controllable.
    Some(match (inputs, outputs) {
        (1, 1) => sized!(1, 1),
        (2, 1) => sized!(2, 1),
        (2, 2) => sized!(2, 2),
        (3, 1) => sized!(3, 1),
        (3, 2) => sized!(3, 2),
        (3, 3) => sized!(3, 3),
        (4, 1) => sized!(4, 1),
        (4, 2) => sized!(4, 2),
        (4, 3) => sized!(4, 3),
        (4, 4) => sized!(4, 4),
        _ => return None,
    })
}

/// A law of one size with its state.
struct Flying<L, const N: usize, const P: usize, const Q: usize, const W: usize> {
    law: L,
    output: SMatrix<f64, Q, N>,
    state: ControllerState<N, P, W>,
}

/// A law for a plant with the output matrix C, at rest.
pub fn at_rest<const N: usize, const P: usize, const Q: usize, const W: usize>(
    law: impl Controller<N, P, Q, W> + Send + Sync + 'static,
    output: &DMatrix<f64>,
) -> Box<dyn Law> {
    Box::new(Flying {
        law,
        output: SMatrix::from_fn(
            |row, column| {
                if column < output.ncols() { output[(row, column)] } else { 0.0 }
            },
        ),
        state: ControllerState::<N, P, W>::at_rest(),
    })
}

/// A vector with zeros behind its elements.
fn padded<const R: usize>(vector: &DVector<f64>) -> SVector<f64, R> {
    SVector::from_fn(|row, _| vector.get(row).copied().unwrap_or(0.0))
}

impl<L, const N: usize, const P: usize, const Q: usize, const W: usize> Law for Flying<L, N, P, Q, W>
where
    L: Controller<N, P, Q, W> + Send + Sync,
{
    fn step(&mut self, told: &Told) -> Answer {
        let measured = padded(&told.measured);
        let reference = Reference {
            state: padded(&told.reference),
            increment: padded(&told.reference_increment),
            input: padded(&told.input_reference),
        };
        let preview: Vec<SVector<f64, Q>> = told.preview.iter().map(padded).collect();
        let sample = Sample {
            disturbance: padded(&told.disturbance),
            upper: &told.upper,
            preview: &preview,
            ..reference.sample(&self.output, &self.state.measured(), &measured)
        };
        let step = self.law.step(&mut self.state, &sample);
        Answer {
            input: step.input.as_slice().to_vec(),
            increment: step.increment.as_slice().to_vec(),
            integral: step.integral.as_slice().to_vec(),
            status: match step.status {
                Status::Optimal => "optimal",
                Status::Relaxed => "relaxed",
                Status::IterationLimit => "iteration_limit",
                Status::Held => "held",
            },
            iterations: step.iterations,
            active: step.active,
        }
    }

    fn take_over(&mut self, measured: &DVector<f64>, applied: &DVector<f64>, input_reference: &DVector<f64>) {
        self.state = ControllerState::new(padded(measured), padded(applied), padded(input_reference));
    }

    fn apply(&mut self, applied: &DVector<f64>) {
        self.state.apply(&padded(applied));
    }

    fn save(&self) -> Result<Vec<u8>, postcard::Error> {
        postcard::to_allocvec(&self.state)
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), postcard::Error> {
        match postcard::take_from_bytes(saved)? {
            (state, []) => self.state = state,
            _ => return Err(postcard::Error::DeserializeBadEncoding),
        }
        Ok(())
    }
}
