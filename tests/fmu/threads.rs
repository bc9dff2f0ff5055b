//! Several instances at once.

use std::thread;

use crate::common::instance::Instance;
use crate::common::subject::Subject;

/// An input that depends on a number.
fn input(subject: &Subject, number: u32) -> [(&'static str, f64); 1] {
    [(subject.sample.input, f64::from(number) * 0.5)]
}

/// A run that depends on its number.
fn run(subject: &'static Subject, number: u32) -> Vec<u64> {
    let mut instance = Instance::initialized(subject, &input(subject, number), &[]);
    let mut outputs = Vec::new();
    for i in 0..100 {
        instance.fly(f64::from(i) * 0.05, 0.05, 1);
        outputs.extend(instance.outputs());
    }
    outputs
}

fn instances_on_threads_run_as_alone(subject: &'static Subject) {
    let alone: Vec<_> = (0..16).map(|number| run(subject, number)).collect();
    let together: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..16).map(|number| scope.spawn(move || run(subject, number))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    assert_eq!(together, alone);
}

fn interleaved_instances_run_as_alone(subject: &'static Subject) {
    let mut instances: Vec<_> =
        (0..4).map(|number| Instance::initialized(subject, &input(subject, number), &[])).collect();
    for i in 0..100 {
        for instance in &mut instances {
            instance.fly(f64::from(i) * 0.05, 0.05, 1);
        }
    }
    for (number, instance) in (0..4).zip(&mut instances) {
        let mut alone = Instance::initialized(subject, &input(subject, number), &[]);
        alone.fly(0.0, 5.0, 1);
        assert_eq!(instance.outputs(), alone.outputs());
    }
}

/// An instance may be made on one thread and used on another.
fn instance_may_change_threads(subject: &'static Subject) {
    struct Handed(usize);
    let mut instance = Instance::initialized(subject, &[], &[]);
    let library = &subject.library;
    let handed = Handed(instance.component as usize);
    thread::spawn(move || {
        // SAFETY: the component is alive: the other thread waits for this one.
        let status = unsafe { (library.do_step)(handed.0 as *mut _, 0.0, 0.5, 1) };
        assert_eq!(status, 0);
    })
    .join()
    .expect("no panic");
    assert_eq!(instance.time(), 0.5);
}

for_each_model! {
    instances_on_threads_run_as_alone,
    interleaved_instances_run_as_alone,
    instance_may_change_threads,
}
