//! Future samples at which the predictive controllers keep their limits.
//!
//! Dense where a limit is about to be met, sparse further out, where it only has to be foreseen: a long
//! flight must begin to brake before the limits are near.

/// Of the attitude controller about roll and pitch: sixteen of 0.96 s, each gap a third longer than the one before. Turning
/// upside down at the angular acceleration that the paper's airframe has in hover takes 1.2 s. Those about yaw are as many
/// times later as yaw is slower.
pub static ATTITUDE: &[usize] = &[0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 34, 44, 57, 74, 96];
