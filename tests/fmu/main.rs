//! The built FMI libraries, loaded and called through their C interface. What does not speak of quadrotors is checked
//! with a second model, too.

#[path = "../common/mod.rs"]
mod common;

/// Runs each check on each model.
macro_rules! for_each_model {
    ($($check:ident),* $(,)?) => {
        mod closed_loop {
            $(#[test]
            fn $check() {
                super::$check(crate::closed_loop());
            })*
        }

        mod lag {
            $(#[test]
            fn $check() {
                super::$check(crate::lag());
            })*
        }
    };
}

mod derivatives;
mod description;
mod flight;
mod floating_point;
mod fmi3;
mod forged;
mod input_derivatives;
mod lifecycle;
mod logging;
mod misuse;
mod model_exchange;
mod parameters;
mod stack;
mod state;
mod stepping;
mod symbols;
mod threads;
mod values;

use std::sync::OnceLock;

use common::subject::Subject;

/// The quadrotor, loaded once for all tests of this executable.
fn closed_loop() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::closed_loop)
}

/// The second model.
fn lag() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::lag)
}
