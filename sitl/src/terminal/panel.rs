//! Lines at the bottom of a terminal that follow the flight.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::live;
use super::screen::{has_live_lines, size};
use super::segment::{Segment, fit};

/// How often the lines change.
const PERIOD: Duration = Duration::from_millis(500);
/// The least height of a terminal that has room for a panel.
const LEAST_ROWS: usize = 8;
/// Ranks of simulation time and of its speed.
const TIME_RANK: u8 = 1;
const SPEED_RANK: u8 = 4;

/// How much is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// One line.
    Line,
    /// Several.
    Panel {
        /// The most that there is room for.
        most: usize,
    },
}

/// What follows the flight: a panel, or one line. It is shown only where it can be written over.
#[derive(Debug)]
pub struct Panel {
    live: bool,
    one_line: bool,
    last: Instant,
    last_us: u64,
    /// Set when the program goes on after it was stopped.
    resumed: Arc<AtomicBool>,
}

impl Panel {
    /// Shows nothing yet; never more than one line if that is asked for.
    pub fn new(now: Instant, one_line: bool) -> Self {
        let resumed = Arc::new(AtomicBool::new(false));
        // Without the handler, what the shell has written meanwhile may be written over.
        #[cfg(unix)]
        let _refused = signal_hook::flag::register(signal_hook::consts::SIGCONT, Arc::clone(&resumed));
        Self { live: has_live_lines(), one_line, last: now, last_us: 0, resumed }
    }

    /// Shows simulation time, µs, its speed and these rows of segments, if it is time to. The first row has room for both.
    pub fn update(&mut self, now: Instant, time_us: u64, rows: impl FnOnce(Form) -> Vec<Vec<Segment>>) {
        let elapsed = now.saturating_duration_since(self.last);
        if !self.live || elapsed < PERIOD {
            return;
        }
        if self.resumed.swap(false, Ordering::Relaxed) {
            live::forget();
        }
        // Another flight begins at zero again.
        let flown_s = time_us.saturating_sub(self.last_us) as f64 / 1e6;
        let speed = flown_s / elapsed.as_secs_f64();
        (self.last, self.last_us) = (now, time_us);
        let (columns, height) = size();
        let form = form(self.one_line, height);
        let mut rows = rows(form);
        if let Some(first) = rows.first_mut() {
            let time = Segment::new(TIME_RANK, format!("{:6.1} s", time_us as f64 / 1e6));
            first.splice(0..0, [time, Segment::new(SPEED_RANK, format!("{speed:.1}x"))]);
        }
        // A line as wide as the terminal could wrap.
        let width = columns.saturating_sub(1);
        live::show(rows.iter().map(|row| fit(row, width)).collect(), form != Form::Line);
    }

    /// Leaves the lines to what follows.
    pub fn clear(&mut self) {
        if self.live {
            live::clear();
        }
    }
}

/// What a terminal of some height has room for: the log keeps half of it.
fn form(one_line: bool, height: usize) -> Form {
    if one_line || height < LEAST_ROWS { Form::Line } else { Form::Panel { most: height / 2 } }
}

#[cfg(test)]
mod tests {
    use super::{Form, form};

    #[test]
    fn a_low_terminal_has_one_line() {
        assert_eq!(form(false, 24), Form::Panel { most: 12 });
        assert_eq!(form(false, 8), Form::Panel { most: 4 });
        assert_eq!(form(false, 7), Form::Line);
        assert_eq!(form(true, 24), Form::Line);
    }
}
