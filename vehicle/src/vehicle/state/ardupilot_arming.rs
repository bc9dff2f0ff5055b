//! What speaks against arming by ArduPilot's parameters alone, in the words that its clients look for.

use super::super::arming_obstacle::{ArmingObstacle, ArmingSubject as Subject};
use super::super::situation::Situation;
use super::Vehicle;
use crate::plan::{PlanKind, command};

/// Bits of ARMING_MIS_ITEMS with the commands that meet them, by name.
const REQUIRED: [(u32, u16, &str); 4] = [
    (1, command::NAV_LAND, "land"),
    (4, command::DO_LAND_START, "do land start"),
    (8, command::NAV_TAKEOFF, "takeoff"),
    (64, command::NAV_RETURN_TO_LAUNCH, "RTL"),
];
const RALLY: u32 = 32;

impl Vehicle {
    /// Batteries, fence and mission items.
    pub(super) fn ardupilot_obstacles(&self) -> Vec<ArmingObstacle> {
        let situation = self.situation();
        let battery = battery(&situation).map(|text| ArmingObstacle::new(Subject::Battery, text));
        let fence = fence(&situation).map(|text| ArmingObstacle::new(Subject::Failsafe, text));
        let items = self.missing_items().map(|text| ArmingObstacle::new(Subject::Mission, text));
        battery.into_iter().chain(fence).chain(items).collect()
    }

    /// Items that ARMING_MIS_ITEMS asks for, and that there are not.
    fn missing_items(&self) -> impl Iterator<Item = String> {
        let wanted = self.conduct().arming.required_items;
        let items = self.plans().get(PlanKind::Mission).items();
        let missing = REQUIRED.into_iter().filter(move |(bit, number, _)| {
            wanted & bit != 0 && !items.iter().any(|item| item.command == *number)
        });
        let rally = wanted & RALLY != 0 && self.plans().get(PlanKind::Rally).items().is_empty();
        let names = missing.map(|(.., name)| name).chain(rally.then_some("rally"));
        names.map(|name| format!("Missing mission item: {name}"))
    }
}

fn battery(situation: &Situation) -> Option<String> {
    let limits = &situation.conduct.failsafe.battery_limits;
    if situation.battery_voltage_v < limits.to_arm_v {
        return Some("Battery 1 below minimum arming voltage".to_owned());
    }
    (situation.battery_left_mah < limits.to_arm_mah)
        .then(|| "Battery 1 below minimum arming capacity".to_owned())
}

/// A fence that cannot be, or that is breached on the ground.
fn fence(situation: &Situation) -> Option<String> {
    if !situation.fence_is_on {
        return None;
    }
    let settings = &situation.conduct.failsafe;
    let parts = settings.fence_parts;
    if parts.height && settings.fence_height_m < 0.0 {
        return Some("Invalid FENCE_ALT_MAX value".to_owned());
    }
    if parts.distance && settings.fence_radius_m < 0.0 {
        return Some("Invalid Circle FENCE_RADIUS value".to_owned());
    }
    if parts.height && parts.floor && settings.fence_height_m < settings.fence_floor_m {
        return Some("FENCE_ALT_MAX < FENCE_ALT_MIN".to_owned());
    }
    let breach = situation.breach_at(&situation.outputs.position_m)?;
    Some(format!("Vehicle breaching {} fence", breach.ardupilot_name()))
}
