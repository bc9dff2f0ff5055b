//! The rotor map (1), both ways, with saturation.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::Airframe;

/// Thrust F along the negative down axis of the body, N, and torques τ_φ, τ_θ, τ_ψ in FRD, N·m.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Wrench {
    /// F, N.
    pub thrust_n: f64,
    /// τ_φ, τ_θ, τ_ψ, N·m.
    pub torque_n_m: Vector3<f64>,
}

/// Thrust and torques of four rotor speeds, rad/s, in the order front, right, back, left: (1).
pub fn wrench_of_rotors(airframe: &Airframe, rotor_speed_rad_s: &[f64; 4]) -> Wrench {
    let (k1, k2, l) =
        (airframe.thrust_coefficient_n_s2, airframe.torque_coefficient_n_m_s2, airframe.arm_length_m);
    let [f, r, b, left] = rotor_speed_rad_s.map(|speed| speed * speed);
    // F = k₁ (ω_f² + ω_r² + ω_b² + ω_l²)
    // τ_φ = l k₁ (ω_l² − ω_r²)
    // τ_θ = l k₁ (ω_f² − ω_b²)
    // τ_ψ = k₂ (−ω_f² + ω_r² − ω_b² + ω_l²)
    Wrench {
        thrust_n: k1 * (f + r + b + left),
        torque_n_m: Vector3::new(l * k1 * (left - r), l * k1 * (f - b), k2 * (-f + r - b + left)),
    }
}

/// The inverse of (1) within the rotors' speed limits.
///
/// What does not fit is given up in this order: the yaw torque first, then the roll and pitch torques
/// together (their direction is kept). The thrust is kept, clamped to what the rotors can do; no rotor
/// pulls backwards.
pub fn rotors_of_wrench(airframe: &Airframe, wanted: &Wrench) -> [f64; 4] {
    let k1 = airframe.thrust_coefficient_n_s2;
    let (weakest, strongest) = airframe.thrust_range_n();
    let (weakest, strongest) = (weakest / 4.0, strongest / 4.0);

    // Thrust of each rotor, front, right, back, left:
    //   F/4 + pitch − yaw,  F/4 − roll + yaw,  F/4 − pitch − yaw,  F/4 + roll + yaw
    let mean = (wanted.thrust_n / 4.0).clamp(weakest, strongest);
    let roll = wanted.torque_n_m.x / (2.0 * airframe.arm_length_m);
    let pitch = wanted.torque_n_m.y / (2.0 * airframe.arm_length_m);
    let yaw = wanted.torque_n_m.z * k1 / (4.0 * airframe.torque_coefficient_n_m_s2);

    let below = mean - weakest;
    let above = strongest - mean;
    let share = tilting_share(roll.abs(), pitch.abs(), (yaw.min(0.0), yaw.max(0.0)), below, above);
    let (roll, pitch) = (share * roll, share * pitch);
    // What is left for yaw: all four rotors within their range. Rounding may cross the two bounds.
    let least = (pitch.abs() - above).max(roll.abs() - below);
    let most = (below - pitch.abs()).min(above - roll.abs());
    let yaw = yaw.min(most).max(least.min(most));

    let thrust = [mean + pitch - yaw, mean - roll + yaw, mean - pitch - yaw, mean + roll + yaw];
    // ω = √(thrust / k₁)
    thrust.map(|newton| libm::sqrt(newton.clamp(weakest, strongest) / k1))
}

/// Largest s ≤ 1 for which s·roll and s·pitch fit together with some share of the yaw, whose thrusts lie
/// between `yaw.0` ≤ 0 and `yaw.1` ≥ 0, when each rotor may lose `below` and gain `above`.
///
/// Yaw must lie between `least` = max(s|pitch| − above, s|roll| − below) and
/// `most` = min(below − s|pitch|, above − s|roll|); each bound here keeps these three intervals in touch.
fn tilting_share(roll: f64, pitch: f64, yaw: (f64, f64), below: f64, above: f64) -> f64 {
    let bounds = [
        (pitch, above + yaw.1),
        (roll, below + yaw.1),
        (pitch, below - yaw.0),
        (roll, above - yaw.0),
        (2.0 * pitch, above + below),
        (2.0 * roll, above + below),
        (pitch + roll, 2.0 * above),
        (pitch + roll, 2.0 * below),
    ];
    bounds.iter().filter(|(size, _)| *size > 0.0).map(|(size, room)| room / size).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::{Wrench, rotors_of_wrench, wrench_of_rotors};
    use crate::Airframe;

    proptest! {
        /// (1) and its inverse agree wherever nothing saturates.
        #[test]
        fn map_and_inverse_agree_inside_the_limits(speeds in prop::array::uniform4(50.0..450.0)) {
            let airframe = Airframe::default();
            let wrench = wrench_of_rotors(&airframe, &speeds);
            let again = rotors_of_wrench(&airframe, &wrench);
            for (speed, repeated) in speeds.iter().zip(again) {
                prop_assert!((speed - repeated).abs() < 1e-6, "{speeds:?} became {again:?}");
            }
        }

        /// Whatever is asked, no rotor leaves its range, the thrust is kept as far as it exists, and the
        /// roll and pitch torques keep their direction.
        #[test]
        fn saturation_gives_up_yaw_then_roll_and_pitch(
            thrust in -50.0..60.0, x in -5.0..5.0, y in -5.0..5.0, z in -2.0..2.0,
        ) {
            let airframe = Airframe::default();
            let (weakest, strongest) = airframe.thrust_range_n();
            let wanted = Wrench { thrust_n: thrust, torque_n_m: Vector3::new(x, y, z) };
            let speeds = rotors_of_wrench(&airframe, &wanted);
            for speed in speeds {
                prop_assert!((50.0 - 1e-9..=450.0 + 1e-9).contains(&speed));
            }
            let made = wrench_of_rotors(&airframe, &speeds);
            prop_assert!((made.thrust_n - thrust.clamp(weakest, strongest)).abs() < 1e-9);

            // Yaw never costs roll and pitch anything.
            let level = Wrench { torque_n_m: Vector3::new(x, y, 0.0), ..wanted };
            let without_yaw = wrench_of_rotors(&airframe, &rotors_of_wrench(&airframe, &level));
            prop_assert!(made.torque_n_m.xy().norm() >= without_yaw.torque_n_m.xy().norm() - 1e-9);
            // Roll and pitch are scaled by one factor in [0, 1].
            let share = made.torque_n_m.xy().norm() / wanted.torque_n_m.xy().norm();
            prop_assert!(share <= 1.0 + 1e-9);
            prop_assert!((made.torque_n_m.xy() - wanted.torque_n_m.xy() * share).norm() < 1e-9);
            // Yaw is never reversed nor exceeded.
            prop_assert!(made.torque_n_m.z * z >= -1e-12 && made.torque_n_m.z.abs() <= z.abs() + 1e-9);
            // Nothing is given up while there is room: some rotor is at a limit, or all is delivered.
            let at_limit = speeds.iter().any(|speed| (speed - 50.0).abs() < 1e-6 || (speed - 450.0).abs() < 1e-6);
            prop_assert!(at_limit || (made.torque_n_m - wanted.torque_n_m).norm() < 1e-9);
        }
    }
}
