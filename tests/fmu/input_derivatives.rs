//! `fmi2SetRealInputDerivatives`: inputs that move during a step.

use quadrotor::{Configuration, Inputs, Simulation};

use crate::closed_loop;
use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::common::subject::{Sample, Subject};

const STEP_S: f64 = 0.2;
const STEPS: u32 = 25;

/// Position and velocity reference of a climb with constant acceleration, without shaping.
fn climb(time_s: f64) -> [(&'static str, f64); 3] {
    [
        ("reference.position.z", -0.2 * time_s * time_s),
        ("reference.velocity.z", -0.4 * time_s),
        ("reference.acceleration.z", -0.4),
    ]
}

fn ready() -> Instance<'static> {
    let origin = [("reference.position.x", 0.0), ("reference.position.y", 0.0)];
    Instance::initialized(
        closed_loop(),
        &[origin[0], origin[1], climb(0.0)[0]],
        &[("reference.shaping", false)],
    )
}

/// Largest tracking error of the climb, m, against the true reference, with communication steps of this length, s.
fn error_of_climb(step_s: f64, with_derivatives: bool) -> f64 {
    let mut instance = ready();
    let mut worst = 0.0_f64;
    for i in 0..STEPS {
        let time_s = f64::from(i) * step_s;
        assert_eq!(instance.set_real(&climb(time_s)), OK);
        if with_derivatives {
            let derivatives = [
                ("reference.position.z", 1, -0.4 * time_s),
                ("reference.position.z", 2, -0.4),
                ("reference.velocity.z", 1, -0.4),
            ];
            assert_eq!(instance.set_input_derivatives(&derivatives), OK);
        }
        assert_eq!(instance.do_step(time_s, step_s), OK);
        let after_s = time_s + step_s;
        worst = worst.max((instance.real("position.z") + 0.2 * after_s * after_s).abs());
    }
    worst
}

/// Points that are set at least every 0.3 s are extended by their own derivatives, which this climb has all of; others are set-points.
#[test]
fn a_moving_reference_is_tracked_better_than_one_that_counts_as_resting() {
    let (held, moving) = (error_of_climb(STEP_S, false), error_of_climb(STEP_S, true));
    assert!(moving < 0.02 && held < 0.02, "{STEP_S} s: {moving} m with derivatives, {held} m without");
    let (held, moving) = (error_of_climb(0.4, false), error_of_climb(0.4, true));
    assert!(moving < 0.2 * held, "0.4 s: {moving} m with derivatives, {held} m without");
}

/// The engine with the polynomial as its input signal flies the same, bit for bit.
#[test]
fn extrapolation_is_the_engines_signal() {
    let mut configuration = Configuration::default();
    configuration.reference.shaping = false;
    let mut inputs = Inputs::default();
    let mut engine = Simulation::new(&configuration, &inputs).expect("a valid configuration");
    let mut instance = Instance::initialized(closed_loop(), &[], &[("reference.shaping", false)]);
    for i in 0..STEPS {
        let (time_s, begin_us) = (f64::from(i) * STEP_S, u64::from(i) * 200_000);
        inputs.reference.position_m.x = time_s;
        assert_eq!(instance.set_real(&[("reference.position.x", time_s)]), OK);
        assert_eq!(instance.set_input_derivatives(&[("reference.position.x", 1, 1.0)]), OK);
        assert_eq!(instance.do_step(time_s, STEP_S), OK);
        let signal = |time_us: u64| {
            let mut moving = inputs;
            moving.reference.position_m.x += 1.0 * ((time_us - begin_us) as f64 * 1e-6);
            moving
        };
        engine.advance_to(begin_us + 200_000, &signal).expect("it flies");
        assert_eq!(instance.real("position.x"), engine.outputs().position_m.x, "after step {i}");
    }
}

/// Derivatives hold for one step; the input itself keeps the value that was set.
#[test]
fn derivatives_end_with_the_step() {
    let flown = |derivative: Option<f64>| {
        let mut instance = ready();
        if let Some(value) = derivative {
            assert_eq!(instance.set_input_derivatives(&[("reference.position.x", 1, value)]), OK);
        }
        // Long enough for a sample of the position controller, if only one.
        instance.fly(0.0, 0.051, 1);
        assert_eq!(instance.real("reference.position.x"), 0.0);
        let first = instance.outputs();
        instance.fly(0.051, 0.2, 20);
        (first, instance.real("position.x").abs())
    };
    let (first, held) = flown(None);
    let (moved, after) = flown(Some(5.0));
    assert_ne!(moved, first);
    assert!(held < 1e-9 && after < 0.05, "the reference is back at 0, the vehicle is at {after} m");
    assert_eq!(flown(Some(0.0)), (first, held), "a derivative of zero is none");
}

fn newest_derivative_counts(subject: &'static Subject) {
    let Sample { input, .. } = subject.sample;
    let flown = |derivatives: &[(&str, i32, f64)]| {
        let mut instance = Instance::initialized(subject, &[], subject.sample.unshaped);
        for derivative in derivatives {
            assert_eq!(instance.set_input_derivatives(&[*derivative]), OK);
        }
        instance.fly(0.0, 0.5, 1);
        instance.outputs()
    };
    assert_eq!(
        flown(&[(input, 1, 9.0), (input, 2, 1.0), (input, 1, 0.5)]),
        flown(&[(input, 1, 0.5), (input, 2, 1.0)])
    );
    assert_ne!(flown(&[(input, 1, 9.0)]), flown(&[(input, 1, 0.5)]));
}

fn impossible_derivatives_are_refused_together(subject: &'static Subject) {
    let Sample { input, switch, output, tunable, .. } = subject.sample;
    let flown = |wrong: Option<(&str, i32, f64)>| {
        let mut instance = Instance::initialized(subject, &[], subject.sample.unshaped);
        if let Some(wrong) = wrong {
            let derivatives = [(input, 1, 1.0), wrong, (input, 2, 1.0)];
            assert_eq!(instance.set_input_derivatives(&derivatives), ERROR, "{wrong:?}");
            let text = instance.log.last().text;
            assert!(text.contains(wrong.0), "{text}");
        }
        instance.fly(0.0, 0.5, 1);
        instance.outputs()
    };
    let untouched = flown(None);
    for wrong in [
        (input, 0, 1.0),
        (input, -1, 1.0),
        (input, 4, 1.0),
        (input, i32::MAX, 1.0),
        (input, 1, f64::NAN),
        (input, 1, f64::INFINITY),
        (switch, 1, 1.0),
        (output, 1, 1.0),
        (tunable, 1, 1.0),
    ] {
        assert_eq!(flown(Some(wrong)), untouched, "{wrong:?}");
    }
}

/// However steep, the input stays within its range, and the flight goes on.
#[test]
fn extrapolation_stays_in_range() {
    let mut instance = ready();
    assert_eq!(instance.set_input_derivatives(&[("reference.position.x", 3, 1e300)]), OK);
    assert_eq!(instance.do_step(0.0, 1.0), OK, "{:?}", instance.log.take());
    assert!(instance.real("setpoint.position.x") <= 1e6);
}

for_each_model! {
    newest_derivative_counts,
    impossible_derivatives_are_refused_together,
}
