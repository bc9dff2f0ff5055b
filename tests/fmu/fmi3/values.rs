//! Types of variables, and time.

use std::ptr;

use super::{all, lag, oscillator};
use crate::common::fmi3::instance::Instance;
use crate::common::fmi3::library::{ERROR, OK};

/// Counts are `Int32`, enumerations are read as `Int64`.
#[test]
fn each_type_has_its_functions() {
    let mut instance = Instance::new(lag());
    assert_eq!(instance.set_int32("divisor", 4), OK);
    assert_eq!(instance.set_int64("sign", 2), OK);
    assert_eq!(instance.set_boolean("hold", true), OK);
    assert_eq!((instance.int32("divisor"), instance.int64("sign")), (Ok(4), Ok(2)));
    assert_eq!(instance.boolean("hold"), Ok(true));
    instance.initialize();
    instance.fly(0.0, 0.1, 1);
    assert_eq!((instance.int32("samples"), instance.int64("direction")), (Ok(100), Ok(2)));
    assert_eq!(instance.boolean("settled"), Ok(false));

    let wrong = [
        (
            instance.int32("sign"),
            "sign (value reference 10) has type Enumeration (read and set as Int64), not Int32",
        ),
        (instance.int32("hold"), "has type Boolean, not Int32"),
    ];
    let messages = instance.log.take();
    for ((answer, text), message) in wrong.into_iter().zip(messages) {
        assert_eq!(answer, Err(ERROR));
        assert!(message.text.contains(text), "{}", message.text);
    }
    assert_eq!(instance.int64("divisor"), Err(ERROR));
    instance.is_refused(ERROR, "divisor (value reference 11) has type Int32");
    assert_eq!(instance.boolean("u"), Err(ERROR));
    instance.is_refused(ERROR, "u (value reference 0) has type Float64, not Boolean");
    let reference = instance.subject.description.reference("hold");
    assert_eq!(instance.try_values(&[reference], 1), Err(ERROR));
    instance.is_refused(ERROR, "has type Boolean, not Float64");
}

#[test]
fn enumerations_and_counts_are_within_their_ranges() {
    let mut instance = Instance::new(lag());
    for number in [0, 3, -1, i64::MAX, i64::MIN, 4_294_967_297] {
        let status = instance.set_int64("sign", number);
        instance.is_refused(status, "allowed 1 (up), 2 (down)");
    }
    let status = instance.set_int32("divisor", 0);
    instance.is_refused(status, "divisor = 0; allowed 1 to 100");
    assert_eq!((instance.int64("sign"), instance.int32("divisor")), (Ok(1), Ok(1)));
}

#[test]
fn time_is_a_variable() {
    for subject in all() {
        let mut instance = Instance::new(subject);
        assert_eq!(instance.enter_initialization_mode(2.0, None), OK);
        assert_eq!(instance.value("time"), 2.0);
        assert_eq!(instance.exit_initialization_mode(), OK);
        instance.fly(2.0, 0.125, 4);
        assert_eq!(instance.value("time"), 2.5);
        let status = instance.set(&["time"], &[3.0]);
        instance.is_refused(status, "time cannot be set: it is the independent variable");
    }
}

/// They can be read in co-simulation, too.
#[test]
fn event_indicators_are_variables() {
    let mut instance = Instance::initialized(oscillator(), &[("initial", &[0.5, -0.5])]);
    assert_eq!(instance.values(&["event_indicator"]), [0.5, -0.5]);
    instance.fly(0.0, 0.1, 2);
    let state = instance.values(&["x"]);
    assert_eq!(instance.values(&["event_indicator"]), state);
    let status = instance.set(&["event_indicator"], &[1.0, 1.0]);
    instance.is_refused(status, "event_indicator cannot be set");
}

/// Start values can be read before initialization; so can what follows from them.
#[test]
fn values_before_initialization() {
    let mut instance = Instance::new(oscillator());
    assert_eq!(instance.values(&["u", "initial", "x"]), [0.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
}

/// There are no variables of these types: an empty list is good, any other is refused.
#[test]
fn absent_types_are_refused() {
    let mut instance = Instance::initialized(lag(), &[]);
    let (c, l) = (instance.pointer, &instance.subject.library);
    macro_rules! absent {
        ($($get:ident $set:ident $type:literal;)*) => {$(
            // SAFETY: the instance is alive; empty arrays may be NULL, and other pointers are valid.
            unsafe {
                assert_eq!((l.$get)(c, ptr::null(), 0, ptr::null_mut(), 0), OK);
                assert_eq!((l.$set)(c, ptr::null(), 0, ptr::null(), 0), OK);
                assert_eq!((l.$get)(c, &0, 1, ptr::null_mut(), 0), ERROR);
            }
            instance.is_refused(ERROR, concat!("u (value reference 0) has type Float64, not ", $type));
            // SAFETY: as above.
            let status = unsafe { (l.$set)(c, &99, 1, ptr::null(), 0) };
            instance.is_refused(status, "unknown value reference 99");
        )*};
    }
    absent! {
        get_float32 set_float32 "Float32";
        get_int8 set_int8 "Int8";
        get_uint8 set_uint8 "UInt8";
        get_int16 set_int16 "Int16";
        get_uint16 set_uint16 "UInt16";
        get_uint32 set_uint32 "UInt32";
        get_uint64 set_uint64 "UInt64";
        get_string set_string "String";
    }
    // SAFETY: as above.
    unsafe {
        assert_eq!((l.get_binary)(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut(), 0), OK);
        assert_eq!((l.get_binary)(c, &0, 1, ptr::null_mut(), ptr::null_mut(), 0), ERROR);
    }
    instance.is_refused(ERROR, "has type Float64, not Binary");
    // SAFETY: as above.
    unsafe {
        assert_eq!((l.set_binary)(c, ptr::null(), 0, ptr::null(), ptr::null(), 0), OK);
        assert_eq!((l.set_clock)(c, ptr::null(), 0, ptr::null()), OK);
        assert_eq!((l.get_clock)(c, &0, 1, ptr::null_mut()), ERROR);
    }
    instance.is_refused(ERROR, "has type Float64, not Clock");
}

#[test]
fn null_pointers_are_refused_by_name() {
    let mut instance = Instance::initialized(lag(), &[]);
    let (c, l) = (instance.pointer, &instance.subject.library);
    let (u, mut value, mut flag) = (0, 0.0, false);
    // SAFETY: the instance is alive, and pointers are NULL or valid.
    let status = unsafe { (l.get_float64)(c, ptr::null(), 1, &mut value, 1) };
    instance.is_refused(status, "valueReferences is NULL");
    // SAFETY: as above.
    let status = unsafe { (l.get_float64)(c, &u, 1, ptr::null_mut(), 1) };
    instance.is_refused(status, "values is NULL");
    // SAFETY: as above.
    let status = unsafe { (l.set_float64)(c, &u, 1, ptr::null(), 1) };
    instance.is_refused(status, "values is NULL");
    // SAFETY: as above.
    let status = unsafe { (l.get_float64)(c, &u, 1, &mut value, usize::MAX) };
    instance.is_refused(status, "do not fit into memory");
    // SAFETY: as above.
    let status = unsafe { (l.do_step)(c, 0.0, 0.1, true, &mut flag, &mut flag, &mut flag, ptr::null_mut()) };
    instance.is_refused(status, "lastSuccessfulTime is NULL");
    // SAFETY: as above.
    let status = unsafe { (l.get_state)(c, ptr::null_mut()) };
    instance.is_refused(status, "FMUState is NULL");
    // SAFETY: as above.
    let status = unsafe { (l.set_state)(c, ptr::null_mut()) };
    instance.is_refused(status, "FMUState is NULL");
    // SAFETY: as above.
    let status = unsafe { (l.set_debug_logging)(c, true, 1, &ptr::null()) };
    instance.is_refused(status, "categories is NULL");
    // Nothing has moved.
    assert_eq!((instance.value("time"), instance.do_step(0.0, 0.1).0), (0.0, OK));
    // SAFETY: no instance is NULL.
    unsafe {
        assert_eq!((l.reset)(ptr::null_mut()), ERROR);
        assert_eq!((l.get_float64)(ptr::null_mut(), &u, 1, &mut value, 1), ERROR);
        (l.free_instance)(ptr::null_mut());
    }
}
