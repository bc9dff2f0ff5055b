//! The way along a line.

use nalgebra::Vector3;
use quadrotor::{Limits, Motion, MotionProfile, PositionReference};

use super::super::motion::at_rest;
use super::direction_limits::limits_along;

/// A time-optimal way along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straight {
    from_m: Vector3<f64>,
    direction: Vector3<f64>,
    /// Along the line.
    profile: MotionProfile,
}

impl Straight {
    /// From a motion along a line to a place on it that is passed with a velocity. `None` if the motion is not along the line, or
    /// would have to turn back to come to that place so. It may run past a place to rest at: see [`Straight::leaves_its_way`].
    pub fn new(
        from: &PositionReference,
        to_m: &Vector3<f64>,
        velocity_m_s: &Vector3<f64>,
        limits: &Limits,
    ) -> Option<Self> {
        /// What counts as beside the line, and as no length: m, m/s, m/s².
        const BESIDE: f64 = 1e-3;
        let way_m = to_m - from.position_m;
        let towards = [*velocity_m_s, from.velocity_m_s, way_m];
        let direction = towards.into_iter().find_map(|vector| vector.try_normalize(BESIDE))?;
        let along = |vector: &Vector3<f64>| {
            let length = vector.dot(&direction);
            ((vector - direction * length).norm() <= BESIDE).then_some(length)
        };
        let motion = Motion {
            position: 0.0,
            velocity: along(&from.velocity_m_s)?,
            acceleration: along(&from.acceleration_m_s2)?,
            jerk: 0.0,
        };
        let (length_m, speed_m_s) = (along(&way_m)?, along(velocity_m_s)?);
        let axis = limits_along(&direction, limits);
        let profile = MotionProfile::fastest(&motion, length_m, speed_m_s, &axis)?;
        // To have come to rest and gone back is no way to pass a place.
        let turns_back = speed_m_s > 0.0 && profile.extremes_from(0.0).velocity[0] < -BESIDE;
        (!turns_back).then_some(Self { from_m: from.position_m, direction, profile })
    }

    /// Whether it runs past its end, or backs away from its beginning: its limits are too low for the motion that it begins with.
    pub fn leaves_its_way(&self) -> bool {
        /// What the vehicle does not show, m.
        const SMALL_M: f64 = 0.01;
        self.profile.extremes_from(0.0).beyond(self.profile.at(0.0).position, self.profile.end().position)
            > SMALL_M
    }

    /// From its beginning to its end, s.
    pub fn duration_s(&self) -> f64 {
        self.profile.duration_s()
    }

    /// Motion so many seconds after the beginning; after the end it goes on evenly. The heading is zero.
    pub fn at(&self, time_s: f64) -> PositionReference {
        let now = self.profile.at(time_s);
        PositionReference {
            velocity_m_s: self.direction * now.velocity,
            acceleration_m_s2: self.direction * now.acceleration,
            jerk_m_s3: self.direction * now.jerk,
            ..at_rest(self.from_m + self.direction * now.position, 0.0)
        }
    }
}
