//! What a control loop learns of its vehicle.

use super::ControlState;
use crate::control::control_inputs::ControlLaw;
use crate::control::learning::flight_sample::FlightSample;
use crate::control::learning::motion_equation::MeasuredMotion;
use crate::design::loop_design::LoopDesign;
use crate::{Belief, Configuration, RigidBody};

impl ControlState {
    /// What the controllers take for the vehicle: the configuration with mass and drag as they were learned.
    pub(crate) fn believed(&self, configuration: &Configuration) -> Configuration {
        self.learned.in_place_of_belief(configuration)
    }

    /// Mass and drag that the controllers go by.
    pub(crate) fn belief(&self, configuration: &Configuration) -> Belief {
        self.learned.belief(configuration)
    }

    /// Learns mass and drag from the motion until now, and goes on with the configuration that has them.
    pub(super) fn learn(
        &mut self,
        LoopDesign { configuration, cascade, .. }: &LoopDesign,
        measured: &RigidBody,
        (is_clear, time_us): (bool, u64),
    ) -> Configuration {
        let believed = self.believed(configuration);
        if self.law == ControlLaw::RotorLoss {
            self.learned.interrupt();
            return believed;
        }
        let by_position = configuration.sensors.output_feedback;
        if by_position && !self.estimator.is_settled(&cascade.estimator, time_us) {
            // A velocity that is not known yet would pass for a force, and that for a mass.
            self.learned.interrupt();
            return believed;
        }
        let seen = self.estimator.seen(&configuration.sensors, measured, time_us);
        let sample = FlightSample {
            motion: if by_position {
                MeasuredMotion::Position(measured.position_m)
            } else {
                MeasuredMotion::Velocity(measured.velocity_m_s)
            },
            is_clear,
            velocity_m_s: seen.velocity_m_s,
            attitude: seen.rotation(),
            rotor_speed_rad_s: &self.estimator.rotor_speed_rad_s(),
            rotor_command_rad_s: &self.command.speed_rad_s,
            time_us,
            averaging: &cascade.averaging,
        };
        if self.learned.observe(configuration, &sample) {
            self.believe(&believed, configuration)
        } else {
            believed
        }
    }

    /// Goes on with what was learned by now in place of what was believed before: the configuration that has it.
    pub(super) fn believe(
        &mut self,
        believed: &Configuration,
        configuration: &Configuration,
    ) -> Configuration {
        let learned = self.believed(configuration);
        self.cascade.believe(believed, &learned);
        self.estimator.believe(believed, &learned);
        learned
    }
}
