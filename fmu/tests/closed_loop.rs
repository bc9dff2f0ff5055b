//! The model behind the interface: its run is the engine's, bit for bit.

use fmi::Model;
use fmi::variables::{Role, Signal, Variable};
use fmu::{ClosedLoop, FlightError};
use quadrotor::{AirframePreset, Configuration, ControllerStatus, Inputs, PositionReference, Simulation};

fn both() -> (ClosedLoop, Simulation) {
    let (configuration, inputs) = (Configuration::default(), Inputs::default());
    (ClosedLoop::new(&configuration, &inputs).unwrap(), Simulation::new(&configuration, &inputs).unwrap())
}

/// Climbs, then goes east.
fn inputs_at(time_us: u64) -> Inputs {
    let goal = if time_us < 300_000 { [0.0, 0.0, -2.0] } else { [0.0, 3.0, -2.0] };
    Inputs { reference: PositionReference::goal(goal, 0.3), ..Inputs::default() }
}

#[test]
fn a_run_is_the_engines_flight() {
    let (mut model, mut flight) = both();
    assert_eq!((model.time_us(), model.outputs(), model.state()), (0, flight.outputs(), flight.state()));
    for time_us in [25_000, 310_500, 700_000] {
        model.advance_to(time_us, &inputs_at).unwrap();
        flight.advance_to(time_us, &inputs_at).unwrap();
        assert_eq!((model.time_us(), model.outputs()), (time_us, flight.outputs()));
        assert_eq!(model.state(), flight.state());
    }
    assert!(matches!(model.advance_to(0, &inputs_at), Err(FlightError::Simulation(_))));
}

#[test]
fn a_saved_state_continues_in_this_run_and_in_another() {
    let (mut model, _) = both();
    model.advance_to(400_000, &inputs_at).unwrap();
    let saved = model.state();
    model.advance_to(800_000, &inputs_at).unwrap();
    let expected = (model.state(), model.outputs());

    model.restore(&Configuration::default(), &saved).unwrap();
    assert_eq!(model.state(), saved);
    let other = ClosedLoop::from_state(&Configuration::default(), &saved).unwrap();
    for mut run in [model, other] {
        run.advance_to(800_000, &inputs_at).unwrap();
        assert_eq!((run.state(), run.outputs()), expected);
    }
}

/// A lighter vehicle that still has the thrust of the heavier one climbs: the change reaches the plant at once.
#[test]
fn changed_parameters_take_effect_in_the_run() {
    let (mut model, mut flight) = both();
    let mut lighter = Configuration::default();
    lighter.airframe.mass_kg *= 0.9;
    model.retune(&lighter).unwrap();
    flight.reconfigure(&lighter).unwrap();
    assert_eq!(model.outputs(), flight.outputs());
    // F / m − g with F = m₀ g: a tenth of the weight over nine tenths of the mass.
    let climb_m_s2 = -model.outputs().acceleration_m_s2.z;
    assert!((climb_m_s2 - quadrotor::GRAVITY_M_S2 * (0.1 / 0.9)).abs() < 1e-9, "{climb_m_s2}");

    let mut wrong = Configuration::default();
    wrong.airframe.mass_kg = -1.0;
    assert!(matches!(model.retune(&wrong), Err(FlightError::Configuration(_))));
    assert!(ClosedLoop::new(&wrong, &Inputs::default()).is_err());
    assert!(ClosedLoop::from_state(&wrong, &model.state()).is_err());
}

/// What runs, and what is read, is the preset with what is set beside it; saved states continue under it.
#[test]
fn a_preset_is_applied_to_the_run_and_to_what_is_read() {
    let mut parameters = Configuration { preset: AirframePreset::Crazyflie, ..Configuration::default() };
    parameters.airframe.mass_kg = 0.03;
    let mut model = ClosedLoop::new(&parameters, &Inputs::default()).unwrap();
    let mut flight = Simulation::new(&parameters.resolved().unwrap(), &Inputs::default()).unwrap();
    model.advance_to(400_000, &inputs_at).unwrap();
    flight.advance_to(400_000, &inputs_at).unwrap();
    assert_eq!(model.outputs(), flight.outputs());
    let read = ClosedLoop::as_read(&parameters);
    assert_eq!((read.preset, read.airframe.mass_kg), (AirframePreset::Crazyflie, 0.03));
    assert_eq!(read.limits, parameters.resolved().unwrap().limits);

    let other = ClosedLoop::from_state(&parameters, &model.state()).unwrap();
    assert_eq!(other.outputs(), model.outputs());
    // A tunable limit in flight; back at its start value it follows the preset again.
    let tuned = |speed_m_s| {
        let mut tuned = parameters;
        tuned.limits.speed_up_m_s = speed_m_s;
        tuned
    };
    assert_eq!(ClosedLoop::as_read(&tuned(1.0)).limits.speed_up_m_s, 1.0);
    assert_eq!(ClosedLoop::as_read(&tuned(4.0)).limits, read.limits);
    model.retune(&tuned(1.0)).unwrap();
    model.retune(&parameters).unwrap();
    parameters.airframe.mass_kg = 3.0;
    assert!(matches!(ClosedLoop::new(&parameters, &Inputs::default()), Err(FlightError::Configuration(_))));
}

/// The message of the log has the figures of the calculated parameters.
#[test]
fn the_first_message_names_the_three_designs() {
    let (model, _) = both();
    let radius = |controller: &str| {
        let variable = variable(&format!("controller.{controller}.spectral_radius"));
        let Role::CalculatedParameter { get, .. } = variable.role else { panic!("{}", variable.name) };
        assert!((0.5..1.0).contains(&get(&model)), "{controller}: {}", get(&model));
        format!("{controller} {:.4}", get(&model))
    };
    let radii = ["altitude", "position", "attitude"].map(radius).join(", ");
    assert_eq!(model.initialized(), format!("initialized; spectral radii of the closed loops: {radii}"));
}

/// Each status has the number of its item, of each controller.
#[test]
fn statuses_are_numbered_as_their_items() {
    let mut outputs = both().0.outputs();
    let statuses = [
        (ControllerStatus::Optimal, 1, "optimal"),
        (ControllerStatus::Relaxed, 2, "relaxed"),
        (ControllerStatus::IterationLimit, 3, "iteration_limit"),
        (ControllerStatus::Held, 4, "held"),
    ];
    for (status, number, item) in statuses {
        for controller in ["altitude", "position", "attitude"] {
            outputs.activity = Default::default();
            match controller {
                "altitude" => outputs.activity.altitude.status = status,
                "position" => outputs.activity.position.status = status,
                _ => outputs.activity.attitude.status = status,
            }
            for read in ["altitude", "position", "attitude"] {
                let variable = variable(&format!("controller.{read}.status"));
                let Role::Output { signal: Signal::Enumeration { choice, get }, .. } = variable.role else {
                    panic!("{} is no enumeration", variable.name)
                };
                assert_eq!(choice.items[number as usize - 1].0, item);
                assert_eq!(
                    get(&outputs),
                    if read == controller { number } else { 1 },
                    "{read} of {controller}"
                );
            }
        }
    }
}

fn variable(name: &str) -> &'static Variable<ClosedLoop> {
    ClosedLoop::VARIABLES.iter().copied().flatten().find(|variable| variable.name == name).unwrap()
}
