//! Times of the day.

/// Hour, minute and second, UTC; what is `None` may be any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeOfDay(pub [Option<u64>; 3]);

const SECOND_US: u64 = 1_000_000;
const DAY_S: u64 = 86_400;

impl TimeOfDay {
    /// How long it is to the next such time from a time since 1970, µs; nothing if it is now.
    pub fn wait_us(&self, unix_us: u64) -> u64 {
        let now_s = unix_us / SECOND_US;
        let fits = |unix_s: &u64| {
            let second = unix_s % DAY_S;
            let parts = [second / 3600, second / 60 % 60, second % 60];
            self.0.iter().zip(parts).all(|(asked, part)| asked.is_none_or(|asked| asked == part))
        };
        let next_s = (now_s..now_s.saturating_add(DAY_S)).find(fits).unwrap_or(now_s);
        next_s.saturating_mul(SECOND_US).saturating_sub(unix_us)
    }
}

#[cfg(test)]
mod tests {
    use super::TimeOfDay;

    /// 2026-11-21 13:45:20.5 UTC.
    const NOW_US: u64 = 1_795_268_720_500_000;

    #[test]
    fn the_next_time_that_fits_is_waited_for() {
        for (asked, wait_s) in [
            ([Some(13), Some(45), Some(30)], 9.5),
            ([Some(13), Some(45), Some(20)], 0.0),
            ([Some(13), Some(45), Some(19)], 86_398.5),
            ([None, Some(46), None], 39.5),
            ([None, None, Some(5)], 44.5),
            ([Some(14), None, None], 879.5),
            ([Some(0), Some(0), Some(0)], 36_879.5),
        ] {
            assert_eq!(TimeOfDay(asked).wait_us(NOW_US) as f64 / 1e6, wait_s, "{asked:?}");
        }
    }
}
