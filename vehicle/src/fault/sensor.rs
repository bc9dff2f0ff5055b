//! Faults of instruments, with their figures.

use serde::{Deserialize, Serialize};

/// An instrument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sensor {
    /// Body rates.
    Gyroscope,
    /// Specific force.
    Accelerometer,
    /// Magnetic field.
    Magnetometer,
    /// Static pressure.
    Barometer,
    /// Position and velocity from satellites.
    Gps,
}

/// What is wrong with an instrument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SensorFault {
    /// It says nothing.
    Off,
    /// It repeats what it said last.
    Stuck,
    /// Its noise has the standard deviation [`Sensor::garbage`].
    Garbage,
    /// It is off by [`Sensor::offset`].
    Wrong,
    /// It reads every [`SensorFault::SLOWNESS`]-th time only.
    Slow,
    /// It says [`SensorFault::DELAY_US`] later what it read.
    Delayed,
    /// It works and says nothing by turns, see [`SensorFault::is_silent`].
    Intermittent,
}

impl Sensor {
    /// All instruments.
    pub const ALL: [Self; 5] =
        [Self::Gyroscope, Self::Accelerometer, Self::Magnetometer, Self::Barometer, Self::Gps];

    /// Constant error of a wrong instrument: rad/s, m/s² or gauss along each body axis, Pa, or m to the north.
    ///
    /// Each is many times what the part's data sheet allows, and no more than an estimator can fly on with for a while.
    pub fn offset(self) -> f64 {
        match self {
            Self::Gyroscope => 0.1,
            Self::Accelerometer => 1.0,
            Self::Magnetometer => 0.2,
            // 5 m.
            Self::Barometer => 60.0,
            Self::Gps => 10.0,
        }
    }

    /// Standard deviation of what an instrument says that reports garbage, per axis, in the same units.
    pub fn garbage(self) -> f64 {
        match self {
            Self::Gyroscope => 1.0,
            Self::Accelerometer => 10.0,
            Self::Magnetometer => 0.5,
            // 20 m.
            Self::Barometer => 240.0,
            Self::Gps => 50.0,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gyroscope => "gyroscope",
            Self::Accelerometer => "accelerometer",
            Self::Magnetometer => "magnetometer",
            Self::Barometer => "barometer",
            Self::Gps => "gps",
        }
    }

    /// FAILURE_UNIT.
    pub fn number(self) -> u32 {
        match self {
            Self::Gyroscope => 0,
            Self::Accelerometer => 1,
            Self::Magnetometer => 2,
            Self::Barometer => 3,
            Self::Gps => 4,
        }
    }
}

impl SensorFault {
    /// Delay of a delayed instrument, µs.
    pub const DELAY_US: u64 = 500_000;
    /// A slow instrument reads once where a sound one reads this often.
    pub const SLOWNESS: u64 = 5;
    /// Half a period of an intermittent instrument, µs.
    const INTERMITTENT_US: u64 = 1_000_000;

    /// Whether nothing is heard of the instrument at a time, µs after the start.
    pub fn is_silent(self, time_us: u64) -> bool {
        match self {
            Self::Off => true,
            Self::Intermittent => (time_us / Self::INTERMITTENT_US).is_multiple_of(2),
            _ => false,
        }
    }
}
