//! Saved states: set, freed, serialized, and bytes that are not one.

use proptest::prelude::*;

use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::common::subject::Subject;

/// An instance in the middle of an eventful run, at 2.03 s, with a derivative waiting.
pub fn midway(subject: &'static Subject) -> Instance<'static> {
    let eventful = &subject.sample.eventful;
    let mut instance = Instance::new(subject);
    assert_eq!(instance.set_real(eventful.reals), OK);
    assert_eq!(instance.set_integer(eventful.integers), OK);
    assert_eq!(instance.set_boolean(eventful.booleans), OK);
    instance.initialize();
    instance.fly(0.0, 0.203, 10);
    assert_eq!(instance.set_real(eventful.on_the_way), OK);
    assert_eq!(instance.set_input_derivatives(&[eventful.derivative]), OK);
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

/// The bytes of its state.
pub fn bytes_midway(subject: &'static Subject) -> Vec<u8> {
    let mut instance = midway(subject);
    let state = instance.get_state();
    let bytes = instance.serialize(state);
    instance.free_state(state);
    bytes
}

fn restored_run_is_the_same(subject: &'static Subject) {
    let mut instance = midway(subject);
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

fn another_instance_continues_the_run(subject: &'static Subject) {
    let mut one = midway(subject);
    let state = one.get_state();
    let first = continued(&mut one);
    let mut fresh = Instance::new(subject);
    assert_eq!(fresh.set_state(state), OK);
    assert_eq!(continued(&mut fresh), first);
    let mut other = Instance::initialized(subject, &[subject.sample.fixed], &[]);
    other.fly(0.0, 1.0, 3);
    assert_eq!(other.set_state(state), OK);
    drop(one);
    assert_eq!(continued(&mut other), first);
    other.free_state(state);
}

fn serialized_state_continues_in_another_instance(subject: &'static Subject) {
    let bytes = bytes_midway(subject);
    let mut instance = Instance::new(subject);
    let state = instance.deserialize(&bytes).expect("good bytes");
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(continued(&mut instance), continued(&mut midway(subject)));
    let again = instance.deserialize(&bytes).expect("good bytes");
    assert_eq!(instance.serialize(again), bytes, "the same state has the same bytes");
    instance.free_state(again);
    instance.free_state(state);
}

fn states_from_before_the_run(subject: &'static Subject) {
    let (parameter, value, observed) = subject.sample.initial;
    let mut instance = Instance::new(subject);
    assert_eq!(instance.set_real(&[(parameter, value)]), OK);
    let state = instance.get_state();
    let bytes = instance.serialize(state);
    instance.initialize();
    instance.fly(0.0, 0.1, 3);
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(instance.do_step(0.0, 0.1), ERROR, "it is back before initialization");
    instance.initialize();
    assert_eq!(instance.real(observed), value);
    instance.free_state(state);

    let mut other = Instance::new(subject);
    let state = other.deserialize(&bytes).expect("good bytes");
    assert_eq!(other.set_state(state), OK);
    other.initialize();
    assert_eq!(other.real(observed), value);
    other.free_state(state);
}

/// FMI: a state that is passed to `fmi2GetFMUstate` is overwritten instead of leaked.
fn state_is_reused(subject: &'static Subject) {
    let mut instance = midway(subject);
    let first = instance.get_state();
    instance.fly(2.03, 0.1, 1);
    let mut second = first;
    // SAFETY: the instance is alive, the state was not freed.
    assert_eq!(unsafe { (subject.library.get_state)(instance.component, &mut second) }, OK);
    assert_eq!(first, second);
    let expected = instance.outputs();
    instance.fly(2.13, 0.1, 5);
    assert_eq!(instance.set_state(second), OK);
    assert_eq!(instance.outputs(), expected);
    instance.free_state(second);
}

fn freed_state_is_null_and_may_be_freed_again(subject: &'static Subject) {
    let mut instance = midway(subject);
    let mut state = instance.get_state();
    for _ in 0..3 {
        // SAFETY: the instance is alive; after the first time the state is NULL.
        assert_eq!(unsafe { (subject.library.free_state)(instance.component, &mut state) }, OK);
        assert!(state.is_null());
    }
}

fn size_must_fit(subject: &'static Subject) {
    let mut instance = midway(subject);
    let state = instance.get_state();
    let size = instance.serialize(state).len();
    let mut bytes = vec![7; size + 1];
    for wrong in [0, 1, size - 1, size + 1] {
        // SAFETY: the instance and the state are alive; there are as many bytes.
        let status = unsafe {
            (subject.library.serialize_state)(instance.component, state, bytes.as_mut_ptr(), wrong)
        };
        assert_eq!(status, ERROR, "{wrong} of {size}");
        assert!(bytes.iter().all(|byte| *byte == 7), "nothing was written");
    }
    instance.free_state(state);
}

fn each_truncation_and_extension_is_refused(subject: &'static Subject) {
    let mut bytes = bytes_midway(subject);
    let mut instance = Instance::with_logging(subject, false);
    for length in 0..bytes.len() {
        assert_eq!(instance.deserialize(&bytes[..length]), Err(ERROR), "{length} bytes");
    }
    bytes.push(0);
    assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    assert!(instance.log.last().text.contains("bytes"));
}

fn each_flipped_bit_is_refused(subject: &'static Subject) {
    let mut bytes = bytes_midway(subject);
    let mut instance = Instance::with_logging(subject, false);
    for bit in 0..bytes.len() * 8 {
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(instance.deserialize(&bytes), Err(ERROR), "bit {bit}");
        bytes[bit / 8] ^= 1 << (bit % 8);
    }
    let state = instance.deserialize(&bytes).expect("good bytes again");
    instance.free_state(state);
}

fn refusals_say_what_is_wrong(subject: &'static Subject) {
    let good = bytes_midway(subject);
    let mut instance = Instance::new(subject);
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
    assert!(reason(&|bytes| bytes.truncate(60)).contains("60 bytes"));
    assert!(reason(&|bytes| *bytes.last_mut().expect("not empty") ^= 1).contains("checksum"));
}

fn random_bytes_are_refused(subject: &'static Subject) {
    proptest!(|(bytes in prop::collection::vec(any::<u8>(), 0..4000))| {
        let mut instance = Instance::with_logging(subject, false);
        prop_assert_eq!(instance.deserialize(&bytes), Err(ERROR));
        instance.initialize();
    });
}

/// A good header before nonsense.
fn random_content_is_refused(subject: &'static Subject) {
    let good = bytes_midway(subject);
    proptest!(|(content in prop::collection::vec(any::<u8>(), 0..4000), keep in 8_usize..41)| {
        let mut bytes = good[..keep].to_vec();
        bytes.extend(content);
        let mut instance = Instance::with_logging(subject, false);
        prop_assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    });
}

fn several_damaged_bytes_are_refused(subject: &'static Subject) {
    let good = bytes_midway(subject);
    let damage = prop::collection::vec((any::<prop::sample::Index>(), 1..=255_u8), 1..20);
    proptest!(|(damage in damage)| {
        let mut bytes = good.clone();
        for (place, flips) in damage {
            let place = place.index(bytes.len());
            bytes[place] ^= flips;
        }
        prop_assume!(bytes != good);
        let mut instance = Instance::with_logging(subject, false);
        prop_assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    });
}

for_each_model! {
    restored_run_is_the_same,
    another_instance_continues_the_run,
    serialized_state_continues_in_another_instance,
    states_from_before_the_run,
    state_is_reused,
    freed_state_is_null_and_may_be_freed_again,
    size_must_fit,
    each_truncation_and_extension_is_refused,
    each_flipped_bit_is_refused,
    refusals_say_what_is_wrong,
    random_bytes_are_refused,
    random_content_is_refused,
    several_damaged_bytes_are_refused,
}
