//! Along a piece of a planned way, with a heading of its own.

use nalgebra::Vector3;
use quadrotor::{Heading, HeadingShaper, Limits, PositionReference};

use super::trajectory::PieceFlight;

/// The way that is flown now. It goes on by itself: after its end evenly, or at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSteering {
    flight: PieceFlight,
    /// The corners of the way from here on, NED, m: it stays between them.
    ahead_m: [Vector3<f64>; 2],
    heading: HeadingShaper,
    /// Where the nose is to point.
    goal: Heading,
}

impl PathSteering {
    /// Begins with a reference's heading, which is to become another one.
    pub fn new(
        flight: PieceFlight,
        ahead_m: [Vector3<f64>; 2],
        now: &PositionReference,
        yaw_rad: f64,
        time_us: u64,
    ) -> Self {
        let heading = HeadingShaper::moving(&Heading::of(now), time_us);
        Self { flight, ahead_m, heading, goal: Heading { yaw_rad, yaw_rate_rad_s: 0.0 } }
    }

    /// The same on another piece.
    pub fn onto(self, flight: PieceFlight, ahead_m: [Vector3<f64>; 2]) -> Self {
        Self { flight, ahead_m, ..self }
    }

    /// The same with the nose somewhere else.
    pub fn turn_to(&mut self, goal: Heading) {
        self.goal = goal;
    }

    /// Where the nose is to point.
    pub fn goal(&self) -> Heading {
        self.goal
    }

    /// The corners of the way from here on, NED, m.
    pub fn ahead_m(&self) -> [Vector3<f64>; 2] {
        self.ahead_m
    }

    /// Motion at the end of the piece.
    pub fn end(&self) -> PositionReference {
        self.flight.end()
    }

    /// The reference at a time, µs.
    pub fn reference(&mut self, limits: &Limits, time_us: u64) -> PositionReference {
        self.heading.update(&self.goal, limits, time_us);
        let Heading { yaw_rad, yaw_rate_rad_s } = self.heading.heading(time_us);
        PositionReference { yaw_rad, yaw_rate_rad_s, ..self.flight.at(time_us) }
    }
}
