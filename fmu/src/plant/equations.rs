//! The plant for importers' own solvers.

use fmi::{Continuous, Seed};
use quadrotor::{PlantState, Switch};

use super::QuadrotorPlant;
use super::commands::Commands;
use super::observed::Observed;

/// A quaternion whose squared length is farther from one than this is made a unit quaternion at the next event. The equations hold for any
/// length; the tolerances of a solver are for one.
const LENGTH_TOLERANCE: f64 = 1e-3;
/// From here on a solver is asked for an event, to be on the safe side of numbers that vanish or overflow.
const LENGTH_LIMIT: f64 = 0.5;

/// f, g and events of the plant.
pub(super) struct Equations;

/// By how much the squared length of the attitude's quaternion differs from one.
fn length_error(state: &PlantState) -> f64 {
    (state.body.attitude.coords.norm_squared() - 1.0).abs()
}

impl Continuous<QuadrotorPlant> for Equations {
    fn event_indicators(&self) -> usize {
        Switch::COUNT
    }

    fn states(&self, model: &QuadrotorPlant, states: &mut [f64]) {
        states.copy_from_slice(&model.simulation.plant_state().to_array());
    }

    fn set_states(&self, model: &mut QuadrotorPlant, states: &[f64]) {
        if let Ok(numbers) = states.try_into() {
            model.simulation.set_plant_state(&PlantState::from_array(numbers));
        }
    }

    fn derivatives(&self, model: &QuadrotorPlant, commands: &Commands, derivatives: &mut [f64]) {
        let (state, inputs) = (model.simulation.plant_state(), model.acting(commands));
        let derivative = model.simulation.plant().derivative_in(model.mode(&inputs), &state, &inputs);
        derivatives.copy_from_slice(&derivative.to_array());
    }

    fn outputs(&self, model: &QuadrotorPlant, commands: &Commands) -> Observed {
        let (state, inputs) = (model.simulation.plant_state(), model.acting(commands));
        Observed::in_mode(model.simulation.plant(), model.mode(&inputs), &state, &inputs)
    }

    fn indicators(&self, model: &QuadrotorPlant, commands: &Commands, indicators: &mut [f64]) {
        let (state, inputs) = (model.simulation.plant_state(), model.acting(commands));
        let plant = model.simulation.plant();
        indicators.copy_from_slice(&plant.event_indicators(model.mode(&inputs), &state, &inputs));
    }

    fn update(&self, model: &mut QuadrotorPlant, commands: &Commands) -> bool {
        let (before, inputs) = (model.simulation.plant_state(), model.acting(commands));
        let (mode, mut state) = model.simulation.plant().event(model.mode(&inputs), &before, &inputs);
        if length_error(&state) > LENGTH_TOLERANCE {
            state = state.normalized();
        }
        model.mode = Some(mode);
        if state == before {
            return false;
        }
        model.simulation.set_plant_state(&state);
        true
    }

    fn needs_event(&self, model: &QuadrotorPlant) -> bool {
        length_error(&model.simulation.plant_state()) > LENGTH_LIMIT
    }

    fn tangent(&self, model: &QuadrotorPlant, commands: &Commands, seed: &Seed<QuadrotorPlant>) -> Observed {
        let (state, inputs) = (model.simulation.plant_state(), model.acting(commands));
        let along = PlantState::from_array(core::array::from_fn(|index| {
            seed.states.get(index).copied().unwrap_or_default()
        }));
        let (moving, pushed) = (state.with_seed(&along), inputs.with_seed(&model.acting(&seed.inputs)));
        let (plant, mode) = (model.simulation.plant(), model.mode(&inputs));
        let observed = match model.mode {
            Some(_) => Observed::in_mode(plant, mode, &moving, &pushed),
            None => Observed::by_steps(plant, mode, &moving, &pushed),
        };
        observed.tangent()
    }

    fn dependencies(&self, unknown: &str) -> &'static [&'static str] {
        const ROTORS: &[&str] = &["rotor.", "battery.discharge"];
        let of = unknown.strip_prefix("der(").map(|name| name.trim_end_matches(')'));
        match (of, of.unwrap_or(unknown)) {
            (Some(_), "position.x") => &["velocity.x"],
            (Some(_), "position.y") => &["velocity.y"],
            (Some(_), "position.z") => &["velocity.z"],
            (Some(_), name) if name.starts_with("velocity.") => FORCES,
            (Some(_), name) if name.starts_with("attitude.") => &["attitude.", "body_rate."],
            (Some(_), name) if name.starts_with("body_rate.") => TORQUES,
            (Some(_), _) => ROTORS,
            (None, "altitude") => &["position.z"],
            (None, "thrust") => THRUST,
            (None, name) if name.starts_with("torque.") => THRUST,
            (None, name) if name.starts_with("acceleration.") => FORCES,
            (None, name) if name.starts_with("body_velocity.") => &["velocity.", "attitude."],
            (None, "attitude.phi" | "attitude.theta" | "attitude.psi") => &["attitude."],
            (None, "battery.voltage" | "battery.current") => &["rotor.speed", "battery.discharge"],
            (None, "battery.remaining") => &["battery.discharge"],
            (None, state) => itself(state),
        }
    }
}

/// What the thrust and the torques of the rotors, or those in their place, depend on.
const THRUST: &[&str] = &[
    "position.z",
    "velocity.",
    "attitude.",
    "body_rate.",
    "rotor.speed",
    "command.",
    "wind.velocity.",
    "ground.z",
];
/// What the acceleration depends on.
const FORCES: &[&str] = &[
    "position.z",
    "velocity.",
    "attitude.",
    "body_rate.",
    "rotor.speed",
    "command.thrust",
    "disturbance.force.",
    "wind.velocity.",
    "ground.z",
];
/// What the angular acceleration depends on; with rotors that have an inertia also on how they speed up.
const TORQUES: &[&str] = &[
    "position.z",
    "velocity.",
    "attitude.",
    "body_rate.",
    "rotor.",
    "battery.discharge",
    "command.",
    "disturbance.",
    "wind.velocity.",
    "ground.z",
];

/// A state depends on itself alone.
fn itself(name: &str) -> &'static [&'static str] {
    const STATES: [&[&str]; 18] = [
        &["position.x"],
        &["position.y"],
        &["position.z"],
        &["velocity.x"],
        &["velocity.y"],
        &["velocity.z"],
        &["attitude.q0"],
        &["attitude.q1"],
        &["attitude.q2"],
        &["attitude.q3"],
        &["body_rate.p"],
        &["body_rate.q"],
        &["body_rate.r"],
        &["rotor.speed[1]"],
        &["rotor.speed[2]"],
        &["rotor.speed[3]"],
        &["rotor.speed[4]"],
        &["battery.discharge"],
    ];
    STATES.into_iter().find(|state| state.contains(&name)).unwrap_or_default()
}
