//! How a process ended, in words.

use std::process::ExitStatus;

/// Signals that end processes, by their POSIX names.
#[cfg(unix)]
const SIGNALS: [(i32, &str); 11] = [
    (libc::SIGSEGV, "segmentation fault (SIGSEGV)"),
    (libc::SIGABRT, "abort (SIGABRT)"),
    (libc::SIGFPE, "arithmetic error (SIGFPE)"),
    (libc::SIGILL, "illegal instruction (SIGILL)"),
    (libc::SIGBUS, "bus error (SIGBUS)"),
    (libc::SIGTRAP, "trap (SIGTRAP)"),
    (libc::SIGSYS, "forbidden system call (SIGSYS)"),
    (libc::SIGPIPE, "broken pipe (SIGPIPE)"),
    (libc::SIGKILL, "killed (SIGKILL): by somebody, or because memory ran out"),
    (libc::SIGTERM, "terminated (SIGTERM)"),
    (libc::SIGINT, "interrupted (SIGINT)"),
];

/// The signal that ended it, in words.
#[cfg(unix)]
pub(super) fn signal(status: ExitStatus) -> Option<String> {
    let number = std::os::unix::process::ExitStatusExt::signal(&status)?;
    let known = SIGNALS.iter().find(|(signal, _)| *signal == number);
    Some(known.map_or_else(|| format!("signal {number}"), |(_, name)| (*name).to_owned()))
}

/// The exception that ended it, in words: Windows gives it as an exit code.
#[cfg(windows)]
pub(super) fn signal(status: ExitStatus) -> Option<String> {
    let code = status.code()?.cast_unsigned();
    Some(match code {
        0xc000_0005 => "access violation".to_owned(),
        0xc000_001d => "illegal instruction".to_owned(),
        0xc000_0094 => "integer division by zero".to_owned(),
        0xc000_00fd => "stack overflow".to_owned(),
        0xc000_0409 => "abort".to_owned(),
        0xc000_0000.. => format!("exception {code:#010x}"),
        _ => return None,
    })
}
