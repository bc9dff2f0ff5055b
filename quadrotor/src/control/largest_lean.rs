//! How far commands may lean beside what a reference does.

/// The room that feedback has beside the lean of a reference, as a share of the largest lean that is commanded.
const FEEDBACK_SHARE: f64 = 0.05;
/// The same of later commands of a plan. Noise makes it lean farther then than now, and the next plan is made before it does: without so much
/// room, noise would take away from the reference itself.
const LATER_FEEDBACK_SHARE: f64 = 0.2;

/// Horizontal accelerations at most, m/s², under one vertical acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LargestLean {
    /// Of commands that nobody foretells: the attitude overshoots them.
    pub(crate) commanded_m_s2: f64,
    /// Of a reference that tells how it goes on, and of feedback beside it.
    pub(crate) foretold_m_s2: f64,
}

impl LargestLean {
    /// Both within what else there is room for, m/s².
    pub(crate) fn within(&self, most_m_s2: f64) -> Self {
        Self {
            commanded_m_s2: self.commanded_m_s2.min(most_m_s2),
            foretold_m_s2: self.foretold_m_s2.min(most_m_s2),
        }
    }

    /// The largest command beside a reference that requires an acceleration itself, m/s².
    pub(crate) fn beside(&self, required_m_s2: f64) -> f64 {
        let both = required_m_s2 + FEEDBACK_SHARE * self.commanded_m_s2;
        both.min(self.foretold_m_s2).max(self.commanded_m_s2)
    }

    /// The largest later command of a plan beside such a reference, if that is within the limits, m/s².
    pub(crate) fn later_beside(&self, required_m_s2: f64) -> f64 {
        self.beside(required_m_s2).max(required_m_s2 + LATER_FEEDBACK_SHARE * self.commanded_m_s2)
    }
}

#[cfg(test)]
mod tests {
    use super::LargestLean;

    /// A reference that leans little leaves commands their own limit; one that leans more takes it along, up to its own.
    #[test]
    fn the_limit_goes_along_with_what_is_foretold() {
        let largest = LargestLean { commanded_m_s2: 6.0, foretold_m_s2: 6.6 };
        for (required, expected) in [(0.0, 6.0), (5.7, 6.0), (6.0, 6.3), (6.3, 6.6), (9.0, 6.6)] {
            assert!((largest.beside(required) - expected).abs() < 1e-12, "{required}");
        }
        for (required, later) in [(0.0, 6.0), (4.0, 6.0), (5.7, 6.9)] {
            assert!((largest.later_beside(required) - later).abs() < 1e-12, "{required}");
        }
        let held = largest.within(4.0);
        assert_eq!((held.commanded_m_s2, held.foretold_m_s2, held.beside(9.0)), (4.0, 4.0, 4.0));
    }
}
