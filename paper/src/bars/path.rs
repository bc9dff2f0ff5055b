//! Paths that are flown at a constant rate of their phase.

use nalgebra::Vector3;
use quadrotor::PositionReference;

use super::taylor::Taylor;

/// A path begins at rest and comes to its rate during this time, s.
pub const START_S: f64 = 5.0;

/// What is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// x = A sin p, y = A/2 sin 2p.
    FigureEight,
    /// x = A cos p, y = A sin p.
    Circle,
    /// The same with z = A/2 sin p.
    TiltedCircle,
    /// x = A sin p, z = A/4 sin 2p.
    UprightEight,
}

/// A closed path about the origin at height zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// What is flown.
    pub shape: Shape,
    /// A, m.
    pub size_m: f64,
    /// Rate of the phase p, rad/s.
    pub rate_rad_s: f64,
}

impl Path {
    /// North, east and down with their derivatives, m.
    pub fn at(&self, time_s: f64) -> [Taylor; 3] {
        let (size_m, level) = (self.size_m, Taylor::line(0.0, 0.0));
        let phase = self.phase(time_s);
        let (sine, cosine) = phase.sine_and_cosine();
        let double = || (phase * 2.0).sine_and_cosine().0;
        match self.shape {
            Shape::FigureEight => [sine * size_m, double() * (size_m / 2.0), level],
            Shape::Circle => [cosine * size_m, sine * size_m, level],
            Shape::TiltedCircle => [cosine * size_m, sine * size_m, sine * (size_m / 2.0)],
            Shape::UprightEight => [sine * size_m, level, double() * (size_m / 4.0)],
        }
    }

    /// p: its rate rises as 10 s³ − 15 s⁴ + 6 s⁵ with s = t/5 s, so that position up to snap begin at rest.
    fn phase(&self, time_s: f64) -> Taylor {
        if time_s >= START_S {
            return Taylor::line(self.rate_rad_s * (time_s - START_S / 2.0), self.rate_rad_s);
        }
        let s = Taylor::line(time_s.max(0.0) / START_S, 1.0 / START_S);
        let travelled = s.power(4) * 2.5 - s.power(5) * 3.0 + s.power(6);
        travelled * (self.rate_rad_s * START_S)
    }

    /// What the geometric controller reaches on the paths of the table of bars, RMS, cm; for others nothing is known.
    pub fn bar_cm(&self) -> f64 {
        match (self.shape, self.size_m, self.rate_rad_s) {
            (Shape::FigureEight, 6.0, 0.7) => 1.2,
            (Shape::FigureEight, 6.0, 0.85) => 2.6,
            (Shape::Circle, 4.0, 1.2) => 0.9,
            (Shape::Circle, 4.0, 1.5) => 2.7,
            _ => f64::INFINITY,
        }
    }

    /// A derivative of the position in NED, m, s.
    pub fn derivative(&self, time_s: f64, order: usize) -> Vector3<f64> {
        Vector3::from(self.at(time_s).map(|axis| axis.derivative(order)))
    }

    /// The point of the trajectory; the heading is north.
    pub fn reference(&self, time_s: f64) -> PositionReference {
        PositionReference {
            velocity_m_s: self.derivative(time_s, 1),
            acceleration_m_s2: self.derivative(time_s, 2),
            jerk_m_s3: self.derivative(time_s, 3),
            snap_m_s4: self.derivative(time_s, 4),
            ..PositionReference::goal(self.derivative(time_s, 0).into(), 0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Path, START_S, Shape};

    fn eight(rate_rad_s: f64) -> Path {
        Path { shape: Shape::FigureEight, size_m: 6.0, rate_rad_s }
    }

    /// 2 A ω² is the largest acceleration to the east: 5.9 and 8.7 m/s² at 0.7 and 0.85 rad/s.
    #[test]
    fn figure_eights_accelerate_as_they_should() {
        for (rate_rad_s, most) in [(0.7, 5.88), (0.85, 8.67)] {
            let path = eight(rate_rad_s);
            let east = |step: u32| path.derivative(START_S + f64::from(step) * 1e-3, 2).y.abs();
            let largest = (0..10_000).map(east).fold(0.0, f64::max);
            assert!((largest - most).abs() < 1e-3, "{largest}");
        }
    }

    /// Central differences of each derivative give the next one, also while the path starts.
    #[test]
    fn each_derivative_is_that_of_the_one_before() {
        let with = |shape| Path { shape, size_m: 4.0, rate_rad_s: 1.2 };
        for path in [eight(0.85), with(Shape::Circle), with(Shape::TiltedCircle), with(Shape::UprightEight)] {
            for time_s in [0.3, 2.5, 4.9, 5.5, 17.0] {
                for order in 0..4 {
                    let ahead = path.derivative(time_s + 1e-4, order);
                    let behind = path.derivative(time_s - 1e-4, order);
                    let slope = (ahead - behind) / 2e-4;
                    assert!((slope - path.derivative(time_s, order + 1)).norm() < 1e-5, "{time_s} {order}");
                }
            }
        }
    }

    /// A ω² and A ω² are the largest accelerations north and up of an upright eight; a tilted circle rises by half of what it is wide.
    #[test]
    fn upright_paths_climb_as_they_should() {
        let with = |shape| Path { shape, size_m: 4.0, rate_rad_s: 1.5 };
        let largest = |path: Path, order: usize| {
            let each = (0..10_000).map(|step| path.derivative(START_S + f64::from(step) * 1e-3, order).abs());
            each.fold(Vector3::zeros(), |largest, each| largest.sup(&each))
        };
        let eight = largest(with(Shape::UprightEight), 2);
        assert!((eight - Vector3::new(9.0, 0.0, 9.0)).norm() < 1e-3, "{eight}");
        let circle = largest(with(Shape::TiltedCircle), 0);
        assert!((circle - Vector3::new(4.0, 4.0, 2.0)).norm() < 1e-3, "{circle}");
    }

    #[test]
    fn paths_begin_at_rest() {
        for order in 1..=3 {
            assert_eq!(eight(1.0).derivative(0.0, order).norm(), 0.0);
        }
    }
}
