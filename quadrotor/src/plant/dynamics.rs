//! The plant: rotors, rigid body and ground as f(x, u), and its integration.

use nalgebra::Vector3;

use crate::plant::ground::contact;
use crate::plant::plant_inputs::{Actuation, PlantInputs};
use crate::plant::plant_state::PlantState;
use crate::{Airframe, Environment, Wrench, wrench_of_rotors};

/// The vehicle without its controllers: equations and constants, no state.
///
/// ```
/// use quadrotor::{Airframe, Environment, InitialState, Plant, PlantInputs, PlantState};
///
/// let airframe = Airframe::default();
/// let plant = Plant::new(&airframe, &Environment::default());
/// let hover = PlantState::hovering(&InitialState::default(), &airframe);
/// let inputs = PlantInputs::rotor_speeds(hover.rotor_speed_rad_s);
/// // f(x₀, u₀) = 0
/// assert!(plant.derivative(&hover, &inputs).body.velocity_m_s.norm() < 1e-12);
/// // Euler's method in place of the plant's own Runge–Kutta step.
/// let next = hover.plus(&plant.derivative(&hover, &inputs), 1e-3).normalized();
/// assert!((next.body.position_m - plant.step(&hover, &inputs, 1e-3).body.position_m).norm() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    airframe: Airframe,
    ground_plane: bool,
}

impl Plant {
    /// The vehicle in its world. The airframe is taken as it is; [`CascadeDesign::new`](crate::CascadeDesign::new) checks
    /// one.
    pub fn new(airframe: &Airframe, environment: &Environment) -> Self {
        Self { airframe: *airframe, ground_plane: environment.ground_plane }
    }

    /// The vehicle's constants.
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// Thrust and torques that the rotors make now.
    pub fn wrench(&self, state: &PlantState) -> Wrench {
        wrench_of_rotors(&self.airframe, &state.rotor_speed_rad_s)
    }

    /// Acceleration in NED, m/s².
    pub fn acceleration_m_s2(&self, state: &PlantState, inputs: &PlantInputs) -> Vector3<f64> {
        self.derivative(state, inputs).body.velocity_m_s
    }

    /// f(x, u): the time derivative of the state. It depends on nothing else, so that any integrator can use it.
    pub fn derivative(&self, state: &PlantState, inputs: &PlantInputs) -> PlantState {
        let airframe = &self.airframe;
        let mut external = inputs.disturbance.external(airframe, &state.body.velocity_m_s);
        if self.ground_plane {
            let ground = contact(airframe, &state.body);
            external.force_n += ground.force_n;
            external.torque_n_m += ground.torque_n_m;
        }
        let wrench = match inputs.actuation {
            Actuation::RotorSpeeds(_) => self.wrench(state),
            Actuation::Wrench(wrench) => wrench,
        };
        PlantState {
            body: state.body.derivative(airframe, &wrench, &external),
            rotor_speed_rad_s: self.rotor_acceleration_rad_s2(state, inputs),
        }
    }

    /// ω̇ = (ω_command − ω) / τ, as far as the rotors are sound.
    fn rotor_acceleration_rad_s2(&self, state: &PlantState, inputs: &PlantInputs) -> [f64; 4] {
        let Actuation::RotorSpeeds(command_rad_s) = inputs.actuation else { return [0.0; 4] };
        core::array::from_fn(|rotor| {
            let present = state.rotor_speed_rad_s[rotor];
            let goal = match inputs.rotor_faults[rotor] {
                Some(fault) => fault.goal_rad_s(command_rad_s[rotor], present),
                None => command_rad_s[rotor],
            };
            (goal - present) / self.airframe.rotor_time_constant_s
        })
    }

    /// One step of the classical fourth-order Runge–Kutta method over `h_s` seconds. The ground is stiff: 1 ms resolves it.
    pub fn step(&self, state: &PlantState, inputs: &PlantInputs, h_s: f64) -> PlantState {
        let f = |state: &PlantState| self.derivative(state, inputs);
        let k1 = f(state);
        let k2 = f(&state.plus(&k1, h_s / 2.0));
        let k3 = f(&state.plus(&k2, h_s / 2.0));
        let k4 = f(&state.plus(&k3, h_s));
        // x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)
        state.plus(&k1, h_s / 6.0).plus(&k2, h_s / 3.0).plus(&k3, h_s / 3.0).plus(&k4, h_s / 6.0).normalized()
    }
}
