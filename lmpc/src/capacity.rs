//! How much a controller has room for.
//!
//! Only the number of unknowns is a compile-time size, the last const generic of a controller: it bounds the square
//! matrices that a step keeps on the stack. Rows of limits are placed on the heap when the controller is made.

/// Slacks by which the limits of a program give way: one for all, so that they give way together.
pub(crate) const SLACKS: usize = 1;

/// Iterations per unknown and row. Problems at hand take fewer than one each; the rest guards against cycles.
const ITERATIONS_PER_SIZE: u32 = 4;

/// Unknowns of the program of a controller with `coefficients` per input, Laguerre terms or moves: the smallest E
/// of a [`LaguerreMpc`](crate::LaguerreMpc) or [`StateSpaceMpc`](crate::StateSpaceMpc), and the W of a
/// [`ControllerState`](crate::ControllerState) that can remember any of its active sets.
///
/// ```
/// use lmpc::{StateSpaceMpc, unknowns};
/// // Six states, three inputs with 25 moves each.
/// type Attitude = StateSpaceMpc<6, 3, 3, { unknowns(3, 25) }>;
/// ```
pub const fn unknowns(inputs: usize, coefficients: usize) -> usize {
    inputs * coefficients + SLACKS
}

/// Iterations after which a program of this size is given up.
pub(crate) fn iteration_limit(unknowns: usize, rows: usize) -> u32 {
    ITERATIONS_PER_SIZE * u32::try_from(unknowns + rows).unwrap_or(u32::MAX / ITERATIONS_PER_SIZE)
}

#[cfg(test)]
mod tests {
    use super::{iteration_limit, unknowns};

    #[test]
    fn a_program_has_all_coefficients_and_one_slack() {
        assert_eq!((unknowns(1, 5), unknowns(3, 25), unknowns(2, 0)), (6, 76, 1));
    }

    /// Four per unknown and row, and no overflow for programs that no memory would hold.
    #[test]
    fn the_iteration_limit_grows_with_the_program() {
        assert_eq!((iteration_limit(6, 0), iteration_limit(6, 80)), (24, 344));
        assert_eq!(iteration_limit(usize::MAX / 2, 7), u32::MAX - 3);
    }
}
