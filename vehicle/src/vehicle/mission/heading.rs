//! Where the vehicle looks while it flies a mission.

use core::f64::consts::TAU;

use super::super::motion::wrapped;
use super::super::state::{TICK_US, Vehicle};
use super::super::steering::Steering;
use super::task::Task;
use crate::plan::step::{Turn, TurnDirection, TurnTo};

/// A turn that is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Heading now, rad.
    at_rad: f64,
    /// Left of it, rad, positive clockwise.
    left_rad: f64,
    rate_rad_s: f64,
}

/// So near to its angle, rad, a turn is done.
const TURNED_RAD: f64 = 0.05;

impl Turning {
    /// A turn from a heading, rad, at most at a rate, rad/s.
    pub fn new(turn: &Turn, from_rad: f64, fastest_rad_s: f64) -> Self {
        let left_rad = match turn.to {
            TurnTo::By(angle_rad) => angle_rad,
            TurnTo::Heading(heading_rad, direction) => {
                let short_rad = wrapped(heading_rad - from_rad);
                match direction {
                    // The long way round if that is the direction.
                    TurnDirection::Clockwise if short_rad < 0.0 => short_rad + TAU,
                    TurnDirection::CounterClockwise if short_rad > 0.0 => short_rad - TAU,
                    _ => short_rad,
                }
            }
        };
        let rate_rad_s = turn.rate_rad_s.map_or(fastest_rad_s, |asked_rad_s| asked_rad_s.min(fastest_rad_s));
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
        if let Some(turn) = &mut self.mission.turn {
            turn.step(TICK_US as f64 / 1e6);
        }
        let (heading_rad, rate_rad_s) = self.mission_heading();
        match &mut self.steering {
            Steering::Goal(goal) => (goal.yaw_rad, goal.yaw_rate_rad_s) = (heading_rad, rate_rad_s),
            _ => self.turn_to_region(),
        }
    }

    /// Heading, rad, and its rate, rad/s.
    fn mission_heading(&self) -> (f64, f64) {
        let mission = &self.mission;
        if let Some(turn) = &mission.turn {
            let rate_rad_s = if turn.left_rad == 0.0 { 0.0 } else { turn.rate_rad_s };
            return (turn.at_rad, libm::copysign(rate_rad_s, turn.left_rad));
        }
        let next_m = match &mission.task {
            Some(Task::Leg(leg, _)) => Some(leg.to_m),
            _ => None,
        };
        match (self.heading_to_region(next_m), &self.steering) {
            (Some(looked), _) => looked,
            // What is too near to be looked at does not turn the vehicle.
            (None, Steering::Goal(goal)) if self.region.is_some() => (goal.yaw_rad, 0.0),
            _ => (mission.heading_rad, 0.0),
        }
    }
}
