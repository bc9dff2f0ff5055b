//! The ordinary ways through the states, and the refusals of `fmi2Instantiate`.

use std::ffi::{CStr, CString, c_char, c_int};
use std::ptr;

use crate::common::instance::{Instance, Log, callbacks};
use crate::common::library::{DISCARD, ERROR, OK};
use crate::common::subject::Subject;

/// Calls `fmi2Instantiate` and says what was logged if there is no instance.
fn refusal(subject: &Subject, name: *const c_char, fmu_type: c_int, guid: *const c_char) -> String {
    let log = Log::default();
    let callbacks = callbacks(&log);
    // SAFETY: pointers are NULL or valid; `log` outlives the call, and there is no instance after it.
    let component =
        unsafe { (subject.library.instantiate)(name, fmu_type, guid, c"".as_ptr(), &callbacks, 0, 0) };
    assert!(component.is_null());
    let message = log.last();
    assert_eq!((message.status, message.category.as_str()), (ERROR, "logStatusError"));
    message.text
}

fn instantiation_says_why_it_is_refused(subject: &'static Subject) {
    let guid = CString::new(subject.description.guid.as_str()).expect("no NUL");
    let (name, guid) = (c"q".as_ptr(), guid.as_ptr());
    let other = c"{00000000-0000-0000-0000-000000000000}";
    assert!(refusal(subject, ptr::null(), 1, guid).contains("instanceName"));
    assert!(refusal(subject, c"".as_ptr(), 1, guid).contains("instanceName"));
    if subject.description.derivatives.is_empty() {
        assert!(refusal(subject, name, 0, guid).contains("fmuType = 0"));
    }
    assert!(refusal(subject, name, 7, guid).contains("fmuType = 7"));
    assert!(refusal(subject, name, 1, ptr::null()).contains("fmuGUID"));
    let text = refusal(subject, name, 1, other.as_ptr());
    assert!(text.contains("00000000-") && text.contains(&subject.description.guid), "{text}");
}

fn without_a_logger_there_is_no_instance_and_no_crash(subject: &'static Subject) {
    let guid = CString::new(subject.description.guid.as_str()).expect("no NUL");
    let (name, guid) = (c"q".as_ptr(), guid.as_ptr());
    let log = Log::default();
    let mut silent = callbacks(&log);
    silent.logger = ptr::null();
    // SAFETY: pointers are NULL or valid.
    unsafe {
        assert!((subject.library.instantiate)(name, 1, guid, ptr::null(), &silent, 0, 1).is_null());
        assert!((subject.library.instantiate)(name, 1, guid, ptr::null(), ptr::null(), 0, 1).is_null());
        (subject.library.free_instance)(ptr::null_mut());
    }
}

fn any_resource_location_is_good(subject: &'static Subject) {
    let guid = CString::new(subject.description.guid.as_str()).expect("no NUL");
    let log = Log::default();
    let callbacks = callbacks(&log);
    let locations: [&CStr; 6] = [
        c"",
        c"file:///tmp/a%20b/resources",
        c"file:/tmp/resources",
        c"file://localhost/tmp/\xc3\xbcber",
        c"nonsense \xff",
        c"https://example.org/",
    ];
    for location in locations.map(CStr::as_ptr).into_iter().chain([ptr::null()]) {
        // SAFETY: pointers are NULL or valid, and the instance is freed at once.
        unsafe {
            let component =
                (subject.library.instantiate)(c"q".as_ptr(), 1, guid.as_ptr(), location, &callbacks, 1, 0);
            assert!(!component.is_null());
            (subject.library.free_instance)(component);
        }
    }
    assert_eq!(log.take(), []);
}

fn from_instantiation_to_termination(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    assert_eq!(instance.setup(0.0, Some(1.0)), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    instance.fly(0.0, 0.05, 20);
    assert_eq!(instance.terminate(), OK);
    let moved = instance.real(subject.sample.output).abs();
    assert!(moved > 0.1, "values can be read after the end: {moved}");
    assert_eq!(instance.time(), 1.0);
}

fn setup_is_not_needed_and_may_be_repeated(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.1), OK);

    let mut instance = Instance::new(subject);
    assert_eq!(instance.setup(1.0, None), OK);
    assert_eq!(instance.setup(2.0, Some(3.0)), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(2.0, 0.1), OK);
}

fn impossible_times_are_refused(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    for (start, stop) in [
        (f64::NAN, None),
        (f64::INFINITY, None),
        (1.0, Some(0.0)),
        (0.0, Some(f64::NAN)),
        (0.0, Some(f64::NEG_INFINITY)),
    ] {
        assert_eq!(instance.setup(start, stop), ERROR, "{start} {stop:?}");
    }
    assert_eq!(instance.setup(0.0, Some(f64::INFINITY)), OK);
}

/// Outputs at the end of a short flight.
fn flown(instance: &mut Instance) -> Vec<u64> {
    instance.initialize();
    instance.fly(0.0, 0.1, 10);
    instance.outputs()
}

/// FMPy resets directly after instantiation; others between runs.
fn reset_from_everywhere_gives_a_fresh_instance(subject: &'static Subject) {
    let fresh = flown(&mut Instance::new(subject));

    let mut instance = Instance::new(subject);
    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);
    assert_eq!(instance.terminate(), OK);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);

    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.set_real(&[(subject.sample.input, -3.0), subject.sample.fixed]), OK);
    assert_eq!(instance.setup(7.0, Some(8.0)), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);
}

/// What ends one run does not end the next.
fn after_a_failed_step_values_can_be_read_and_reset_starts_again(subject: &'static Subject) {
    let fresh = flown(&mut Instance::new(subject));
    let mut instance = Instance::new(subject);
    for _ in 0..2 {
        instance.initialize_to_break(subject);
        let mut time = 0.0;
        while instance.do_step(time, 0.1) == OK {
            time += 0.1;
            assert!(time < 10.0, "it does not break");
        }
        let text = instance.log.last().text;
        assert!(text.contains(&format!("the {} cannot continue", subject.sample.run)), "{text}");
        let (mut status, mut ended) = (OK, 9);
        // SAFETY: the instance is alive and all pointers are valid.
        unsafe {
            assert_eq!((subject.library.get_status)(instance.component, 0, &mut status), OK);
            assert_eq!((subject.library.get_boolean_status)(instance.component, 3, &mut ended), OK);
        }
        assert_eq!((status, ended, instance.time()), (ERROR, 0, time));
        let finite = |bits: u64| f64::from_bits(bits).is_finite();
        assert!(instance.outputs().into_iter().all(finite));
        // What FMI does not allow in this state is refused and harms nothing.
        assert_eq!(instance.do_step(time, 0.1), ERROR);
        assert_eq!(instance.terminate(), ERROR);
        instance.log.take();
        assert_eq!(instance.reset(), OK);
        assert_eq!(flown(&mut instance), fresh);
        assert_eq!(instance.terminate(), OK);
        assert_eq!(instance.reset(), OK);
    }
    instance.initialize_to_break(subject);
    assert_eq!(instance.do_step(0.0, 10.0), ERROR);
    // And now it is freed.
}

fn status_functions_answer_what_they_can(subject: &'static Subject) {
    let mut instance = Instance::initialized(subject, &[], &[]);
    instance.fly(0.0, 0.25, 2);
    let (c, l) = (instance.component, &subject.library);
    let (mut status, mut real, mut integer, mut boolean, mut string) = (9, 9.0, 9, 9, ptr::null());
    // SAFETY: the instance is alive and all pointers are valid.
    unsafe {
        assert_eq!((l.get_status)(c, 0, &mut status), OK);
        assert_eq!(status, OK);
        assert_eq!((l.get_real_status)(c, 2, &mut real), OK);
        assert_eq!(real, 0.5);
        assert_eq!((l.get_boolean_status)(c, 3, &mut boolean), OK);
        assert_eq!(boolean, 0);
        for kind in [-1, 1, 2, 3, 4, 99] {
            assert_eq!((l.get_status)(c, kind, &mut status), DISCARD);
            assert_eq!((l.get_integer_status)(c, kind, &mut integer), DISCARD);
            assert_eq!((l.get_string_status)(c, kind, &mut string), DISCARD);
        }
        assert_eq!((l.get_real_status)(c, 0, &mut real), DISCARD);
        assert_eq!((l.get_boolean_status)(c, 0, &mut boolean), DISCARD);
    }
    assert_eq!((real, integer, boolean, string), (0.5, 9, 0, ptr::null()));

    assert_eq!(instance.do_step(0.5, -1.0), ERROR);
    // SAFETY: as above.
    unsafe {
        assert_eq!((l.get_status)(c, 0, &mut status), OK);
        assert_eq!(status, ERROR);
        assert_eq!((l.get_real_status)(c, 2, &mut real), OK);
    }
    assert_eq!(real, 0.5);
}

for_each_model! {
    instantiation_says_why_it_is_refused,
    without_a_logger_there_is_no_instance_and_no_crash,
    any_resource_location_is_good,
    from_instantiation_to_termination,
    setup_is_not_needed_and_may_be_repeated,
    impossible_times_are_refused,
    reset_from_everywhere_gives_a_fresh_instance,
    after_a_failed_step_values_can_be_read_and_reset_starts_again,
    status_functions_answer_what_they_can,
}
