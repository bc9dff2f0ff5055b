//! How much stack the library needs.

use std::thread;

use crate::common::instance::Instance;
use crate::common::library::OK;
use crate::common::subject::Subject;

/// Stack that is enough for every call, bytes; documented for users.
const ENOUGH: usize = 64 * 1024;

/// A flight with all that takes stack: design, redesign, states, reset. An overflow ends the test's process.
fn a_small_stack_is_enough(subject: &'static Subject) {
    let run = move || {
        let mut instance = Instance::with_logging(subject, false);
        assert_eq!(instance.set_real(subject.sample.eventful.reals), OK);
        assert_eq!(instance.set_integer(subject.sample.eventful.integers), OK);
        instance.initialize();
        instance.fly(0.0, 0.05, 100);
        assert_eq!(instance.set_real(subject.sample.eventful.on_the_way), OK);
        let state = instance.get_state();
        let bytes = instance.serialize(state);
        instance.fly(5.0, 0.05, 100);
        assert_eq!(instance.set_state(state), OK);
        instance.free_state(state);
        let state = instance.deserialize(&bytes).expect("our own bytes");
        assert_eq!(instance.reset(), OK);
        assert_eq!(instance.set_state(state), OK);
        instance.free_state(state);
        instance.fly(5.0, 0.05, 1);
        assert_eq!(instance.reset(), OK);
        instance.initialize();
        instance.fly(0.0, 0.05, 100);
    };
    thread::Builder::new().stack_size(ENOUGH).spawn(run).expect("a thread").join().expect("no panic");
}

for_each_model! {
    a_small_stack_is_enough,
}
