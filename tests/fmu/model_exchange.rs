//! Model exchange: the tests' own solver integrates the lag, whose solution is known.

use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::lag;

/// In continuous-time mode at time 0.
fn begun() -> Instance<'static> {
    let mut instance = Instance::for_model_exchange(lag());
    assert_eq!(instance.set_real(&[("gain", 3.0), ("time_constant", 0.25)]), OK);
    instance.initialize();
    let info = instance.new_discrete_states();
    assert_eq!((info.new_discrete_states_needed, info.terminate_simulation), (0, 0));
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

#[test]
fn a_solver_of_the_importer_finds_the_solution() {
    let mut instance = begun();
    assert_eq!(instance.nominals(), [1.0]);
    for i in 0..100 {
        step(&mut instance, f64::from(i) * 0.01, 0.01);
    }
    let expected = 3.0 * (1.0 - (-4.0_f64).exp());
    let [y, rate] = instance.reals(["y", "der(y)"]);
    assert!((y - expected).abs() < 1e-6 && (rate - (3.0 - y) / 0.25).abs() < 1e-12, "{y} {rate}");
    assert_eq!(instance.continuous_states(), [y]);
    assert_eq!(instance.terminate(), OK);
}

/// The indicator changes its sign where y comes within 0.01 of its goal: after τ ln(3 / 0.01).
#[test]
fn the_indicator_finds_the_event() {
    let mut instance = begun();
    let (h, mut time) = (1e-3, 0.0);
    while instance.event_indicators()[0] > 0.0 {
        step(&mut instance, time, h);
        time += h;
        assert!(time < 5.0, "no event");
    }
    let expected = 0.25 * 300.0_f64.ln();
    assert!((time - h..=time).contains(&expected), "{time} {expected}");
    assert_eq!(instance.enter_event_mode(), OK);
    assert_eq!(instance.new_discrete_states().values_of_continuous_states_changed, 0);
    assert!(instance.boolean("settled"));
}

/// An input acts at once, what is discrete waits for an event.
#[test]
fn inputs_act_at_once() {
    let mut instance = begun();
    let before = instance.real("der(y)");
    assert_eq!(instance.set_real(&[("u", 2.0)]), OK);
    assert_eq!((before, instance.real("der(y)"), instance.derivatives()), (12.0, 24.0, vec![24.0]));
    assert_eq!(instance.set_boolean(&[("hold", true)]), ERROR);
    assert!(instance.log.last().text.contains("hold can only be set in event mode"));
    assert_eq!(instance.set_real(&[("gain", 1.0)]), ERROR);
    assert_eq!(instance.enter_event_mode(), OK);
    // What acted at the last event is held: the input of the beginning.
    assert_eq!(instance.set_boolean(&[("hold", true)]), OK);
    assert_eq!(instance.set_real(&[("gain", 1.0)]), OK);
    instance.new_discrete_states();
    assert_eq!(instance.enter_continuous_time_mode(), OK);
    assert_eq!(instance.real("der(y)"), 4.0);
}

#[test]
fn impossible_states_and_counts_are_refused() {
    let mut instance = begun();
    for (states, named) in
        [(&[f64::NAN][..], "state y = NaN"), (&[0.0, 0.0], "nx = 2; must be 1"), (&[], "nx = 0")]
    {
        assert_eq!(instance.set_continuous_states(states), ERROR);
        let text = instance.log.last().text;
        assert!(text.contains(named), "{text}");
    }
    assert_eq!(instance.set_time(f64::NAN), ERROR);
    assert_eq!(instance.set_time(-1.0), ERROR);
    assert_eq!(instance.continuous_states(), [0.0]);
}

/// CasADi sets states by their value references.
#[test]
fn states_can_be_set_as_variables() {
    let mut instance = begun();
    assert_eq!(instance.set_real(&[("y", 1.5), ("u", 2.0)]), OK);
    assert_eq!((instance.continuous_states(), instance.derivatives()), (vec![1.5], vec![18.0]));
    // All of them or none.
    assert_eq!(instance.set_real(&[("y", 0.5), ("u", 1e6)]), ERROR);
    assert_eq!(instance.set_real(&[("u", 1.0), ("y", f64::NAN)]), ERROR);
    assert_eq!((instance.continuous_states(), instance.derivatives()), (vec![1.5], vec![18.0]));
    assert_eq!(instance.set_real(&[("der(y)", 0.0)]), ERROR);
}

/// A state of model exchange continues in another instance, and is not one of co-simulation.
#[test]
fn saved_states_continue() {
    let mut instance = begun();
    (0..10).for_each(|i| step(&mut instance, f64::from(i) * 0.01, 0.01));
    let saved = instance.get_state();
    let bytes = instance.serialize(saved);
    step(&mut instance, 0.1, 0.01);
    let expected = instance.continuous_states();

    let mut other = Instance::for_model_exchange(lag());
    let state = other.deserialize(&bytes).expect("our own bytes");
    assert_eq!(other.set_state(state), OK);
    step(&mut other, 0.1, 0.01);
    assert_eq!(other.continuous_states(), expected);

    let mut stepped = Instance::new(lag());
    assert_eq!(stepped.set_state(state), ERROR);
    assert!(stepped.log.last().text.contains("the other kind"));
    other.free_state(state);
    instance.free_state(saved);
}

#[test]
fn an_instance_of_co_simulation_has_no_states_to_solve() {
    let mut instance = Instance::new(lag());
    assert_eq!(instance.enter_initialization_mode(), OK);
    let mut derivative = 0.0;
    // SAFETY: the instance is alive and the pointer valid.
    let status = unsafe { (instance.library.get_derivatives)(instance.component, &mut derivative, 1) };
    assert_eq!(status, ERROR);
    assert!(instance.log.last().text.contains("made for co-simulation"));
}
