//! What faults make of readings.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::barometer::BarometerReading;
use super::gps::GpsFix;
use super::magnetometer::MagnetometerReading;
use super::noise::{Channel, Noise};
use crate::fault::{Sensor, SensorFault};

/// A reading that faults can spoil.
pub trait Spoil: Copy {
    /// When it is said to have been taken, µs.
    fn time_us(&self) -> u64;
    /// The same, said to have been taken at another time.
    fn restamped(self, time_us: u64) -> Self;
    /// With an error added: along each axis, of the pressure in the first of them, of the position.
    fn with_error(self, error: &Vector3<f64>) -> Self;
}

/// Three axes of an inertial unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// When, µs.
    pub time_us: u64,
    /// What, FRD.
    pub axes: Vector3<f64>,
}

/// Stands behind an instrument and lets its readings through, or what its fault leaves of them.
#[derive(Clone, Debug)]
pub struct Defect<R> {
    sensor: Sensor,
    noise: Noise,
    readings: u64,
    told: Option<R>,
    underway: VecDeque<R>,
}

impl<R: Spoil> Defect<R> {
    /// Behind a sound instrument.
    pub fn new(sensor: Sensor, seed: u64) -> Self {
        let noise = Noise::new(seed, Channel::Fault(sensor));
        Self { sensor, noise, readings: 0, told: None, underway: VecDeque::new() }
    }

    /// What is told of a reading.
    pub fn tell(&mut self, reading: R, fault: Option<SensorFault>) -> Option<R> {
        let time_us = reading.time_us();
        if fault != Some(SensorFault::Delayed) {
            self.underway.clear();
        }
        self.readings = self.readings.wrapping_add(1);
        let told = match fault {
            Some(fault) if fault.is_silent(time_us) => None,
            None | Some(SensorFault::Off | SensorFault::Intermittent) => Some(reading),
            Some(SensorFault::Stuck) => Some(self.told.unwrap_or(reading).restamped(time_us)),
            Some(SensorFault::Garbage) => Some(reading.with_error(&self.noise.vector(self.sensor.garbage()))),
            Some(SensorFault::Wrong) => Some(reading.with_error(&self.offset())),
            Some(SensorFault::Slow) => self.readings.is_multiple_of(SensorFault::SLOWNESS).then_some(reading),
            Some(SensorFault::Delayed) => {
                self.underway.push_back(reading);
                let due = |first: &&R| first.time_us() + SensorFault::DELAY_US <= time_us;
                let late = self.underway.front().filter(due).copied();
                if late.is_some() {
                    self.underway.pop_front();
                }
                late.map(|late| late.restamped(time_us))
            }
        };
        self.told = told.or(self.told);
        told
    }

    fn offset(&self) -> Vector3<f64> {
        let offset = self.sensor.offset();
        match self.sensor {
            Sensor::Gps => Vector3::new(offset, 0.0, 0.0),
            _ => Vector3::repeat(offset),
        }
    }
}

impl Spoil for Axes {
    fn time_us(&self) -> u64 {
        self.time_us
    }

    fn restamped(self, time_us: u64) -> Self {
        Self { time_us, ..self }
    }

    fn with_error(self, error: &Vector3<f64>) -> Self {
        Self { axes: self.axes + error, ..self }
    }
}

impl Spoil for GpsFix {
    fn time_us(&self) -> u64 {
        self.time_us
    }

    fn restamped(self, time_us: u64) -> Self {
        Self { time_us, ..self }
    }

    fn with_error(self, error: &Vector3<f64>) -> Self {
        Self { position_m: self.position_m + error, ..self }
    }
}

impl Spoil for BarometerReading {
    fn time_us(&self) -> u64 {
        self.time_us
    }

    fn restamped(self, time_us: u64) -> Self {
        Self { time_us, ..self }
    }

    fn with_error(self, error: &Vector3<f64>) -> Self {
        Self { pressure_pa: self.pressure_pa + error.x, ..self }
    }
}

impl Spoil for MagnetometerReading {
    fn time_us(&self) -> u64 {
        self.time_us
    }

    fn restamped(self, time_us: u64) -> Self {
        Self { time_us, ..self }
    }

    fn with_error(self, error: &Vector3<f64>) -> Self {
        Self { field_gauss: self.field_gauss + error, ..self }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Axes, Defect};
    use crate::fault::{Sensor, SensorFault};

    /// What is told of readings every 10 ms, whose first axis is their number; the fault begins with the 100th.
    fn told(sensor: Sensor, fault: SensorFault) -> Vec<(u64, Option<Axes>)> {
        let mut defect = Defect::new(sensor, 1);
        let reading =
            |number: u64| Axes { time_us: number * 10_000, axes: Vector3::new(number as f64, 0.0, 0.0) };
        (0..400)
            .map(|number| (number, defect.tell(reading(number), (number >= 100).then_some(fault))))
            .skip(100)
            .collect()
    }

    #[test]
    fn each_fault_leaves_what_its_name_says() {
        use SensorFault::{Delayed, Garbage, Intermittent, Off, Slow, Stuck, Wrong};
        let sensor = Sensor::Magnetometer;
        assert!(told(sensor, Off).iter().all(|(_, told)| told.is_none()));
        for (number, told) in told(sensor, Stuck) {
            let told = told.expect("it repeats");
            assert_eq!((told.time_us, told.axes.x), (number * 10_000, 99.0));
        }
        for (number, told) in told(sensor, Wrong) {
            let error = told.expect("a reading").axes - Vector3::new(number as f64, 0.0, 0.0);
            assert!((error - Vector3::repeat(0.2)).norm() < 1e-9, "{error}");
        }
        let slow = told(sensor, Slow);
        assert_eq!(slow.iter().filter(|(_, told)| told.is_some()).count(), 60);
        for (number, told) in told(sensor, Delayed) {
            // Half a second is 50 readings, and until the first arrives there is none.
            let expected = (number >= 150).then(|| ((number * 10_000), (number - 50) as f64));
            assert_eq!(told.map(|told| (told.time_us, told.axes.x)), expected);
        }
        // A second by turns: silent from 2 to 3 s, and from the start of the fault at 1 s it speaks.
        for (number, told) in told(sensor, Intermittent) {
            assert_eq!(told.is_some(), !(200..300).contains(&number), "{number}");
        }
        let garbage = told(sensor, Garbage);
        let squares = garbage.iter().filter_map(|(_, told)| *told).map(|told| told.axes.y.powi(2));
        let deviation = (squares.sum::<f64>() / 300.0).sqrt();
        assert!((deviation / 0.5 - 1.0).abs() < 5.0 / (2.0_f64 * 300.0).sqrt(), "{deviation}");
        // To the north only.
        let off = told(Sensor::Gps, Wrong)[0].1.expect("a reading").axes;
        assert_eq!(off, Vector3::new(110.0, 0.0, 0.0));
    }
}
