//! Signals of the system that end the program in good order.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// A flag that signals set: SIGINT, SIGTERM, and SIGHUP of a terminal that is closed. A second one ends the program at once.
///
/// # Errors
/// When the system refuses handlers.
pub fn stop_on_signals() -> io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    // With a handler a limit on the size of files is an error of the file, and not the end of the flight.
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    for signal in [SIGINT, SIGTERM].into_iter().chain(hangup()) {
        flag::register_conditional_shutdown(signal, 130, Arc::clone(&stop))?;
        flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

/// The signal of a terminal that is closed, if there is one and it is not ignored.
fn hangup() -> Option<i32> {
    #[cfg(unix)]
    return Some(signal_hook::consts::SIGHUP).filter(|signal| !is_ignored(*signal));
    #[cfg(not(unix))]
    None
}

/// Whether whoever started the program wants a signal to be ignored, as `nohup` does. Where the system does not tell, the signal
/// is left as it is.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let ignored = || {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
        u64::from_str_radix(mask.trim(), 16).ok()
    };
    ignored().is_none_or(|mask| mask >> (signal - 1) & 1 == 1)
}
