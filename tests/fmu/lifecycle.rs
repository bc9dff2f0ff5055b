//! The ordinary ways through the states, and the refusals of `fmi2Instantiate`.

use std::ffi::{CStr, CString, c_char, c_int};
use std::ptr;

use crate::common::description::description;
use crate::common::instance::{Instance, Log, callbacks};
use crate::common::library::{DISCARD, ERROR, OK};
use crate::library;

/// Calls `fmi2Instantiate` and says what was logged if there is no instance.
fn refusal(name: *const c_char, fmu_type: c_int, guid: *const c_char) -> String {
    let log = Log::default();
    let callbacks = callbacks(&log);
    // SAFETY: pointers are NULL or valid; `log` outlives the call, and there is no instance after it.
    let component = unsafe { (library().instantiate)(name, fmu_type, guid, c"".as_ptr(), &callbacks, 0, 0) };
    assert!(component.is_null());
    let message = log.last();
    assert_eq!((message.status, message.category.as_str()), (ERROR, "logStatusError"));
    message.text
}

#[test]
fn instantiation_says_why_it_is_refused() {
    let guid = CString::new(description().guid.as_str()).expect("no NUL");
    let (name, guid) = (c"q".as_ptr(), guid.as_ptr());
    let other = c"{00000000-0000-0000-0000-000000000000}";
    assert!(refusal(ptr::null(), 1, guid).contains("instanceName"));
    assert!(refusal(c"".as_ptr(), 1, guid).contains("instanceName"));
    assert!(refusal(name, 0, guid).contains("fmuType = 0"));
    assert!(refusal(name, 7, guid).contains("fmuType = 7"));
    assert!(refusal(name, 1, ptr::null()).contains("fmuGUID"));
    let text = refusal(name, 1, other.as_ptr());
    assert!(text.contains("00000000-") && text.contains(&description().guid), "{text}");
}

#[test]
fn without_a_logger_there_is_no_instance_and_no_crash() {
    let guid = CString::new(description().guid.as_str()).expect("no NUL");
    let (name, guid) = (c"q".as_ptr(), guid.as_ptr());
    let log = Log::default();
    let mut silent = callbacks(&log);
    silent.logger = ptr::null();
    // SAFETY: pointers are NULL or valid.
    unsafe {
        assert!((library().instantiate)(name, 1, guid, ptr::null(), &silent, 0, 1).is_null());
        assert!((library().instantiate)(name, 1, guid, ptr::null(), ptr::null(), 0, 1).is_null());
        (library().free_instance)(ptr::null_mut());
    }
}

#[test]
fn any_resource_location_is_good() {
    let guid = CString::new(description().guid.as_str()).expect("no NUL");
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
                (library().instantiate)(c"q".as_ptr(), 1, guid.as_ptr(), location, &callbacks, 1, 0);
            assert!(!component.is_null());
            (library().free_instance)(component);
        }
    }
    assert_eq!(log.take(), []);
}

#[test]
fn from_instantiation_to_termination() {
    let mut instance = Instance::new(library());
    assert_eq!(instance.setup(0.0, Some(1.0)), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    instance.fly(0.0, 0.05, 20);
    assert_eq!(instance.terminate(), OK);
    let height = -instance.real("position.z");
    assert!(height > 0.1, "values can be read after the end: {height}");
    assert_eq!(instance.time(), 1.0);
}

#[test]
fn setup_is_not_needed_and_may_be_repeated() {
    let mut instance = Instance::new(library());
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.1), OK);

    let mut instance = Instance::new(library());
    assert_eq!(instance.setup(1.0, None), OK);
    assert_eq!(instance.setup(2.0, Some(3.0)), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(2.0, 0.1), OK);
}

#[test]
fn impossible_times_are_refused() {
    let mut instance = Instance::new(library());
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

/// FMPy resets directly after instantiation; others between runs.
#[test]
fn reset_from_everywhere_gives_a_fresh_instance() {
    let flown = |instance: &mut Instance| {
        instance.initialize();
        instance.fly(0.0, 0.1, 10);
        instance.outputs()
    };
    let fresh = flown(&mut Instance::new(library()));

    let mut instance = Instance::new(library());
    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);
    assert_eq!(instance.terminate(), OK);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);

    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.set_real(&[("reference.position.x", -3.0), ("airframe.mass", 0.8)]), OK);
    assert_eq!(instance.setup(7.0, Some(8.0)), OK);
    assert_eq!(instance.enter_initialization_mode(), OK);
    assert_eq!(instance.reset(), OK);
    assert_eq!(flown(&mut instance), fresh);
}

#[test]
fn status_functions_answer_what_they_can() {
    let mut instance = Instance::initialized(library(), &[], &[]);
    instance.fly(0.0, 0.25, 2);
    let (c, l) = (instance.component, library());
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
