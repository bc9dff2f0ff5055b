//! Future samples at which the predictive controllers keep their limits.
//!
//! Dense where a limit is about to be met, sparse further out, where it only has to be foreseen: a long
//! flight must begin to brake before the limits are near.

/// Of the attitude controller: 0.1 s, and every fourth sample of 0.6 s.
pub static ATTITUDE: &[usize] =
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48, 52, 56];
