//! Ideal sensors: the truth, as long as they say anything.

use super::estimate::Validity;
use super::navigation::{InstrumentHealth, Readings};
use super::true_motion::TrueMotion;
use crate::fault::{Faults, Sensor, SensorFault};
use crate::world::Geodetic;

/// An instrument that has said nothing new for longer has failed, µs.
const PATIENCE_US: u64 = 500_000;
/// A vehicle without a GPS receiver for longer no longer knows its position, µs: what the estimator behind realistic
/// sensors, and PX4, take for lost (EKF2_NOAID_TOUT).
const POSITION_PATIENCE_US: u64 = 5_000_000;

/// Remembers when each instrument was last heard. Faults silence them; what a fault changes in a reading is for
/// realistic ones.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct IdealSensors {
    heard_us: [u64; Sensor::ALL.len()],
    time_us: u64,
}

impl IdealSensors {
    /// One tick.
    pub fn step(&mut self, time_us: u64, faults: &Faults) {
        self.time_us = time_us;
        for (heard_us, sensor) in self.heard_us.iter_mut().zip(Sensor::ALL) {
            let speaks = match faults.sensor(sensor) {
                Some(SensorFault::Stuck) => false,
                Some(fault) => !fault.is_silent(time_us),
                None => true,
            };
            if speaks {
                *heard_us = time_us;
            }
        }
    }

    fn is_heard(&self, sensor: Sensor, patience_us: u64) -> bool {
        let heard = Sensor::ALL.into_iter().zip(self.heard_us).find(|(kept, _)| *kept == sensor);
        heard.is_some_and(|(_, heard_us)| self.time_us - heard_us <= patience_us)
    }

    /// Which instruments work.
    pub fn health(&self) -> InstrumentHealth {
        InstrumentHealth {
            gyroscope: self.is_heard(Sensor::Gyroscope, PATIENCE_US),
            accelerometer: self.is_heard(Sensor::Accelerometer, PATIENCE_US),
            magnetometer: self.is_heard(Sensor::Magnetometer, PATIENCE_US),
            barometer: self.is_heard(Sensor::Barometer, PATIENCE_US),
            gps: self.is_heard(Sensor::Gps, PATIENCE_US),
            vision: false,
        }
    }

    /// What of the motion is known: all but, without the receiver, the position.
    pub fn validity(&self) -> Validity {
        let positioned = self.is_heard(Sensor::Gps, POSITION_PATIENCE_US);
        Validity { horizontal_position: positioned, horizontal_velocity: positioned, ..Validity::ALL }
    }

    /// What the instruments show of a motion at a place.
    pub fn readings(&self, motion: &TrueMotion, place: &Geodetic) -> Readings {
        let mut readings = Readings::exact(motion, place);
        readings.gps = readings.gps.filter(|_| self.is_heard(Sensor::Gps, PATIENCE_US));
        readings
    }
}
