//! The same flight by both versions of the interface, bit for bit.

use super::{closed_loop, lag};
use crate::common::fmi3::instance::Instance;
use crate::common::fmi3::subject::Subject;
use crate::common::instance::Instance as Second;
use crate::common::subject::Subject as SecondSubject;

/// All outputs of the instance of version 2.0, in the order of its description.
fn outputs(instance: &mut Second) -> Vec<u64> {
    let description = instance.description;
    let bits = description.outputs().map(|variable| match variable.value_type.as_str() {
        "Real" => instance.real(&variable.name).to_bits(),
        "Boolean" => u64::from(instance.boolean(&variable.name)),
        _ => instance.integer(&variable.name) as u64,
    });
    bits.collect()
}

fn fly_both(second: &'static SecondSubject, third: &'static Subject, step: f64, steps: u32) {
    let (mut second, mut third) = (Second::new(second), Instance::new(third));
    second.initialize();
    third.initialize();
    for i in 0..steps {
        assert_eq!(outputs(&mut second), third.outputs(), "before step {i}");
        second.fly(f64::from(i) * step, step, 1);
        third.fly(f64::from(i) * step, step, 1);
    }
    assert_eq!(outputs(&mut second), third.outputs());
}

/// The default experiment.
#[test]
fn of_the_closed_loop() {
    fly_both(crate::closed_loop(), closed_loop(), 0.025, 800);
}

#[test]
fn of_the_lag() {
    fly_both(crate::lag(), lag(), 0.05, 100);
}
