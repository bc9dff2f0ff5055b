//! The region of interest: what the vehicle turns its nose to while it flies a mission, takes off, or holds its place.

use nalgebra::Vector3;
use quadrotor::PositionReference;

use super::set_point::YawTarget;
use super::state::Vehicle;
use super::steering::Steering;
use crate::mode::Mode;
use crate::plan::Look;

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegionOfInterest {
    /// A place, NED, m.
    Place(Vector3<f64>),
    /// Where the leg of a mission leads, plus an angle, rad.
    NextWaypoint(f64),
}

/// Nearer than this, m, there is no direction to a place.
const TOO_NEAR_M: f64 = 0.5;

impl RegionOfInterest {
    /// What is looked at by a vehicle at `here_m`, NED, while home is at `home_z_m`.
    pub fn of(look: &Look, here_m: &Vector3<f64>, home_z_m: f64) -> Self {
        match look {
            Look::At(place) => {
                let [x, y] = place.horizontal_m.unwrap_or([here_m.x, here_m.y]);
                Self::Place(Vector3::new(x, y, place.down_m(home_z_m).unwrap_or(0.0)))
            }
            Look::NextWaypoint { offset_rad } => Self::NextWaypoint(*offset_rad),
        }
    }

    /// Heading to it, rad, and its rate, rad/s, seen from a reference on a leg that leads to `next_m`; `None` where there is
    /// nothing to be looked at.
    pub fn heading(&self, reference: &PositionReference, next_m: Option<Vector3<f64>>) -> Option<(f64, f64)> {
        let (place_m, offset_rad) = match *self {
            Self::Place(place_m) => (place_m, 0.0),
            Self::NextWaypoint(offset_rad) => (next_m?, offset_rad),
        };
        // ψ = atan2(w_y, w_x),  ψ̇ = (w_y v_x − w_x v_y) / (w_x² + w_y²)
        let (way, v) = ((place_m - reference.position_m).xy(), reference.velocity_m_s);
        let rate_rad_s = (way.y * v.x - way.x * v.y) / way.norm_squared();
        (way.norm() > TOO_NEAR_M).then(|| (libm::atan2(way.y, way.x) + offset_rad, rate_rad_s))
    }
}

impl Vehicle {
    /// Looks at something, `None` at nothing any more: until another one, or until the rotors stop.
    pub fn look(&mut self, look: Option<&Look>) {
        let (here_m, home_z_m) = (self.outputs.position_m, self.home.position_m.z);
        self.region = look.map(|look| RegionOfInterest::of(look, &here_m, home_z_m));
        if self.region.is_none() && self.chooses_its_heading() {
            self.turn_on(None);
        }
    }

    /// Heading to it, rad, and its rate, rad/s, on a leg that leads to `next_m`; `None` where there is nothing to be looked at.
    pub(super) fn heading_to_region(&self, next_m: Option<Vector3<f64>>) -> Option<(f64, f64)> {
        self.region?.heading(&self.outputs.setpoint, next_m)
    }

    /// Turns the vehicle to it where nothing else asks for a heading.
    pub(super) fn turn_to_region(&mut self) {
        if self.region.is_some() {
            self.turn_on(self.heading_to_region(None));
        }
    }

    /// Turns on to a heading, rad, that changes at a rate, rad/s; without one it stays.
    fn turn_on(&mut self, heading: Option<(f64, f64)>) {
        match (&mut self.steering, heading) {
            (Steering::Goal(goal), Some((heading_rad, rate_rad_s))) => {
                (goal.yaw_rad, goal.yaw_rate_rad_s) = (heading_rad, rate_rad_s);
            }
            (Steering::Goal(goal), None) => goal.yaw_rate_rad_s = 0.0,
            (Steering::Motion(motion), Some((heading_rad, rate_rad_s))) => {
                motion.turn_to(YawTarget::Follow(heading_rad, rate_rad_s));
            }
            (Steering::Motion(motion), None) => motion.turn_to(YawTarget::Hold),
            (Steering::Idle { .. } | Steering::Attitude { .. } | Steering::Descent { .. }, _) => {}
        }
    }

    /// Whether the mode leaves the heading to the vehicle.
    pub(super) fn chooses_its_heading(&self) -> bool {
        match self.mode {
            Mode::Hold | Mode::Takeoff => true,
            // ArduPilot's guided mode, before set-points steer it.
            Mode::Offboard => self.identity.is_ardupilot() && !self.set_points.applied,
            _ => false,
        }
    }
}
