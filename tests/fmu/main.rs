//! The built FMI libraries, loaded and called through their C interface. What does not speak of quadrotors is checked
//! with a model that knows none, too.

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

        mod controller {
            $(#[test]
            fn $check() {
                super::$check(crate::controller());
            })*
        }

        mod lag {
            $(#[test]
            fn $check() {
                super::$check(crate::lag());
            })*
        }

        mod plant {
            $(#[test]
            fn $check() {
                super::$check(crate::plant());
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
mod plant_exchange;
mod stack;
mod state;
mod stepping;
mod symbols;
mod terminals;
mod threads;
mod values;

use std::sync::OnceLock;

use common::subject::Subject;

/// The quadrotor, loaded once for all tests of this executable.
fn closed_loop() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::closed_loop)
}

/// Its controllers alone, from the same library.
fn controller() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::controller)
}

/// A model that knows no quadrotor.
fn lag() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::lag)
}

/// The quadrotor without its controllers, from the same library.
fn plant() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(Subject::plant)
}
