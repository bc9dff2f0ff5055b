//! Saved states continue in another instance, whichever version of the interface it has.

use std::ptr;

use super::{closed_loop, lag, oscillator};
use crate::common::fmi3::instance::Instance;
use crate::common::fmi3::library::{ERROR, OK};
use crate::common::instance::Instance as Second;
use crate::common::library as second;

/// On the way, with noise: its place in the sequence is part of the state.
fn midway() -> Instance {
    let mut instance = Instance::new(closed_loop());
    assert_eq!(instance.set(&["sensor.position_noise", "wind.velocity"], &[0.02, 4.0, 0.0, 0.0]), OK);
    assert_eq!(instance.set_boolean("sensor.output_feedback", true), OK);
    instance.initialize();
    instance.fly(0.0, 0.1, 13);
    instance
}

#[test]
fn a_restored_run_is_the_same() {
    let mut instance = midway();
    let (state, time) = (instance.get_state(), instance.value("time"));
    instance.fly(1.3, 0.1, 7);
    let expected = instance.outputs();
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(instance.value("time"), time);
    instance.fly(1.3, 0.1, 7);
    assert_eq!(instance.outputs(), expected);
    instance.free_state(state);
}

#[test]
fn bytes_continue_in_both_versions() {
    let mut instance = midway();
    let state = instance.get_state();
    let bytes = instance.serialize(state);
    instance.fly(1.3, 0.1, 7);
    let expected = instance.values(&["position", "velocity", "quaternion"]);

    let mut other = Instance::new(closed_loop());
    let copy = other.deserialize(&bytes).expect("our own bytes");
    assert_eq!(other.set_state(copy), OK);
    other.fly(1.3, 0.1, 7);
    assert_eq!(other.values(&["position", "velocity", "quaternion"]), expected);
    other.free_state(copy);

    let mut older = Second::new(crate::closed_loop());
    let copy = older.deserialize(&bytes).expect("the same bytes");
    assert_eq!(older.set_state(copy), second::OK);
    older.fly(1.3, 0.1, 7);
    let flown = older.reals(["position.x", "position.y", "position.z", "velocity.x"]);
    assert_eq!(flown[..], expected[..4]);
    older.free_state(copy);
    instance.free_state(state);
}

#[test]
fn other_bytes_are_refused() {
    let mut instance = midway();
    let state = instance.get_state();
    let mut bytes = instance.serialize(state);
    let mut short = vec![7; bytes.len() - 1];
    // SAFETY: the instance and the state are alive; there are as many bytes.
    let status = unsafe {
        (instance.subject.library.serialize_state)(instance.pointer, state, short.as_mut_ptr(), short.len())
    };
    instance.is_refused(status, "bytes; expected");
    assert!(short.iter().all(|byte| *byte == 7), "nothing was written");
    instance.free_state(state);

    let mut other = Instance::new(lag());
    assert_eq!(other.deserialize(&bytes), Err(ERROR));
    other.is_refused(ERROR, "not a saved state");
    *bytes.last_mut().expect("not empty") ^= 1;
    assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    instance.is_refused(ERROR, "checksum");
    // Freeing nothing does nothing.
    let mut nothing = ptr::null_mut();
    // SAFETY: the instance is alive.
    assert_eq!(unsafe { (instance.subject.library.free_state)(instance.pointer, &mut nothing) }, OK);
}

/// The library has both models: their states are kept apart.
#[test]
fn a_state_of_another_model_is_refused() {
    let mut one = Instance::initialized(lag(), &[]);
    let mut other = Instance::initialized(oscillator(), &[]);
    let state = one.get_state();
    let status = other.set_state(state);
    other.is_refused(status, "belongs to another model");
    one.free_state(state);
}
