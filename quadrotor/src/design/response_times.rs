//! How soon a vehicle does what its reference asks for.

use crate::Configuration;

/// Times between what a reference asks for and what the vehicle does about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseTimes {
    /// How late a torque comes that is commanded: by the lag of the rotors and half a sample of the attitude controller, s.
    pub torque_delay_s: f64,
    /// Time between two samples of the position controller, s. What changes faster is a jump to it.
    pub sample_time_s: f64,
}

impl Configuration {
    /// Those of this vehicle.
    pub(crate) fn response_times(&self) -> ResponseTimes {
        let controllers = &self.controllers;
        ResponseTimes {
            torque_delay_s: self.airframe.mean_rotor_lag_s() + controllers.attitude.sample_time_s() / 2.0,
            sample_time_s: controllers.position.sample_time_s(),
        }
    }
}
