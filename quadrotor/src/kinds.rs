//! Which of many things are alike.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

/// Kinds of things, numbered in the order of their first ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kinds {
    /// Index of the first thing of each kind.
    pub first: Vec<usize>,
    /// Kind of each thing.
    pub of_each: Vec<usize>,
}

impl Kinds {
    /// Of things that have equal fingerprints if they are the same, and hardly ever otherwise: only those are compared.
    pub fn of<T>(things: &[T], fingerprint: impl Fn(&T) -> u64, is_same: impl Fn(&T, &T) -> bool) -> Self {
        let mut first: Vec<usize> = Vec::new();
        let mut known: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        let kind = |(index, thing): (usize, &T)| {
            let alike = known.entry(fingerprint(thing)).or_default();
            if let Some(kind) = alike.iter().find(|kind| is_same(&things[first[**kind]], thing)) {
                return *kind;
            }
            alike.push(first.len());
            first.push(index);
            first.len() - 1
        };
        let of_each = things.iter().enumerate().map(kind).collect();
        Self { first, of_each }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::Kinds;

    #[test]
    fn things_of_one_fingerprint_are_compared() {
        // 3, 13 and 23 share a fingerprint, and are three kinds.
        let kinds = Kinds::of(&[3, 13, 4, 3, 23, 13], |thing| thing % 10, |one, other| one == other);
        assert_eq!(kinds, Kinds { first: vec![0, 1, 2, 4], of_each: vec![0, 1, 2, 0, 3, 1] });
    }
}
