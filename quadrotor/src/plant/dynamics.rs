//! The plant: rotors, rigid body and ground as f(x, u), and its integration.

use nalgebra::Vector3;

use crate::plant::ground::{contact, is_held};
use crate::plant::plant_inputs::{Actuation, PlantInputs};
use crate::plant::plant_state::PlantState;
use crate::plant::rotor_forces::{RotorForces, Surroundings};
use crate::{Airframe, BatteryOutput, Environment, External, Wrench};

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
    /// The vehicle in its world. The airframe is not checked: use one of a configuration that
    /// [`CascadeDesign::new`](crate::CascadeDesign::new) accepts.
    pub fn new(airframe: &Airframe, environment: &Environment) -> Self {
        Self { airframe: *airframe, ground_plane: environment.ground_plane }
    }

    /// The vehicle's constants.
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// Thrust and torques about the centre of mass that drive the body now: those of the rotors, or the ones in their place.
    /// The torques of spinning rotors ([`RotorSpin`](crate::RotorSpin)) are not among them.
    pub fn wrench(&self, state: &PlantState, inputs: &PlantInputs) -> Wrench {
        self.loads(state, inputs).0
    }

    /// What the battery gives now.
    pub fn battery(&self, state: &PlantState) -> BatteryOutput {
        let power_w = self.airframe.electric_power_w(&state.rotor_speed_rad_s);
        self.airframe.battery.output(power_w, state.discharge)
    }

    /// Acceleration in NED, m/s²; none along the ground while static friction holds the vehicle.
    pub fn acceleration_m_s2(&self, state: &PlantState, inputs: &PlantInputs) -> Vector3<f64> {
        let acceleration = self.derivative(state, inputs).body.velocity_m_s;
        if self.is_held(state, inputs) { Vector3::new(0.0, 0.0, acceleration.z) } else { acceleration }
    }

    /// f(x, u): the time derivative of the state. It is continuous and has no memory, so that any integrator can use it. Its
    /// slope jumps where a foot touches the ground, where a rotor with different lags meets its command, and where the
    /// thrust or the voltage reaches a bound.
    /// Static friction is not in it: on the ground it has sliding friction only, so that a vehicle in a wind creeps.
    /// [`Plant::step`] adds the rule that holds it still.
    pub fn derivative(&self, state: &PlantState, inputs: &PlantInputs) -> PlantState {
        let airframe = &self.airframe;
        let (wrench, mut external) = self.loads(state, inputs);
        if self.ground_plane {
            let ground = contact(airframe, &state.body);
            external.force_n += ground.force_n;
            external.torque_n_m += ground.torque_n_m;
        }
        PlantState {
            body: state.body.derivative(airframe, &wrench, &external),
            rotor_speed_rad_s: self.rotor_acceleration_rad_s2(state, inputs),
            discharge: self.discharge_rate(state, inputs),
        }
    }

    /// ω̇ = (ω_goal − ω) / τ, as far as the rotors are sound.
    fn rotor_acceleration_rad_s2(&self, state: &PlantState, inputs: &PlantInputs) -> [f64; 4] {
        let Actuation::RotorSpeeds(mut command_rad_s) = inputs.actuation else { return [0.0; 4] };
        if self.airframe.battery.sag {
            let share = self.airframe.battery.speed_share(self.battery(state).voltage_v);
            command_rad_s = command_rad_s.map(|command| command * share);
        }
        core::array::from_fn(|rotor| {
            let present = state.rotor_speed_rad_s[rotor];
            let goal = match inputs.rotor_faults[rotor] {
                Some(fault) => fault.goal_rad_s(command_rad_s[rotor], present),
                None => command_rad_s[rotor],
            };
            (goal - present) / self.airframe.lag_s(goal, present)
        })
    }

    /// Share of the battery's charge that is drawn per second.
    fn discharge_rate(&self, state: &PlantState, inputs: &PlantInputs) -> f64 {
        match inputs.actuation {
            Actuation::RotorSpeeds(_) if self.airframe.battery.sag => {
                self.battery(state).current_a / self.airframe.battery.capacity_a_s
            }
            _ => 0.0,
        }
    }

    /// All that acts on the body but gravity and the ground: thrust and torques that drive it, and the rest.
    fn loads(&self, state: &PlantState, inputs: &PlantInputs) -> (Wrench, External) {
        let (airframe, disturbance) = (&self.airframe, &inputs.disturbance);
        let mut external = airframe.drag(&state.body, &disturbance.wind_m_s);
        external.force_n += disturbance.force_n;
        external.torque_n_m += disturbance.torque_n_m;
        if let Actuation::Wrench(wrench) = inputs.actuation {
            return (wrench, external);
        }
        let around = Surroundings { wind_m_s: disturbance.wind_m_s, ground_plane: self.ground_plane };
        let RotorForces { wrench, lateral_n } = RotorForces::new(airframe, state, &around);
        if lateral_n != Vector3::zeros() {
            external.force_n += state.body.rotation() * lateral_n;
        }
        if airframe.rotor_spin.inertia_kg_m2 > 0.0 {
            external.torque_n_m += airframe.spin_torque_n_m(
                &state.body.body_rate_rad_s,
                &state.rotor_speed_rad_s,
                &self.rotor_acceleration_rad_s2(state, inputs),
            );
        }
        (wrench, external)
    }

    /// One step of the classical fourth-order Runge–Kutta method over `h_s` seconds. The ground is stiff: 1 ms resolves it.
    ///
    /// Static friction is decided at the beginning of the step. A vehicle that stands on all feet, slips by less than
    /// 0.1 m/s, and is pulled along the ground by less than μ N (μ = 0.7) keeps its place and heading exactly, while it may
    /// still sink or tilt on its feet. Pulled by more, it slips.
    pub fn step(&self, state: &PlantState, inputs: &PlantInputs, h_s: f64) -> PlantState {
        if !self.is_held(state, inputs) {
            return runge_kutta(state, h_s, |state| self.derivative(state, inputs));
        }
        let mut still = *state;
        hold(&mut still);
        runge_kutta(&still, h_s, |state| {
            let mut derivative = self.derivative(state, inputs);
            (derivative.body.position_m.x, derivative.body.position_m.y) = (0.0, 0.0);
            hold(&mut derivative);
            derivative
        })
    }

    /// Whether static friction holds the vehicle where it is.
    fn is_held(&self, state: &PlantState, inputs: &PlantInputs) -> bool {
        if !self.ground_plane {
            return false;
        }
        // What it would be pulled by at rest.
        let mut still = *state;
        hold(&mut still);
        let (wrench, mut pull) = self.loads(&still, inputs);
        pull.force_n += still.body.rotation() * Vector3::new(0.0, 0.0, -wrench.thrust_n);
        pull.torque_n_m += wrench.torque_n_m;
        is_held(&self.airframe, &state.body, &pull)
    }
}

/// Stops the motion along the ground, or its change.
fn hold(state: &mut PlantState) {
    let body = &mut state.body;
    (body.velocity_m_s.x, body.velocity_m_s.y, body.body_rate_rad_s.z) = (0.0, 0.0, 0.0);
}

fn runge_kutta(state: &PlantState, h_s: f64, f: impl Fn(&PlantState) -> PlantState) -> PlantState {
    let k1 = f(state);
    let k2 = f(&state.plus(&k1, h_s / 2.0));
    let k3 = f(&state.plus(&k2, h_s / 2.0));
    let k4 = f(&state.plus(&k3, h_s));
    // x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)
    state.plus(&k1, h_s / 6.0).plus(&k2, h_s / 3.0).plus(&k3, h_s / 3.0).plus(&k4, h_s / 6.0).normalized()
}
