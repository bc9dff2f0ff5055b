//! Pulses of the servo outputs.

use nalgebra::UnitQuaternion;

use super::Vehicle;
use crate::equipment::{GimbalAxis, Output, OutputFunction};

impl Vehicle {
    /// The pulse of an output that is no rotor's, counted from 1, µs; 0: none.
    pub fn output_us(&self, number: usize) -> u16 {
        let settings = &self.conduct().equipment;
        let Some(output) = settings.output(number).filter(|_| !self.is_safe()) else { return 0 };
        match output.follows(number) {
            OutputFunction::Command => self.equipment().servos().pulse_us(number),
            OutputFunction::Radio { channel, scaled } => self.radio_output_us(output, channel, scaled),
            OutputFunction::Gripper if self.equipment().gripper().waits() => settings.gripper_waits_us,
            OutputFunction::Gripper if self.equipment().gripper().grabs() => settings.grabbing_us,
            OutputFunction::Gripper => settings.releasing_us,
            OutputFunction::Parachute => {
                self.equipment().parachute().pulse_us(&settings.parachute, self.time_us())
            }
            OutputFunction::Gimbal(axis) => self.gimbal_output_us(output, axis),
            OutputFunction::LandingGear => {
                let is_down = self.equipment().landing_gear_is_down();
                is_down.map_or(0, |is_down| output.along_us(f64::from(u8::from(is_down))))
            }
            OutputFunction::Minimum => output.minimum_us as u16,
            OutputFunction::Trim => output.trim_us as u16,
            OutputFunction::Maximum => output.maximum_us as u16,
            OutputFunction::Nothing => 0,
        }
    }

    /// An output that follows a channel of the radio, counted from 1. A scaled one does not follow pulses of a radio that is not to be
    /// believed: it stays where it was, or goes to its centre once the radio is lost.
    fn radio_output_us(&self, output: &Output, number: usize, scaled: bool) -> u16 {
        let (conduct, pilot) = (self.conduct(), self.pilot());
        let centres = conduct.equipment.centred_when_lost >> (number - 1) & 1 != 0;
        if scaled && pilot.lost && centres {
            return output.trim_us as u16;
        }
        let pulses = if scaled { pilot.believed } else { pilot.pulses.or(pilot.believed) };
        let pulse_us = pulses.and_then(|pulses| pulses.get(number - 1).copied()).unwrap_or(0);
        let channel = conduct.radio.channels.get(number - 1).filter(|_| scaled && pulse_us > 0);
        let is_throttle = conduct.radio.axes.throttle == number as f64;
        channel.map_or(pulse_us, |channel| output.scaled_us(channel, pulse_us, is_throttle))
    }

    /// A servo of the gimbal: it turns an axis against the vehicle, between the limits of the gimbal.
    fn gimbal_output_us(&self, output: &Output, axis: GimbalAxis) -> u16 {
        let limits = self.conduct().equipment.mount.limits();
        let [roll, pitch, yaw] = self.equipment().gimbal().angles_rad().data.0[0];
        let attitude = self.outputs().orientation();
        let heading_rad = self.outputs().attitude_rad.z;
        let camera = UnitQuaternion::from_euler_angles(roll, pitch, yaw + heading_rad);
        let (roll, pitch, yaw) = (attitude.inverse() * camera).euler_angles();
        let (angle_rad, [least_rad, most_rad]) = match axis {
            GimbalAxis::Roll => (roll, limits.roll_rad),
            GimbalAxis::Pitch => (pitch, limits.pitch_rad),
            GimbalAxis::Yaw => (yaw, limits.yaw_rad),
        };
        let range_rad = most_rad - least_rad;
        output.along_us(if range_rad > 0.0 { (angle_rad - least_rad) / range_rad } else { 0.5 })
    }
}
