//! What stands at the bottom of the terminal and is written over. There is one terminal, and so there is one of it; the log comes from
//! any thread.
//!
//! Nothing is set that would have to be set back: no scroll region, no hidden cursor, no mode. However the program ends, the terminal
//! is as it was. The cursor rests in the line below a panel, so that what others write begins there.

use std::io::{Write, stderr};
use std::sync::{Mutex, PoisonError};

use super::screen::size;

/// What stands there.
static SHOWN: Mutex<Shown> = Mutex::new(Shown { lines: Vec::new(), below: false });

#[derive(Debug, Default)]
struct Shown {
    lines: Vec<String>,
    /// Whether the cursor is in the line below them, and not at their end.
    below: bool,
}

/// Shows lines in place of those that stand there; the cursor goes below them, or stays at their end.
pub fn show(lines: Vec<String>, below: bool) {
    change(|shown, columns| {
        let erased = shown.erase(columns);
        *shown = Shown { lines, below };
        (erased + &shown.draw()).into_bytes()
    });
}

/// Removes what stands there.
pub fn clear() {
    change(|shown, columns| {
        let erased = shown.erase(columns);
        *shown = Shown::default();
        erased.into_bytes()
    });
}

/// Leaves what stands there to itself: something else may stand below it now.
pub fn forget() {
    change(|shown, _| {
        *shown = Shown::default();
        Vec::new()
    });
}

/// Writes whole lines above what stands there.
pub fn write_above(text: &[u8]) {
    change(|shown, columns| [shown.erase(columns).as_bytes(), text, shown.draw().as_bytes()].concat());
}

fn change(with: impl FnOnce(&mut Shown, usize) -> Vec<u8>) {
    // A panic elsewhere leaves it whole: nothing here is half done.
    let mut shown = SHOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let bytes = with(&mut shown, size().0);
    // In one piece, and nobody minds if a terminal is gone.
    let _gone = stderr().write_all(&bytes).and_then(|()| stderr().flush());
}

impl Shown {
    /// What removes the lines from a terminal of so many columns. A terminal that has become narrower has wrapped them.
    fn erase(&self, columns: usize) -> String {
        if self.lines.is_empty() {
            return String::new();
        }
        let rows: usize =
            self.lines.iter().map(|line| line.chars().count().div_ceil(columns.max(1)).max(1)).sum();
        match rows - usize::from(!self.below) {
            0 => "\r\x1b[K".to_owned(),
            up => format!("\r\x1b[{up}A\x1b[J"),
        }
    }

    fn draw(&self) -> String {
        let end = if self.below && !self.lines.is_empty() { "\n" } else { "" };
        self.lines.join("\n") + end
    }
}

#[cfg(test)]
mod tests {
    use super::Shown;

    fn shown(lines: &[&str], below: bool) -> Shown {
        Shown { lines: lines.iter().map(|line| (*line).to_owned()).collect(), below }
    }

    #[test]
    fn nothing_is_erased_where_nothing_stands() {
        assert_eq!(Shown::default().erase(80), "");
        assert_eq!(Shown::default().draw(), "");
    }

    #[test]
    fn a_line_ends_at_its_end_and_a_panel_below_itself() {
        assert_eq!(shown(&["armed"], false).draw(), "armed");
        assert_eq!(shown(&["armed"], false).erase(80), "\r\x1b[K");
        assert_eq!(shown(&["armed", "north"], true).draw(), "armed\nnorth\n");
        assert_eq!(shown(&["armed", "north"], true).erase(80), "\r\x1b[2A\x1b[J");
    }

    #[test]
    fn lines_that_a_narrower_terminal_has_wrapped_are_erased_whole() {
        let panel = shown(&["0123456789", "", "01234"], true);
        assert_eq!(panel.erase(10), "\r\x1b[3A\x1b[J");
        assert_eq!(panel.erase(5), "\r\x1b[4A\x1b[J");
        assert_eq!(panel.erase(4), "\r\x1b[6A\x1b[J");
        assert_eq!(shown(&["0123456789"], false).erase(5), "\r\x1b[1A\x1b[J");
    }
}
