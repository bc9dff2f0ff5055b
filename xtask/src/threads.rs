//! Work beside other work.

use std::panic;
use std::thread::ScopedJoinHandle;

/// Waits for a thread and returns its result; if it panicked, so does the caller.
pub fn join<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|payload| panic::resume_unwind(payload))
}
