//! An airframe with all optional physics.

use quadrotor::{Airframe, BatteryPack, RotorAerodynamics, RotorSpin};

/// Every term that the default leaves out.
pub fn all_physics() -> Airframe {
    Airframe {
        inertia_kg_m2: [0.1, 0.11, 0.18],
        products_of_inertia_kg_m2: [0.004, -0.006, 0.003],
        centre_of_gravity_m: [0.01, -0.02, 0.03],
        rotor_spin: RotorSpin { inertia_kg_m2: 1e-4, fall_time_ratio: 2.0 },
        rotor_aerodynamics: RotorAerodynamics {
            drag_coefficient_n_s2_m: 1e-4,
            inflow_coefficient_n_s2_m: 2e-4,
            translational_lift_coefficient_n_s2_m2: 3e-3,
            ground_effect: true,
            ..RotorAerodynamics::default()
        },
        drag_n_s_m: [0.1, 0.2, 0.3],
        body_drag_n_s_m: [0.05, 0.04, 0.1],
        battery: BatteryPack { sag: true, resistance_ohm: 0.15, ..BatteryPack::default() },
        ..Airframe::default()
    }
}
