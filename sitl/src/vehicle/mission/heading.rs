//! Where the vehicle looks while it flies a mission.

use core::f64::consts::TAU;

use nalgebra::Vector3;

use super::super::motion::wrapped;
use super::super::state::{TICK_US, Vehicle};
use super::super::steering::Steering;
use super::task::Task;
use crate::plan::{MissionItem, command};

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegionOfInterest {
    /// A place, NED, m.
    Place(Vector3<f64>),
    /// Where the leg leads, plus an angle, rad.
    NextWaypoint(f64),
}

/// A turn at a rate in a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Heading now, rad.
    at_rad: f64,
    /// Left of it, rad, positive clockwise.
    left_rad: f64,
    rate_rad_s: f64,
}

/// So near to its angle, rad, a turn is done.
const TURNED_RAD: f64 = 0.05;
/// Nearer than this, m, there is no direction to a place.
const TOO_NEAR_M: f64 = 0.5;

impl Turn {
    /// CONDITION_YAW from a heading, rad: angle, rate (0: as fast as `fastest_rad_s`), direction (0: the short way; a relative
    /// angle turns clockwise then), relative or not.
    pub fn new(item: &MissionItem, from_rad: f64, fastest_rad_s: f64) -> Self {
        let angle_rad = item.parameter(1).to_radians();
        let direction = item.parameter_or(3, 0.0);
        let relative = item.parameter_or(4, 0.0) > 0.5;
        let short_rad = wrapped(angle_rad - from_rad);
        let left_rad = match (relative, direction) {
            (true, direction) if direction < 0.0 => -angle_rad,
            (true, _) => angle_rad,
            (false, 0.0) => short_rad,
            // The long way round if that is the direction.
            (false, direction) if short_rad * direction < 0.0 => short_rad + TAU * direction.signum(),
            (false, _) => short_rad,
        };
        let asked_rad_s = item.parameter_or(2, 0.0).to_radians();
        let rate_rad_s = if asked_rad_s > 0.0 { asked_rad_s.min(fastest_rad_s) } else { fastest_rad_s };
        Self { at_rad: from_rad, left_rad, rate_rad_s }
    }

    fn step(&mut self, dt_s: f64) {
        let step = self.left_rad.clamp(-self.rate_rad_s * dt_s, self.rate_rad_s * dt_s);
        self.at_rad += step;
        self.left_rad -= step;
    }

    /// Whether the vehicle with a heading, rad, has turned as far.
    pub fn is_done(&self, yaw_rad: f64) -> bool {
        self.left_rad == 0.0 && wrapped(yaw_rad - self.at_rad).abs() < TURNED_RAD
    }
}

impl Vehicle {
    /// DO_SET_ROI and its successors.
    pub(super) fn look_at(&mut self, item: &MissionItem) {
        let place = |vehicle: &Self, item: &MissionItem| {
            let anchor_m = vehicle.mission.anchor_m;
            vehicle.site().place(item).map(|place| {
                let [x, y] = place.horizontal_m.unwrap_or([anchor_m.x, anchor_m.y]);
                RegionOfInterest::Place(Vector3::new(x, y, place.down_m.unwrap_or(0.0)))
            })
        };
        self.mission.region = match (item.command, item.parameter_or(1, 0.0) as i64) {
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

    /// Turns the shaper's goal to where the vehicle is to look.
    pub(super) fn turn_on_the_way(&mut self) {
        if let Some(turn) = &mut self.mission.turn {
            turn.step(TICK_US as f64 / 1e6);
        }
        let (heading_rad, rate_rad_s) = self.mission_heading();
        if let Steering::Goal(goal) = &mut self.steering {
            (goal.yaw_rad, goal.yaw_rate_rad_s) = (heading_rad, rate_rad_s);
        }
    }

    /// Heading, rad, and its rate, rad/s.
    fn mission_heading(&self) -> (f64, f64) {
        let mission = &self.mission;
        if let Some(turn) = &mission.turn {
            let rate_rad_s = if turn.left_rad == 0.0 { 0.0 } else { turn.rate_rad_s };
            return (turn.at_rad, libm::copysign(rate_rad_s, turn.left_rad));
        }
        // ψ = atan2(w_y, w_x),  ψ̇ = (w_y v_x − w_x v_y) / (w_x² + w_y²)
        let bearing_to = |place_m: &Vector3<f64>| {
            let reference = &self.outputs.setpoint;
            let (way, v) = ((place_m - reference.position_m).xy(), reference.velocity_m_s);
            let rate_rad_s = (way.y * v.x - way.x * v.y) / way.norm_squared();
            (way.norm() > TOO_NEAR_M).then(|| (libm::atan2(way.y, way.x), rate_rad_s))
        };
        let looked = match (&mission.region, &mission.task) {
            (Some(RegionOfInterest::Place(place_m)), _) => bearing_to(place_m),
            (Some(RegionOfInterest::NextWaypoint(offset)), Some(Task::Leg(leg, _))) => {
                bearing_to(&leg.to_m).map(|(bearing, rate)| (bearing + offset, rate))
            }
            _ => None,
        };
        match (looked, &self.steering) {
            (Some(looked), _) => looked,
            // What is too near to be looked at does not turn the vehicle.
            (None, Steering::Goal(goal)) if mission.region.is_some() => (goal.yaw_rad, 0.0),
            _ => (mission.heading_rad, 0.0),
        }
    }
}
