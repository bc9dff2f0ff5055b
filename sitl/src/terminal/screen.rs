//! What the terminal can show.

use std::io::{IsTerminal, stderr, stdout};

/// Width where the terminal does not tell.
const DEFAULT_COLUMNS: usize = 80;

/// Whether a line can be written over: both streams are the same person's terminal, and it knows control sequences
/// (`TERM` is set, and not `dumb`). With the standard output in a pipe, the line would run into what comes out of it.
pub fn has_live_line() -> bool {
    stdout().is_terminal() && stderr().is_terminal() && anstyle_query::term_supports_color()
}

/// Whether the log is coloured: on a terminal that can, unless `NO_COLOR` is set; always with `CLICOLOR_FORCE`.
pub fn has_colours() -> bool {
    let wanted = !anstyle_query::no_color() && anstyle_query::clicolor() != Some(false);
    let able = stderr().is_terminal() && anstyle_query::term_supports_color();
    wanted && (able || anstyle_query::clicolor_force())
}

/// Width of the terminal, in characters.
pub fn columns() -> usize {
    #[cfg(unix)]
    if let Ok(size) = rustix::termios::tcgetwinsize(stderr())
        && size.ws_col > 0
    {
        return size.ws_col.into();
    }
    DEFAULT_COLUMNS
}
