//! What is known of a model from elsewhere.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::ForeignMotion;

/// What a model is in place of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ForeignRole {
    /// Controllers and plant: it follows a reference.
    ClosedLoop,
    /// The plant: it moves under our controllers' rotor speeds, or thrust and torques.
    Plant,
}

impl fmt::Display for ForeignRole {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::ClosedLoop => "closed loop",
            Self::Plant => "plant",
        })
    }
}

/// A model from elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForeignDescription {
    /// What people call it: "the FMU LmpcQuadrotor".
    pub name: String,
    /// What it is in place of.
    pub role: ForeignRole,
    /// Its motion at the start.
    pub start: ForeignMotion,
}
