//! The flight of a mission.
//!
//! ```text
//!                  ┌────────── next item ◄─────────────┐
//!                  ▼                                   │ done: reached
//!  sequence ──► begin ──► task: climb, leg, wait, ─────┘
//!  (jumps)        │             circle, descend
//!                 └─► actions on the way: conditions, speed, home, region of interest
//! ```
//!
//! Items that navigate (NAV_…) are flown one after the other. Those between two of them (DO_…, CONDITION_…) begin with the
//! second one's leg; a condition that is not fulfilled when the leg ends is dropped with what follows it, as ArduPilot has it.

mod action;
mod circle;
mod control;
mod heading;
mod leg;
mod path;
mod sequence;
mod status;
mod task;

use std::collections::{BTreeMap, VecDeque};

use action::Waiting;
use heading::Turning;
use leg::Carry;
use nalgebra::Vector3;
use task::Task;

use crate::plan::Program;

pub use status::{MissionState, MissionStatus};

/// How far the mission has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Progress {
    /// It waits for its start.
    #[default]
    NotStarted,
    /// It has begun.
    Started,
    /// Its last item is done.
    Complete,
}

/// What changes while a mission is flown.
#[derive(Debug, Default)]
pub(super) struct Mission {
    /// Its steps.
    program: Program,
    progress: Progress,
    /// The item that is flown, or will be.
    current: usize,
    /// What is being done for it.
    task: Option<Task>,
    /// Motion that the next leg takes over.
    carry: Option<Carry>,
    /// Where the next leg begins, NED, m.
    anchor_m: Vector3<f64>,
    /// Items on the way that are still to be done.
    actions: VecDeque<usize>,
    /// What the first of them waits for.
    waiting: Option<Waiting>,
    /// How often each jump has been made.
    jumps: BTreeMap<usize, u32>,
    turn: Option<Turning>,
    /// Heading of the present item, rad.
    heading_rad: f64,
    /// Whether it waits in its own mode.
    paused: bool,
    /// Items that were reached since the last look.
    reached: Vec<u16>,
}
