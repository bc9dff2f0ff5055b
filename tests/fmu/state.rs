//! Saved states: set, freed, serialized, and bytes that are not one.

use proptest::prelude::*;

use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::library;

/// An instance in the middle of an eventful flight, at 2.03 s, with a derivative waiting: warm starts, an estimate
/// and the place in the sequence of noise are part of its state.
fn midway() -> Instance<'static> {
    let start = [
        ("disturbance.force.x", 0.5),
        ("airframe.drag.x", 0.1),
        ("wind.velocity.x", 4.0),
        ("sensor.position_noise", 0.02),
        ("sensor.attitude_noise", 0.005),
    ];
    let mut instance = Instance::new(library());
    assert_eq!(instance.set_real(&start), OK);
    assert_eq!(instance.set_integer(&[("controller.kind", 2), ("sensor.seed", 5)]), OK);
    assert_eq!(instance.set_boolean(&[("sensor.output_feedback", true), ("reference.shaping", false)]), OK);
    instance.initialize();
    instance.fly(0.0, 0.203, 10);
    assert_eq!(instance.set_real(&[("reference.position.y", 1.0), ("limits.tilt", 0.45)]), OK);
    assert_eq!(instance.set_input_derivatives(&[("reference.position.y", 1, 0.5)]), OK);
    instance
}

/// All outputs on the way from 2.03 s on.
fn continued(instance: &mut Instance) -> Vec<Vec<u64>> {
    let mut outputs = vec![instance.outputs()];
    for i in 0..30 {
        instance.fly(2.03 + f64::from(i) * 0.11, 0.11, 1);
        outputs.push(instance.outputs());
    }
    outputs
}

fn bytes_midway() -> Vec<u8> {
    let mut instance = midway();
    let state = instance.get_state();
    let bytes = instance.serialize(state);
    instance.free_state(state);
    bytes
}

#[test]
fn restored_flight_is_the_same() {
    let mut instance = midway();
    let state = instance.get_state();
    let first = continued(&mut instance);
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(continued(&mut instance), first);
    assert_eq!(instance.set_state(state), OK, "a state can be set more than once");
    assert_eq!(continued(&mut instance), first);
    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.set_state(state), OK, "also after a reset");
    assert_eq!(continued(&mut instance), first);
    instance.free_state(state);
}

#[test]
fn another_instance_continues_the_flight() {
    let mut one = midway();
    let state = one.get_state();
    let first = continued(&mut one);
    let mut fresh = Instance::new(library());
    assert_eq!(fresh.set_state(state), OK);
    assert_eq!(continued(&mut fresh), first);
    let mut other = Instance::initialized(library(), &[("airframe.mass", 0.9)], &[]);
    other.fly(0.0, 1.0, 3);
    assert_eq!(other.set_state(state), OK);
    drop(one);
    assert_eq!(continued(&mut other), first);
    other.free_state(state);
}

#[test]
fn serialized_state_continues_in_another_instance() {
    let bytes = bytes_midway();
    let mut instance = Instance::new(library());
    let state = instance.deserialize(&bytes).expect("good bytes");
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(continued(&mut instance), continued(&mut midway()));
    let again = instance.deserialize(&bytes).expect("good bytes");
    assert_eq!(instance.serialize(again), bytes, "the same state has the same bytes");
    instance.free_state(again);
    instance.free_state(state);
}

#[test]
fn states_from_before_the_flight() {
    let mut instance = Instance::new(library());
    assert_eq!(instance.set_real(&[("initial.position.x", 2.0)]), OK);
    let state = instance.get_state();
    let bytes = instance.serialize(state);
    instance.initialize();
    instance.fly(0.0, 0.1, 3);
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(instance.do_step(0.0, 0.1), ERROR, "it is back before initialization");
    instance.initialize();
    assert_eq!(instance.real("position.x"), 2.0);
    instance.free_state(state);

    let mut other = Instance::new(library());
    let state = other.deserialize(&bytes).expect("good bytes");
    assert_eq!(other.set_state(state), OK);
    other.initialize();
    assert_eq!(other.real("position.x"), 2.0);
    other.free_state(state);
}

/// FMI: a state that is passed to `fmi2GetFMUstate` is overwritten instead of leaked.
#[test]
fn state_is_reused() {
    let mut instance = midway();
    let first = instance.get_state();
    instance.fly(2.03, 0.1, 1);
    let mut second = first;
    // SAFETY: the instance is alive, the state was not freed.
    assert_eq!(unsafe { (library().get_state)(instance.component, &mut second) }, OK);
    assert_eq!(first, second);
    let expected = instance.outputs();
    instance.fly(2.13, 0.1, 5);
    assert_eq!(instance.set_state(second), OK);
    assert_eq!(instance.outputs(), expected);
    instance.free_state(second);
}

#[test]
fn freed_state_is_null_and_may_be_freed_again() {
    let mut instance = midway();
    let mut state = instance.get_state();
    for _ in 0..3 {
        // SAFETY: the instance is alive; after the first time the state is NULL.
        assert_eq!(unsafe { (library().free_state)(instance.component, &mut state) }, OK);
        assert!(state.is_null());
    }
}

#[test]
fn size_must_fit() {
    let mut instance = midway();
    let state = instance.get_state();
    let size = instance.serialize(state).len();
    let mut bytes = vec![7; size + 1];
    for wrong in [0, 1, size - 1, size + 1] {
        // SAFETY: the instance and the state are alive; there are as many bytes.
        let status =
            unsafe { (library().serialize_state)(instance.component, state, bytes.as_mut_ptr(), wrong) };
        assert_eq!(status, ERROR, "{wrong} of {size}");
        assert!(bytes.iter().all(|byte| *byte == 7), "nothing was written");
    }
    instance.free_state(state);
}

#[test]
fn each_truncation_and_extension_is_refused() {
    let mut bytes = bytes_midway();
    let mut instance = Instance::with_logging(library(), false);
    for length in 0..bytes.len() {
        assert_eq!(instance.deserialize(&bytes[..length]), Err(ERROR), "{length} bytes");
    }
    bytes.push(0);
    assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    assert!(instance.log.last().text.contains("bytes"));
}

#[test]
fn each_flipped_bit_is_refused() {
    let mut bytes = bytes_midway();
    let mut instance = Instance::with_logging(library(), false);
    for bit in 0..bytes.len() * 8 {
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(instance.deserialize(&bytes), Err(ERROR), "bit {bit}");
        bytes[bit / 8] ^= 1 << (bit % 8);
    }
    let state = instance.deserialize(&bytes).expect("good bytes again");
    instance.free_state(state);
}

#[test]
fn refusals_say_what_is_wrong() {
    let good = bytes_midway();
    let mut instance = Instance::new(library());
    let mut reason = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = good.clone();
        change(&mut bytes);
        assert_eq!(instance.deserialize(&bytes), Err(ERROR));
        instance.log.last().text
    };
    assert!(reason(&|bytes| bytes.clear()).contains("not a saved state"));
    assert!(reason(&|bytes| bytes[0] = b'X').contains("not a saved state"));
    assert!(reason(&|bytes| bytes[8] = 99).contains("format 99"));
    assert!(reason(&|bytes| bytes[12] ^= 1).contains("another model"));
    assert!(reason(&|bytes| bytes.truncate(100)).contains("100 bytes"));
    assert!(reason(&|bytes| bytes[200] ^= 1).contains("checksum"));
}

proptest! {
    #[test]
    fn random_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..4000)) {
        let mut instance = Instance::with_logging(library(), false);
        prop_assert_eq!(instance.deserialize(&bytes), Err(ERROR));
        instance.initialize();
    }

    /// A good header before nonsense.
    #[test]
    fn random_content_is_refused(content in prop::collection::vec(any::<u8>(), 0..4000), keep in 8_usize..41) {
        let mut bytes = bytes_midway();
        bytes.truncate(keep);
        bytes.extend(content);
        let mut instance = Instance::with_logging(library(), false);
        prop_assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    }

    #[test]
    fn several_damaged_bytes_are_refused(damage in prop::collection::vec((any::<prop::sample::Index>(), 1..=255_u8), 1..20)) {
        let good = bytes_midway();
        let mut bytes = good.clone();
        for (place, flips) in damage {
            let place = place.index(bytes.len());
            bytes[place] ^= flips;
        }
        prop_assume!(bytes != good);
        let mut instance = Instance::with_logging(library(), false);
        prop_assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    }
}
