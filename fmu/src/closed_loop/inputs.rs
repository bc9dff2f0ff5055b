//! The inputs.

use fmi::variables::Variable;

use super::ClosedLoop;
use crate::tables::{disturbances, ground, references};

/// What the vehicle is asked for.
pub(super) const REFERENCE: [Variable<ClosedLoop>; 11] = references::reference();

/// What pushes it.
pub(super) const DISTURBANCE: [Variable<ClosedLoop>; 9] = disturbances::disturbance();

/// Whether its rotors turn.
pub(super) const ARMED: [Variable<ClosedLoop>; 1] = references::armed();

/// What it stands on.
pub(super) const GROUND: [Variable<ClosedLoop>; 1] = ground::ground(ground::OF_PLANT);
