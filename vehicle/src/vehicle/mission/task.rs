//! What is being done for a step.

use super::super::ground_way::GroundWay;
use super::super::situation::Situation;
use super::super::spline::Spline;
use super::circle_turns::CircleTurns;
use super::leg::{Leg, Turn};
use crate::plan::step::Delay;

/// A task.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
pub enum Task {
    /// Up to z, m, where it is.
    Climb {
        /// Goal, m.
        z_m: f64,
        /// Whether that is a takeoff, or the way up to another step.
        takeoff: bool,
    },
    /// The nose to the next place, before it flies there.
    Face,
    /// To a place.
    Leg(Leg, Then),
    /// Until a time, µs, or for ever.
    Wait(Option<u64>),
    /// Around a place.
    Circle(CircleTurns),
    /// Home, which is flown by the machine for that.
    Return,
    /// Down, above a place if there is one.
    Descend(Option<[f64; 2]>),
    /// To another height, z, m, where it is.
    Rise(f64),
    /// Along a curve; then it stays for a time, s.
    Spline(Spline, f64),
    /// Along a piece of a way that follows the ground; what comes at the end of the way.
    GroundWay(GroundWay, Spline, Then),
    /// Down to the ground with what the gripper holds, and back.
    Lower(Lowering),
}

/// A descent with what the gripper holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lowering {
    /// North and east, m.
    pub above_m: [f64; 2],
    /// How low it may get, z, m.
    pub lowest_z_m: f64,
    /// Where it goes back to, z, m.
    pub back_z_m: f64,
}

/// Who steers in a tick of the mission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Helm {
    /// The mission itself.
    Mission,
    /// From now on the return.
    ReturnBegins,
    /// The return, which is under way.
    Return,
}

/// What comes at the end of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Then {
    /// The next step, after so many seconds.
    Wait(f64),
    /// Nothing.
    Stay,
    /// Turns.
    Circle(CircleTurns),
    /// A landing.
    Land([f64; 2]),
    /// Another height, z, m.
    Rise(f64),
    /// A descent of so far, m, with what the gripper holds.
    Lower(f64),
}

/// How a task goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // One of them is returned a tick.
pub enum TaskProgress {
    /// As it is.
    Going,
    /// It stays where it is for ever; the step counts as reached.
    Staying,
    /// With the same step.
    Again,
    /// The step is done; the next leg may take a turn over.
    Done(Option<Turn>),
}

/// When a delay ends that begins now, µs.
pub fn delay_end_us(delay: &Delay, situation: &Situation) -> u64 {
    match delay {
        Delay::Until(time) => {
            let unix_us = situation.unix_start_us + situation.time_us;
            situation.time_us.saturating_add(time.wait_us(unix_us))
        }
        Delay::For(time_s) => situation.after_us(*time_s),
    }
}
