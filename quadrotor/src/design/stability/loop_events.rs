//! When the controllers of a loop sample, over a time after which all repeats.

use alloc::vec::Vec;

/// Most samples of a loop that are looked at. Sample times without a common multiple within so many samples are followed
/// for as long.
const MOST_EVENTS: usize = 1_200;

/// One instant at which a controller samples, and the time until the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoopEvent {
    /// Whether the outer controller (position or altitude) samples.
    pub(crate) outer: bool,
    /// Whether the attitude controller samples.
    pub(crate) inner: bool,
    /// Share of the outer controller's sample time that has passed since it sampled.
    pub(crate) share: f64,
    /// The same, one sample of the attitude controller later.
    pub(crate) share_ahead: f64,
    /// By how much this instant is before the one that the estimator has predicted for, s.
    pub(crate) early_s: f64,
    /// Time to the next instant, µs.
    pub(crate) duration_us: u64,
}

/// The instants of an outer and of the attitude controller, both of which sample at the first one. Sample times in µs.
pub(crate) fn loop_events(outer_us: u64, inner_us: u64) -> Vec<LoopEvent> {
    let mut events = Vec::new();
    let (mut time_us, mut outer_at_us, mut inner_at_us, mut sampled_us) = (0, 0, 0, 0);
    while events.len() < MOST_EVENTS {
        let (outer, inner) = (time_us == outer_at_us, time_us == inner_at_us);
        if outer && inner && !events.is_empty() {
            break;
        }
        let early_s = (inner_at_us - time_us) as f64 / 1e6;
        if outer {
            sampled_us = time_us;
            outer_at_us += outer_us;
        }
        if inner {
            inner_at_us += inner_us;
        }
        let next_us = outer_at_us.min(inner_at_us);
        let share = |at_us: u64| (at_us - sampled_us) as f64 / outer_us as f64;
        events.push(LoopEvent {
            outer,
            inner,
            share: share(time_us).min(1.0),
            share_ahead: share(time_us + inner_us).min(2.0),
            early_s,
            duration_us: next_us - time_us,
        });
        time_us = next_us;
    }
    events
}

/// How long these events take, s.
pub(crate) fn period_s(events: &[LoopEvent]) -> f64 {
    events.iter().map(|event| event.duration_us).sum::<u64>() as f64 / 1e6
}

#[cfg(test)]
mod tests {
    use super::{loop_events, period_s};

    #[test]
    fn sample_times_repeat_after_their_least_common_multiple() {
        for (outer_us, inner_us, count, expected_s) in [
            (50_000, 10_000, 5, 0.05),
            (10_000, 10_000, 1, 0.01),
            // At 0, 10, 20, 25, 30 and 40 ms.
            (25_000, 10_000, 6, 0.05),
        ] {
            let events = loop_events(outer_us, inner_us);
            assert_eq!(events.len(), count);
            assert!((period_s(&events) - expected_s).abs() < 1e-12);
        }
        let events = loop_events(25_000, 10_000);
        assert!(events[3].outer && !events[3].inner && (events[3].early_s - 0.005).abs() < 1e-12);
        assert!((events[2].share - 0.8).abs() < 1e-12 && (events[2].share_ahead - 1.2).abs() < 1e-12);
    }
}
