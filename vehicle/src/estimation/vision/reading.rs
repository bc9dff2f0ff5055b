//! One estimate from outside.

use nalgebra::{UnitQuaternion, Vector3};

use crate::world::FARTHEST_M;

/// Faster than this, m/s, nothing that is estimated moves.
const FASTEST_M_S: f64 = 200.0;

/// A vector that somebody else has estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The vector.
    pub value: Vector3<f64>,
    /// Variances of its axes; what is not a positive number is unknown.
    pub variance: Vector3<f64>,
}

/// The frame of a velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocityFrame {
    /// North, east, down.
    North,
    /// That of the positions of a reading whose first axis points anywhere.
    Free,
    /// The vehicle's, FRD.
    Body,
}

/// An estimate of the motion, or of parts of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisionReading {
    /// Position, m: north, east, down, or along a first axis that points anywhere.
    pub position: Option<Measured>,
    /// Velocity, m/s, and its frame.
    pub velocity: Option<(VelocityFrame, Measured)>,
    /// Attitude, FRD into the frame of positions, and the variance of its heading, rad².
    pub attitude: Option<(UnitQuaternion<f64>, f64)>,
    /// Whether the first axis of positions points north.
    pub points_north: bool,
    /// Counts how often the one who estimates has begun anew elsewhere.
    pub resets: u8,
    /// Quality, %: −1 failed, 0 unknown.
    pub quality: i8,
}

impl VisionReading {
    /// Nothing, along axes that point north, east and down.
    pub const NOTHING: Self =
        Self { position: None, velocity: None, attitude: None, points_north: true, resets: 0, quality: 0 };

    /// With positions in other units, the variance of which is told in metres.
    pub fn scaled(mut self, scale: f64) -> Self {
        if let Some(position) = &mut self.position {
            position.value *= scale;
        }
        self
    }

    /// Whether what it says can be: finite numbers, at most 100 km away and 200 m/s fast.
    pub fn is_possible(&self) -> bool {
        let within = |measured: &Measured, most: f64| measured.value.norm() <= most;
        let attitude =
            self.attitude.is_none_or(|(attitude, _)| attitude.coords.iter().all(|part| part.is_finite()));
        self.position.is_none_or(|position| within(&position, FARTHEST_M))
            && self.velocity.is_none_or(|(_, velocity)| within(&velocity, FASTEST_M_S))
            && attitude
    }
}

impl Measured {
    /// A vector without known variances.
    pub fn of(value: Vector3<f64>) -> Self {
        Self { value, variance: Vector3::repeat(f64::NAN) }
    }

    /// Horizontal and vertical standard deviations: the told ones, if they count, but no less than the least and no more than
    /// the most.
    pub fn deviations(&self, least: f64, most: f64, told_counts: bool) -> [f64; 2] {
        let variance = |axis: usize| self.variance.get(axis).copied().unwrap_or(f64::NAN);
        let deviation = |axis: usize| deviation(variance(axis), least, most, told_counts);
        [deviation(0).max(deviation(1)), deviation(2)]
    }
}

/// The standard deviation of a variance, between the least and the most; the least if it is unknown or does not count.
pub fn deviation(variance: f64, least: f64, most: f64, told_counts: bool) -> f64 {
    let told = if told_counts && variance.is_finite() && variance > 0.0 { libm::sqrt(variance) } else { 0.0 };
    told.max(least).min(most)
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::{Measured, VelocityFrame, VisionReading, deviation};

    #[test]
    fn only_what_can_be_is_possible() {
        let at = |north: f64| VisionReading {
            position: Some(Measured::of(Vector3::new(north, 0.0, 0.0))),
            ..VisionReading::NOTHING
        };
        assert!(at(99e3).is_possible() && VisionReading::NOTHING.is_possible());
        for north in [1e6, f64::NAN, f64::INFINITY, -1e300] {
            assert!(!at(north).is_possible(), "{north}");
        }
        let fast = Measured::of(Vector3::new(0.0, 300.0, 0.0));
        assert!(
            !VisionReading { velocity: Some((VelocityFrame::Body, fast)), ..VisionReading::NOTHING }
                .is_possible()
        );
        let mut odd = UnitQuaternion::identity().into_inner();
        odd.w = f64::NAN;
        let attitude = Some((UnitQuaternion::new_unchecked(odd), 0.1));
        assert!(!VisionReading { attitude, ..VisionReading::NOTHING }.is_possible());
    }

    #[test]
    fn deviations_are_never_absurd() {
        for variance in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-30, 1e300, f64::MIN_POSITIVE] {
            let deviation = deviation(variance, 0.1, 100.0, true);
            assert!((0.1..=100.0).contains(&deviation), "{variance}: {deviation}");
        }
        assert_eq!(deviation(4.0, 0.1, 100.0, true), 2.0);
        assert_eq!(deviation(4.0, 0.1, 100.0, false), 0.1);
        let measured = Measured { value: Vector3::zeros(), variance: Vector3::new(1.0, 4.0, 9.0) };
        assert_eq!(measured.deviations(0.1, 100.0, true), [2.0, 3.0]);
    }
}
