//! Several instances at once.

use std::thread;

use crate::common::instance::Instance;
use crate::common::library::Library;
use crate::library;

/// A flight that depends on its number.
fn flown(library: &Library, number: u32) -> Vec<u64> {
    let goal = [("reference.position.x", f64::from(number)), ("reference.yaw", f64::from(number) * 0.1)];
    let mut instance = Instance::initialized(library, &goal, &[]);
    let mut outputs = Vec::new();
    for i in 0..100 {
        instance.fly(f64::from(i) * 0.05, 0.05, 1);
        outputs.extend(instance.outputs());
    }
    outputs
}

#[test]
fn instances_on_threads_fly_as_alone() {
    let alone: Vec<_> = (0..16).map(|number| flown(library(), number)).collect();
    let together: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..16).map(|number| scope.spawn(move || flown(library(), number))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    assert_eq!(together, alone);
}

#[test]
fn interleaved_instances_fly_as_alone() {
    let mut instances: Vec<_> = (0..4)
        .map(|number| Instance::initialized(library(), &[("reference.position.x", f64::from(number))], &[]))
        .collect();
    for i in 0..100 {
        for instance in &mut instances {
            instance.fly(f64::from(i) * 0.05, 0.05, 1);
        }
    }
    for (number, instance) in (0..4).zip(&mut instances) {
        let mut alone = Instance::initialized(library(), &[("reference.position.x", f64::from(number))], &[]);
        alone.fly(0.0, 5.0, 1);
        assert_eq!(instance.outputs(), alone.outputs());
    }
}

/// An instance may be made on one thread and used on another.
#[test]
fn instance_may_change_threads() {
    struct Handed(usize);
    let mut instance = Instance::initialized(library(), &[], &[]);
    let handed = Handed(instance.component as usize);
    thread::spawn(move || {
        // SAFETY: the component is alive: the other thread waits for this one.
        let status = unsafe { (library().do_step)(handed.0 as *mut _, 0.0, 0.5, 1) };
        assert_eq!(status, 0);
    })
    .join()
    .expect("no panic");
    assert_eq!(instance.time(), 0.5);
}
