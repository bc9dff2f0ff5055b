//! Health and arming checks as events: a summary, what speaks against arming, and a summary of the health.

use vehicle::{ArmingObstacle, Vehicle};

use crate::event_catalog::{Event, HEALTH_COMPONENTS, LogLevel, health_component};

/// An event that is still to be numbered.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Which.
    pub event: Event,
    /// How important.
    pub level: LogLevel,
    /// Its arguments, the lowest byte of each first.
    pub arguments: Vec<u8>,
}

/// The only chunk of a report.
const CHUNK: u8 = 0;

/// The report of now.
pub fn report(vehicle: &Vehicle) -> Vec<Draft> {
    let obstacles = if vehicle.is_armed() { Vec::new() } else { vehicle.arming_obstacles() };
    let modes = || (0_u32..).zip(vehicle.identity().selectable_modes());
    let all = modes().fold(0_u32, |bits, (index, _)| bits | 1 << index);
    let now = modes().find(|(_, mode)| *mode == vehicle.mode()).map_or(0, |(index, _)| 1 << index);
    let affected = |obstacle: &ArmingObstacle| if obstacle.subject.is_of_mode() { now } else { all };
    let can_arm = all & !obstacles.iter().fold(0, |bits, obstacle| bits | affected(obstacle));
    let failed =
        obstacles.iter().fold(0_u64, |bits, obstacle| bits | 1 << health_component(obstacle.subject));
    // What is about no component is about none.
    let failed = failed & !1;
    let present = ((1_u64 << HEALTH_COMPONENTS.len()) - 1) & !1;
    let none = 0_u64;
    let mut summary = vec![CHUNK];
    summary.extend(failed.to_le_bytes());
    summary.extend(none.to_le_bytes());
    summary.extend(can_arm.to_le_bytes());
    // What can be armed in can be flown, and in flight everything can.
    summary.extend(can_arm.to_le_bytes());
    let mut health = vec![CHUNK];
    health.extend(present.to_le_bytes());
    health.extend(failed.to_le_bytes());
    health.extend(none.to_le_bytes());
    let protocol = |event, arguments| Draft { event, level: LogLevel::Protocol, arguments };
    let checks = obstacles.iter().map(|obstacle| {
        let mut arguments = affected(obstacle).to_le_bytes().to_vec();
        arguments.push(health_component(obstacle.subject));
        Draft { event: Event::ArmingCheck(obstacle.subject), level: LogLevel::Error, arguments }
    });
    let mut drafts = vec![protocol(Event::ArmingCheckSummary, summary)];
    drafts.extend(checks);
    drafts.push(protocol(Event::HealthSummary, health));
    drafts
}
