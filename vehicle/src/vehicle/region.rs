//! The region of interest: what the vehicle turns its nose to while it flies a mission, takes off, or holds its place.

use nalgebra::Vector3;
use quadrotor::PositionReference;

use super::notice::Refusal;
use super::set_point::YawTarget;
use super::state::Vehicle;
use super::steering::Steering;
use crate::mode::Mode;
use crate::plan::{FaultCode, MissionItem, PlanKind, check, command};

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegionOfInterest {
    /// A place, NED, m.
    Place(Vector3<f64>),
    /// Where the leg of a mission leads, plus an angle, rad.
    NextWaypoint(f64),
}

/// MAV_ROI that is an item of the mission.
const ITEM: f64 = 2.0;
/// Nearer than this, m, there is no direction to a place.
const TOO_NEAR_M: f64 = 0.5;

impl RegionOfInterest {
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
    /// DO_SET_ROI and its successors, as a command: until another one, or until the rotors stop.
    ///
    /// # Errors
    /// [`Refusal`] of what is no region, with the reason.
    pub fn look(&mut self, item: &MissionItem) -> Result<(), Refusal> {
        let number = self.first_mission_item();
        check::item(PlanKind::Mission, number, item, &self.site()).map_err(|fault| match fault.code {
            FaultCode::Unsupported => Refusal::Unsupported(fault.reason),
            FaultCode::UnsupportedFrame => Refusal::UnsupportedFrame(fault.reason),
            _ => Refusal::denied(format!("Region of interest: {}", fault.reason)),
        })?;
        let count = self.mission_items().len();
        let named = item.parameter(2);
        if item.command == command::DO_SET_ROI
            && item.parameter(1) == ITEM
            && !(0.0..count as f64).contains(&named)
        {
            return Err(Refusal::denied(format!("Region of interest: no item {named} among {count}")));
        }
        self.look_at(item);
        if self.region.is_none() && self.chooses_its_heading() {
            self.turn_on(None);
        }
        Ok(())
    }

    /// The same as an item.
    pub(super) fn look_at(&mut self, item: &MissionItem) {
        let place = |vehicle: &Self, item: &MissionItem| {
            let here_m = vehicle.outputs.position_m;
            vehicle.site().place(item).map(|place| {
                let [x, y] = place.horizontal_m.unwrap_or([here_m.x, here_m.y]);
                RegionOfInterest::Place(Vector3::new(x, y, place.down_m.unwrap_or(0.0)))
            })
        };
        self.region = match (item.command, item.parameter_or(1, 0.0) as i64) {
            (command::DO_SET_ROI_LOCATION, _) | (command::DO_SET_ROI, 3) => place(self, item),
            (command::DO_SET_ROI_WPNEXT_OFFSET, _) => {
                Some(RegionOfInterest::NextWaypoint(item.parameter_or(7, 0.0).to_radians()))
            }
            (command::DO_SET_ROI, 1) => Some(RegionOfInterest::NextWaypoint(0.0)),
            (command::DO_SET_ROI, 2) => {
                let index = item.parameter(2) as usize;
                self.mission_items().get(index).copied().and_then(|item| place(self, &item))
            }
            // ArduPilot's clients send the place without saying that it is one.
            (command::DO_SET_ROI, 0) if item.position.iter().any(|value| *value != 0.0) => place(self, item),
            _ => None,
        };
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
