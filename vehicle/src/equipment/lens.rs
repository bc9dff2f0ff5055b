//! Zoom and focus.

/// Shortest focal length, mm, and how many times longer the longest is.
pub const FOCAL_LENGTH_MM: f64 = 8.0;
const LONGEST: f64 = 10.0;
/// Width and height of the sensor, mm.
pub const SENSOR_MM: [f64; 2] = [6.17, 4.55];
/// A step, percent.
const STEP: f64 = 10.0;
/// Movement at full rate, percent per second.
const FASTEST_PER_S: f64 = 20.0;

/// How zoom or focus is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// One step, up or down.
    Step(f64),
    /// On and on, −1 to 1 of the full rate; 0 stops.
    Continuous(f64),
    /// To a share of the range, percent.
    Range(f64),
    /// To a focal length, mm.
    FocalLength(f64),
    /// To a distance in focus, m.
    Distance(f64),
    /// By itself.
    Automatic,
}

/// A drive with its place.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Lens {
    percent: f64,
    rate: f64,
}

impl Lens {
    /// Its place in the range, percent.
    pub fn percent(&self) -> f64 {
        self.percent
    }

    /// Whether nothing will happen by itself.
    pub fn rests(&self) -> bool {
        self.rate == 0.0
    }

    /// Drives it.
    pub fn drive(&mut self, drive: Drive) {
        self.rate = 0.0;
        let percent = match drive {
            Drive::Step(direction) => self.percent + STEP * direction.signum(),
            Drive::Continuous(rate) => {
                self.rate = rate.clamp(-1.0, 1.0);
                self.percent
            }
            Drive::Range(percent) => percent,
            Drive::FocalLength(length_mm) => (length_mm / FOCAL_LENGTH_MM - 1.0) / (LONGEST - 1.0) * 100.0,
            // Half of the range at 1 m, all of it at infinity.
            Drive::Distance(distance_m) => 100.0 * distance_m / (1.0 + distance_m),
            Drive::Automatic => 100.0,
        };
        self.percent = percent.clamp(0.0, 100.0);
    }

    /// Moves on by a time, s.
    pub fn step(&mut self, dt_s: f64) {
        if self.rate != 0.0 {
            self.percent = (self.percent + FASTEST_PER_S * self.rate * dt_s).clamp(0.0, 100.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Drive, Lens};

    #[test]
    fn it_is_driven_within_its_range() {
        let mut lens = Lens::default();
        let mut at = |drive| {
            lens.drive(drive);
            lens.percent()
        };
        assert_eq!(at(Drive::Step(1.0)), 10.0);
        assert_eq!(at(Drive::Step(-1.0)), 0.0);
        assert_eq!(at(Drive::Step(-1.0)), 0.0);
        assert_eq!(at(Drive::Range(40.0)), 40.0);
        assert_eq!(at(Drive::FocalLength(80.0)), 100.0);
        assert_eq!(at(Drive::Distance(1.0)), 50.0);
        lens.drive(Drive::Continuous(-0.5));
        lens.step(2.0);
        assert_eq!((lens.percent(), lens.rests()), (30.0, false));
        lens.drive(Drive::Continuous(0.0));
        assert!(lens.rests());
    }
}
