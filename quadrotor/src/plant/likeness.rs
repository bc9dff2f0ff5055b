//! Which plants are the same.

use crate::design::design_cache::hashed;
use crate::{Airframe, BatteryPack, Rotor, RotorAerodynamics, RotorSpin};

/// A number that is equal for plants whose constants are equal bit for bit, and hardly ever for others.
pub(crate) fn likeness(airframe: &Airframe, ground_plane: bool) -> u64 {
    let Airframe {
        mass_kg,
        arm_length_m,
        layout,
        inertia_kg_m2,
        products_of_inertia_kg_m2,
        centre_of_gravity_m,
        thrust_coefficient_n_s2,
        torque_coefficient_n_m_s2,
        rotor_speed_min_rad_s,
        rotor_speed_max_rad_s,
        rotor_time_constant_s,
        rotor_spin: RotorSpin { inertia_kg_m2: propeller_kg_m2, fall_time_ratio },
        rotor_aerodynamics,
        drag_n_s_m,
        body_drag_n_s_m,
        battery: BatteryPack { sag, voltage_v, resistance_ohm, capacity_a_s },
    } = airframe;
    let RotorAerodynamics {
        drag_coefficient_n_s2_m,
        inflow_coefficient_n_s2_m,
        translational_lift_coefficient_n_s2_m2,
        radius_m,
        ground_effect,
    } = rotor_aerodynamics;
    let switches = [*sag, *ground_effect, ground_plane].map(u64::from);
    let rotors = layout.rotors.iter().flat_map(|Rotor { x, y, direction }| [*x, *y, direction.torque_sign()]);
    let vectors =
        [inertia_kg_m2, products_of_inertia_kg_m2, centre_of_gravity_m, drag_n_s_m, body_drag_n_s_m];
    let others = [
        *mass_kg,
        *arm_length_m,
        *thrust_coefficient_n_s2,
        *torque_coefficient_n_m_s2,
        *rotor_speed_min_rad_s,
        *rotor_speed_max_rad_s,
        *rotor_time_constant_s,
        *propeller_kg_m2,
        *fall_time_ratio,
        *drag_coefficient_n_s2_m,
        *inflow_coefficient_n_s2_m,
        *translational_lift_coefficient_n_s2_m2,
        *radius_m,
        *voltage_v,
        *resistance_ohm,
        *capacity_a_s,
    ];
    let numbers = rotors.chain(vectors.into_iter().flatten().copied()).chain(others).map(f64::to_bits);
    hashed(numbers.chain(switches))
}

#[cfg(test)]
mod tests {
    use super::likeness;
    use crate::Airframe;

    #[test]
    fn plants_are_alike_when_all_bits_are_equal() {
        let airframe = Airframe::default();
        assert_eq!(likeness(&airframe, true), likeness(&airframe, true));
        assert_ne!(likeness(&airframe, true), likeness(&airframe, false));
        let (mut heavier, mut signed, mut turned) = (airframe, airframe, airframe);
        heavier.mass_kg += 1e-12;
        signed.drag_n_s_m[2] = -0.0;
        turned.layout.rotors.swap(0, 1);
        for other in [heavier, signed, turned] {
            assert_ne!(likeness(&airframe, true), likeness(&other, true));
        }
    }
}
