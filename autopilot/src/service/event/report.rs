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
    /// Its arguments as they are sent: [`packed`].
    pub arguments: [u8; ARGUMENTS],
}

/// Bytes of the arguments of an event.
const ARGUMENTS: usize = 40;

/// Arguments one behind the other, the lowest byte of each first.
pub fn packed<const N: usize>(arguments: [&[u8]; N]) -> [u8; ARGUMENTS] {
    let mut packed = [0; ARGUMENTS];
    for (place, byte) in packed.iter_mut().zip(arguments.into_iter().flatten()) {
        *place = *byte;
    }
    packed
}

/// The only chunk of a report.
const CHUNK: u8 = 0;

/// The report of now. While nothing speaks against arming, it needs no memory.
pub fn report(vehicle: &Vehicle) -> impl Iterator<Item = Draft> {
    let obstacles = if vehicle.is_armed() { Vec::new() } else { vehicle.arming_obstacles() };
    let modes = || (0_u32..).zip(vehicle.identity().selectable_modes());
    let all = modes().fold(0_u32, |bits, (index, _)| bits | 1 << index);
    let now = modes().find(|(_, mode)| *mode == vehicle.mode()).map_or(0, |(index, _)| 1 << index);
    let affected = move |obstacle: &ArmingObstacle| if obstacle.subject.is_of_mode() { now } else { all };
    let can_arm = all & !obstacles.iter().fold(0, |bits, obstacle| bits | affected(obstacle));
    let failed =
        obstacles.iter().fold(0_u64, |bits, obstacle| bits | 1 << health_component(obstacle.subject));
    // What is about no component is about none.
    let failed = failed & !1;
    let present = ((1_u64 << HEALTH_COMPONENTS.len()) - 1) & !1;
    let none = 0_u64;
    let [present, failed, none] = [present, failed, none].map(u64::to_le_bytes);
    let can_arm = can_arm.to_le_bytes();
    // What can be armed in can be flown, and in flight everything can.
    let summary = packed([&[CHUNK], &failed, &none, &can_arm, &can_arm]);
    let health = packed([&[CHUNK], &present, &failed, &none]);
    let protocol = |event, arguments| Draft { event, level: LogLevel::Protocol, arguments };
    let checks = obstacles.into_iter().map(move |obstacle| {
        let modes = affected(&obstacle).to_le_bytes();
        let arguments = packed([&modes, &[health_component(obstacle.subject)]]);
        Draft { event: Event::ArmingCheck(obstacle.subject), level: LogLevel::Error, arguments }
    });
    let before = std::iter::once(protocol(Event::ArmingCheckSummary, summary));
    before.chain(checks).chain(std::iter::once(protocol(Event::HealthSummary, health)))
}
