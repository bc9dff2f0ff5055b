//! One line at the bottom of a terminal that follows the flight.

use std::io::{Write, stderr};
use std::time::{Duration, Instant};

use super::screen::{columns, has_live_line};

/// How often the line changes.
const PERIOD: Duration = Duration::from_millis(500);
/// Between two segments.
const GAP: &str = "  ";
/// Ranks of simulation time and of its speed.
const TIME_RANK: u8 = 1;
const SPEED_RANK: u8 = 4;

/// A part of the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// What it says.
    pub text: String,
    /// Where there is not room for all, low ranks stay.
    pub rank: u8,
}

impl Segment {
    /// A segment of a rank.
    pub fn new(rank: u8, text: impl Into<String>) -> Self {
        Self { text: text.into(), rank }
    }
}

/// The status line. It is shown only where it can be written over.
#[derive(Debug)]
pub struct StatusLine {
    live: bool,
    shown: bool,
    last: Instant,
    last_us: u64,
}

impl StatusLine {
    /// Shows nothing yet.
    pub fn new(now: Instant) -> Self {
        Self { live: has_live_line(), shown: false, last: now, last_us: 0 }
    }

    /// Shows simulation time, µs, its speed and these segments, if it is time to.
    pub fn update(&mut self, now: Instant, time_us: u64, segments: impl FnOnce() -> Vec<Segment>) {
        let elapsed = now.saturating_duration_since(self.last);
        if !self.live || elapsed < PERIOD {
            return;
        }
        // Another flight begins at zero again.
        let flown_s = time_us.saturating_sub(self.last_us) as f64 / 1e6;
        let speed = flown_s / elapsed.as_secs_f64();
        (self.last, self.last_us, self.shown) = (now, time_us, true);
        let mut all = vec![
            Segment::new(TIME_RANK, format!("{:6.1} s", time_us as f64 / 1e6)),
            Segment::new(SPEED_RANK, format!("{speed:.1}x")),
        ];
        all.extend(segments());
        // A line as wide as the terminal could wrap, and what has wrapped cannot be written over.
        let text = fit(&all, columns().saturating_sub(1));
        // Nobody minds if a terminal is gone.
        let _gone = write!(stderr(), "\r\x1b[K{text}").and_then(|()| stderr().flush());
    }

    /// Leaves the line to what follows.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.shown) {
            let _gone = write!(stderr(), "\r\x1b[K").and_then(|()| stderr().flush());
        }
    }
}

/// As many segments as fit into a width, those of low rank first, in their order; cut off if not even one fits.
fn fit(segments: &[Segment], width: usize) -> String {
    let length = |segment: &Segment| segment.text.chars().count();
    let mut by_rank: Vec<usize> = (0..segments.len()).collect();
    by_rank.sort_by_key(|number| segments.get(*number).map(|segment| segment.rank));
    let mut kept: Vec<usize> = Vec::new();
    let mut used = 0;
    for number in by_rank {
        let Some(segment) = segments.get(number) else { continue };
        let gap = if kept.is_empty() { 0 } else { GAP.len() };
        if kept.is_empty() || used + gap + length(segment) <= width {
            used += gap + length(segment);
            kept.push(number);
        }
    }
    kept.sort_unstable();
    let words: Vec<&str> =
        kept.iter().filter_map(|number| segments.get(*number)).map(|segment| segment.text.as_str()).collect();
    words.join(GAP).chars().take(width).collect()
}

#[cfg(test)]
mod tests {
    use super::{Segment, fit};

    fn segments() -> Vec<Segment> {
        vec![
            Segment::new(1, "  12.3 s"),
            Segment::new(4, "1.0x"),
            Segment::new(0, "armed Hold"),
            Segment::new(2, "N   0.0 E   0.0 up 10.0 m"),
            Segment::new(3, "battery 99 %"),
            Segment::new(5, "1 client"),
        ]
    }

    #[test]
    fn what_matters_least_goes_first_and_the_order_stays() {
        for (width, expected) in [
            (120, "  12.3 s  1.0x  armed Hold  N   0.0 E   0.0 up 10.0 m  battery 99 %  1 client"),
            (69, "  12.3 s  1.0x  armed Hold  N   0.0 E   0.0 up 10.0 m  battery 99 %"),
            (60, "  12.3 s  1.0x  armed Hold  N   0.0 E   0.0 up 10.0 m"),
            (39, "  12.3 s  armed Hold  battery 99 %"),
            (10, "armed Hold"),
            (5, "armed"),
            (0, ""),
        ] {
            assert_eq!(fit(&segments(), width), expected, "{width}");
        }
    }

    #[test]
    fn no_width_is_exceeded() {
        for width in 0..130 {
            assert!(fit(&segments(), width).chars().count() <= width);
        }
    }
}
