//! The ordinary ways through the states, instantiation, and the log.

use std::ffi::{CString, c_char};
use std::ptr;

use super::{all, closed_loop, lag, oscillator};
use crate::common::fmi3::instance::{Instance, Step};
use crate::common::fmi3::library::{ERROR, Instance as Pointer, LogMessage, OK};
use crate::common::fmi3::log::{Log, record};
use crate::common::fmi3::subject::Subject;

/// What a call of `fmi3InstantiateCoSimulation` may differ in.
struct Request {
    name: *const c_char,
    token: *const c_char,
    event_mode: bool,
    intermediate: &'static [u32],
    log_message: LogMessage,
}

fn instantiated(subject: &Subject, request: &Request, log: &Log) -> Pointer {
    // SAFETY: pointers are NULL or valid; `log` outlives the call.
    unsafe {
        (subject.library.instantiate_co_simulation)(
            request.name,
            request.token,
            c"/no/such/path".as_ptr(),
            true,
            false,
            request.event_mode,
            false,
            request.intermediate.as_ptr(),
            request.intermediate.len(),
            log.environment(),
            request.log_message,
            ptr::null(),
        )
    }
}

/// Also with logging off, a refusal tells its reason.
#[test]
fn instantiation_says_why_it_is_refused() {
    let subject = lag();
    let token = CString::new(subject.description.token.as_str()).expect("no NUL");
    let good = || Request {
        name: c"lag".as_ptr(),
        token: token.as_ptr(),
        event_mode: false,
        intermediate: &[],
        log_message: Some(record),
    };
    let other = c"{00000000-0000-0000-0000-000000000000}".as_ptr();
    let refused = [
        (
            Request { name: ptr::null(), ..good() },
            "fmi3InstantiateCoSimulation: instanceName is NULL or empty",
        ),
        (Request { name: c"".as_ptr(), ..good() }, "instanceName is NULL or empty"),
        (Request { token: ptr::null(), ..good() }, "instantiationToken is NULL"),
        (Request { token: other, ..good() }, "does not match the library"),
        (Request { event_mode: true, ..good() }, "eventModeUsed must be fmi3False"),
        (Request { intermediate: &[2], ..good() }, "nRequiredIntermediateVariables = 1; must be 0"),
    ];
    for (request, text) in refused {
        let log = Log::default();
        assert!(instantiated(subject, &request, &log).is_null());
        let message = log.last();
        assert_eq!((message.status, message.category.as_str()), (ERROR, "logStatusError"));
        assert!(message.text.contains(text), "{}", message.text);
        let silent = Request { log_message: None, ..request };
        assert!(instantiated(subject, &silent, &log).is_null());
    }
    let log = Log::default();
    let pointer = instantiated(subject, &Request { log_message: None, ..good() }, &log);
    assert!(!pointer.is_null());
    // SAFETY: the instance is alive, and freed once.
    unsafe {
        assert_eq!((subject.library.exit_initialization_mode)(pointer), ERROR);
        (subject.library.free_instance)(pointer);
    }
    assert_eq!(log.take(), []);
}

#[test]
fn kinds_that_a_model_does_not_have_are_refused() {
    for subject in all() {
        let token = CString::new(subject.description.token.as_str()).expect("no NUL");
        let (name, token) = (c"name".as_ptr(), token.as_ptr());
        let log = Log::default();
        let (l, e) = (&subject.library, log.environment());
        // SAFETY: pointers are NULL or valid; an instance is freed once.
        unsafe {
            let none = ptr::null();
            let scheduled = (l.instantiate_scheduled_execution)(
                name,
                token,
                none,
                false,
                true,
                e,
                Some(record),
                ptr::null(),
                ptr::null(),
                ptr::null(),
            );
            assert!(scheduled.is_null());
            assert!(log.last().text.contains("scheduled execution is not supported"));
            let exchanged = (l.instantiate_model_exchange)(name, token, none, false, true, e, Some(record));
            let exchanges = subject.second.event_indicators > 0;
            assert_eq!(!exchanged.is_null(), exchanges);
            if exchanges {
                (l.free_instance)(exchanged);
            } else {
                assert!(log.last().text.contains("LmpcQuadrotor does not support model exchange"));
            }
        }
    }
}

#[test]
fn a_step_tells_how_far_it_came() {
    let mut instance = Instance::initialized(lag(), &[]);
    let done = |time| Step {
        event_handling_needed: false,
        terminate_simulation: false,
        early_return: false,
        last_successful_time: time,
    };
    assert_eq!(instance.do_step(0.0, 0.25), (OK, done(0.25)));
    assert_eq!(instance.do_step(0.25, 0.25), (OK, done(0.5)));
    // Refused: nothing has moved.
    assert_eq!(instance.do_step(0.25, 0.25), (ERROR, done(0.5)));
    instance.is_refused(ERROR, "currentCommunicationPoint = 0.25; expected 0.5");
    assert_eq!(instance.do_step(0.5, 0.25), (OK, done(0.75)));
    assert_eq!(instance.terminate(), OK);
    assert!(instance.value("y") > 0.1);
}

#[test]
fn a_failed_run_can_be_read_and_reset() {
    let mut instance = Instance::initialized(lag(), &[("gain", &[50.0]), ("u", &[10.0])]);
    let (status, told) = instance.do_step(0.0, 5.0);
    assert_eq!(told.last_successful_time, 0.0);
    instance.is_refused(status, "fmi3DoStep: the simulation cannot continue");
    assert!(instance.value("y").is_finite());
    assert_eq!(instance.do_step(0.0, 0.1).0, ERROR);
    assert_eq!(instance.reset(), OK);
    instance.initialize();
    assert_eq!((instance.value("gain"), instance.do_step(0.0, 0.1).0), (2.0, OK));
}

#[test]
fn impossible_times_are_refused() {
    let mut instance = Instance::new(oscillator());
    for (start, stop) in [(f64::NAN, None), (f64::INFINITY, None), (1.0, Some(0.0)), (0.0, Some(f64::NAN))] {
        assert_eq!(instance.enter_initialization_mode(start, stop), ERROR, "{start} {stop:?}");
    }
    assert_eq!(instance.enter_initialization_mode(1.0, Some(2.0)), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    instance.fly(1.0, 0.5, 2);
    let (status, _) = instance.do_step(2.0, 0.5);
    instance.is_refused(status, "after stopTime = 2.0");
}

/// FMI 3.0: without logging there is no message at all.
#[test]
fn logging_is_off_when_it_is_off() {
    let mut instance = Instance::with_logging(closed_loop(), false);
    assert_eq!(instance.enter_initialization_mode(0.0, None), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(3.0, 0.1).0, ERROR);
    assert_eq!(instance.log.take(), []);
    let select = |instance: &Instance, on: bool, names: &[*const c_char]| {
        let function = instance.subject.library.set_debug_logging;
        // SAFETY: the instance is alive, and there are as many names.
        unsafe { function(instance.pointer, on, names.len(), names.as_ptr()) }
    };
    assert_eq!(select(&instance, true, &[c"logStatusError".as_ptr()]), OK);
    assert_eq!(instance.do_step(3.0, 0.1).0, ERROR);
    assert_eq!(instance.reset(), OK);
    let messages = instance.log.take();
    assert_eq!(messages.len(), 1, "only errors: {messages:?}");
    assert_eq!(select(&instance, true, &[]), OK);
    assert_eq!(instance.reset(), OK);
    let message = instance.log.last();
    assert_eq!(
        (message.status, message.category.as_str(), message.text.as_str()),
        (OK, "logEvents", "reset")
    );
    let status = select(&instance, true, &[c"logNonsense".as_ptr()]);
    instance.is_refused(status, "unknown log category \"logNonsense\"");
}
