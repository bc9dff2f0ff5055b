//! What an FMU says.

use std::ffi::{CStr, c_int};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use super::types::{Environment, Status, Text};

/// A message of an FMU's logger, with its arguments written into it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Message {
    /// How serious it is.
    pub status: Status,
    /// The category that the FMU gave it.
    pub category: String,
    /// One or more lines.
    pub text: String,
}

/// Who takes the messages of an instance. FMUs may log from threads of their own.
pub(crate) struct Receiver(Mutex<Box<dyn FnMut(Message) + Send>>);

impl Receiver {
    pub(crate) fn new(take: impl FnMut(Message) + Send + 'static) -> Self {
        Self(Mutex::new(Box::new(take)))
    }
}

unsafe extern "C" {
    /// Of `logger.c`: formats, then calls [`importer_take_message`].
    pub(crate) fn importer_logger(
        environment: Environment,
        instance: Text,
        status: c_int,
        category: Text,
        format: Text,
        ...
    );
}

/// The other end of `logger.c`.
///
/// # Safety
/// `environment` is that of the callbacks; texts are null or end with a zero.
#[unsafe(no_mangle)]
unsafe extern "C" fn importer_take_message(
    environment: Environment,
    status: c_int,
    category: Text,
    text: Text,
) {
    // SAFETY: an FMU hands back the environment that it was given, which lives as long as the instance; some hand back null.
    let Some(receiver) = (unsafe { environment.cast::<Receiver>().as_ref() }) else { return };
    let message =
        // SAFETY: as promised above.
        unsafe { Message { status: status.into(), category: text_of(category), text: text_of(text) } };
    let mut take = receiver.0.lock().unwrap_or_else(PoisonError::into_inner);
    take(message);
}

/// A C text, whatever its bytes are.
///
/// # Safety
/// It is null or ends with a zero.
pub(crate) unsafe fn text_of(text: Text) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: it is not null, so that it ends with a zero.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use std::ffi::c_void;
    use std::ptr::{from_ref, null, null_mut};
    use std::sync::mpsc;

    use super::{Message, Receiver, Status, importer_logger};

    fn logged(log: impl Fn(*mut c_void)) -> Vec<Message> {
        let (sender, messages) = mpsc::channel();
        let receiver = Receiver::new(move |message| sender.send(message).expect("the test listens"));
        log(from_ref(&receiver).cast_mut().cast());
        drop(receiver);
        messages.iter().collect()
    }

    #[test]
    fn arguments_are_written_into_the_message() {
        let messages = logged(|environment| {
            // SAFETY: as an FMU in C would call it; the format fits its arguments.
            unsafe {
                importer_logger(
                    environment,
                    c"one".as_ptr(),
                    3,
                    c"logStatusError".as_ptr(),
                    c"%s: x[%d] = %.3f, %g, 100 %%\n".as_ptr(),
                    c"no root".as_ptr(),
                    7_i32,
                    2.5_f64,
                    1e-9_f64,
                );
            }
        });
        let expected = Message {
            status: Status::Error,
            category: "logStatusError".to_owned(),
            text: "no root: x[7] = 2.500, 1e-09, 100 %".to_owned(),
        };
        assert_eq!(messages, [expected]);
    }

    #[test]
    fn long_messages_are_cut_and_missing_texts_are_empty() {
        let long = std::ffi::CString::new("x".repeat(10_000)).expect("a text");
        let messages = logged(|environment| {
            // SAFETY: null texts are what the test is about.
            unsafe {
                importer_logger(environment, null(), 0, null(), c"%s".as_ptr(), long.as_ptr());
                importer_logger(environment, null(), 9, null(), null());
                importer_logger(null_mut(), null(), 0, null(), c"to nobody".as_ptr());
            }
        });
        assert_eq!(messages.len(), 2);
        assert_eq!(messages[0].text.len(), 4095);
        assert_eq!(
            messages[1],
            Message { status: Status::Unknown(9), category: String::new(), text: String::new() }
        );
    }
}
