//! Where the vehicle looks while it flies a mission.

use core::f64::consts::TAU;

use super::super::motion::wrapped;
use super::super::state::{TICK_US, Vehicle};
use super::super::steering::Steering;
use super::task::Task;
use crate::plan::MissionItem;

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
    /// Turns the shaper's goal to where the vehicle is to look.
    pub(super) fn turn_on_the_way(&mut self) {
        if let Some(turn) = &mut self.machines.mission.turn {
            turn.step(TICK_US as f64 / 1e6);
        }
        let (heading_rad, rate_rad_s) = self.mission_heading();
        self.consult(|_, situation, proposal| match proposal.steering() {
            Steering::Goal(_) => proposal.turn_on(Some((heading_rad, rate_rad_s))),
            _ => proposal.turn_to_region(situation),
        });
    }

    /// Heading, rad, and its rate, rad/s.
    fn mission_heading(&self) -> (f64, f64) {
        let mission = &self.machines.mission;
        if let Some(turn) = &mission.turn {
            let rate_rad_s = if turn.left_rad == 0.0 { 0.0 } else { turn.rate_rad_s };
            return (turn.at_rad, libm::copysign(rate_rad_s, turn.left_rad));
        }
        let next_m = match &mission.task {
            Some(Task::Leg(leg, _)) => Some(leg.to_m),
            _ => None,
        };
        let region = self.decided.region();
        let looked = region.and_then(|region| region.heading(&self.perception.outputs().setpoint, next_m));
        match (looked, self.decided.steering()) {
            (Some(looked), _) => looked,
            // What is too near to be looked at does not turn the vehicle.
            (None, Steering::Goal(goal)) if region.is_some() => (goal.yaw_rad, 0.0),
            _ => (mission.heading_rad, 0.0),
        }
    }
}
