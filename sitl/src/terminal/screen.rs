//! What the terminal can show.

use std::io::{IsTerminal, stderr, stdout};

/// Columns and rows where the terminal does not tell.
const DEFAULT_SIZE: (usize, usize) = (80, 24);

/// Whether lines can be written over: both streams are the same person's terminal, and it knows control sequences
/// (`TERM` is set, and not `dumb`). With the standard output in a pipe, they would run into what comes out of it.
pub fn has_live_lines() -> bool {
    stdout().is_terminal() && stderr().is_terminal() && anstyle_query::term_supports_color()
}

/// Whether the log is coloured: on a terminal that can, unless `NO_COLOR` is set; always with `CLICOLOR_FORCE`.
pub fn has_colours() -> bool {
    let wanted = !anstyle_query::no_color() && anstyle_query::clicolor() != Some(false);
    let able = stderr().is_terminal() && anstyle_query::term_supports_color();
    wanted && (able || anstyle_query::clicolor_force())
}

/// Columns and rows of the terminal.
pub fn size() -> (usize, usize) {
    #[cfg(unix)]
    if let Ok(size) = rustix::termios::tcgetwinsize(stderr())
        && size.ws_col > 0
        && size.ws_row > 0
    {
        return (size.ws_col.into(), size.ws_row.into());
    }
    DEFAULT_SIZE
}
