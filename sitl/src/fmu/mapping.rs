//! A map made for one FMU: which variable is which signal, and how it is converted.

use std::path::PathBuf;
use std::time::Duration;

use importer::StartValue;
use vehicle::foreign::ForeignRole;

use super::axes::Axes;

/// Ours = scale · theirs + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// The scale.
    pub scale: f64,
    /// The offset, SI.
    pub offset: f64,
}

impl Conversion {
    /// A value of the FMU in SI units.
    pub fn ours(&self, theirs: f64) -> f64 {
        // As it is, with the sign of zero.
        if self.is_identity() { theirs } else { self.scale * theirs + self.offset }
    }

    /// A value in SI units as the FMU takes it.
    pub fn theirs(&self, ours: f64) -> f64 {
        if self.is_identity() { ours } else { (ours - self.offset) / self.scale }
    }

    /// Whether it changes nothing.
    pub fn is_identity(&self) -> bool {
        self.scale == 1.0 && self.offset == 0.0
    }
}

/// A variable that is a signal: the part of a group.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index of the group.
    pub group: usize,
    /// Which of its parts.
    pub part: usize,
    /// The variable's name and reference.
    pub variable: (String, u32),
    /// Its unit, as the FMU or the map says; `None`: taken as SI.
    pub unit: Option<String>,
    /// Its conversion.
    pub conversion: Conversion,
}

/// What flies, and how it is reached.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping {
    /// Name of the model.
    pub model_name: String,
    /// What it is in place of.
    pub role: ForeignRole,
    /// Its axes.
    pub axes: Axes,
    /// Real inputs.
    pub inputs: Vec<Channel>,
    /// Its Boolean input that lets the rotors turn, if it has one.
    pub armed: Option<(String, u32)>,
    /// Real outputs.
    pub outputs: Vec<Channel>,
    /// Outputs that do not change: group, part and value.
    pub constants: Vec<(usize, usize, f64)>,
    /// Start values: the variable's name and what it is set to.
    pub values: Vec<(String, u32, StartValue)>,
    /// Libraries to load before it.
    pub preload: Vec<PathBuf>,
    /// Longest time of a step.
    pub longest_step: Duration,
}

impl Mapping {
    /// Whether an input group is driven.
    pub fn takes(&self, group: usize) -> bool {
        self.inputs.iter().any(|channel| channel.group == group)
    }

    /// Whether an output group is shown.
    pub fn shows(&self, group: usize) -> bool {
        self.outputs.iter().any(|channel| channel.group == group)
            || self.constants.iter().any(|(constant, _, _)| *constant == group)
    }
}
