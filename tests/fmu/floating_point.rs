//! Hosts with a floating-point environment of their own, and what the flight itself asks of the arithmetic.
#![cfg(target_arch = "x86_64")]

use std::arch::asm;

use quadrotor::{Configuration, Inputs, PositionReference, Simulation};

use crate::common::instance::Instance;
use crate::common::library::OK;
use crate::common::subject::Subject;

/// Bits of MXCSR (Intel SDM, volume 1, section 10.2.3): the flags "invalid operation" and "divide by zero".
const INVALID: u32 = 1 << 0;
const DIVIDE_BY_ZERO: u32 = 1 << 2;
/// All exceptions masked, no flag raised.
const DEFAULT: u32 = 0x1f80;
/// Invalid operations, divisions by zero and overflows trap.
const TRAPPING: u32 = DEFAULT & !(1 << 7) & !(1 << 9) & !(1 << 10);
/// Tiny numbers are zero, as operands and as results.
const FLUSHING: u32 = DEFAULT | 1 << 15 | 1 << 6;
/// Results are rounded towards zero.
const TRUNCATING: u32 = DEFAULT | 3 << 13;

fn read() -> u32 {
    let mut value = 0_u32;
    // SAFETY: it writes four bytes to `value`.
    unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack)) };
    value
}

fn write(value: u32) {
    // SAFETY: it reads four bytes of `value`, none of whose reserved bits is set.
    unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack)) };
}

/// Calls the library under an environment of the host, which must be the same afterwards.
fn under<T>(environment: u32, call: impl FnOnce() -> T) -> T {
    write(environment);
    let result = call();
    let after = read();
    write(DEFAULT);
    assert_eq!(after, environment, "the environment is the host's");
    result
}

/// A run, all of whose calls are made under an environment.
fn run(subject: &'static Subject, environment: u32) -> Vec<u64> {
    let mut instance = under(environment, || Instance::new(subject));
    assert_eq!(under(environment, || instance.setup(0.0, None)), OK);
    assert_eq!(under(environment, || instance.enter_initialization_mode()), OK);
    assert_eq!(under(environment, || instance.exit_initialization_mode()), OK);
    for i in 0..200 {
        let point = f64::from(i) * 0.1;
        assert_eq!(under(environment, || instance.do_step(point, 0.1)), OK);
    }
    let outputs = under(environment, || instance.outputs());
    under(environment, || drop(instance));
    outputs
}

/// Neither does a trap end the host, nor do its rounding and its tiny numbers change the flight.
fn the_environment_of_the_host_changes_nothing(subject: &'static Subject) {
    let expected = run(subject, DEFAULT);
    for environment in [TRAPPING, FLUSHING, TRUNCATING] {
        assert_eq!(run(subject, environment), expected, "{environment:#x}");
    }
}

/// Flags that a part of a flight has raised.
fn raised<T>(part: impl FnOnce() -> T) -> (T, u32) {
    write(if std::env::var("HIMP_TRAP").is_ok() { DEFAULT & !(1 << 7) & !(1 << 9) } else { DEFAULT });
    let result = part();
    let flags = read() & (INVALID | DIVIDE_BY_ZERO);
    write(DEFAULT);
    (result, flags)
}

/// The default experiment, and one of each kind, from the first design to the end. Only the first samples divide by zero: in
/// candidates of the shaper's solver, which it discards, and without shaping in a quotient that is not used.
#[test]
fn a_flight_divides_by_zero_at_its_first_samples_at_most() {
    let goal = |reference| Inputs { reference, ..Inputs::default() };
    let shaped = Configuration::default();
    let mut unshaped = shaped;
    unshaped.reference.shaping = false;
    let turned = PositionReference::goal([1.0, -2.0, -3.0], 1.0);
    for (name, configuration, inputs) in [
        ("default", shaped, Inputs::default()),
        ("turned", shaped, goal(turned)),
        ("unshaped", unshaped, goal(turned)),
        ("disarmed", shaped, Inputs { armed: false, ..Inputs::default() }),
    ] {
        let (flight, flags) = raised(|| Simulation::new(&configuration, &inputs));
        assert_eq!(flags, 0, "{name}: at the start");
        let mut flight = flight.expect("a valid configuration");
        for i in 1..=400 {
            let (outcome, flags) = raised(|| flight.advance_to(i * 50_000, &inputs));
            outcome.expect("it flies");
            let discarded = match (inputs.armed && i == 1, configuration.reference.shaping) {
                (true, true) => INVALID | DIVIDE_BY_ZERO,
                (true, false) => DIVIDE_BY_ZERO,
                (false, _) => 0,
            };
            assert_eq!(flags & !discarded, 0, "{name}: until {} ms", i * 50);
            let (_, flags) = raised(|| flight.outputs());
            assert_eq!(flags, 0, "{name}: outputs at {} ms", i * 50);
        }
    }
}

for_each_model! {
    the_environment_of_the_host_changes_nothing,
}
