//! What was known before a surprise along the thrust, until it is clear that this was no gust.
//!
//! A mass that changes, and a push that comes, look the same at first. What a wrong mass makes of the equation of motion is in proportion to
//! the thrust, and stays; a gust ends. While one lasts, the thrust answers it, and passes for a mass.

use serde::{Deserialize, Serialize};

use crate::control::learning::bounded_estimate::{BoundedEstimate, Prior};

/// Share of what a surprise has changed, below which it has gone …
const GONE_SHARE: f64 = 0.3;
/// … once it has been so for this long, s.
const GONE_S: f64 = 0.15;
/// Equations of a filter that has taken in less than this tell too little.
const FILLED: f64 = 0.5;

/// The most by which the reciprocal of a mass, as a multiple of the airframe's, may have been wrong.
const MOST_WRONG: f64 = 1.5;

/// An estimate of N numbers before a surprise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct GustMemory<const N: usize> {
    estimate: BoundedEstimate<N>,
    /// What has surprised.
    surprise: Surprise,
    /// The most that the estimate has missed of the acceleration along the thrust since then, m/s².
    most_missed_m_s2: f64,
    since_us: u64,
    gone_s: f64,
}

/// A change of the acceleration along the thrust.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Surprise {
    /// By how much it has changed, m/s².
    pub(crate) jump_m_s2: f64,
    /// Thrust per mass then, m/s².
    pub(crate) thrust_m_s2: f64,
    /// The same in the seconds before, m/s².
    pub(crate) steady_thrust_m_s2: f64,
}

impl Surprise {
    /// What it makes likely that an equation under another thrust per mass, m/s², is off by, m/s², if it was a mass that has changed, or one
    /// that has been wrong, under a force that made up for it.
    fn of_a_mass_m_s2(&self, thrust_m_s2: f64, most_missed_m_s2: f64) -> f64 {
        let changed = most_missed_m_s2 * (thrust_m_s2 / self.thrust_m_s2).min(1.0);
        let since = libm::fabs(self.thrust_m_s2 - self.steady_thrust_m_s2);
        let wrong = (self.jump_m_s2 / since.max(f64::MIN_POSITIVE)).min(MOST_WRONG);
        changed.min(wrong * libm::fabs(thrust_m_s2 - self.steady_thrust_m_s2))
    }
}

impl<const N: usize> GustMemory<N> {
    /// What is known at a surprise.
    pub(crate) fn new(estimate: BoundedEstimate<N>, surprise: Surprise, since_us: u64) -> Self {
        Self { estimate, surprise, most_missed_m_s2: surprise.jump_m_s2, since_us, gone_s: 0.0 }
    }

    /// What was known.
    pub(crate) fn estimate(&self) -> &BoundedEstimate<N> {
        &self.estimate
    }

    /// By how much the acceleration changed at most, m/s².
    pub(crate) fn most_missed_m_s2(&self) -> f64 {
        self.most_missed_m_s2
    }

    /// Time of the surprise, µs.
    pub(crate) fn since_us(&self) -> u64 {
        self.since_us
    }

    /// Looks at what the estimate of before misses of the acceleration under a thrust per mass, m/s², by an equation that is `filled`, a time
    /// after the one before, s. Whether that has gone which was a surprise.
    pub(crate) fn has_ended(
        &mut self,
        (missed_m_s2, thrust_m_s2): (f64, f64),
        filled: f64,
        interval_s: f64,
    ) -> bool {
        if filled <= FILLED {
            return false;
        }
        let missed_m_s2 = libm::fabs(missed_m_s2);
        self.most_missed_m_s2 = self.most_missed_m_s2.max(missed_m_s2);
        let of_a_mass_m_s2 = self.surprise.of_a_mass_m_s2(thrust_m_s2, self.most_missed_m_s2);
        let is_gone = missed_m_s2 < GONE_SHARE * of_a_mass_m_s2;
        self.gone_s = if is_gone { self.gone_s + interval_s } else { 0.0 };
        self.gone_s >= GONE_S
    }

    /// Whether a flight can have been in this state: saved states may come from anywhere.
    pub(crate) fn is_possible(&self, prior: &Prior<N>) -> bool {
        let Self { estimate, surprise, most_missed_m_s2, since_us: _, gone_s } = self;
        let Surprise { jump_m_s2, thrust_m_s2, steady_thrust_m_s2 } = surprise;
        let numbers = [jump_m_s2, thrust_m_s2, steady_thrust_m_s2, most_missed_m_s2, gone_s];
        estimate.is_possible(prior) && numbers.iter().all(|number| number.is_finite() && **number >= 0.0)
    }
}
