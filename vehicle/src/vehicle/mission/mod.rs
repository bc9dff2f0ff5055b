//! The flight of a mission.
//!
//! ```text
//!                  ┌────────── next step ◄─────────────┐
//!                  ▼                                   │ done: reached
//!  jumps ─────► begin ──► task: climb, leg, wait, ─────┘
//!                 │             circle, descend
//!                 └─► actions on the way: conditions, speed, home, region of interest
//! ```
//!
//! Steps that are flown follow one another. Actions and conditions between two of them begin with the second one's leg; a
//! condition that is not fulfilled when the leg ends is dropped with what follows it, as ArduPilot has it.
//!
//! [`Mission`] is the machine: it owns the program and how far it has come. `course` owns what is done for the present step,
//! `actions` what is done on the way, `jumps` how often each jump was made. They look at a situation and ask in a proposal.

mod actions;
mod announcement;
mod circle_turns;
mod course;
mod jumps;
mod leg;
mod leg_end;
mod machine;
mod path;
mod planned_way;
mod route;
mod status;
mod takeoff_height;
mod task;
#[cfg(test)]
mod tests;

pub use course::Course;
pub use jumps::Jumps;
pub use machine::Mission;
pub use planned_way::{Beginning, PlannedLeg, planned_way};
pub use route::Route;
pub use status::{MissionState, MissionStatus};
pub use takeoff_height::height_without_m;
pub use task::{Helm, TaskProgress};
