//! What is being done, with the time since the start, and at the end how long each step took.

use std::fmt::Write;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Steps shorter than this are left out of the summary.
const WORTH_MENTIONING: Duration = Duration::from_millis(500);

/// The clock of a task and the steps that it has taken. Steps may overlap.
pub struct Progress {
    start: Instant,
    taken: Mutex<Vec<(String, Duration)>>,
}

impl Progress {
    /// Starts the clock.
    pub fn start() -> Self {
        Self { start: Instant::now(), taken: Mutex::default() }
    }

    /// Prints a line with the time since the start.
    pub fn note(&self, text: &str) {
        eprintln!("[{:6.1} s] {text}", self.elapsed().as_secs_f64());
    }

    /// Does a step, which is printed as it begins and timed.
    pub fn timed<T>(&self, text: &str, step: impl FnOnce() -> T) -> T {
        self.note(text);
        let begin = Instant::now();
        let result = step();
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        taken.push((text.to_owned(), begin.elapsed()));
        result
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// Prints how long the steps took, in the order in which they ended, and the task as a whole.
    pub fn print_summary(&self) {
        let taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        eprint!("{}", summary(&taken, self.elapsed()));
    }
}

fn summary(taken: &[(String, Duration)], total: Duration) -> String {
    let mut text = "\nTime (steps overlap)\n".to_owned();
    let worth = taken.iter().filter(|(_, duration)| *duration >= WORTH_MENTIONING);
    for (step, duration) in worth.map(|(step, duration)| (step.as_str(), *duration)).chain([("Total", total)])
    {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {:6.1} s  {step}", duration.as_secs_f64());
    }
    text
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::summary;

    #[test]
    fn summary_has_long_steps_and_the_total() {
        let taken =
            [("compile".to_owned(), Duration::from_secs(61)), ("look".to_owned(), Duration::from_millis(20))];
        let text = summary(&taken, Duration::from_millis(62_500));
        assert_eq!(text, "\nTime (steps overlap)\n    61.0 s  compile\n    62.5 s  Total\n");
    }
}
