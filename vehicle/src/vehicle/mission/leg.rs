//! One leg: straight to a place, and around its corner without stopping where the next leg allows.
//!
//! ```text
//!          W   acceptance radius around W
//!   entry ·─┐
//!   │       · exit ──► next leg
//!   │ straight, arrives at the entry with the speed of the corner
//! ```
//!
//! The shaper flies each piece: to the entry, around to the exit, and on. Entry and exit lie within the acceptance radius, the
//! way between them inside the triangle that they make with W.

use nalgebra::Vector3;
use quadrotor::PositionReference;

use super::path::Corner;

/// Where the next leg takes over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carry {
    /// End of the corner, NED, m.
    pub position_m: Vector3<f64>,
    /// Velocity there, NED, m/s.
    pub velocity_m_s: Vector3<f64>,
}

/// Part of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Around the corner before it.
    Leaving(Carry),
    /// Straight.
    Straight,
    /// Around the corner at its end.
    Turning,
}

/// How a leg goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LegProgress {
    /// It is flown.
    Flying,
    /// Its end is reached at rest.
    Arrived,
    /// Its end is passed.
    Passed(Carry),
}

/// A leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Where it begins, NED, m.
    pub from_m: Vector3<f64>,
    /// Where it ends, NED, m.
    pub to_m: Vector3<f64>,
    /// Acceptance radius of its end, m.
    pub radius_m: f64,
    corner: Option<Corner>,
    phase: Phase,
}

/// The nearest that an end at rest is waited for, m, and the farthest; and how slow, m/s.
const REST_M: (f64, f64) = (0.1, 0.5);
const SLOW_M_S: f64 = 0.5;
/// Share of a control sample that the switch to the next piece comes ahead: on average it is neither early nor late.
const AHEAD_S: f64 = 0.025;

impl Leg {
    /// A leg that takes a motion over, and passes its corner if there is one.
    pub fn new(
        from_m: Vector3<f64>,
        to_m: Vector3<f64>,
        radius_m: f64,
        carry: Option<Carry>,
        corner: Option<Corner>,
    ) -> Self {
        let phase = carry.map_or(Phase::Straight, Phase::Leaving);
        Self { from_m, to_m, radius_m, corner, phase }
    }

    /// The same with another corner, if it is not being flown yet.
    pub fn with_corner(mut self, corner: Option<Corner>) -> Self {
        if self.phase != Phase::Turning {
            self.corner = corner;
        }
        self
    }

    /// Its corner, if it passes one.
    pub fn corner(&self) -> Option<Corner> {
        self.corner
    }

    /// What the shaper is told.
    pub fn goal(&self, yaw_rad: f64) -> PositionReference {
        let (position_m, velocity_m_s) = match (self.phase, &self.corner) {
            (Phase::Leaving(carry), _) => (carry.position_m, carry.velocity_m_s),
            (Phase::Straight, Some(corner)) => (corner.entry_m, corner.entry_velocity_m_s),
            (Phase::Turning, Some(corner)) => (corner.exit_m, corner.exit_velocity_m_s),
            (_, None) => (self.to_m, Vector3::zeros()),
        };
        PositionReference { velocity_m_s, ..PositionReference::goal(position_m.into(), yaw_rad) }
    }

    /// One look: at the reference and at the vehicle.
    pub fn update(
        &mut self,
        reference: &PositionReference,
        position_m: &Vector3<f64>,
        velocity_m_s: &Vector3<f64>,
    ) -> LegProgress {
        if let Phase::Leaving(carry) = self.phase {
            if is_past(reference, &carry.position_m, &carry.velocity_m_s) {
                self.phase = Phase::Straight;
            }
            return LegProgress::Flying;
        }
        let distance_m = (position_m - self.to_m).norm();
        let Some(corner) = self.corner else {
            let near_m = self.radius_m.clamp(REST_M.0, REST_M.1);
            let arrived = distance_m < near_m && velocity_m_s.norm() < SLOW_M_S;
            return if arrived { LegProgress::Arrived } else { LegProgress::Flying };
        };
        if self.phase == Phase::Straight && is_past(reference, &corner.entry_m, &corner.entry_velocity_m_s) {
            self.phase = Phase::Turning;
        }
        let through = self.phase == Phase::Turning
            && (distance_m <= self.radius_m || is_past(reference, &corner.exit_m, &corner.exit_velocity_m_s));
        if !through {
            return LegProgress::Flying;
        }
        LegProgress::Passed(Carry { position_m: corner.exit_m, velocity_m_s: corner.exit_velocity_m_s })
    }

    /// Signed distance of a position from the leg's line, horizontally, positive to the right, m.
    pub fn cross_track_m(&self, position_m: &Vector3<f64>) -> f64 {
        let way = (self.to_m - self.from_m).xy();
        let off = (position_m - self.from_m).xy();
        match way.try_normalize(0.1) {
            Some(along) => along.x * off.y - along.y * off.x,
            None => off.norm(),
        }
    }

    /// Direction of the leg, rad from north, if it has a horizontal one.
    pub fn bearing_rad(&self) -> Option<f64> {
        const SHORTEST_M: f64 = 1.0;
        let way = self.to_m - self.from_m;
        (way.xy().norm() > SHORTEST_M).then(|| libm::atan2(way.y, way.x))
    }
}

/// Whether a reference that moves through a point has passed it, or does so within this sample.
fn is_past(reference: &PositionReference, point_m: &Vector3<f64>, velocity_m_s: &Vector3<f64>) -> bool {
    let speed_m_s = velocity_m_s.norm();
    if speed_m_s == 0.0 {
        return false;
    }
    (point_m - reference.position_m).dot(velocity_m_s) <= AHEAD_S * speed_m_s * speed_m_s
}
