//! Measurements of the vehicle, with noise.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::SeedableRng;
use nalgebra::{UnitQuaternion, Vector3};
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use crate::control::measurement::{Instruments, Measurement};
use crate::{PlantState, RigidBody, Sensors};

/// Words of the generator's stream that belong to one reading: far more than its twelve numbers take.
const WORDS_PER_READING: u128 = 1 << 10;

/// State of the noise: how many readings have been taken. Each has its own place in the generator's stream, so
/// that this is all there is to save.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct NoiseState {
    readings: u64,
}

/// Sensors on a plant: between plant and control loop.
#[derive(Debug)]
pub(crate) struct SimulatedSensors<'a> {
    /// Deviations of their noise.
    pub(crate) sensors: &'a Sensors,
    /// Its state.
    pub(crate) noise: &'a mut NoiseState,
    /// The truth.
    pub(crate) plant: &'a PlantState,
    /// What somebody outside has made of sensors of his own: then these are not read.
    pub(crate) estimate: Option<&'a RigidBody>,
}

impl SimulatedSensors<'_> {
    fn measurement(&self, motion: RigidBody) -> Measurement {
        Measurement { motion, rotor_speed_rad_s: self.plant.rotor_speed_rad_s }
    }
}

impl Instruments for SimulatedSensors<'_> {
    fn read(&mut self, _time_us: u64) -> Measurement {
        let motion = match self.estimate {
            Some(estimate) => *estimate,
            None => self.noise.read(self.sensors, &self.plant.body),
        };
        self.measurement(motion)
    }

    /// Without an estimate from outside, the true motion: the noise of one reading would displace the reference.
    fn read_at_takeover(&mut self, _time_us: u64) -> Measurement {
        self.measurement(*self.estimate.unwrap_or(&self.plant.body))
    }
}

impl NoiseState {
    /// What the sensors say of the body's motion. Without noise it is the motion itself.
    pub(crate) fn read(&mut self, sensors: &Sensors, body: &RigidBody) -> RigidBody {
        let reading = self.readings;
        self.readings = self.readings.wrapping_add(1);
        sensors.reading(reading, body)
    }

    /// The noise of the latest reading on the body's motion of now.
    pub(crate) fn latest(&self, sensors: &Sensors, body: &RigidBody) -> RigidBody {
        sensors.reading(self.readings.wrapping_sub(1), body)
    }
}

impl Sensors {
    /// Whether nothing is added to the truth.
    pub fn is_exact(&self) -> bool {
        [self.position_noise_m, self.velocity_noise_m_s, self.attitude_noise_rad, self.body_rate_noise_rad_s]
            == [0.0; 4]
    }

    /// Whether position and velocity are estimated, because they are not both measured exactly.
    pub(crate) fn estimates_motion(&self) -> bool {
        self.output_feedback || self.filters_motion()
    }

    /// Whether position and velocity are measured, but not both exactly: then they are filtered.
    pub(crate) fn filters_motion(&self) -> bool {
        !self.output_feedback && (self.position_noise_m > 0.0 || self.velocity_noise_m_s > 0.0)
    }

    fn reading(&self, number: u64, body: &RigidBody) -> RigidBody {
        if self.is_exact() {
            return *body;
        }
        let mut generator = ChaCha8Rng::seed_from_u64(u64::from(self.seed));
        generator.set_word_pos(u128::from(number) * WORDS_PER_READING);
        let mut noise = |deviation: f64| {
            Vector3::from_fn(|_, _| {
                let sample: f64 = StandardNormal.sample(&mut generator);
                deviation * sample
            })
        };
        let position = noise(self.position_noise_m);
        let velocity = noise(self.velocity_noise_m_s);
        let turned = UnitQuaternion::from_scaled_axis(noise(self.attitude_noise_rad));
        RigidBody {
            position_m: body.position_m + position,
            velocity_m_s: body.velocity_m_s + velocity,
            attitude: (body.rotation() * turned).into_inner(),
            body_rate_rad_s: body.body_rate_rad_s + noise(self.body_rate_noise_rad_s),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::vec::Vec;

    use nalgebra::{UnitQuaternion, Vector3};

    use super::NoiseState;
    use crate::{RigidBody, Sensors};

    fn at_rest() -> RigidBody {
        RigidBody {
            position_m: Vector3::new(1.0, 2.0, 3.0),
            velocity_m_s: Vector3::zeros(),
            attitude: UnitQuaternion::from_euler_angles(0.1, -0.2, 2.0).into_inner(),
            body_rate_rad_s: Vector3::zeros(),
        }
    }

    #[test]
    fn without_noise_the_truth_is_read() {
        assert_eq!(NoiseState::default().read(&Sensors::default(), &at_rest()), at_rest());
    }

    /// One channel of noise is noise; the seed alone is not.
    #[test]
    fn exact_sensors_have_no_noise_in_any_channel() {
        assert!(Sensors { seed: 7, ..Sensors::default() }.is_exact());
        for channel in 0..4 {
            let noise = |at: usize| if at == channel { 1e-9 } else { 0.0 };
            let sensors = Sensors {
                position_noise_m: noise(0),
                velocity_noise_m_s: noise(1),
                attitude_noise_rad: noise(2),
                body_rate_noise_rad_s: noise(3),
                ..Sensors::default()
            };
            assert!(!sensors.is_exact(), "channel {channel}");
            assert_ne!(NoiseState::default().read(&sensors, &at_rest()), at_rest(), "channel {channel}");
        }
    }

    /// The latest noise is that of the last reading, again and again, until the next one.
    #[test]
    fn the_latest_reading_can_be_seen_again() {
        let sensors = Sensors { position_noise_m: 0.5, seed: 3, ..Sensors::default() };
        let mut state = NoiseState::default();
        let first = state.read(&sensors, &at_rest());
        assert_eq!([state.latest(&sensors, &at_rest()), state.latest(&sensors, &at_rest())], [first; 2]);
        let second = state.read(&sensors, &at_rest());
        assert_ne!(first, second);
        assert_eq!(state.latest(&sensors, &at_rest()), second);
    }

    /// Mean, deviation and correlation from reading to reading of every channel, within five standard errors.
    #[test]
    fn noise_is_white_and_as_wide_as_asked() {
        const READINGS: usize = 20_000;
        let sensors = Sensors {
            position_noise_m: 0.5,
            velocity_noise_m_s: 0.2,
            attitude_noise_rad: 0.02,
            body_rate_noise_rad_s: 0.1,
            seed: 11,
            ..Sensors::default()
        };
        let (body, mut state) = (at_rest(), NoiseState::default());
        let readings: Vec<[f64; 12]> = (0..READINGS)
            .map(|_| {
                let read = state.read(&sensors, &body);
                let turned = (body.rotation().inverse() * read.rotation()).scaled_axis();
                let parts = [
                    (read.position_m - body.position_m) / sensors.position_noise_m,
                    read.velocity_m_s / sensors.velocity_noise_m_s,
                    turned / sensors.attitude_noise_rad,
                    read.body_rate_rad_s / sensors.body_rate_noise_rad_s,
                ];
                core::array::from_fn(|channel| parts[channel / 3][channel % 3])
            })
            .collect();
        let count = READINGS as f64;
        let bound = 5.0 / count.sqrt();
        for channel in 0..12 {
            let mean = readings.iter().map(|reading| reading[channel]).sum::<f64>() / count;
            let variance = readings.iter().map(|reading| reading[channel].powi(2)).sum::<f64>() / count;
            let shifted =
                readings.windows(2).map(|pair| pair[0][channel] * pair[1][channel]).sum::<f64>() / count;
            assert!(mean.abs() < bound, "channel {channel}: mean {mean}");
            assert!(
                (variance - 1.0).abs() < bound * 2.0_f64.sqrt(),
                "channel {channel}: variance {variance}"
            );
            assert!(shifted.abs() < bound, "channel {channel}: correlation {shifted}");
        }
        for (one, other) in [(0, 1), (0, 3), (6, 9), (2, 8)] {
            let together = readings.iter().map(|reading| reading[one] * reading[other]).sum::<f64>() / count;
            assert!(together.abs() < bound, "channels {one} and {other}: correlation {together}");
        }
    }
}
