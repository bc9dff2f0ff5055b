//! What a library logs.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;
use std::sync::Mutex;

use super::library::Status;

/// One message that the library logged.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub status: Status,
    pub category: String,
    pub text: String,
}

/// The environment that is given to the library, and comes back with each message.
#[derive(Default)]
pub struct Log(Mutex<Vec<Message>>);

impl Log {
    /// The messages since the last call.
    pub fn take(&self) -> Vec<Message> {
        std::mem::take(&mut self.0.lock().expect("no test panics while it logs"))
    }

    /// The last message; it must be there.
    pub fn last(&self) -> Message {
        self.take().pop().expect("something was logged")
    }

    pub fn environment(&self) -> *mut c_void {
        ptr::from_ref(self).cast_mut().cast()
    }
}

/// Logger of the tests.
pub unsafe extern "C" fn record(
    environment: *mut c_void,
    status: Status,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the environment is the `Log` that was given; the strings end with NUL.
    unsafe {
        let text = |text| CStr::from_ptr(text).to_string_lossy().into_owned();
        let message = Message { status, category: text(category), text: text(message) };
        (*environment.cast::<Log>()).0.lock().expect("no test panics while it logs").push(message);
    }
}
