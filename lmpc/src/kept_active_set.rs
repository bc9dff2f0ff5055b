//! An active set that a controller keeps from one sample to the next, to begin with.

use core::fmt;

use crate::Precision;
use crate::active_set::ActiveSet;

/// Room for an active set of up to K unknowns, none for K = 0. It saves time and changes no result, so it is no part of what a state is:
/// states that differ in it are equal, and it is not saved with them.
#[derive(Clone, Copy)]
pub(crate) struct KeptActiveSet<const K: usize, T>(pub(crate) ActiveSet<K, T>);

impl<const K: usize, T: Precision> Default for KeptActiveSet<K, T> {
    fn default() -> Self {
        Self(ActiveSet::empty())
    }
}

impl<const K: usize, T> PartialEq for KeptActiveSet<K, T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<const K: usize, T> fmt::Debug for KeptActiveSet<K, T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("KeptActiveSet").finish_non_exhaustive()
    }
}
