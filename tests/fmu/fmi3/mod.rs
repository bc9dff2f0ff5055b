//! The FMI 3.0 interface of the same libraries: what it has in common with that of 2.0 is the same instance, and tested there.

use std::sync::OnceLock;

use crate::common::fmi3::subject::Subject;

mod arrays;
mod description;
mod equality;
mod lifecycle;
mod misuse;
mod model_exchange;
mod states;
mod values;

/// The quadrotor, loaded once for all tests of this executable.
fn closed_loop() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::closed_loop)
}

/// A first-order lag.
fn lag() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::lag)
}

/// An oscillator, whose states are a vector.
fn oscillator() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::oscillator)
}

/// All models.
fn all() -> [&'static Subject; 3] {
    [closed_loop(), lag(), oscillator()]
}
