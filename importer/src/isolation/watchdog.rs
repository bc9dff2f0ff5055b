//! Ends what does not return in time.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Between two looks at the deadline.
const LOOK: Duration = Duration::from_millis(20);

#[derive(Debug, Default)]
struct Watched {
    deadline: Option<Instant>,
    expired: bool,
    over: bool,
}

/// A thread that does something once when a deadline passes.
#[derive(Debug)]
pub(super) struct Watchdog {
    shared: Arc<(Mutex<Watched>, Condvar)>,
    thread: Option<JoinHandle<()>>,
}

impl Watchdog {
    /// Watches; `bite` is called once when a deadline has passed.
    pub(super) fn new(bite: impl FnOnce() + Send + 'static) -> Self {
        let shared = Arc::new((Mutex::new(Watched::default()), Condvar::new()));
        let watched = Arc::clone(&shared);
        let thread = std::thread::spawn(move || {
            let (state, over) = &*watched;
            let mut state = lock(state);
            while !state.over {
                if state.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
                    state.expired = true;
                    drop(state);
                    bite();
                    return;
                }
                state = over.wait_timeout(state, LOOK).unwrap_or_else(PoisonError::into_inner).0;
            }
        });
        Self { shared, thread: Some(thread) }
    }

    /// Sets a deadline.
    pub(super) fn arm(&self, within: Duration) {
        lock(&self.shared.0).deadline = Instant::now().checked_add(within);
    }

    /// It has returned. Whether that was too late.
    pub(super) fn disarm(&self) -> bool {
        let mut state = lock(&self.shared.0);
        state.deadline = None;
        state.expired
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        lock(&self.shared.0).over = true;
        self.shared.1.notify_all();
        if let Some(thread) = self.thread.take() {
            let _bitten = thread.join();
        }
    }
}

fn lock(state: &Mutex<Watched>) -> MutexGuard<'_, Watched> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
