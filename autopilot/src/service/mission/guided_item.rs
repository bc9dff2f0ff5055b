//! An item that is no part of a mission: by ArduPilot's convention `current` = 2 makes it a goal of the guided mode, 3 its altitude alone.

use vehicle::plan::{FaultCode, PlanFault, PlanKind, check, command};
use vehicle::{Mode, Refusal, Reposition};

use super::answer;
use crate::codec::MissionItemMessage;
use crate::context::Context;
use crate::envelope::Origin;

const GOAL: u8 = 2;
const ALTITUDE: u8 = 3;

/// Whether a message is such an item.
pub fn is_one(message: &MissionItemMessage) -> bool {
    message.kind == PlanKind::Mission.number() && matches!(message.current, GOAL | ALTITUDE)
}

/// Goes there, and answers by MISSION_ACK.
pub fn take(context: &mut Context, origin: &Origin, message: &MissionItemMessage) {
    match go(context, message) {
        Ok(()) => answer::accepted(context, origin, message.kind, 0),
        Err(fault) => answer::refused_aloud(context, origin, message.kind, &fault),
    }
}

fn go(context: &mut Context, message: &MissionItemMessage) -> Result<(), PlanFault> {
    let vehicle = &mut context.vehicle;
    let (item, site) = (&message.item, vehicle.site());
    // As any item but home.
    check::item(PlanKind::Mission, 1, item, &site)?;
    let fault = |reason: String| PlanFault::of_plan(FaultCode::Error, reason);
    if item.command != command::NAV_WAYPOINT {
        return Err(fault("a guided target must be a waypoint".to_owned()));
    }
    if !matches!(vehicle.mode(), Mode::Offboard | Mode::Takeoff) {
        return Err(fault("a guided target needs Guided mode".to_owned()));
    }
    let Some(place) = site.place(item) else {
        return Err(PlanFault::of_plan(FaultCode::Invalid, "a guided target needs a place"));
    };
    let horizontal_m = place.horizontal_m.filter(|_| message.current == GOAL);
    let goal = Reposition {
        horizontal_m,
        down_m: place.down_m(site.home_m.z),
        yaw_rad: None,
        is_above_ground: place.is_above_ground(),
    };
    vehicle.reposition(&goal).map_err(|refusal: Refusal| fault(refusal.to_string()))
}
