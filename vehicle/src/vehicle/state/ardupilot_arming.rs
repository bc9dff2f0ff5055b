//! What speaks against arming by ArduPilot's parameters alone, in the words that its clients look for.

use super::super::arming_obstacle::{ArmingObstacle, ArmingSubject as Subject};
use super::super::situation::Situation;
use super::Vehicle;
use crate::kept::KeptValues;
use crate::mode::{Mode, Needs};
use crate::plan::{PlanKind, command, is_above_ground};
use crate::radio::{RadioFailure, RadioLossAction};

/// Bits of ARMING_MIS_ITEMS with the commands that meet them, by name.
const REQUIRED: [(u32, u16, &str); 4] = [
    (1, command::NAV_LAND, "land"),
    (4, command::DO_LAND_START, "do land start"),
    (8, command::NAV_TAKEOFF, "takeoff"),
    (64, command::NAV_RETURN_TO_LAUNCH, "RTL"),
];
const RALLY: u32 = 32;

impl Vehicle {
    /// Batteries, fence, mission items, the radio, and values that no vehicle has.
    pub(super) fn ardupilot_obstacles(&self) -> Vec<ArmingObstacle> {
        let situation = self.situation();
        let battery = battery(&situation).map(|text| ArmingObstacle::new(Subject::Battery, text));
        let fence = fence(&situation).map(|text| ArmingObstacle::new(Subject::Failsafe, text));
        let items = self.missing_items().map(|text| ArmingObstacle::new(Subject::Mission, text));
        let radio = radio(&situation).map(|text| ArmingObstacle::from(text.to_owned()));
        let values = bad_values(&situation.conduct.kept).map(ArmingObstacle::from);
        let terrain = self.terrain_obstacle().map(|text| ArmingObstacle::new(Subject::Mission, text));
        let sources = self.source_obstacle().map(ArmingObstacle::from);
        let boot = self.machines.boot_fault.obstacle().map(|text| ArmingObstacle::from(text.to_owned()));
        boot.into_iter()
            .chain(battery)
            .chain(fence)
            .chain(items)
            .chain(terrain)
            .chain(radio)
            .chain(values)
            .chain(sources)
            .collect()
    }

    /// Sources of the estimator that there are not, or that tell no place on the map.
    fn source_obstacle(&self) -> Option<String> {
        if self.conduct().aiding.ardupilot.lack_vision() {
            return Some("EK3 sources require VisualOdom (VISO_TYPE)".to_owned());
        }
        let needs_origin = self.aiding().vision.is_some() && self.mode().needs() == Needs::Place;
        (needs_origin && !self.knows_origin()).then(|| "no origin: send SET_GPS_GLOBAL_ORIGIN".to_owned())
    }

    /// A mission above the ground, which ArduPilot knows from its terrain data or from a rangefinder, where neither is to be used.
    fn terrain_obstacle(&self) -> Option<&'static str> {
        let items = self.plans().get(PlanKind::Mission).items();
        let wanted = items.iter().skip(1).any(|item| is_above_ground(item.frame));
        (wanted && !self.knows_the_ground()).then_some("Mission above the terrain, and terrain disabled")
    }

    fn knows_the_ground(&self) -> bool {
        let is_on = |id: &str| self.conduct().kept.by_id(id).is_some_and(|value| value != 0.0);
        let rangefinder = || is_on("WP_RFND_USE") && is_on("WPNAV_RFND_USE") && self.has_rangefinder();
        is_on("TERRAIN_ENABLE") || rangefinder()
    }

    /// Looks at the ground of a mission that is flown.
    pub(super) fn watch_terrain(&mut self) {
        const PERIOD_US: u64 = 100_000;
        if !self.time_us().is_multiple_of(PERIOD_US) || !self.identity().is_ardupilot() {
            return;
        }
        let flies = self.is_armed() && !self.situation().landed && self.mode() == Mode::Mission;
        let current = self.mission_status().current;
        let item = self.plans().get(PlanKind::Mission).items().get(current).filter(|_| flies);
        let is_unknown = item.is_some_and(|item| is_above_ground(item.frame)) && !self.knows_the_ground();
        self.consult(|parts, situation, proposal| parts.terrain.watch(situation, proposal, is_unknown));
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
    if limits.is_missing() {
        return Some("Battery 1 unhealthy".to_owned());
    }
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
    let parts = situation.fence_parts();
    if parts.height && settings.fence_height_m < 0.0 {
        return Some("Invalid FENCE_ALT_MAX value".to_owned());
    }
    if parts.distance && settings.fence_radius_m < 0.0 {
        return Some("Invalid Circle FENCE_RADIUS value".to_owned());
    }
    if parts.height && parts.floor && situation.fence_height_m() < situation.fence_floor_m() {
        return Some("FENCE_ALT_MAX < FENCE_ALT_MIN".to_owned());
    }
    let breach = situation.breach_at(&situation.outputs.position_m)?;
    Some(format!("Vehicle breaching {} fence", breach.ardupilot_name()))
}

/// A radio that has never been received because it fails, or one whose throttle says that its sender is gone.
fn radio(situation: &Situation) -> Option<&'static str> {
    let (settings, pilot) = (&situation.conduct.radio, &situation.pilot);
    if situation.conduct.failsafe.pilot_lost == RadioLossAction::None {
        return None;
    }
    if settings.failure == RadioFailure::NoPulses && !pilot.has_radio {
        return Some("RC not found");
    }
    let throttle = settings.channel(settings.axes.throttle).zip(pilot.pulses);
    let throttle_us = throttle.and_then(|((index, _), pulses)| pulses.get(index).copied());
    let low = throttle_us.is_some_and(|pulse| f64::from(pulse) < settings.low_throttle_us);
    low.then_some("Throttle below failsafe")
}

/// Gains that ArduPilot's position control needs, and what its motors need to turn.
const GAINS: [&str; 10] = [
    "PSC_POSXY_P",
    "PSC_NE_POS_P",
    "PSC_POSZ_P",
    "PSC_D_POS_P",
    "PSC_VELXY_P",
    "PSC_NE_VEL_P",
    "PSC_VELZ_P",
    "PSC_D_VEL_P",
    "PSC_ACCZ_P",
    "PSC_D_ACC_P",
];
/// The most that MOT_SPIN_MIN may be.
const MOST_SPIN: f32 = 0.3;

/// Parameters that change nothing here, and with whose values ArduPilot does not arm.
fn bad_values(kept: &KeptValues) -> impl Iterator<Item = String> {
    let value = |id: &str| kept.by_id(id).unwrap_or_default();
    let gains = GAINS.into_iter().filter(|id| kept.by_id(id).is_some_and(|gain| gain <= 0.0));
    let gains = gains.map(|id| format!("{id} must be > 0")).collect::<Vec<_>>();
    let (least, longest) = (value("MOT_PWM_MIN"), value("MOT_PWM_MAX"));
    let (spins, idles) = (value("MOT_SPIN_MIN"), value("MOT_SPIN_ARM"));
    let motors = if least >= longest {
        Some("Motors: Check MOT_PWM_MIN and MOT_PWM_MAX".to_owned())
    } else if spins > MOST_SPIN {
        Some(format!("Motors: MOT_SPIN_MIN too high {spins:.2} > {MOST_SPIN:.1}"))
    } else {
        (idles > spins).then(|| "Motors: MOT_SPIN_ARM > MOT_SPIN_MIN".to_owned())
    };
    gains.into_iter().chain(motors)
}
