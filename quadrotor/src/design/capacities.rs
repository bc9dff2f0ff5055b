//! How much the cascade's controllers have room for. A larger configuration is refused by the ranges of its
//! parameters, which derive from these sizes, as the programs do.

use lmpc::unknowns;

/// Most Laguerre terms per input: five give the regulator's gain to 0.1 %, twenty leave room to study how it converges.
pub(crate) const MOST_TERMS: usize = 20;

/// Most moves per input of the state-space MPC: the paper's 25, and some to compare with.
pub(crate) const MOST_MOVES: usize = 30;

/// Laguerre terms per input up to which the smaller programs are used: at most so many fly by default, and come within 1 % of
/// the optimum. Their square matrices have a tenth of the elements that those of the larger programs have, which a controller's state has
/// room for: it keeps them from one step to the next.
pub(crate) const FEW_TERMS: usize = 8;

/// Coefficients per input of the larger programs.
const MANY: usize = if MOST_TERMS > MOST_MOVES { MOST_TERMS } else { MOST_MOVES };

/// Unknowns of the smaller programs, by the number of inputs: G; θ, φ; roll and pitch; yaw.
pub(crate) const ALTITUDE_FEW: usize = unknowns(1, FEW_TERMS);
pub(crate) const POSITION_FEW: usize = unknowns(2, FEW_TERMS);
pub(crate) const LEAN_FEW: usize = unknowns(2, FEW_TERMS);
pub(crate) const TURN_FEW: usize = unknowns(1, FEW_TERMS);

/// Unknowns of the larger programs, and active limits that a controller's state can remember.
pub(crate) const ALTITUDE_MANY: usize = unknowns(1, MANY);
pub(crate) const POSITION_MANY: usize = unknowns(2, MANY);
pub(crate) const LEAN_MANY: usize = unknowns(2, MANY);
pub(crate) const TURN_MANY: usize = unknowns(1, MANY);

/// Bounds of the attitude controller about roll and pitch: the thrust of each of four rotors, up and down.
pub(crate) const LEAN_BOUNDS: usize = 4 * 2;
/// Its bounds about yaw: both ways, now and later.
pub(crate) const TURN_BOUNDS: usize = 2 * 2;
