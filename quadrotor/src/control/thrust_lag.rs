//! Rotor commands under which the thrust, not the speed, answers with the rotors' lag.

use crate::{Airframe, Configuration, PredictionModel};

/// A rotor's speed ω follows its command with a first-order lag, and its thrust is f = k₁ ω². Commanding √(f_c/k₁) makes the
/// thrust answer neither evenly nor in proportion: it rises slower than it falls, so that torques that come and go cost lift.
/// Here the command is the one after which, one sample later, the thrust is where a first-order lag would have it:
///
/// ```text
/// f⁺ = f + (f_c − f)(1 − κ)       κ = e^(−ΔT/T)
/// ω_c = (√(f⁺/k₁) − κ ω)/(1 − κ)
/// ```
///
/// f and the four rotors' torques are then linear, as the controllers' models have them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ThrustLag {
    /// κ, what is left of a difference between a rotor's speed and its command after a sample.
    kept: f64,
    /// Whether commands allow for it, instead of being taken to act at once.
    is_foreseen: bool,
    /// 1/(1 − κ) and 1/k₁: all rotors are multiplied by them.
    per_rest: f64,
    per_coefficient_1_n_s2: f64,
    coefficient_n_s2: f64,
    speed_range_rad_s: (f64, f64),
}

impl ThrustLag {
    /// For the commands of an attitude controller.
    pub(crate) fn of(configuration: &Configuration) -> Self {
        let controllers = &configuration.controllers;
        Self::new(&configuration.airframe, controllers.model, controllers.attitude.sample_time_s())
    }

    /// For commands that are held for `sample_time_s`.
    fn new(airframe: &Airframe, model: PredictionModel, sample_time_s: f64) -> Self {
        let kept = libm::exp(-sample_time_s / airframe.mean_rotor_lag_s());
        Self {
            kept,
            is_foreseen: model == PredictionModel::InnerLoops,
            per_rest: 1.0 / (1.0 - kept),
            per_coefficient_1_n_s2: 1.0 / airframe.thrust_coefficient_n_s2,
            coefficient_n_s2: airframe.thrust_coefficient_n_s2,
            speed_range_rad_s: (airframe.rotor_speed_min_rad_s, airframe.rotor_speed_max_rad_s),
        }
    }

    /// κ.
    pub(crate) fn kept(&self) -> f64 {
        self.kept
    }

    /// The command, rad/s, for a thrust, N, of a rotor at a speed, rad/s; within the range of speeds.
    pub(crate) fn command_rad_s(&self, thrust_n: f64, speed_rad_s: f64) -> f64 {
        let k1 = self.coefficient_n_s2;
        let (slowest, fastest) = self.speed_range_rad_s;
        let speed_of = |thrust_n: f64| libm::sqrt(thrust_n.max(0.0) * self.per_coefficient_1_n_s2);
        let command = if self.is_foreseen {
            let after = thrust_n + (k1 * speed_rad_s * speed_rad_s - thrust_n) * self.kept;
            (speed_of(after) - self.kept * speed_rad_s) * self.per_rest
        } else {
            speed_of(thrust_n)
        };
        command.clamp(slowest, fastest)
    }

    /// The speed, rad/s, at which the commanded thrust is the one that a command, rad/s, stands for: a lower one than was asked
    /// for when the rotor cannot turn fast enough.
    pub(crate) fn settled_rad_s(&self, command_rad_s: f64, speed_rad_s: f64) -> f64 {
        if !self.is_foreseen {
            return command_rad_s;
        }
        let after = command_rad_s + (speed_rad_s - command_rad_s) * self.kept;
        libm::sqrt(((after * after - speed_rad_s * speed_rad_s * self.kept) * self.per_rest).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::ThrustLag;
    use crate::{Airframe, PredictionModel};

    proptest! {
        /// The rotor's own lag, over a sample, ends where the thrust's lag would; at the top as near as it can.
        #[test]
        fn the_thrust_answers_as_a_first_order_lag(
            speed in 50.0..450.0_f64, wanted in 50.0..450.0_f64, lag in 0.005..0.2,
        ) {
            let airframe = Airframe { rotor_time_constant_s: lag, ..Airframe::default() };
            let k1 = airframe.thrust_coefficient_n_s2;
            let thrust_lag = ThrustLag::new(&airframe, PredictionModel::InnerLoops, 0.01);
            let (present, thrust) = (k1 * speed * speed, k1 * wanted * wanted);
            let command = thrust_lag.command_rad_s(thrust, speed);
            prop_assert!((50.0 - 1e-9..=450.0).contains(&command));
            let gone = 1.0 - (-0.01 / lag).exp();
            let speed_after = speed + (command - speed) * gone;
            let after = k1 * speed_after * speed_after;
            let linear = present + (thrust - present) * gone;
            if command < 450.0 {
                prop_assert!((after - linear).abs() < 1e-9, "{after} {linear}");
                prop_assert!((thrust_lag.settled_rad_s(command, speed) - wanted).abs() < 1e-6);
            } else {
                prop_assert!(after <= linear + 1e-9 && thrust > present);
                // What the command stands for answers linearly.
                let settled = thrust_lag.settled_rad_s(command, speed);
                let stands_for = k1 * settled * settled;
                prop_assert!((present + (stands_for - present) * gone - after).abs() < 1e-9);
                prop_assert!(stands_for <= thrust + 1e-8 && stands_for >= present - 1e-9);
            }
        }

        /// With the paper's models a command acts at once.
        #[test]
        fn prompt_commands_are_roots(speed in 50.0..450.0_f64, wanted in 50.0..450.0_f64) {
            let airframe = Airframe::default();
            let prompt = ThrustLag::new(&airframe, PredictionModel::Paper, 0.01);
            let thrust = airframe.thrust_coefficient_n_s2 * wanted * wanted;
            prop_assert!((prompt.command_rad_s(thrust, speed) - wanted).abs() < 1e-9);
            prop_assert_eq!(prompt.settled_rad_s(wanted, speed), wanted);
        }
    }
}
