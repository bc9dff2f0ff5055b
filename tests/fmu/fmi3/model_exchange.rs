//! Model exchange: the tests' own solver integrates the oscillator, whose solution is known.

use super::{closed_loop, oscillator};
use crate::common::fmi3::instance::{Event, Instance};
use crate::common::fmi3::library::{ERROR, OK};

/// In continuous-time mode at time 0.
fn begun() -> Instance {
    let mut instance = Instance::for_model_exchange(oscillator());
    assert_eq!(instance.set(&["initial", "frequency"], &[1.0, 0.5, 3.0]), OK);
    instance.initialize();
    assert_eq!(instance.update_discrete_states(), (OK, Event::default()));
    assert_eq!(instance.enter_continuous_time_mode(), OK);
    instance
}

/// One step of the classical Runge-Kutta method.
fn step(instance: &mut Instance, time: f64, h: f64) {
    let x = instance.continuous_states();
    let mut slope = |share: f64, k: &[f64]| {
        let at: Vec<f64> = x.iter().zip(k).map(|(x, k)| x + share * h * k).collect();
        assert_eq!(instance.set_time(time + share * h), OK);
        assert_eq!(instance.set_continuous_states(&at), OK);
        instance.derivatives()
    };
    let k1 = slope(0.0, &vec![0.0; x.len()]);
    let k2 = slope(0.5, &k1);
    let k3 = slope(0.5, &k2);
    let k4 = slope(1.0, &k3);
    let next: Vec<f64> =
        (0..x.len()).map(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect();
    assert_eq!(instance.set_time(time + h), OK);
    assert_eq!(instance.set_continuous_states(&next), OK);
}

/// x turns by ω t.
#[test]
fn a_solver_of_the_importer_finds_the_solution() {
    let mut instance = begun();
    assert_eq!((instance.number_of_continuous_states(), instance.number_of_event_indicators()), (2, 2));
    assert_eq!(instance.nominals(), [1.0, 1.0]);
    for i in 0..100 {
        step(&mut instance, f64::from(i) * 0.01, 0.01);
    }
    let (sin, cos) = 3.0_f64.sin_cos();
    let states = instance.continuous_states();
    assert!((states[0] - (cos - 0.5 * sin)).abs() < 1e-6 && (states[1] - (sin + 0.5 * cos)).abs() < 1e-6);
    // The vectors of states and derivatives are the arrays.
    assert_eq!(instance.values(&["x"]), states);
    assert_eq!(instance.values(&["der(x)"]), instance.derivatives());
    assert_eq!(instance.values(&["event_indicator"]), instance.event_indicators());
    assert_eq!(instance.value("time"), 1.0);
    assert_eq!(instance.terminate(), OK);
}

#[test]
fn inputs_act_at_once_and_parameters_at_events() {
    let mut instance = begun();
    let before = instance.derivatives();
    assert_eq!(instance.set(&["u"], &[1.0, -1.0]), OK);
    assert_eq!(instance.derivatives(), [before[0] + 1.0, before[1] - 1.0]);
    let status = instance.set(&["frequency"], &[1.0]);
    instance.is_refused(status, "frequency can only be set in event mode");
    assert_eq!(instance.enter_event_mode(), OK);
    assert_eq!(instance.set(&["frequency"], &[1.0]), OK);
    assert_eq!(instance.update_discrete_states().0, OK);
    assert_eq!(instance.enter_continuous_time_mode(), OK);
    assert_eq!(instance.derivatives(), [0.5, 0.0]);
    let (mut enter, mut terminate) = (true, true);
    let function = instance.subject.library.completed_integrator_step;
    // SAFETY: the instance is alive and all pointers are valid.
    assert_eq!(unsafe { function(instance.pointer, true, &mut enter, &mut terminate) }, OK);
    assert_eq!((enter, terminate), (false, false));
}

#[test]
fn impossible_states_and_counts_are_refused() {
    let mut instance = begun();
    for (states, named) in [
        (&[f64::NAN, 0.0][..], "state x[1] = NaN"),
        (&[0.0], "nContinuousStates = 1; must be 2"),
        (&[], "nContinuousStates = 0"),
    ] {
        let status = instance.set_continuous_states(states);
        instance.is_refused(status, named);
    }
    assert_eq!(instance.continuous_states(), [1.0, 0.5]);
}

/// What only model exchange has is refused in co-simulation, with a reason.
#[test]
fn co_simulation_has_no_states_to_solve() {
    for subject in [oscillator(), closed_loop()] {
        let mut instance = Instance::new(subject);
        let mut count = 7;
        // SAFETY: the instance is alive and the pointer valid.
        let status =
            unsafe { (subject.library.get_number_of_continuous_states)(instance.pointer, &mut count) };
        instance.is_refused(status, "made for co-simulation");
        // SAFETY: as above.
        let status =
            unsafe { (subject.library.get_number_of_event_indicators)(instance.pointer, &mut count) };
        instance.is_refused(status, "made for co-simulation");
        assert_eq!(count, 7);
        instance.initialize();
        let status = instance.enter_event_mode();
        instance.is_refused(status, "made for co-simulation");
        assert_eq!((instance.do_step(0.0, 0.1).0, instance.update_discrete_states().0), (OK, ERROR));
    }
}
