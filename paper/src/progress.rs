//! A progress bar, on a terminal only.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How far the computation has come; advanced from any thread.
#[derive(Clone, Debug)]
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Shown on standard error if that is a terminal, with so many parts to come.
    pub fn shown(parts: u64) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(parts), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("[{elapsed}] {bar:40} {percent:>3} % {msg}") {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Shown nowhere.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden() }
    }

    /// What is being computed.
    pub fn stage(&self, name: &str) {
        self.bar.set_message(name.to_owned());
    }

    /// One part is done.
    pub fn advance(&self) {
        self.bar.inc(1);
    }

    /// All parts are done: the bar disappears.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
