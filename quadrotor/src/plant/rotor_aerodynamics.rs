//! What the air does to a rotor that moves through it, or turns close to the ground.

use core::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::plant::airframe::vanish;
use crate::plant::differentiation::real::Real;
use crate::plant::events::branches::Branches;
use crate::plant::events::switch::Switch;

/// Density of the air at sea level in the international standard atmosphere, kg/m³.
const AIR_DENSITY_KG_M3: f64 = 1.225;
/// Largest thrust as a multiple of the static one at the same speed: the linear inflow ends in the vortex ring state, and
/// with it what a descent adds.
const MOST_THRUST: f64 = 1.5;
/// Closest distance to the ground that Cheeseman and Bennett's image holds for, rotor radii; below it the effect is that
/// there.
const CLOSEST_RADII: f64 = 0.5;
/// What differences of thrusts are compared with, N.
const THRUST_N: f64 = 1.0;

/// Aerodynamic coefficients of one rotor, all for a hub that moves through the air. The default leaves everything out, as
/// the paper does.
///
/// For a rotor of speed Ω whose hub moves through the air with v (FRD), with v_h the part of v in the rotor's plane:
///
/// * thrust T = k₁Ω² + k_z Ω v_z + k_h |v_h|², at least zero and at most one and a half times k₁Ω²: a climb (v_z < 0) meets
///   the inflow and loses thrust, and forward flight gains some (Svacha, Mohta, Kumar 2017, "Improving quadrotor trajectory
///   tracking by compensating for aerodynamic effects"; Folk, Paulos, Kumar 2023, "RotorPy: a Python-based multirotor
///   simulator with aerodynamics for education and research");
/// * drag in the plane of the rotor −k_d Ω v_h, of flapping and induced drag (Martin and Salaün 2010, "The true role of
///   accelerometer feedback in quadrotor control"; Furrer, Burri, Achtelik, Siegwart 2016, "RotorS"; with a constant sum of
///   the speeds it is the rotor drag of Faessler, Franchi, Scaramuzza 2018, "Differential flatness of quadrotor dynamics
///   subject to rotor drag", and of Kai, Allibert, Hua, Hamel 2017, "Nonlinear feedback control of quadrotors exploiting
///   first-order drag effects").
///
/// For the AscTec Hummingbird (0.5 kg, k₁ = 5.57e-6 N·s²) RotorPy has k_d = 1.19e-4 and k_z = 2.32e-4 N·s²/m. The drag
/// torque k₂Ω² stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RotorAerodynamics {
    /// k_d, drag per rotor speed and lateral airspeed, N·s²/m.
    pub drag_coefficient_n_s2_m: f64,
    /// k_z, thrust lost per rotor speed and climb rate, N·s²/m.
    pub inflow_coefficient_n_s2_m: f64,
    /// k_h, thrust gained per squared lateral airspeed, N·s²/m².
    pub translational_lift_coefficient_n_s2_m2: f64,
    /// R, radius of the propeller, m. Only the ground effect reads it.
    pub radius_m: f64,
    /// Whether the ground adds to the thrust of rotors close to it.
    pub ground_effect: bool,
}

/// The radius is that of the propeller that k₁ is for: 12 inches across.
impl Default for RotorAerodynamics {
    fn default() -> Self {
        Self {
            drag_coefficient_n_s2_m: 0.0,
            inflow_coefficient_n_s2_m: 0.0,
            translational_lift_coefficient_n_s2_m2: 0.0,
            radius_m: 0.1525,
            ground_effect: false,
        }
    }
}

impl RotorAerodynamics {
    /// Whether a rotor makes k₁Ω² along its axis and nothing else, wherever it is and however it moves.
    #[inline]
    pub(crate) fn is_static(&self) -> bool {
        let Self {
            drag_coefficient_n_s2_m: drag,
            inflow_coefficient_n_s2_m: inflow,
            translational_lift_coefficient_n_s2_m2: lift,
            radius_m: _,
            ground_effect,
        } = *self;
        vanish(&[drag, inflow, lift]) && !ground_effect
    }

    /// Whether rotors drag in their plane.
    #[inline]
    pub(crate) fn drags(&self) -> bool {
        self.drag_coefficient_n_s2_m != 0.0
    }

    /// Thrust, N, of the rotor at `index`, which makes `static_n` at rest, turns with `speed_rad_s`, climbs with `climb_m_s`
    /// along its axis and has the squared lateral airspeed `lateral_m2_s2`.
    pub(crate) fn thrust_n<T: Real>(
        &self,
        index: usize,
        [static_n, speed_rad_s, climb_m_s, lateral_m2_s2]: [T; 4],
        branches: &mut impl Branches<T>,
    ) -> T {
        let lost_n = speed_rad_s * self.inflow_coefficient_n_s2_m * climb_m_s;
        let gained_n = lateral_m2_s2 * self.translational_lift_coefficient_n_s2_m2;
        let (thrust_n, most_n) = (static_n - lost_n + gained_n, static_n * MOST_THRUST);
        if branches.exceeds(Switch::MostThrust(index), thrust_n, most_n, THRUST_N) {
            return most_n;
        }
        if branches.exceeds(Switch::NoThrust(index), T::zero(), thrust_n, THRUST_N) {
            T::zero()
        } else {
            thrust_n
        }
    }

    /// By how much the ground multiplies `thrust_n` of the rotor at `index`, whose hub is `height_m` above it and whose axis
    /// leans from the vertical by an angle with the cosine `upright`.
    ///
    /// T/T∞ = 1/(1 − (R/4z)²/(1 + (V/v_i)²)) with the induced velocity v_i = √(T/2ρπR²) and the lateral airspeed V (Cheeseman
    /// and Bennett 1955, "The effect of the ground on a helicopter rotor in forward flight", ARC R&M 3021). z is measured
    /// along the axis of the rotor, which has no ground below it when it points down. Below half a radius the ratio stays at
    /// 4/3.
    pub(crate) fn ground_ratio<T: Real>(
        &self,
        index: usize,
        [thrust_n, height_m, upright, lateral_m2_s2]: [T; 4],
        branches: &mut impl Branches<T>,
    ) -> T {
        if !self.ground_effect || !branches.exceeds(Switch::Upright, upright, T::zero(), 1.0) {
            return T::one();
        }
        let closest_m = CLOSEST_RADII * self.radius_m;
        let (closest, aslant_m) = (T::constant(closest_m), height_m / upright.at_least(f64::MIN_POSITIVE));
        let close = branches.exceeds(Switch::NearGround(index), closest, aslant_m, self.radius_m);
        // Not beyond the bound in either mode: the image has a pole there.
        let distance_m = if close { closest } else { aslant_m.at_least(closest_m) };
        let image = T::constant(self.radius_m) / (distance_m * 4.0);
        let disc_m2 = PI * self.radius_m * self.radius_m;
        let below = thrust_n / (thrust_n + lateral_m2_s2 * (2.0 * AIR_DENSITY_KG_M3 * disc_m2));
        let ratio = T::one() / (T::one() - image * image * below);
        thrust_n.where_greater(T::zero(), ratio, T::one())
    }
}

#[cfg(test)]
mod tests {
    use super::RotorAerodynamics;
    use crate::plant::events::branches::ByValue;

    const ROTOR: RotorAerodynamics = RotorAerodynamics {
        drag_coefficient_n_s2_m: 1e-4,
        inflow_coefficient_n_s2_m: 2e-4,
        translational_lift_coefficient_n_s2_m2: 3e-3,
        radius_m: 0.2,
        ground_effect: true,
    };

    #[test]
    fn a_climb_loses_thrust_and_forward_flight_gains_some_within_bounds() {
        let thrust = |speed: f64, climb: f64, lateral: f64| {
            ROTOR.thrust_n(0, [2.0, speed, climb, lateral * lateral], &mut ByValue)
        };
        assert_eq!(thrust(300.0, 0.0, 0.0), 2.0);
        assert!((thrust(300.0, 5.0, 0.0) - 1.7).abs() < 1e-15);
        assert!((thrust(300.0, -5.0, 0.0) - 2.3).abs() < 1e-15);
        assert!((thrust(300.0, 0.0, 10.0) - 2.3).abs() < 1e-15);
        assert_eq!(thrust(300.0, 50.0, 0.0), 0.0);
        assert_eq!(thrust(300.0, -50.0, 0.0), 3.0);
        // A rotor that stands still makes none.
        assert_eq!(ROTOR.thrust_n(0, [0.0, 0.0, -5.0, 100.0], &mut ByValue), 0.0);
        assert!(!ROTOR.is_static() && RotorAerodynamics::default().is_static());
    }

    /// Cheeseman and Bennett's table: 16/15 at one radius, 64/63 at two, 4/3 at a half and below.
    #[test]
    fn the_ground_adds_thrust() {
        let ratio = |height: f64, upright: f64, speed: f64| {
            ROTOR.ground_ratio(0, [3.0, height, upright, speed * speed], &mut ByValue)
        };
        for (radii, expected) in
            [(1.0, 16.0 / 15.0), (2.0, 64.0 / 63.0), (0.5, 4.0 / 3.0), (0.0, 4.0 / 3.0), (-1.0, 4.0 / 3.0)]
        {
            assert!((ratio(radii * 0.2, 1.0, 0.0) - expected).abs() < 1e-15, "{radii}");
        }
        // At the induced velocity of √(3/(2 · 1.225 · π · 0.04)) = 3.121567 m/s half of the image is blown away.
        assert!((ratio(0.2, 1.0, 3.121_567) - 1.0 / (1.0 - 1.0 / 32.0)).abs() < 1e-6);
        // Aslant the ground is farther along the axis, and there is none above.
        assert!((ratio(0.2, 0.5, 0.0) - 64.0 / 63.0).abs() < 1e-15);
        assert_eq!(ratio(0.2, -0.5, 0.0), 1.0);
        assert_eq!(ROTOR.ground_ratio(0, [0.0, 0.2, 1.0, 0.0], &mut ByValue), 1.0);
        let off = RotorAerodynamics { ground_effect: false, ..ROTOR };
        assert_eq!(off.ground_ratio(0, [3.0, 0.2, 1.0, 0.0], &mut ByValue), 1.0);
    }
}
