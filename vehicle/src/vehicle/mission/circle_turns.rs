//! Turns around a place, at the speed that half of the acceleration allows.

use core::f64::consts::TAU;

use nalgebra::Vector3;
use quadrotor::Limits;

use super::super::circle::Circle;
use super::super::set_point::PositionSetPoint;
use crate::plan::step::Turns;

/// Radius of turns that name none, m: that of ArduPilot's circle mode.
const DEFAULT_RADIUS_M: f64 = 10.0;
/// Share of the horizontal acceleration that points to the centre.
const CENTRIPETAL: f64 = 0.5;

/// A number of turns around a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircleTurns {
    circle: Circle,
    turns_rad: f64,
}

impl CircleTurns {
    /// Turns around a centre from the point of the circle that is next to a place.
    pub fn new(centre_m: Vector3<f64>, near_m: &Vector3<f64>, turns: &Turns) -> Self {
        let radius_m = turns.radius_m.unwrap_or(DEFAULT_RADIUS_M);
        Self { circle: Circle::new(centre_m, near_m, radius_m), turns_rad: turns.turns * TAU }
    }

    /// Where it is now, NED, m.
    pub fn position_m(&self) -> Vector3<f64> {
        self.circle.position_m()
    }

    /// Places of the turns, NED, m: of the first one, and the end of the last one.
    pub fn sketch_m(&self) -> impl Iterator<Item = Vector3<f64>> {
        const PARTS: u32 = 24;
        let first_rad = self.turns_rad.min(TAU);
        let parts = (1..=PARTS).map(move |part| first_rad * f64::from(part) / f64::from(PARTS));
        parts.chain([self.turns_rad]).map(|flown_rad| self.circle.ahead_m(flown_rad))
    }

    /// Heading towards the centre, rad.
    pub fn heading_rad(&self) -> f64 {
        self.circle.heading_rad()
    }

    /// Moves on by `dt_s`; `None` when all turns are flown.
    pub fn step(&mut self, limits: &Limits, dt_s: f64) -> Option<PositionSetPoint> {
        let tangential = Circle::tangential_m_s2(limits);
        let left_m = (self.turns_rad - self.circle.flown_rad()) * self.circle.radius_m();
        if left_m <= 1e-3 {
            return None;
        }
        let fastest = self.circle.fastest_m_s(CENTRIPETAL, limits);
        // Slow enough to come to rest at the end, and never so slow that it does not come there.
        let wanted = libm::sqrt(2.0 * tangential * left_m).min(fastest).max(0.01);
        // Within lower limits than it began with it brakes as it must to come to rest at the end.
        let speed_m_s = self.circle.speed_m_s();
        let needed = speed_m_s * speed_m_s / (2.0 * left_m);
        Some(self.circle.advance(wanted, (1.1 * tangential).max(needed), limits, dt_s))
    }
}
