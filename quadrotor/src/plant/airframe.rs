//! The vehicle's physical constants.

use nalgebra::{Vector3, Vector4};
use serde::{Deserialize, Serialize};

use crate::{BatteryPack, RotorAerodynamics, RotorLayout, RotorSpin};

/// Standard acceleration of free fall, m/s² (ISO 80000-3). The paper writes g and gives no number.
pub const GRAVITY_M_S2: f64 = 9.806_65;

/// Mass, geometry, rotors and drag of a quadrotor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Airframe {
    /// m, kg.
    pub mass_kg: f64,
    /// l, the unit of length of the layout, m: in "+", "X" and "H" the distance of each rotor from the rotors' centre.
    pub arm_length_m: f64,
    /// Where the rotors are and which way they turn: "+" unless it is given.
    #[serde(default)]
    pub layout: RotorLayout,
    /// Diagonal of the inertia tensor J_x, J_y, J_z, kg·m².
    pub inertia_kg_m2: [f64; 3],
    /// Its other entries J_xy, J_xz, J_yz, kg·m²: J_xy = −∫ x y dm, the sign that URDF and SDF have.
    #[serde(default)]
    pub products_of_inertia_kg_m2: [f64; 3],
    /// Place of the centre of mass, FRD from the rotors' centre, m. Position and velocity of the vehicle are those of the
    /// centre of mass, and so is what instruments measure; the inertia tensor is about it; disturbance forces act there.
    /// Thrusts act at the rotors and drag at the rotors' centre. The controllers take the offset for a disturbance.
    #[serde(default)]
    pub centre_of_gravity_m: [f64; 3],
    /// k₁ of (1), thrust per squared rotor speed, N·s².
    pub thrust_coefficient_n_s2: f64,
    /// k₂ of (1), drag torque per squared rotor speed, N·m·s².
    pub torque_coefficient_n_m_s2: f64,
    /// Lowest rotor speed while armed, rad/s.
    pub rotor_speed_min_rad_s: f64,
    /// Highest rotor speed, rad/s.
    pub rotor_speed_max_rad_s: f64,
    /// Time constant of the first-order lag from commanded to actual rotor speed, s.
    pub rotor_time_constant_s: f64,
    /// What the rotors' motors and masses do beside the lag.
    #[serde(default)]
    pub rotor_spin: RotorSpin,
    /// What the air does to the rotors beside their static thrust.
    #[serde(default)]
    pub rotor_aerodynamics: RotorAerodynamics,
    /// Linear drag along the world axes north, east, down, N·s/m.
    pub drag_n_s_m: [f64; 3],
    /// Linear drag along the body axes forward, right, down, N·s/m, in addition.
    #[serde(default)]
    pub body_drag_n_s_m: [f64; 3],
    /// What the motors draw their power from.
    #[serde(default)]
    pub battery: BatteryPack,
}

/// The paper's Table 1, and our choice of what it leaves out:
///
/// | constant | default | reason |
/// | --- | --- | --- |
/// | m, l, J | Table 1 | the paper |
/// | layout | "+" | the paper, Figure 1 |
/// | k₁ | 2.7e-5 N·s² | 12-inch propeller (D = 0.305 m, the largest that clears a 0.275 m arm): C_T ρ D⁴/4π² with C_T = 0.1 |
/// | k₂ | 6.0e-7 N·m·s² | the same propeller: k₂/k₁ = D C_Q/C_T = 0.022 m with C_Q = 0.0073 |
/// | ω min | 50 rad/s | idle at a fifth of the hover speed, keeps the motors synchronised |
/// | ω max | 450 rad/s | thrust to weight of 3.2, usual for a vehicle that must carry a load |
/// | rotor lag | 0.03 s | brushless motor with a propeller of this size |
/// | drag | 0 | the paper has none |
/// | all else | none | the paper has none: principal axes, centre of mass amid the rotors, massless rotors, ideal battery |
impl Default for Airframe {
    fn default() -> Self {
        Self {
            mass_kg: 0.7,
            arm_length_m: 0.275,
            layout: RotorLayout::plus(),
            inertia_kg_m2: [0.1063, 0.1063, 0.2122],
            products_of_inertia_kg_m2: [0.0; 3],
            centre_of_gravity_m: [0.0; 3],
            thrust_coefficient_n_s2: 2.7e-5,
            torque_coefficient_n_m_s2: 6.0e-7,
            rotor_speed_min_rad_s: 50.0,
            rotor_speed_max_rad_s: 450.0,
            rotor_time_constant_s: 0.03,
            rotor_spin: RotorSpin::default(),
            rotor_aerodynamics: RotorAerodynamics::default(),
            drag_n_s_m: [0.0; 3],
            body_drag_n_s_m: [0.0; 3],
            battery: BatteryPack::default(),
        }
    }
}

impl Airframe {
    /// Weight m g, N: the thrust in hover.
    pub fn weight_n(&self) -> f64 {
        self.mass_kg * GRAVITY_M_S2
    }

    /// Speed at which four equal rotors carry the weight, rad/s: f(x₀, u₀) = 0 with 4 k₁ ω² = m g.
    pub fn hover_rotor_speed_rad_s(&self) -> f64 {
        libm::sqrt(self.weight_n() / (4.0 * self.thrust_coefficient_n_s2))
    }

    /// Speeds at which the rotors carry the weight without turning the vehicle, rad/s, in the order of its layout: those nearer to an offset
    /// centre of mass carry more of it. Equal speeds where a rotor would have to pull, or make more than its largest thrust.
    ///
    /// ```
    /// use quadrotor::{Airframe, wrench_of_rotors};
    ///
    /// // 1 cm ahead of the rotors' centre: the front rotor turns faster than the back one.
    /// let airframe = Airframe { centre_of_gravity_m: [0.01, 0.0, 0.0], ..Airframe::default() };
    /// let speeds = airframe.balanced_rotor_speeds_rad_s();
    /// assert!(speeds[0] > speeds[1] && speeds[1] > speeds[2]);
    /// let wrench = wrench_of_rotors(&airframe, &speeds);
    /// assert!((wrench.thrust_n - airframe.weight_n()).abs() < 1e-12);
    /// assert!((wrench.torque_n_m.y - 0.01 * airframe.weight_n()).abs() < 1e-12);
    /// ```
    pub fn balanced_rotor_speeds_rad_s(&self) -> [f64; 4] {
        let equal = [self.hover_rotor_speed_rad_s(); 4];
        let [x, y, _] = self.centre_of_gravity_m;
        if x == 0.0 && y == 0.0 {
            return equal;
        }
        let Ok(inverse) = self.layout.inverse_allocation() else { return equal };
        // The thrust acts at the centre of mass: c × (0, 0, −m g) about the rotors' centre.
        let (weight_n, l) = (self.weight_n(), self.arm_length_m);
        let thrusts_n = inverse * Vector4::new(weight_n, -y * weight_n / l, x * weight_n / l, 0.0);
        let most_n = self.thrust_range_n().1 / 4.0;
        if thrusts_n.iter().any(|thrust_n| !(0.0..=most_n).contains(thrust_n)) {
            return equal;
        }
        // ω = √(thrust / k₁)
        thrusts_n.map(|thrust_n| libm::sqrt(thrust_n / self.thrust_coefficient_n_s2)).into()
    }

    /// Thrust in hover as a share of the largest thrust of the four rotors.
    pub fn hover_thrust_share(&self) -> f64 {
        self.weight_n() / self.thrust_range_n().1
    }

    /// Smallest and largest thrust that the four rotors make together, N.
    pub fn thrust_range_n(&self) -> (f64, f64) {
        let thrust = |speed: f64| 4.0 * self.thrust_coefficient_n_s2 * speed * speed;
        (thrust(self.rotor_speed_min_rad_s), thrust(self.rotor_speed_max_rad_s))
    }
}

impl Airframe {
    /// Whether the centre of mass lies amid the rotors.
    #[inline]
    pub(crate) fn is_centred(&self) -> bool {
        vanish(&self.centre_of_gravity_m)
    }

    /// Whether all that the rotors do is in the rotor map (1).
    pub(crate) fn has_static_rotors(&self) -> bool {
        self.is_centred() && self.rotor_aerodynamics.is_static() && self.rotor_spin.inertia_kg_m2 == 0.0
    }

    /// No rotor, and no foot below one, is farther from the centre of mass, m.
    pub(crate) fn reach_m(&self) -> f64 {
        let [x, y, _] = self.centre_of_gravity_m;
        self.arm_length_m * self.layout.reach() + libm::hypot(x, y)
    }

    /// Places of the rotors, FRD from the centre of mass, m.
    #[inline]
    pub(crate) fn rotor_places_m(&self) -> [Vector3<f64>; 4] {
        let (l, centre_of_gravity) = (self.arm_length_m, Vector3::from(self.centre_of_gravity_m));
        self.layout.rotors.map(|rotor| Vector3::new(l * rotor.x, l * rotor.y, 0.0) - centre_of_gravity)
    }
}

/// Whether all three are zero. The plant asks that several times in each derivative: without a branch for each number it takes half the
/// instructions of a comparison.
#[inline(always)]
pub(crate) fn vanish(numbers: &[f64; 3]) -> bool {
    let [x, y, z] = numbers.map(f64::to_bits);
    // The uppermost bit is the sign.
    (x | y | z) << 1 == 0
}

#[cfg(test)]
mod tests {
    use super::{Airframe, vanish};

    #[test]
    fn only_zeros_vanish() {
        assert!(vanish(&[0.0; 3]) && vanish(&[-0.0, 0.0, -0.0]));
        for number in [f64::MIN_POSITIVE, 5e-324, -1.0, f64::NAN, f64::INFINITY] {
            assert!(
                !vanish(&[0.0, number, 0.0]) && !vanish(&[number, -0.0, 0.0]) && !vanish(&[0.0, 0.0, number])
            );
        }
    }

    /// Four rotors of 2.7e-5 N s² at 450 rad/s lift 21.87 N, at 50 rad/s 0.27 N; the weight is 0.7 kg at 9.80665 m/s².
    #[test]
    fn weight_and_thrust_are_those_of_the_table() {
        let airframe = Airframe::default();
        assert!((airframe.weight_n() - 6.864_655).abs() < 1e-12);
        let (weakest, strongest) = airframe.thrust_range_n();
        assert!((weakest - 0.27).abs() < 1e-12 && (strongest - 21.87).abs() < 1e-12);
        assert!((airframe.hover_thrust_share() - 6.864_655 / 21.87).abs() < 1e-15);
        // √(6.864655 / 1.08e-4)
        assert!((airframe.hover_rotor_speed_rad_s() - 252.114_6).abs() < 1e-3);
    }
}
