//! What any solver does with a sample of a program.

use crate::program::{PosedSample, Program};

/// A solver with a program in it.
pub trait Solver {
    /// "DAQP".
    fn name(&self) -> &str;

    /// Solves a sample into `z`. `warm` lets it begin where the last one ended.
    fn solve(&mut self, sample: &PosedSample, warm: bool, z: &mut [f64]) -> Solved;

    /// Bytes that it holds for the program, if it tells.
    fn memory(&self) -> Option<usize>;
}

/// How a solution went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Solved {
    /// Whether the solver is content.
    pub solved: bool,
    /// In its own counting.
    pub iterations: u32,
}

/// Makes solvers.
pub trait Maker {
    /// A solver of a program; `None` if it refuses it.
    fn solver<'a>(&'a self, program: &'a Program) -> Option<Box<dyn Solver + 'a>>;
}
