//! Steps of several vehicles at once.

use core::array::from_fn;

use nalgebra::Vector3;

use crate::plant::dynamics::runge_kutta;
use crate::plant::ground::cannot_be_held;
use crate::plant::lanes::{LANES, Lanes, Unanimous};
use crate::{Actuation, Disturbance, Plant, PlantInputs, PlantState};

impl Plant {
    /// A step of several vehicles of this plant, each as [`Plant::step`] takes it, bit for bit. `None` if their equations differ: vehicles with
    /// different faults, on the ground, or on different sides of a branch, step one by one.
    pub(crate) fn step_side_by_side(
        &self,
        states: &[PlantState; LANES],
        inputs: &[PlantInputs; LANES],
        h_s: f64,
    ) -> Option<[PlantState; LANES]> {
        let mut flown = states.iter().zip(inputs);
        let is_clear = |(state, inputs): (&PlantState, &PlantInputs)| {
            cannot_be_held(&state.body, inputs.ground_z_m, self.reach_m())
        };
        if self.has_ground() && !flown.all(is_clear) {
            return None;
        }
        let (inputs, mut branches) = (gathered_inputs(inputs)?, Unanimous::new());
        let reached = runge_kutta(&gathered(states), h_s, |state| {
            self.forces(state, &inputs, &mut branches).derivative(self.mass(), state)
        });
        branches.have_agreed().then(|| scattered(&reached))
    }
}

/// States of vehicles, number by number.
#[inline(always)]
fn gathered(states: &[PlantState; LANES]) -> PlantState<Lanes> {
    let numbers = states.map(|state| state.to_array());
    PlantState::from_array(from_fn(|number| Lanes::new(from_fn(|lane| numbers[lane][number]))))
}

/// The states of each vehicle.
#[inline(always)]
fn scattered(states: &PlantState<Lanes>) -> [PlantState; LANES] {
    let numbers = states.to_array().map(Lanes::numbers);
    from_fn(|lane| PlantState::from_array(from_fn(|number| numbers[number][lane])))
}

/// Inputs of vehicles, number by number, if rotors with the same faults drive all of them.
#[inline(always)]
fn gathered_inputs(inputs: &[PlantInputs; LANES]) -> Option<PlantInputs<Lanes>> {
    let rotor_faults = inputs[0].rotor_faults;
    let mut commands_rad_s = [[0.0; LANES]; 4];
    for (lane, inputs) in inputs.iter().enumerate() {
        let Actuation::RotorSpeeds(command_rad_s) = inputs.actuation else { return None };
        if inputs.rotor_faults != rotor_faults {
            return None;
        }
        for (commands_rad_s, command_rad_s) in commands_rad_s.iter_mut().zip(command_rad_s) {
            commands_rad_s[lane] = command_rad_s;
        }
    }
    let vectors = |of: fn(&Disturbance) -> &Vector3<f64>| {
        Vector3::from_fn(|axis, _| Lanes::new(from_fn(|lane| of(&inputs[lane].disturbance)[axis])))
    };
    Some(PlantInputs {
        actuation: Actuation::RotorSpeeds(commands_rad_s.map(Lanes::new)),
        disturbance: Disturbance {
            force_n: vectors(|disturbance| &disturbance.force_n),
            torque_n_m: vectors(|disturbance| &disturbance.torque_n_m),
            wind_m_s: vectors(|disturbance| &disturbance.wind_m_s),
        },
        rotor_faults,
        ground_z_m: Lanes::new(from_fn(|lane| inputs[lane].ground_z_m)),
    })
}

#[cfg(test)]
#[path = "../../tests/suite/common/physics.rs"]
mod physics;

#[cfg(test)]
mod tests {
    use core::array::from_fn;

    use nalgebra::{UnitQuaternion, Vector3};
    use proptest::prelude::*;

    use super::physics::all_physics;
    use crate::plant::lanes::LANES;
    use crate::{Airframe, Disturbance, Environment, Plant, PlantInputs, PlantState, RigidBody, RotorFault};

    prop_compose! {
        fn state(height_m: f64)(
            position in prop::array::uniform3(-1.0..1.0), velocity in prop::array::uniform3(-4.0..4.0),
            angles in prop::array::uniform3(-1.2..1.2), rate in prop::array::uniform3(-3.0..3.0),
            rotor_speed_rad_s in prop::array::uniform4(0.0..450.0), discharge in 0.0..0.8,
        ) -> PlantState {
            PlantState {
                body: RigidBody {
                    position_m: Vector3::from(position) - Vector3::z() * height_m,
                    velocity_m_s: velocity.into(),
                    attitude: UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]).into_inner(),
                    body_rate_rad_s: rate.into(),
                },
                rotor_speed_rad_s,
                discharge,
            }
        }
    }

    prop_compose! {
        fn inputs()(
            command_rad_s in prop::array::uniform4(0.0..450.0), force in prop::array::uniform3(-2.0..2.0),
            torque in prop::array::uniform3(-0.1..0.1), wind in prop::array::uniform3(-5.0..5.0),
            ground_z_m in -0.5..0.5,
        ) -> PlantInputs {
            let disturbance =
                Disturbance { force_n: force.into(), torque_n_m: torque.into(), wind_m_s: wind.into() };
            PlantInputs { disturbance, ground_z_m, ..PlantInputs::rotor_speeds(command_rad_s) }
        }
    }

    fn bits(state: &PlantState) -> [u64; PlantState::LEN] {
        state.to_array().map(f64::to_bits)
    }

    /// Steps all at once, and compares with steps of each. Whether they could.
    fn step_together(plant: &Plant, states: &[PlantState; LANES], inputs: &[PlantInputs; LANES]) -> bool {
        let Some(together) = plant.step_side_by_side(states, inputs, 1e-3) else { return false };
        let alone: [PlantState; LANES] = from_fn(|lane| plant.step(&states[lane], &inputs[lane], 1e-3));
        assert_eq!(together.map(|state| bits(&state)), alone.map(|state| bits(&state)));
        true
    }

    fn plant(physics: bool, ground_plane: bool) -> Plant {
        let airframe = if physics { all_physics() } else { Airframe::default() };
        Plant::new(&airframe, &Environment { ground_plane })
    }

    proptest! {
        /// In the air vehicles step at once, and have the doubles that each has alone.
        #[test]
        fn vehicles_in_the_air_step_at_once(
            states in prop::array::uniform4(state(3.0)), inputs in prop::array::uniform4(inputs()),
            physics in any::<bool>(), ground_plane in any::<bool>(), fault in any::<bool>(),
        ) {
            let mut inputs = inputs;
            if fault {
                inputs.iter_mut().for_each(|inputs| inputs.rotor_faults[2] = Some(RotorFault::Weak { share: 0.7 }));
            }
            let together = step_together(&plant(physics, ground_plane), &states, &inputs);
            // The air may bound the thrust of one vehicle's rotor and not of another's.
            prop_assert!(together || physics);
        }

        /// Close to the ground some stand on it and some do not.
        #[test]
        fn vehicles_at_the_ground_step_at_once_only_as_they_would_alone(
            states in prop::array::uniform4(state(0.0)), inputs in prop::array::uniform4(inputs()),
            physics in any::<bool>(),
        ) {
            step_together(&plant(physics, true), &states, &inputs);
        }
    }

    /// Slow flight in a breeze with everything that acts on a vehicle, but on the same sides of all branches.
    #[test]
    fn all_physics_step_at_once() {
        let initial = crate::InitialState { position_m: [0.0, 0.0, -1.0], ..crate::InitialState::default() };
        let states = from_fn(|lane| {
            let mut state = PlantState::hovering(&initial, &all_physics());
            state.body.velocity_m_s = Vector3::new(0.5, -0.2, 0.1) * lane as f64;
            state.body.body_rate_rad_s = Vector3::new(0.1, 0.3, -0.2) * lane as f64;
            state
        });
        let inputs = from_fn(|lane| PlantInputs::rotor_speeds([240.0, 250.0, 260.0, 255.0 + lane as f64]));
        assert!(step_together(&plant(true, true), &states, &inputs));
    }

    #[test]
    fn vehicles_with_different_equations_step_one_by_one() {
        let aloft = crate::InitialState { position_m: [0.0, 0.0, -5.0], ..crate::InitialState::default() };
        let states = [PlantState::hovering(&aloft, &Airframe::default()); LANES];
        let mut inputs = [PlantInputs::default(); LANES];
        inputs[1].rotor_faults[0] = Some(RotorFault::Off);
        assert!(plant(false, true).step_side_by_side(&states, &inputs, 1e-3).is_none());
        inputs[1] = PlantInputs::wrench(crate::Wrench::default());
        assert!(plant(false, true).step_side_by_side(&states, &inputs, 1e-3).is_none());
        let mut landed = states;
        landed[3].body.position_m.z = 0.004;
        assert!(
            plant(false, true).step_side_by_side(&landed, &[PlantInputs::default(); LANES], 1e-3).is_none()
        );
    }
}
