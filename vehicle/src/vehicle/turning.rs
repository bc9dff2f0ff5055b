//! Turns of the heading.

use core::f64::consts::TAU;

use super::motion::wrapped;
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

    /// Turns on.
    pub fn step(&mut self, dt_s: f64) {
        let step = self.left_rad.clamp(-self.rate_rad_s * dt_s, self.rate_rad_s * dt_s);
        self.at_rad += step;
        self.left_rad -= step;
    }

    /// Heading now, rad, and its rate, rad/s.
    pub fn heading(&self) -> (f64, f64) {
        let rate_rad_s = if self.left_rad == 0.0 { 0.0 } else { self.rate_rad_s };
        (self.at_rad, libm::copysign(rate_rad_s, self.left_rad))
    }

    /// Whether the vehicle with a heading, rad, has turned as far.
    pub fn is_done(&self, yaw_rad: f64) -> bool {
        self.left_rad == 0.0 && wrapped(yaw_rad - self.at_rad).abs() < TURNED_RAD
    }
}
