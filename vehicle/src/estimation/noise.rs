//! Random numbers of the instruments.

use nalgebra::Vector3;
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::fault::Sensor;

/// Whose numbers they are. Each instrument has its own stream: what happens to one does not change the noise of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Gyroscope and accelerometer.
    Inertial,
    /// GPS receiver.
    Gps,
    /// Barometer.
    Barometer,
    /// Magnetometer.
    Magnetometer,
    /// What a fault adds to an instrument.
    Fault(Sensor),
    /// What a user adds to all of them.
    Error,
}

impl Channel {
    fn number(self) -> u64 {
        match self {
            Self::Inertial => 1,
            Self::Gps => 2,
            Self::Barometer => 3,
            Self::Magnetometer => 4,
            Self::Fault(sensor) => 5 + u64::from(sensor.number()),
            Self::Error => 10,
        }
    }
}

/// A stream of normal numbers. The same seed gives the same numbers on every platform.
#[derive(Clone, Debug)]
pub struct Noise(Pcg64Mcg);

impl Noise {
    /// The stream of a channel under the seed of the run.
    pub fn new(seed: u64, channel: Channel) -> Self {
        // An odd factor sends different channels to different seeds.
        let own = seed ^ channel.number().wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Self(Pcg64Mcg::seed_from_u64(own))
    }

    /// A normal number with a standard deviation.
    pub fn normal(&mut self, deviation: f64) -> f64 {
        let sample: f64 = StandardNormal.sample(&mut self.0);
        deviation * sample
    }

    /// Three of them, independent.
    pub fn vector(&mut self, deviation: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal(deviation))
    }
}
