//! The largest share of a demand that bounds leave room for, when something else may give way to it.

/// A bound on a share s while something gives way by g: size·s ≤ room + gain·g.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bound {
    /// What the whole demand takes of the room.
    pub size: f64,
    /// The room while nothing gives way.
    pub room: f64,
    /// What the room gains per unit given.
    pub gain: f64,
}

impl Bound {
    /// A smaller gain than this share of its two summands is rounding.
    const ROUNDING: f64 = 1e-9;

    /// What two bounds on the same variable, one from below and one from above, leave for the share.
    pub(super) fn joined(self, other: Self) -> Self {
        let gain = self.gain + other.gain;
        let rounded = libm::fabs(gain) <= Self::ROUNDING * (libm::fabs(self.gain) + libm::fabs(other.gain));
        Self {
            size: self.size + other.size,
            room: self.room + other.room,
            gain: if rounded { 0.0 } else { gain },
        }
    }
}

/// The largest share s ≤ 1 under bounds when up to `most` ≥ 0 may be given, and the least g that has to be given for it.
///
/// g is eliminated (Fourier–Motzkin): a bound that gains from g allows s only as far as the bounds that lose by it allow that g.
pub(super) fn largest_share(bounds: &[Bound], most: f64) -> (f64, f64) {
    let mut share: f64 = 1.0;
    let mut keep = |size: f64, room: f64| {
        // Most bounds leave room for all of it, and need no division.
        if size > 0.0 && room < size {
            share = share.min(room / size);
        }
    };
    // 0 ≤ g ≤ most
    for bound in bounds {
        keep(bound.size, bound.room + bound.gain.max(0.0) * most);
    }
    if most <= 0.0 {
        return (share, 0.0);
    }
    let gaining = || bounds.iter().filter(|bound| bound.gain > 0.0);
    // (size·s − room)/gain ≤ g for those that gain, g ≤ (room − size·s)/−gain for those that lose
    for one in gaining() {
        for other in bounds.iter().filter(|bound| bound.gain < 0.0) {
            keep(
                one.size / one.gain - other.size / other.gain,
                one.room / one.gain - other.room / other.gain,
            );
        }
    }
    let needed = gaining().map(|bound| (bound.size * share - bound.room) / bound.gain).fold(0.0, f64::max);
    (share, needed.min(most))
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::{Bound, largest_share};

    proptest! {
        /// A fine grid over s and g finds no larger share, and none as large that needs less to be given.
        #[test]
        fn no_point_of_a_grid_is_better(
            bounds in prop::collection::vec((-2.0..2.0, 0.0..1.5, -1.0..1.0), 1..8), most in 0.0..2.0,
        ) {
            let bounds: Vec<Bound> =
                bounds.into_iter().map(|(size, room, gain)| Bound { size, room, gain }).collect();
            let (share, given) = largest_share(&bounds, most);
            let slack = |share: f64, given: f64| {
                let slack = |bound: &Bound| bound.room + bound.gain * given - bound.size * share;
                bounds.iter().map(slack).fold(f64::INFINITY, f64::min)
            };
            prop_assert!((0.0..=most).contains(&given) && share <= 1.0);
            prop_assert!(slack(share, given) > -1e-9, "{share} {given}: {}", slack(share, given));
            for step in 0..=200 {
                let other = most * f64::from(step) / 200.0;
                prop_assert!(share == 1.0 || slack(share + 1e-6, other) < 0.0, "{share} under {other}");
                prop_assert!(other >= given - 1e-9 || slack(share, other) < 1e-9, "{other} would do for {given}");
            }
        }
    }
}
