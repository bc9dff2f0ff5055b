//! What an FMU says.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_int};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

type Take = Mutex<Box<dyn FnMut(Message) + Send>>;

/// Who takes messages, by the environments that their instances were given. FMUs hand back what they like, also null and pointers of
/// their own: an environment is looked up here, and never followed.
static RECEIVERS: Mutex<BTreeMap<usize, Arc<Take>>> = Mutex::new(BTreeMap::new());

fn receivers() -> MutexGuard<'static, BTreeMap<usize, Arc<Take>>> {
    RECEIVERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Who takes the messages of an instance, as long as the value lives. FMUs may log from threads of their own.
pub(crate) struct Receiver(Arc<Take>);

impl Receiver {
    pub(crate) fn new(take: impl FnMut(Message) + Send + 'static) -> Self {
        let receiver = Self(Arc::new(Mutex::new(Box::new(take))));
        receivers().insert(receiver.environment().addr(), Arc::clone(&receiver.0));
        receiver
    }

    /// What the FMU is given, and should hand back.
    pub(crate) fn environment(&self) -> Environment {
        Arc::as_ptr(&self.0).cast_mut().cast()
    }
}

impl Drop for Receiver {
    fn drop(&mut self) {
        receivers().remove(&self.environment().addr());
    }
}

/// Who takes a message: the instance with its environment, or all that there are, since nobody can tell whose it is.
fn takers(environment: Environment) -> Vec<Arc<Take>> {
    let receivers = receivers();
    match receivers.get(&environment.addr()) {
        Some(take) => vec![Arc::clone(take)],
        None => receivers.values().cloned().collect(),
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
/// Texts are null or end with a zero. `environment` may be anything.
#[unsafe(no_mangle)]
unsafe extern "C" fn importer_take_message(
    environment: Environment,
    status: c_int,
    category: Text,
    text: Text,
) {
    let message =
        // SAFETY: as promised above.
        unsafe { Message { status: status.into(), category: text_of(category), text: text_of(text) } };
    // Nothing is locked but the one who takes it: it may make or free instances.
    for taker in takers(environment) {
        let mut take = taker.lock().unwrap_or_else(PoisonError::into_inner);
        take(message.clone());
    }
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
    use std::sync::{Mutex, PoisonError, mpsc};

    use super::{Message, Receiver, Status, importer_logger};

    /// Messages without an owner go to all: these tests would hear one another.
    static ALONE: Mutex<()> = Mutex::new(());

    fn logged(log: impl Fn(*mut c_void)) -> Vec<Message> {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let (sender, messages) = mpsc::channel();
        let receiver = Receiver::new(move |message| sender.send(message).expect("the test listens"));
        log(receiver.environment());
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
            }
        });
        assert_eq!(messages.len(), 2);
        assert_eq!(messages[0].text.len(), 4095);
        assert_eq!(
            messages[1],
            Message { status: Status::Unknown(9), category: String::new(), text: String::new() }
        );
    }

    /// An FMU's own pointer, null, and one of an instance that is gone.
    #[test]
    fn an_environment_that_is_not_known_is_not_followed() {
        let gone = {
            let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
            Receiver::new(|_| {}).environment().addr()
        };
        let own = [usize::MAX; 32];
        let messages = logged(|_| {
            for environment in
                [from_ref(&own).cast_mut().cast(), null_mut(), std::ptr::without_provenance_mut(gone + 1)]
            {
                // SAFETY: the format fits its arguments; the environment may be anything.
                unsafe { importer_logger(environment, null(), 1, null(), c"lost".as_ptr()) };
            }
        });
        assert_eq!(messages.len(), 3, "{messages:?}");
        assert!(messages.iter().all(|message| message.text == "lost"), "{messages:?}");
    }

    #[test]
    fn messages_of_two_instances_are_told_apart() {
        let first = logged(|environment| {
            let (sender, messages) = mpsc::channel();
            let other =
                Receiver::new(move |message: Message| sender.send(message).expect("the test listens"));
            for (environment, text) in [(environment, c"one"), (other.environment(), c"two")] {
                // SAFETY: the formats have no arguments.
                unsafe { importer_logger(environment, null(), 0, null(), text.as_ptr()) };
            }
            drop(other);
            assert_eq!(messages.iter().map(|message| message.text).collect::<Vec<_>>(), ["two"]);
        });
        assert_eq!(first.into_iter().map(|message| message.text).collect::<Vec<_>>(), ["one"]);
    }
}
