//! Turns around a place, at the speed that half of the acceleration allows.

use core::f64::consts::TAU;

use nalgebra::Vector3;
use quadrotor::Limits;

use super::super::motion::wrapped;
use super::super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use crate::plan::step::Turns;

/// Radius of turns that name none, m: that of ArduPilot's circle mode.
const DEFAULT_RADIUS_M: f64 = 10.0;
/// Share of the horizontal acceleration that points to the centre.
const CENTRIPETAL: f64 = 0.5;
/// Share of it that speeds up and brakes.
const TANGENTIAL: f64 = 0.2;

/// A flight around a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    centre_m: Vector3<f64>,
    radius_m: f64,
    /// +1 clockwise seen from above, −1 the other way.
    direction: f64,
    /// Angle of the start seen from the centre, rad from north.
    start_rad: f64,
    /// Way around that is flown, and that is to be flown, rad.
    flown_rad: f64,
    turns_rad: f64,
    speed_m_s: f64,
}

impl Circle {
    /// Turns around a centre from the point of the circle that is next to a place.
    pub fn new(centre_m: Vector3<f64>, near_m: &Vector3<f64>, turns: &Turns) -> Self {
        let radius_m = turns.radius_m.unwrap_or(DEFAULT_RADIUS_M);
        let off = near_m - centre_m;
        Self {
            centre_m,
            radius_m: radius_m.abs(),
            direction: radius_m.signum(),
            start_rad: if off.xy().norm() > 1e-6 { libm::atan2(off.y, off.x) } else { 0.0 },
            flown_rad: 0.0,
            turns_rad: turns.turns * TAU,
            speed_m_s: 0.0,
        }
    }

    fn angle_rad(&self) -> f64 {
        self.start_rad + self.direction * self.flown_rad
    }

    /// Where it is now, NED, m.
    pub fn position_m(&self) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(self.angle_rad());
        self.centre_m + Vector3::new(cos, sin, 0.0) * self.radius_m
    }

    /// Heading towards the centre, rad.
    pub fn heading_rad(&self) -> f64 {
        wrapped(self.angle_rad() + TAU / 2.0)
    }

    /// Moves on by `dt_s`; `None` when all turns are flown.
    pub fn step(&mut self, limits: &Limits, dt_s: f64) -> Option<PositionSetPoint> {
        let a = limits.acceleration_horizontal_m_s2;
        let tangential = TANGENTIAL * a;
        let left_m = (self.turns_rad - self.flown_rad) * self.radius_m;
        if left_m <= 1e-3 {
            return None;
        }
        let fastest = libm::sqrt(CENTRIPETAL * a * self.radius_m).min(limits.speed_horizontal_m_s);
        // Slow enough to come to rest at the end, and never so slow that it does not come there.
        let wanted = libm::sqrt(2.0 * tangential * left_m).min(fastest).max(0.01);
        // Within lower limits than it began with it brakes as it must to come to rest at the end.
        let needed = self.speed_m_s * self.speed_m_s / (2.0 * left_m);
        let braking = (1.1 * tangential).max(needed);
        let change = (wanted - self.speed_m_s).clamp(-braking * dt_s, tangential * dt_s);
        self.speed_m_s += change;
        self.flown_rad += self.speed_m_s / self.radius_m * dt_s;
        Some(self.set_point(change / dt_s))
    }

    /// Position, velocity v along the circle and acceleration: v²/r to the centre, v̇ along it.
    fn set_point(&self, tangential_m_s2: f64) -> PositionSetPoint {
        let (sin, cos) = libm::sincos(self.angle_rad());
        let outward = Vector3::new(cos, sin, 0.0);
        let along = Vector3::new(-sin, cos, 0.0) * self.direction;
        let position_m = self.position_m();
        let velocity_m_s = along * self.speed_m_s;
        let acceleration_m_s2 =
            along * tangential_m_s2 - outward * (self.speed_m_s * self.speed_m_s / self.radius_m);
        let axes = core::array::from_fn(|axis| AxisTarget::Track {
            position_m: position_m[axis],
            velocity_m_s: velocity_m_s[axis],
            acceleration_m_s2: acceleration_m_s2[axis],
        });
        let rate_rad_s = self.direction * self.speed_m_s / self.radius_m;
        PositionSetPoint { axes, yaw: YawTarget::Track(self.heading_rad(), rate_rad_s) }
    }
}
