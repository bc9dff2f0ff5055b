//! The plant: rotors, rigid body and ground as f(x, u), and its integration.

use nalgebra::Vector3;

use crate::plant::calmness::Calmness;
use crate::plant::differentiation::real::{Real, Valued};
use crate::plant::events::branches::{Branches, ByValue};
use crate::plant::forces::Forces;
use crate::plant::ground::{HoldingMargins, cannot_be_held, contact};
#[cfg(feature = "fleet")]
use crate::plant::likeness::likeness;
use crate::plant::mass_properties::MassProperties;
use crate::plant::plant_inputs::{Actuation, PlantInputs};
use crate::plant::plant_state::PlantState;
use crate::plant::rotor_fault::goals_rad_s;
use crate::plant::rotor_forces::{RotorForces, Surroundings};
use crate::plant::rotor_map::RotorMap;
use crate::plant::rotor_spin::RotorLag;
use crate::{Airframe, Environment, External, RotorFault};

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
#[derive(Clone, Copy, Debug)]
pub struct Plant {
    airframe: Airframe,
    ground_plane: bool,
    mass: MassProperties,
    rotor_lag: RotorLag,
    rotor_map: RotorMap,
    /// Whether its rotors do what the rotor map says, and drag and battery do nothing.
    is_plain: bool,
    /// No foot is farther from the centre of mass.
    reach_m: f64,
    /// What calm flight keeps to, if there is any.
    pub(crate) calmness: Option<Calmness>,
    /// Fleets look for plants of a kind at each call.
    #[cfg(feature = "fleet")]
    likeness: u64,
}

/// The beginning of a step, which is the same however long the step is: where it begins, and the derivative there.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BegunStep {
    /// It flies or slips.
    Free { from: PlantState, slope: PlantState },
    /// Static friction holds its place and heading. It may sink or tilt on its feet.
    Held { from: PlantState, slope: PlantState },
    /// Nothing moves.
    Still(PlantState),
}

/// What is held on the ground and moves more slowly than this, m/s and rad/s, stands still if it would begin to move by less than
/// [`STIRS`]: the contact would slow it down for ever.
const CREEPS: f64 = 1e-8;
/// Accelerations of body and rotors, m/s² and rad/s². At this one a foot is 4e-10 m from where it would come to rest.
const STIRS: f64 = 1e-6;

/// The rest follows from what is compared.
impl PartialEq for Plant {
    fn eq(&self, other: &Self) -> bool {
        self.airframe == other.airframe && self.ground_plane == other.ground_plane
    }
}

impl Plant {
    /// The vehicle in its world. The airframe is not checked: use one of a configuration that
    /// [`CascadeDesign::new`](crate::CascadeDesign::new) accepts.
    pub fn new(airframe: &Airframe, environment: &Environment) -> Self {
        let ground_plane = environment.ground_plane;
        Self {
            airframe: *airframe,
            ground_plane,
            mass: MassProperties::new(airframe),
            rotor_lag: RotorLag::new(airframe),
            rotor_map: RotorMap::new(airframe),
            is_plain: airframe.has_static_rotors() && !airframe.drags() && !airframe.battery.sag,
            reach_m: airframe.reach_m(),
            calmness: Calmness::new(airframe),
            #[cfg(feature = "fleet")]
            likeness: likeness(airframe, ground_plane),
        }
    }

    /// The vehicle's constants.
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// A number that is equal for plants whose constants are equal bit for bit, and hardly ever for others.
    #[cfg(feature = "fleet")]
    pub(crate) fn likeness(&self) -> u64 {
        self.likeness
    }

    /// Mass and inertia in the equations of motion.
    pub(crate) fn mass(&self) -> &MassProperties {
        &self.mass
    }

    /// Whether there is ground.
    pub(crate) fn has_ground(&self) -> bool {
        self.ground_plane
    }

    /// No foot is farther from the centre of mass, m.
    pub(crate) fn reach_m(&self) -> f64 {
        self.reach_m
    }

    /// f(x, u): the time derivative of the state. It has no memory, so that any integrator can use it. Where a foot comes to the
    /// ground with a vertical speed it jumps; its slope jumps where a foot begins to slip fast, where a rotor with different
    /// lags meets its command, where the ground effect or the thrust of a rotor reaches a bound, and at the knee and the end of
    /// the battery's charge and at its greatest power. [`Plant::derivative_in`] is smooth between [events](Plant::event).
    ///
    /// Static friction is not in it: on the ground it has sliding friction only, so that a vehicle in a wind creeps.
    /// [`Plant::step`] adds the rule that holds it still.
    pub fn derivative<T: Valued>(&self, state: &PlantState<T>, inputs: &PlantInputs<T>) -> PlantState<T> {
        self.forces(state, inputs, &mut ByValue).derivative(&self.mass, state)
    }

    /// All that acts on the plant.
    #[inline(always)]
    pub(crate) fn forces<T: Real>(
        &self,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
        branches: &mut impl Branches<T>,
    ) -> Forces<T> {
        let mut forces = self.loads(state, inputs, branches);
        if self.ground_plane {
            let ground = contact(&self.airframe, &state.body, inputs.ground_z_m, self.reach_m, branches);
            forces.external.force_n += ground.force_n;
            forces.external.torque_n_m += ground.torque_n_m;
        }
        forces
    }

    /// All that acts on the plant but the ground: thrust and torques that drive it, and the rest.
    #[inline(always)]
    pub(crate) fn loads<T: Real>(
        &self,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
        branches: &mut impl Branches<T>,
    ) -> Forces<T> {
        let (airframe, disturbance) = (&self.airframe, &inputs.disturbance);
        let mut external = External { force_n: disturbance.force_n, torque_n_m: disturbance.torque_n_m };
        let speeds_rad_s = &state.rotor_speed_rad_s;
        if let Actuation::RotorSpeeds(command_rad_s) = &inputs.actuation
            && self.is_plain
        {
            // All that is left out is zero.
            let goals_rad_s = goals_rad_s(&inputs.rotor_faults, command_rad_s, speeds_rad_s);
            return Forces {
                wrench: self.rotor_map.wrench(speeds_rad_s),
                external,
                rotor_acceleration_rad_s2: self.rotor_lag.accelerations_rad_s2(&goals_rad_s, speeds_rad_s),
                discharge_per_s: T::zero(),
            };
        }
        if airframe.drags() {
            let drag = airframe.drag(&state.body, &disturbance.wind_m_s);
            external.force_n += drag.force_n;
            external.torque_n_m += drag.torque_n_m;
        }
        let command_rad_s = match &inputs.actuation {
            Actuation::RotorSpeeds(command_rad_s) => command_rad_s,
            Actuation::Wrench(wrench) => return Forces::without_rotors(*wrench, external),
        };
        let (rotor_acceleration_rad_s2, discharge_per_s) =
            self.drive(state, command_rad_s, &inputs.rotor_faults, branches);
        let ground_z_m = self.ground_plane.then_some(inputs.ground_z_m);
        let around = Surroundings { wind_m_s: disturbance.wind_m_s, ground_z_m };
        let RotorForces { wrench, lateral_n } =
            RotorForces::new((airframe, &self.rotor_map), state, &around, branches);
        if airframe.rotor_aerodynamics.drags() {
            external.force_n += state.body.orientation().in_world(&lateral_n);
        }
        if airframe.rotor_spin.inertia_kg_m2 > 0.0 {
            external.torque_n_m += airframe.spin_torque_n_m(
                &state.body.body_rate_rad_s,
                speeds_rad_s,
                &rotor_acceleration_rad_s2,
            );
        }
        Forces { wrench, external, rotor_acceleration_rad_s2, discharge_per_s }
    }

    /// Accelerations of the rotors, rad/s², ω̇ = (ω_goal − ω) / τ as far as they are sound, and the share of the battery's charge
    /// that is drawn per second.
    #[inline(always)]
    fn drive<T: Real>(
        &self,
        state: &PlantState<T>,
        command_rad_s: &[T; 4],
        faults: &[Option<RotorFault>; 4],
        branches: &mut impl Branches<T>,
    ) -> ([T; 4], T) {
        let (mut command_rad_s, mut discharge_per_s) = (*command_rad_s, T::zero());
        let pack = &self.airframe.battery;
        if pack.sag {
            let power_w = self.airframe.electric_power_w(&state.rotor_speed_rad_s);
            let battery = pack.output_in(power_w, state.discharge, branches);
            let share = pack.speed_share(battery.voltage_v);
            command_rad_s = command_rad_s.map(|command| command * share);
            discharge_per_s = battery.current_a / pack.capacity_a_s;
        }
        let goals_rad_s = goals_rad_s(faults, &command_rad_s, &state.rotor_speed_rad_s);
        (self.rotor_lag.accelerations_rad_s2(&goals_rad_s, &state.rotor_speed_rad_s), discharge_per_s)
    }

    /// One step of the classical fourth-order Runge–Kutta method over `h_s` seconds. The ground is stiff: 1 ms resolves it. In the air, 5 ms
    /// are as good if all motions are slower than that.
    ///
    /// Static friction is decided at the beginning of the step. A vehicle that stands on all feet, slips by less than
    /// 0.1 m/s, and is pulled along the ground by less than μ N (μ = 0.7) keeps its place and heading exactly, while it may
    /// still sink or tilt on its feet. Pulled by more, it slips. When it hardly moves any more, by 1e-8 m/s, and nothing is about to
    /// move it, it stands still exactly.
    pub fn step<T: Valued>(&self, state: &PlantState<T>, inputs: &PlantInputs<T>, h_s: f64) -> PlantState<T> {
        if !self.is_held(state, inputs) {
            return runge_kutta(state, h_s, |state| self.derivative(state, inputs));
        }
        let mut from = *state;
        hold(&mut from);
        if let Some(still) = self.stopped(&from, inputs) {
            return still;
        }
        runge_kutta(&from, h_s, |state| held(self.derivative(state, inputs)))
    }

    /// Begins a step of any length.
    pub(crate) fn begin_step(&self, state: &PlantState, inputs: &PlantInputs) -> BegunStep {
        if !self.is_held(state, inputs) {
            return BegunStep::Free { from: *state, slope: self.derivative(state, inputs) };
        }
        let mut from = *state;
        hold(&mut from);
        match self.stopped(&from, inputs) {
            Some(still) => BegunStep::Still(still),
            None => BegunStep::Held { from, slope: held(self.derivative(&from, inputs)) },
        }
    }

    /// Ends a step so many seconds after its beginning: where [`Plant::step`] leads, bit for bit.
    pub(crate) fn end_step(&self, begun: &BegunStep, inputs: &PlantInputs, h_s: f64) -> PlantState {
        match begun {
            BegunStep::Free { from, slope } => {
                runge_kutta_from(from, slope, h_s, |state| self.derivative(state, inputs))
            }
            BegunStep::Held { from, slope } => {
                runge_kutta_from(from, slope, h_s, |state| held(self.derivative(state, inputs)))
            }
            BegunStep::Still(state) => *state,
        }
    }

    /// Whether a step of any length leads to where it begins: the vehicle stands still on the ground.
    pub(crate) fn stands_still(&self, state: &PlantState, inputs: &PlantInputs) -> bool {
        let body = &state.body;
        body.velocity_m_s == Vector3::zeros()
            && body.body_rate_rad_s == Vector3::zeros()
            && matches!(self.begin_step(state, inputs), BegunStep::Still(_))
    }

    /// Where what is held stands still, if it hardly moves and would hardly begin to. It stays there: the same is found there again.
    fn stopped<T: Valued>(
        &self,
        held_state: &PlantState<T>,
        inputs: &PlantInputs<T>,
    ) -> Option<PlantState<T>> {
        let below = |vector: &Vector3<T>, most: f64| vector.iter().all(|x| libm::fabs(x.value()) <= most);
        let body = &held_state.body;
        if !(below(&body.velocity_m_s, CREEPS) && below(&body.body_rate_rad_s, CREEPS)) {
            return None;
        }
        let mut still = *held_state;
        still.body.velocity_m_s.fill(T::zero());
        still.body.body_rate_rad_s.fill(T::zero());
        let slope = held(self.derivative(&still, inputs));
        let stays = below(&slope.body.velocity_m_s, STIRS)
            && below(&slope.body.body_rate_rad_s, STIRS)
            && slope.rotor_speed_rad_s.iter().all(|rate| libm::fabs(rate.value()) <= STIRS)
            && slope.discharge.value() == 0.0;
        stays.then_some(still)
    }

    /// Whether static friction holds the vehicle where it is.
    pub(crate) fn is_held<T: Valued>(&self, state: &PlantState<T>, inputs: &PlantInputs<T>) -> bool {
        if !self.ground_plane || cannot_be_held(&state.body, inputs.ground_z_m.value(), self.reach_m) {
            return false;
        }
        let (state, inputs) = (state.zip_map(state, |x, _| x.value()), inputs.values());
        self.holding_margins(&state, &inputs).is_held()
    }

    /// How far static friction is from letting the vehicle go, or from holding it.
    pub(crate) fn holding_margins(&self, state: &PlantState, inputs: &PlantInputs) -> HoldingMargins {
        // What it would be pulled by at rest.
        let mut still = *state;
        hold(&mut still);
        let Forces { wrench, external: mut pull, .. } = self.loads(&still, inputs, &mut ByValue);
        let thrust_n = Vector3::new(0.0, 0.0, -wrench.thrust_n);
        pull.force_n += still.body.orientation().in_world(&thrust_n);
        pull.torque_n_m += wrench.torque_n_m;
        HoldingMargins::new(&self.airframe, &state.body, inputs.ground_z_m, &pull)
    }
}

/// Stops the motion along the ground, or its change.
pub(crate) fn hold<T: Real>(state: &mut PlantState<T>) {
    let body = &mut state.body;
    (body.velocity_m_s.x, body.velocity_m_s.y, body.body_rate_rad_s.z) = (T::zero(), T::zero(), T::zero());
}

/// The derivative of what is held.
pub(crate) fn held<T: Real>(mut derivative: PlantState<T>) -> PlantState<T> {
    (derivative.body.position_m.x, derivative.body.position_m.y) = (T::zero(), T::zero());
    hold(&mut derivative);
    derivative
}

/// A step of the classical fourth-order Runge–Kutta method.
#[inline(always)]
pub(crate) fn runge_kutta<T: Real>(
    state: &PlantState<T>,
    h_s: f64,
    mut f: impl FnMut(&PlantState<T>) -> PlantState<T>,
) -> PlantState<T> {
    let k1 = f(state);
    runge_kutta_from(state, &k1, h_s, f)
}

/// The same from a known k₁ = f(x).
#[inline(always)]
fn runge_kutta_from<T: Real>(
    state: &PlantState<T>,
    k1: &PlantState<T>,
    h_s: f64,
    mut f: impl FnMut(&PlantState<T>) -> PlantState<T>,
) -> PlantState<T> {
    let k2 = f(&state.plus(k1, h_s / 2.0));
    let k3 = f(&state.plus(&k2, h_s / 2.0));
    let k4 = f(&state.plus(&k3, h_s));
    // x + h/6 (k₁ + 2 (k₂ + k₃) + k₄)
    let ends = k1.zip_map(&k4, |first, last| first + last);
    let middle = k2.zip_map(&k3, |second, third| second + third);
    state.plus(&ends.zip_map(&middle, |ends, middle| ends + (middle + middle)), h_s / 6.0).normalized()
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{BegunStep, STIRS};
    use crate::{
        Airframe, AirframePreset, Environment, GRAVITY_M_S2, InitialState, Plant, PlantInputs, PlantState,
    };

    /// In the air, sliding on the ground and held by it: the same as steps that begin by themselves, bit for bit.
    #[test]
    fn a_step_that_was_begun_once_ends_anywhere() {
        let airframe = Airframe::default();
        let plant = Plant::new(&airframe, &Environment { ground_plane: true });
        for (height_m, velocity_m_s, share, is_held) in
            [(10.0, 3.0, 1.1, false), (0.0, 3.0, 0.2, false), (-0.002, 0.0, 0.2, true)]
        {
            let initial = InitialState {
                position_m: [1.0, -2.0, -height_m],
                velocity_m_s: [velocity_m_s, 0.0, 0.0],
                ..InitialState::default()
            };
            let state = PlantState::hovering(&initial, &airframe);
            let [a, b, c, d] = state.rotor_speed_rad_s.map(|speed| share * speed);
            let mut state = PlantState { rotor_speed_rad_s: [a, b, c, d], ..state };
            state.discharge = 0.1;
            let inputs = PlantInputs::rotor_speeds([1.1 * a, b, 0.9 * c, d]);
            let begun = plant.begin_step(&state, &inputs);
            assert_eq!(matches!(begun, BegunStep::Held { .. }), is_held, "{height_m}");
            for h_s in [0.001, 0.0025, 0.005] {
                assert_eq!(plant.end_step(&begun, &inputs, h_s), plant.step(&state, &inputs, h_s));
            }
        }
    }

    /// Down from a tilted start, its rotors running down: it stands still within two seconds, as deep as its springs carry its weight
    /// (z = g/ω² with ω = 50 rad/s), level, and there every step ends where it begins. A push that friction holds
    /// does not move it; a slow rotor, half of the weight from above, or a push of the whole weight does.
    #[test]
    fn what_has_come_to_rest_on_the_ground_stands_still() {
        for preset in AirframePreset::ALL {
            let airframe = preset.airframe();
            let plant = Plant::new(&airframe, &Environment { ground_plane: true });
            let initial = InitialState {
                position_m: [1.0, -2.0, -0.02],
                attitude_rad: [0.02, -0.01, 0.7],
                ..InitialState::default()
            };
            let mut state = PlantState::at_rest(&initial);
            state.rotor_speed_rad_s = [0.3 * airframe.hover_rotor_speed_rad_s(); 4];
            let inputs = PlantInputs::default();
            let is_still = |state: &PlantState, inputs: &PlantInputs| {
                matches!(plant.begin_step(state, inputs), BegunStep::Still(_))
            };
            let steps = (0..2_000).find(|_| {
                let was_still = is_still(&state, &inputs);
                state = plant.step(&state, &inputs, 1e-3);
                was_still
            });
            assert!(steps.is_some(), "{}", preset.name());
            assert!((state.body.position_m.z - GRAVITY_M_S2 / 2500.0).abs() < 1e-9, "{state:?}");
            assert!(state.body.down_axis().0.xy().norm() < 1e-9, "level");
            assert!(state.rotor_speed_rad_s.iter().all(|speed| speed.abs() < STIRS), "{state:?}");
            assert!(plant.stands_still(&state, &inputs));
            assert_eq!(plant.is_calm(&state, &inputs), plant.calmness.is_some(), "long steps are as good");
            for h_s in [1e-3, 5e-3] {
                assert_eq!(plant.step(&state, &inputs, h_s), state);
                assert_eq!(plant.end_step(&plant.begin_step(&state, &inputs), &inputs, h_s), state);
            }
            let weight_n = airframe.weight_n();
            let pushed = |force_n: Vector3<f64>| {
                let mut inputs = inputs;
                inputs.disturbance.force_n = force_n;
                inputs
            };
            assert!(is_still(&state, &pushed(Vector3::new(0.3 * weight_n, 0.0, 0.0))), "friction holds it");
            assert!(!is_still(&state, &pushed(Vector3::new(0.0, 0.0, 0.5 * weight_n))), "pressed down");
            assert!(!is_still(&state, &pushed(Vector3::new(weight_n, 0.0, 0.0))), "it slips");
            let [_, two, three, four] = [0.1 * airframe.hover_rotor_speed_rad_s(); 4];
            assert!(!is_still(&state, &PlantInputs::rotor_speeds([0.0, two, three, four])), "rotors start");
        }
    }
}
