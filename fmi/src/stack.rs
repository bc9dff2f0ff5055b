//! Room on the stack for a call.
//!
//! Hosts call from threads of their own, whose stacks may be small: 64 KiB are enough. To design controllers takes several
//! times as much, in numbers that live as long as the call.

/// A call with less room left on its thread's stack than this, bytes, runs on a stack of its own.
const NEEDED: usize = 512 * 1024;
/// Size of that stack, bytes.
const OWN: usize = 1024 * 1024;

/// Calls `body` with enough room on the stack. Threads with megabytes of it, as most have, are not switched.
pub(crate) fn with_room<T>(body: impl FnOnce() -> T) -> T {
    stacker::maybe_grow(NEEDED, OWN, body)
}
