//! Rotors that spin: how they follow their commands, and the angular momentum that they carry.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::Airframe;
use crate::plant::differentiation::real::Real;
use crate::plant::plant_state::zipped;

/// What a rotor's motor and mass do beside the first-order lag. The default leaves both out, as the paper does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RotorSpin {
    /// J_r, moment of inertia of one propeller with its motor's bell about the spin axis, kg·m².
    pub inertia_kg_m2: f64,
    /// Time constant of a falling speed as a multiple of that of a rising one: motors drive a propeller up, and mostly its
    /// drag brakes it. The multicopter motor model of Gazebo and RotorS (Furrer, Burri, Achtelik, Siegwart 2016) has 2:
    /// 0.0125 s up, 0.025 s down.
    pub fall_time_ratio: f64,
}

impl Default for RotorSpin {
    fn default() -> Self {
        Self { inertia_kg_m2: 0.0, fall_time_ratio: 1.0 }
    }
}

/// The lag of the rotors, inverted once for all steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RotorLag {
    falling_1_s: f64,
    rising_1_s: f64,
}

impl RotorLag {
    /// Of the rotors of an airframe.
    pub(crate) fn new(airframe: &Airframe) -> Self {
        Self { falling_1_s: 1.0 / airframe.lag_s(0.0, 1.0), rising_1_s: 1.0 / airframe.lag_s(1.0, 0.0) }
    }

    /// ω̇ = (ω_goal − ω)/τ, rad/s². τ jumps where the two meet, but there the acceleration is zero and stays continuous.
    #[inline(always)]
    pub(crate) fn accelerations_rad_s2<T: Real>(
        &self,
        goals_rad_s: &[T; 4],
        present_rad_s: &[T; 4],
    ) -> [T; 4] {
        let [falling, rising] = [self.falling_1_s, self.rising_1_s].map(T::constant);
        if self.falling_1_s == self.rising_1_s {
            return zipped(goals_rad_s, present_rad_s, |goal, present| (goal - present) * rising);
        }
        zipped(goals_rad_s, present_rad_s, |goal, present| {
            (goal - present) * present.where_greater(goal, falling, rising)
        })
    }
}

impl Airframe {
    /// Time constant of the lag of a rotor that turns at `present_rad_s` towards `goal_rad_s`, s.
    pub(crate) fn lag_s(&self, goal_rad_s: f64, present_rad_s: f64) -> f64 {
        let falls = present_rad_s > goal_rad_s;
        self.rotor_time_constant_s * if falls { self.rotor_spin.fall_time_ratio } else { 1.0 }
    }

    /// Time constant of the lag of rotors that slow down as often as they speed up, s: the mean of both. Controllers are designed for it.
    pub(crate) fn mean_rotor_lag_s(&self) -> f64 {
        self.rotor_time_constant_s * (1.0 + self.rotor_spin.fall_time_ratio) / 2.0
    }

    /// Near hover, the reaction to spin-up is the drag torque's rate of change times this, s: J_r Ω̇ = J_r/(2k₂Ω) · d(k₂Ω²)/dt.
    pub(crate) fn spin_up_lead_s(&self) -> f64 {
        let drag_per_speed = 2.0 * self.torque_coefficient_n_m_s2 * self.hover_rotor_speed_rad_s();
        self.rotor_spin.inertia_kg_m2 / drag_per_speed
    }

    /// Torque of the spinning rotors on the body, FRD, N·m, for rotor speeds and accelerations in the order of the layout.
    ///
    /// The angular momentum of body and rotors is Jω + h with h = Σ s J_r Ω e₃, s = 1 for a rotor that turns clockwise seen
    /// from above. Its balance J ω̇ + ḣ + ω × (Jω + h) = τ leaves −ω × h, the gyroscopic torque, and −ḣ, the reaction to the
    /// spin-up (Bouabdallah 2007, "Design and control of quadrotors with application to autonomous flying"; Mahony,
    /// Kumar, Corke 2012, "Multirotor aerial vehicles").
    pub(crate) fn spin_torque_n_m<T: Real>(
        &self,
        rate_rad_s: &Vector3<T>,
        rotor_speed_rad_s: &[T; 4],
        rotor_acceleration_rad_s2: &[T; 4],
    ) -> Vector3<T> {
        // The drag torque on the body has the opposite direction of the rotor's turn.
        let along_axis = |values: &[T; 4]| {
            let rotors = self.layout.rotors.iter().zip(values);
            let turns = rotors.map(|(rotor, value)| *value * -rotor.direction.torque_sign());
            turns.fold(T::zero(), |sum, turn| sum + turn) * self.rotor_spin.inertia_kg_m2
        };
        let momentum = Vector3::new(T::zero(), T::zero(), along_axis(rotor_speed_rad_s));
        let reaction = Vector3::new(T::zero(), T::zero(), along_axis(rotor_acceleration_rad_s2));
        -rate_rad_s.cross(&momentum) - reaction
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{RotorLag, RotorSpin};
    use crate::Airframe;

    /// Front and back turn clockwise, right and left counterclockwise.
    #[test]
    fn a_rotor_that_spins_up_turns_the_body_the_other_way() {
        let spin = RotorSpin { inertia_kg_m2: 1e-4, ..RotorSpin::default() };
        let airframe = Airframe { rotor_spin: spin, ..Airframe::default() };
        let torque = |speeds: [f64; 4], accelerations: [f64; 4], rate: [f64; 3]| {
            airframe.spin_torque_n_m(&rate.into(), &speeds, &accelerations)
        };
        // To the right is positive about the down axis.
        assert!((torque([0.0; 4], [50.0, 0.0, 0.0, 0.0], [0.0; 3]).z + 5e-3).abs() < 1e-15);
        assert!((torque([0.0; 4], [0.0, 50.0, 0.0, 0.0], [0.0; 3]).z - 5e-3).abs() < 1e-15);
        assert_eq!(torque([300.0; 4], [50.0; 4], [1.0, 2.0, 3.0]).norm(), 0.0, "they cancel");
        // −ω × h with h = 0.06 e₃ of the clockwise pair: e₁ × e₃ = −e₂, e₂ × e₃ = e₁.
        let tilted = torque([300.0, 0.0, 300.0, 0.0], [0.0; 4], [2.0, 3.0, 5.0]);
        assert!((tilted - Vector3::new(-0.18, 0.12, 0.0)).norm() < 1e-15, "{tilted}");
    }

    #[test]
    fn a_falling_speed_has_a_lag_of_its_own() {
        let spin = RotorSpin { fall_time_ratio: 2.5, ..RotorSpin::default() };
        let airframe = Airframe { rotor_spin: spin, rotor_time_constant_s: 0.04, ..Airframe::default() };
        assert_eq!((airframe.lag_s(300.0, 200.0), airframe.lag_s(200.0, 300.0)), (0.04, 0.1));
        assert!((airframe.mean_rotor_lag_s() - 0.07).abs() < 1e-15);
        assert_eq!(Airframe::default().mean_rotor_lag_s(), Airframe::default().rotor_time_constant_s);
        let lag = RotorLag::new(&airframe);
        let [rising, falling, ..] =
            lag.accelerations_rad_s2(&[300.0, 200.0, 0.0, 0.0], &[200.0, 300.0, 0.0, 0.0]);
        assert!((rising - 2500.0).abs() < 1e-12 && (falling + 1000.0).abs() < 1e-12);
    }
}
