//! Future samples at which the predictive controllers keep their limits.
//!
//! Dense where a limit is about to be met, sparse further out, where it only has to be foreseen: a long
//! flight must begin to brake before the limits are near.

/// Of the altitude controller: every sample of 1.5 s.
pub static ALTITUDE: &[usize] = &[
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28,
    29,
];

/// Of the position controller: fifteen of 4.3 s, each gap a third longer than the one before.
pub static POSITION: &[usize] = &[0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 27, 36, 48, 64, 85];

/// Of the attitude controller about roll and pitch: sixteen of 0.96 s, each gap a third longer than the one before. Turning
/// upside down at the angular acceleration that the paper's airframe has in hover takes 1.2 s. Those about yaw are as many
/// times later as yaw is slower.
pub static ATTITUDE: &[usize] = &[0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 34, 44, 57, 74, 96];
