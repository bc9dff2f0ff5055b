//! Along a piece of a planned way, with a heading of its own.

use nalgebra::Vector3;
use quadrotor::{Heading, HeadingShaper, Limits, PositionReference};

use super::trajectory::PieceFlight;

/// The way that is flown now. It goes on by itself: after its end evenly, or at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSteering {
    flight: PieceFlight,
    /// The corners of the way after the piece, NED, m.
    after_m: [Vector3<f64>; 2],
    heading: HeadingShaper,
    /// Where the nose is to point.
    goal: Heading,
}

impl PathSteering {
    /// Begins with a reference's heading, which is to become another one.
    pub fn new(
        flight: PieceFlight,
        after_m: [Vector3<f64>; 2],
        now: &PositionReference,
        yaw_rad: f64,
        limits: &Limits,
        time_us: u64,
    ) -> Self {
        let heading = HeadingShaper::moving(&Heading::of(now), limits, time_us);
        Self { flight, after_m, heading, goal: Heading::fixed(yaw_rad) }
    }

    /// The same on another piece.
    pub fn onto(self, flight: PieceFlight, after_m: [Vector3<f64>; 2]) -> Self {
        Self { flight, after_m, ..self }
    }

    /// The same with the nose somewhere else.
    pub fn turn_to(&mut self, goal: Heading) {
        self.goal = goal;
    }

    /// Where the nose is to point.
    pub fn goal(&self) -> Heading {
        self.goal
    }

    /// Places on the way from a time, µs, on, NED, m, as far as it is known: on the present piece, then its corners.
    pub fn places_m(&self, time_us: u64) -> impl Iterator<Item = Vector3<f64>> {
        self.flight.places_m(time_us).chain(self.after_m)
    }

    /// The highest that the known way leads, z, m.
    pub fn highest_z_m(&self) -> f64 {
        self.after_m.iter().map(|place_m| place_m.z).fold(self.end().position_m.z, f64::min)
    }

    /// Motion at the end of the piece.
    pub fn end(&self) -> PositionReference {
        self.flight.end()
    }

    /// The reference at a time, µs.
    pub fn reference(&mut self, limits: &Limits, time_us: u64) -> PositionReference {
        self.heading.update(&self.goal, limits, time_us);
        self.heading.heading(time_us).on(&self.flight.at(time_us))
    }
}
