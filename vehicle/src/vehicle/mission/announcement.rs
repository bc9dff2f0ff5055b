//! What clients of ArduPilot are told of a mission's steps, in the words that they look for.

use super::super::notice::Severity;
use super::super::proposal::Proposal;
use super::super::situation::Situation;
use crate::plan::step::Navigate;

/// A step begins.
pub(super) fn begin(step: &Navigate, index: usize, situation: &Situation, proposal: &mut Proposal) {
    if situation.identity.is_ardupilot() {
        proposal.say(Severity::Info, format!("Mission: {index} {}", name(step)));
    }
}

/// Turns begin, at the edge of their circle.
pub(super) fn circling(situation: &Situation, proposal: &mut Proposal) {
    if situation.identity.is_ardupilot() {
        proposal.say(Severity::Info, "Mission: circling");
    }
}

/// A step is done.
pub(super) fn end(step: &Navigate, index: usize, situation: &Situation, proposal: &mut Proposal) {
    let told = matches!(step, Navigate::Waypoint(_) | Navigate::Spline { .. } | Navigate::LoiterTime { .. });
    if told && situation.identity.is_ardupilot() {
        proposal.say(Severity::Info, format!("Reached command #{index}"));
    }
}

fn name(step: &Navigate) -> &'static str {
    match step {
        Navigate::Waypoint(_) => "WP",
        Navigate::Loiter { .. } => "LoitUnlim",
        Navigate::LoiterTime { .. } => "LoitTime",
        Navigate::LoiterTurns(_) => "LoitTurns",
        Navigate::ReturnToLaunch => "RTL",
        Navigate::Land { .. } => "Land",
        Navigate::Takeoff { .. } => "Takeoff",
        Navigate::LoiterToAltitude { .. } => "LoitAltitude",
        Navigate::Spline { .. } => "SplineWP",
        Navigate::PlacePayload { .. } => "PayloadPlace",
        Navigate::Delay(_) => "Delay",
    }
}
