//! What the rotors do to the body: (1), or more than that when the air or an offset centre of gravity matters.

use nalgebra::Vector3;

use crate::plant::differentiation::real::{Real, constant};
use crate::plant::events::branches::Branches;
use crate::plant::rotor_map::RotorMap;
use crate::{Airframe, PlantState, Wrench};

/// Forces of all rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RotorForces<T> {
    /// Thrust along the rotors' axis, and all torques about the centre of mass.
    pub(crate) wrench: Wrench<T>,
    /// Force in the plane of the rotors, FRD, N: their drag.
    pub(crate) lateral_n: Vector3<T>,
}

/// The air around the rotors and the ground below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surroundings<T> {
    /// NED, m/s.
    pub(crate) wind_m_s: Vector3<T>,
    /// z of the ground, NED, m, if there is any.
    pub(crate) ground_z_m: Option<T>,
}

impl<T: Real> RotorForces<T> {
    /// Of the rotors of a plant in this state.
    #[inline(always)]
    pub(crate) fn new(
        (airframe, map): (&Airframe, &RotorMap),
        state: &PlantState<T>,
        around: &Surroundings<T>,
        branches: &mut impl Branches<T>,
    ) -> Self {
        if airframe.is_centred() && airframe.rotor_aerodynamics.is_static() {
            return Self { wrench: map.wrench(&state.rotor_speed_rad_s), lateral_n: Vector3::zeros() };
        }
        Self::of_each(airframe, state, around, branches)
    }

    /// The same, rotor by rotor: with what the air does to each of them, about a centre of mass that may be anywhere.
    fn of_each(
        airframe: &Airframe,
        state: &PlantState<T>,
        around: &Surroundings<T>,
        branches: &mut impl Branches<T>,
    ) -> Self {
        let (k1, k2) = (airframe.thrust_coefficient_n_s2, airframe.torque_coefficient_n_m_s2);
        let aerodynamics = &airframe.rotor_aerodynamics;
        let body = &state.body;
        let orientation = body.orientation();
        let upright = orientation.in_world(&Vector3::z()).z;
        let airspeed = orientation.in_body(&(body.velocity_m_s - around.wind_m_s));
        let mut total = Self { wrench: Wrench::default(), lateral_n: Vector3::zeros() };
        let rotors = airframe.layout.rotors.iter().zip(airframe.rotor_places_m());
        for (index, (rotor, place)) in rotors.enumerate() {
            let (place, speed) = (constant(place), state.rotor_speed_rad_s[index]);
            let air = airspeed + body.body_rate_rad_s.cross(&place);
            let lateral_m2_s2 = air.x * air.x + air.y * air.y;
            let mut thrust_n =
                aerodynamics.thrust_n(index, [speed * k1 * speed, speed, -air.z, lateral_m2_s2], branches);
            if let Some(ground_z_m) = around.ground_z_m {
                let height_m = -(body.position_m.z - ground_z_m + orientation.in_world(&place).z);
                let there = [thrust_n, height_m, upright, lateral_m2_s2];
                thrust_n *= aerodynamics.ground_ratio(index, there, branches);
            }
            let drag = speed * -aerodynamics.drag_coefficient_n_s2_m;
            let lateral_n = Vector3::new(drag * air.x, drag * air.y, T::zero());
            total.wrench.thrust_n += thrust_n;
            total.wrench.torque_n_m += place.cross(&(lateral_n - Vector3::z() * thrust_n));
            total.wrench.torque_n_m.z += speed * (rotor.direction.torque_sign() * k2) * speed;
            total.lateral_n += lateral_n;
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::{RotorForces, Surroundings};
    use crate::plant::events::branches::ByValue;
    use crate::plant::rotor_map::RotorMap;
    use crate::{Airframe, InitialState, PlantState, RotorAerodynamics, wrench_of_rotors};

    const CALM: Surroundings<f64> =
        Surroundings { wind_m_s: Vector3::new(0.0, 0.0, 0.0), ground_z_m: Some(0.0) };

    fn made(airframe: &Airframe, state: &PlantState, around: &Surroundings<f64>) -> RotorForces<f64> {
        RotorForces::new((airframe, &RotorMap::new(airframe)), state, around, &mut ByValue)
    }

    fn state(speeds: [f64; 4], velocity_m_s: [f64; 3]) -> PlantState {
        let initial = InitialState { velocity_m_s, position_m: [0.0, 0.0, -50.0], ..InitialState::default() };
        PlantState { rotor_speed_rad_s: speeds, ..PlantState::at_rest(&initial) }
    }

    fn windmill(aerodynamics: RotorAerodynamics, centre_of_gravity_m: [f64; 3]) -> Airframe {
        Airframe { rotor_aerodynamics: aerodynamics, centre_of_gravity_m, ..Airframe::default() }
    }

    /// The general sum is (1) where nothing but (1) acts.
    #[test]
    fn at_rest_in_still_air_it_is_the_rotor_map() {
        let aerodynamics = RotorAerodynamics {
            drag_coefficient_n_s2_m: 1e-4,
            inflow_coefficient_n_s2_m: 2e-4,
            translational_lift_coefficient_n_s2_m2: 3e-3,
            ..RotorAerodynamics::default()
        };
        let airframe = windmill(aerodynamics, [0.0; 3]);
        let speeds = [310.0, 240.0, 190.0, 280.0];
        let forces = made(&airframe, &state(speeds, [0.0; 3]), &CALM);
        let map = wrench_of_rotors(&airframe, &speeds);
        assert!((forces.wrench.thrust_n - map.thrust_n).abs() < 1e-14);
        assert!((forces.wrench.torque_n_m - map.torque_n_m).norm() < 1e-15);
        assert_eq!(forces.lateral_n.norm(), 0.0);
    }

    /// The torque about another point differs by the moment of the thrust: −c × (−F e₃).
    #[test]
    fn an_offset_centre_of_gravity_shifts_the_moment() {
        let airframe = windmill(RotorAerodynamics::default(), [0.02, -0.03, 0.05]);
        let speeds = [310.0, 240.0, 190.0, 280.0];
        let forces = made(&airframe, &state(speeds, [1.0, 2.0, 3.0]), &CALM);
        let map = wrench_of_rotors(&airframe, &speeds);
        // A thrust behind the centre of mass, which is ahead, pitches down; one on its right rolls to the left.
        let expected = map.torque_n_m + Vector3::new(-0.03, -0.02, 0.0) * map.thrust_n;
        assert!((forces.wrench.torque_n_m - expected).norm() < 1e-14, "{}", forces.wrench.torque_n_m);
        assert!((forces.wrench.thrust_n - map.thrust_n).abs() < 1e-14);
    }

    /// −k_d ΣΩ v in the rotors' plane, at hubs 5 cm above the centre of mass; and Σ k_d Ω l² r brakes a turn.
    #[test]
    fn rotors_drag_in_their_plane() {
        let aerodynamics =
            RotorAerodynamics { drag_coefficient_n_s2_m: 1e-4, ..RotorAerodynamics::default() };
        let airframe = windmill(aerodynamics, [0.0, 0.0, 0.05]);
        let mut moving = state([250.0; 4], [3.0, -4.0, 7.0]);
        let forces = made(&airframe, &moving, &CALM);
        assert!((forces.lateral_n - Vector3::new(-0.3, 0.4, 0.0)).norm() < 1e-15);
        // (0, 0, −0.05) × (−0.3, 0.4, 0)
        assert!((forces.wrench.torque_n_m - Vector3::new(0.02, 0.015, 0.0)).norm() < 1e-15);
        moving = state([250.0; 4], [0.0; 3]);
        moving.body.body_rate_rad_s.z = 2.0;
        let turned = made(&airframe, &moving, &CALM).wrench.torque_n_m;
        assert!((turned - Vector3::new(0.0, 0.0, -0.1 * 0.275 * 0.275 * 2.0)).norm() < 1e-15, "{turned}");
        // In a wind of the same velocity nothing drags, however it leans.
        moving = state([250.0; 4], [3.0, -4.0, 7.0]);
        moving.body.attitude = UnitQuaternion::from_euler_angles(0.4, -0.3, 2.0).into_inner();
        let drifting = Surroundings { wind_m_s: moving.body.velocity_m_s, ground_z_m: None };
        assert_eq!(made(&airframe, &moving, &drifting).lateral_n.norm(), 0.0);
    }

    /// A roll to the right lowers the right rotor: it descends, gains thrust, and damps the roll.
    #[test]
    fn inflow_damps_roll_and_pitch() {
        let aerodynamics =
            RotorAerodynamics { inflow_coefficient_n_s2_m: 2e-4, ..RotorAerodynamics::default() };
        let airframe = windmill(aerodynamics, [0.0; 3]);
        let mut rolling = state([250.0; 4], [0.0; 3]);
        rolling.body.body_rate_rad_s = Vector3::new(2.0, -1.0, 0.0);
        let torque = made(&airframe, &rolling, &CALM).wrench.torque_n_m;
        // Two rotors on each axis: 2 k_z Ω l² p
        let damping = 2.0 * 2e-4 * 250.0 * 0.275 * 0.275;
        assert!((torque - Vector3::new(-2.0 * damping, damping, 0.0)).norm() < 1e-14, "{torque}");
    }

    /// Rolled by 0.2 rad close to the ground, the lower right rotor gains more than the left one: it levels.
    #[test]
    fn the_ground_levels_a_vehicle_that_leans() {
        let aerodynamics = RotorAerodynamics { ground_effect: true, ..RotorAerodynamics::default() };
        let airframe = windmill(aerodynamics, [0.0; 3]);
        let mut low = state([250.0; 4], [0.0; 3]);
        low.body.position_m.z = -0.3;
        low.body.attitude = UnitQuaternion::from_euler_angles(0.2, 0.0, 0.0).into_inner();
        let forces = made(&airframe, &low, &CALM);
        assert!(forces.wrench.torque_n_m.x < -0.005 && forces.wrench.torque_n_m.y.abs() < 1e-15);
        let none = Surroundings { ground_z_m: None, ..CALM };
        assert!(made(&airframe, &low, &none).wrench.torque_n_m.norm() < 1e-15);
    }
}
