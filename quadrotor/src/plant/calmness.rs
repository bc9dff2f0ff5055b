//! Whether a plant moves so calmly that a long step integrates it as well as short ones.

use nalgebra::Vector3;

use crate::plant::ground::is_farther_than;
use crate::plant::plant_inputs::{Actuation, PlantInputs};
use crate::plant::plant_state::PlantState;
use crate::schedule::LONG_STEP_S;
use crate::{Airframe, Plant};

/// Fastest rate of a part of the plant for itself, 1/s, that long steps integrate: then a step takes a quarter of its time constant, and
/// leaves 8e-6 of a jump as an error.
const FASTEST_1_S: f64 = 0.25 / LONG_STEP_S;
/// Fastest body rate in calm flight, rad/s: a tenth of a radian in a long step.
const TURNS_RAD_S: f64 = 20.0;
/// Fastest motion and wind in calm flight, m/s.
const MOVES_M_S: f64 = 100.0;
/// Largest acceleration by a force, m/s², and by a torque, rad/s², from outside in calm flight.
const PUSHED_M_S2: f64 = 100.0;
const TURNED_RAD_S2: f64 = 1_000.0;
/// By how much a vertical speed may grow in a long step, m/s.
const MORE_M_S: f64 = 0.5;
/// How much faster than by its airframe a rotor may turn in calm flight.
const FASTER: f64 = 1.5;

/// What a plant and its inputs keep to in calm flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Calmness {
    force_n: f64,
    torque_n_m: f64,
    rotor_rad_s: f64,
}

impl Calmness {
    /// Of an airframe; `None` if parts of it react too fast.
    pub(crate) fn new(airframe: &Airframe) -> Option<Self> {
        let [smallest_kg_m2, ..] = airframe.principal_moments_kg_m2();
        let lag_s = airframe.lag_s(0.0, 1.0).min(airframe.lag_s(1.0, 0.0));
        let fastest_rad_s = airframe.rotor_speed_max_rad_s;
        let aerodynamics = &airframe.rotor_aerodynamics;
        let of_rotors_n_s_m = 4.0
            * fastest_rad_s
            * aerodynamics.drag_coefficient_n_s2_m.max(aerodynamics.inflow_coefficient_n_s2_m);
        let largest = |of_axes: &[f64; 3]| of_axes.iter().fold(0.0, |most: f64, one| most.max(*one));
        let drag_n_s_m = largest(&airframe.drag_n_s_m) + largest(&airframe.body_drag_n_s_m) + of_rotors_n_s_m;
        // Two rotors that turn one way, against none that turn the other way.
        let gyroscopic_1_s = 2.0 * airframe.rotor_spin.inertia_kg_m2 * fastest_rad_s / smallest_kg_m2;
        let fastest_1_s = (1.0 / lag_s).max(drag_n_s_m / airframe.mass_kg).max(gyroscopic_1_s);
        (fastest_1_s <= FASTEST_1_S).then_some(Self {
            force_n: PUSHED_M_S2 * airframe.mass_kg,
            torque_n_m: TURNED_RAD_S2 * smallest_kg_m2,
            rotor_rad_s: FASTER * fastest_rad_s,
        })
    }
}

impl Plant {
    /// Whether a long step from this state under these inputs is as good as short ones: it turns and moves at ordinary speeds, nothing
    /// extraordinary acts on it, and it stays away from the stiff ground, or stands still on it. What is calm cannot leave the range of
    /// numbers within a long step.
    pub(crate) fn is_calm(&self, state: &PlantState, inputs: &PlantInputs) -> bool {
        let Some(Calmness { force_n, torque_n_m, rotor_rad_s }) = self.calmness else { return false };
        let Actuation::RotorSpeeds(command_rad_s) = &inputs.actuation else { return false };
        let (body, disturbance) = (&state.body, &inputs.disturbance);
        let within = |vector: &Vector3<f64>, most: f64| vector.norm_squared() <= most * most;
        let turn = |speeds: &[f64; 4]| speeds.iter().all(|speed| libm::fabs(*speed) <= rotor_rad_s);
        let falls_m = LONG_STEP_S * (body.velocity_m_s.z.max(0.0) + MORE_M_S);
        within(&body.body_rate_rad_s, TURNS_RAD_S)
            && within(&body.velocity_m_s, MOVES_M_S)
            && within(&disturbance.force_n, force_n)
            && within(&disturbance.torque_n_m, torque_n_m)
            && within(&disturbance.wind_m_s, MOVES_M_S)
            && turn(command_rad_s)
            && turn(&state.rotor_speed_rad_s)
            && (!self.has_ground()
                || is_farther_than(falls_m, body, inputs.ground_z_m, self.reach_m())
                || self.stands_still(state, inputs))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use crate::schedule::LONG_STEP_S;
    use crate::{
        Airframe, Environment, InitialState, Plant, PlantInputs, PlantState, RotorAerodynamics, RotorSpin,
        Wrench,
    };

    /// Five metres above the ground, on its way, with rotors that carry it.
    fn flight() -> (Plant, PlantState, PlantInputs) {
        let airframe = Airframe::default();
        let initial = InitialState {
            position_m: [1.0, 2.0, -5.0],
            velocity_m_s: [3.0, -2.0, 1.0],
            attitude_rad: [0.2, -0.3, 0.4],
            body_rate_rad_s: [1.0, -2.0, 0.5],
            ..InitialState::default()
        };
        let state = PlantState::hovering(&initial, &airframe);
        let [a, b, c, d] = state.rotor_speed_rad_s;
        let inputs = PlantInputs::rotor_speeds([1.1 * a, 0.9 * b, c, 1.2 * d]);
        (Plant::new(&airframe, &Environment { ground_plane: true }), state, inputs)
    }

    #[test]
    fn a_calm_long_step_is_as_good_as_many_short_ones() {
        let (plant, state, inputs) = flight();
        assert!(plant.is_calm(&state, &inputs));
        let long = plant.step(&state, &inputs, LONG_STEP_S);
        let short = (0..50).fold(state, |state, _| plant.step(&state, &inputs, LONG_STEP_S / 50.0));
        for (long, short) in long.to_array().into_iter().zip(short.to_array()) {
            assert!((long - short).abs() < 1e-6 * (1.0 + short.abs()), "{long} beside {short}");
        }
    }

    #[test]
    fn what_turns_moves_or_is_pushed_too_fast_is_not_calm() {
        let (plant, calm, inputs) = flight();
        let changed = |change: fn(&mut PlantState)| {
            let mut state = calm;
            change(&mut state);
            plant.is_calm(&state, &inputs)
        };
        assert!(!changed(|state| state.body.body_rate_rad_s.y = 21.0));
        assert!(!changed(|state| state.body.velocity_m_s.x = 101.0));
        assert!(!changed(|state| state.rotor_speed_rad_s[2] = 1e5));
        assert!(!changed(|state| state.body.velocity_m_s.y = f64::NAN));
        let under = |change: fn(&mut PlantInputs)| {
            let mut inputs = inputs;
            change(&mut inputs);
            plant.is_calm(&calm, &inputs)
        };
        assert!(!under(|inputs| inputs.disturbance.force_n.z = 1e4));
        assert!(!under(|inputs| inputs.disturbance.torque_n_m.x = -1e3));
        assert!(!under(|inputs| inputs.disturbance.wind_m_s.x = 1e3));
        assert!(!under(|inputs| *inputs = PlantInputs::rotor_speeds([1e6, 0.0, 0.0, 0.0])));
        assert!(!under(|inputs| *inputs = PlantInputs::wrench(Wrench::default())));
    }

    /// At 1 m/s down and at most 0.5 m/s more, 5 ms are 7.5 mm.
    #[test]
    fn near_the_ground_it_is_not_calm() {
        let (plant, mut state, mut inputs) = flight();
        let reach_m = plant.reach_m();
        state.body.position_m.z = -reach_m - 0.0076;
        assert!(plant.is_calm(&state, &inputs));
        state.body.position_m.z = -reach_m - 0.0074;
        assert!(!plant.is_calm(&state, &inputs));
        inputs.ground_z_m = 0.001;
        assert!(plant.is_calm(&state, &inputs));
        let nowhere = Environment { ground_plane: false };
        assert!(
            Plant::new(plant.airframe(), &nowhere)
                .is_calm(&state, &PlantInputs { ground_z_m: 0.0, ..inputs })
        );
    }

    #[test]
    fn fast_parts_are_never_calm() {
        let (_, state, inputs) = flight();
        let calm =
            |airframe: &Airframe| Plant::new(airframe, &Environment::default()).is_calm(&state, &inputs);
        let airframe = Airframe::default();
        let lag = |rotor_time_constant_s| Airframe { rotor_time_constant_s, ..airframe };
        assert!(calm(&lag(0.0201)) && !calm(&lag(0.0199)));
        let spin = |fall_time_ratio, inertia_kg_m2| RotorSpin { fall_time_ratio, inertia_kg_m2 };
        assert!(!calm(&Airframe { rotor_spin: spin(0.5, 0.0), ..airframe }), "15 ms when it falls");
        assert!(!calm(&Airframe { rotor_spin: spin(1.0, 0.1), ..airframe }));
        assert!(!calm(&Airframe {
            drag_n_s_m: Vector3::new(0.0, 0.0, 51.0 * airframe.mass_kg).into(),
            ..airframe
        }));
        let inflow = RotorAerodynamics { inflow_coefficient_n_s2_m: 0.02, ..airframe.rotor_aerodynamics };
        assert!(!calm(&Airframe { rotor_aerodynamics: inflow, ..airframe }));
    }
}
