//! A mission as it is flown.

use super::step::{Navigate, Step};

/// A step with what becomes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgramStep {
    /// What is done.
    pub step: Step,
    /// Whether the next one follows by itself.
    pub continues: bool,
}

/// The steps of a mission. Each has the number of the item that it was made from.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Program {
    steps: Vec<ProgramStep>,
    first: usize,
}

impl Program {
    /// Steps of which number `first` is the first that is flown: in ArduPilot's convention the one before it is home.
    pub fn new(steps: Vec<ProgramStep>, first: usize) -> Self {
        Self { steps, first }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Number of the first step that is flown.
    pub fn first(&self) -> usize {
        self.first
    }

    /// A step.
    pub fn step(&self, index: usize) -> Option<Step> {
        self.steps.get(index).map(|entry| entry.step)
    }

    /// A step, if it is flown.
    pub fn navigate(&self, index: usize) -> Option<Navigate> {
        match self.step(index) {
            Some(Step::Navigate(navigate)) => Some(navigate),
            _ => None,
        }
    }

    /// Whether another step follows one by itself.
    pub fn continues_after(&self, index: usize) -> bool {
        self.steps.get(index).is_some_and(|entry| entry.continues)
    }

    /// Whether there is something to be flown.
    pub fn is_flown(&self) -> bool {
        (self.first..self.steps.len()).any(|index| self.navigate(index).is_some())
    }
}
