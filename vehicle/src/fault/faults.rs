//! Everything that is broken now.

use quadrotor::RotorFault;
use serde::{Deserialize, Serialize};

use super::{BatteryFault, Fault, Sensor, SensorFault};

/// The present faults of all units.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Faults {
    sensors: [Option<SensorFault>; Sensor::ALL.len()],
    battery: Option<BatteryFault>,
    rotors: [Option<RotorFault>; 4],
}

impl Faults {
    /// Breaks a unit, or mends it.
    pub fn set(&mut self, fault: &Fault) {
        match *fault {
            Fault::Sensor(sensor, fault) => {
                for (place, kept) in self.sensors.iter_mut().zip(Sensor::ALL) {
                    if kept == sensor {
                        *place = fault;
                    }
                }
            }
            Fault::Battery(fault) => self.battery = fault,
            Fault::Rotors(rotors, fault) => {
                for (index, place) in self.rotors.iter_mut().enumerate() {
                    if rotors.contains(index) {
                        *place = fault;
                    }
                }
            }
        }
    }

    /// With rotors that make a share of their thrust only, the first in the lowest bit; one that is broken already stays as it is.
    pub fn with_weak(mut self, rotors: u32, share: f64) -> Self {
        let fault = if share > 0.0 { RotorFault::Weak { share } } else { RotorFault::Off };
        for (index, place) in self.rotors.iter_mut().enumerate() {
            if rotors & 1 << index != 0 {
                place.get_or_insert(fault);
            }
        }
        self
    }

    /// What is wrong with an instrument.
    pub fn sensor(&self, sensor: Sensor) -> Option<SensorFault> {
        Sensor::ALL.into_iter().zip(self.sensors).find(|(kept, _)| *kept == sensor)?.1
    }

    /// What is wrong with the battery.
    pub fn battery(&self) -> Option<BatteryFault> {
        self.battery
    }

    /// What is wrong with the front, right, back and left rotor.
    pub fn rotors(&self) -> [Option<RotorFault>; 4] {
        self.rotors
    }
}
