//! The commands of missions: what is taken of each, and the step that is made of it. A new command of missions begins here.

use super::command::*;
use super::equipment_commands::EQUIPMENT_COMMANDS;
use super::item_search::{LARGEST_TAG, tagged_item};
use super::step::{Condition, Delay, Do, Jump, Navigate, Step, Turn, TurnDirection, TurnTo, Turns, Waypoint};
use super::{ChangeSpeed, Look, MissionItem, Place, Site, TimeOfDay};

/// What is known of a command of missions.
pub(super) struct MissionCommand {
    /// MAV_CMD.
    pub number: u16,
    /// What parameters 5 to 7 are.
    pub place: PlaceRule,
    /// Parameters that have to be given.
    pub needed: &'static [u8],
    /// Parameters that are whole numbers.
    pub whole: &'static [u8],
    /// Ranges of parameters; one that was not given (NaN) is in every range.
    pub ranges: &'static [(u8, &'static str, f64, f64)],
    /// The step that is made of a checked item.
    pub step: fn(&Source<'_>) -> Step,
}

/// What parameters 5 to 7 are.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum PlaceRule {
    /// No place.
    None,
    /// One that is flown to.
    Goal,
    /// One on the ground, whose altitude is not flown to.
    Ground,
    /// One that is looked at, or remembered.
    Mark,
}

/// What a step is made from.
pub(super) struct Source<'a> {
    /// The item.
    pub item: &'a MissionItem,
    /// All items of its mission.
    pub items: &'a [MissionItem],
    /// What its place refers to.
    pub site: &'a Site,
}

/// Longest time, s.
pub(super) const LONGEST_S: f64 = 86_400.0;
/// Fastest speed, m/s: what the limits of the closed loop can be set to.
pub(super) const FASTEST_M_S: f64 = 50.0;
/// Kind of DO_SET_ROI that is an item of the mission (MAV_ROI).
pub(super) const ROI_ITEM: f64 = 2.0;
/// Kind of DO_SET_ROI that is a place.
pub(super) const ROI_LOCATION: f64 = 3.0;
/// Largest radius, m.
const WIDEST_M: f64 = 1000.0;
/// Most turns.
const TURNS: f64 = 1000.0;
/// An angle, degrees.
const ANGLE: (f64, f64) = (-360.0, 360.0);
/// Largest angle of a turn, degrees: as many turns as a circle.
const TURNED: f64 = TURNS * 360.0;
/// Highest number of an item.
const LAST: f64 = u16::MAX as f64;

#[rustfmt::skip] // A few lines per command read as the table that it is.
static MISSION_COMMANDS: &[MissionCommand] = &[
    MissionCommand { number: NAV_WAYPOINT, step: waypoint, place: PlaceRule::Goal, needed: &[], whole: &[], ranges: &[
        (1, "hold time", 0.0, LONGEST_S), (2, "acceptance radius", 0.0, WIDEST_M),
        (3, "pass-by radius", -WIDEST_M, WIDEST_M), (4, "yaw", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: NAV_LOITER_UNLIM, step: loiter, place: PlaceRule::Goal, needed: &[], whole: &[], ranges: &[
        (3, "radius", -WIDEST_M, WIDEST_M), (4, "yaw", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: NAV_LOITER_TURNS, step: turns, place: PlaceRule::Goal, needed: &[1], whole: &[], ranges: &[
        (1, "turns", 0.0, TURNS), (3, "radius", -WIDEST_M, WIDEST_M)] },
    MissionCommand { number: NAV_LOITER_TIME, step: loiter_time, place: PlaceRule::Goal, needed: &[1], whole: &[], ranges: &[
        (1, "time", 0.0, LONGEST_S), (3, "radius", -WIDEST_M, WIDEST_M)] },
    MissionCommand { number: NAV_RETURN_TO_LAUNCH, step: |_| Step::Navigate(Navigate::ReturnToLaunch),
        place: PlaceRule::None, needed: &[], whole: &[], ranges: &[] },
    MissionCommand { number: NAV_LAND, step: land, place: PlaceRule::Ground, needed: &[], whole: &[], ranges: &[
        (4, "yaw", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: NAV_TAKEOFF, step: takeoff, place: PlaceRule::Goal, needed: &[], whole: &[], ranges: &[
        (4, "yaw", ANGLE.0, ANGLE.1)] },
    // Without wings they are the same.
    MissionCommand { number: NAV_VTOL_LAND, step: land, place: PlaceRule::Ground, needed: &[], whole: &[], ranges: &[
        (4, "yaw", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: NAV_VTOL_TAKEOFF, step: takeoff, place: PlaceRule::Goal, needed: &[], whole: &[], ranges: &[
        (4, "yaw", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: NAV_LOITER_TO_ALT, step: |source| Step::Navigate(Navigate::LoiterToAltitude { place: source.place() }),
        place: PlaceRule::Goal, needed: &[7], whole: &[], ranges: &[(2, "radius", -WIDEST_M, WIDEST_M)] },
    MissionCommand { number: NAV_SPLINE_WAYPOINT, step: spline, place: PlaceRule::Goal, needed: &[], whole: &[], ranges: &[
        (1, "hold time", 0.0, LONGEST_S)] },
    MissionCommand { number: NAV_GUIDED_ENABLE, step: |_| Step::Do(Do::Mark), place: PlaceRule::None, needed: &[], whole: &[],
        ranges: &[(1, "enable (guided control within a mission is not supported: switch to Guided mode instead)", 0.0, 0.0)] },
    MissionCommand { number: NAV_PAYLOAD_PLACE, step: place_payload, place: PlaceRule::Goal, needed: &[], whole: &[], ranges: &[
        (1, "descent", 0.0, 1e4)] },
    MissionCommand { number: NAV_SCRIPT_TIME, step: |source| Step::Navigate(Navigate::Delay(Delay::For(source.value(2)))),
        place: PlaceRule::None, needed: &[2], whole: &[], ranges: &[(2, "timeout", 0.1, LONGEST_S)] },
    MissionCommand { number: NAV_DELAY, step: delay, place: PlaceRule::None, needed: &[1], whole: &[2, 3, 4], ranges: &[
        (1, "delay", -1.0, LONGEST_S), (2, "hour", -1.0, 23.0), (3, "minute", -1.0, 59.0), (4, "second", -1.0, 59.0)] },
    MissionCommand { number: CONDITION_DELAY, step: |source| Step::Condition(Condition::Delay(source.value(1))),
        place: PlaceRule::None, needed: &[1], whole: &[], ranges: &[(1, "delay", 0.0, LONGEST_S)] },
    MissionCommand { number: CONDITION_DISTANCE, step: |source| Step::Condition(Condition::Distance(source.value(1))),
        place: PlaceRule::None, needed: &[1], whole: &[], ranges: &[(1, "distance", 0.0, 1e5)] },
    MissionCommand { number: CONDITION_GATE, step: gate, place: PlaceRule::Mark, needed: &[5, 6], whole: &[], ranges: &[
        (1, "geometry", 0.0, 0.0)] },
    MissionCommand { number: CONDITION_YAW, step: turn, place: PlaceRule::None, needed: &[1], whole: &[], ranges: &[
        (1, "angle", -TURNED, TURNED), (2, "rate", 0.0, 360.0), (3, "direction", -1.0, 1.0),
        (4, "relative", 0.0, 1.0)] },
    MissionCommand { number: DO_JUMP, step: jump, place: PlaceRule::None, needed: &[1, 2], whole: &[1, 2], ranges: &[
        (1, "item", 0.0, LAST), (2, "repeats", -1.0, LAST)] },
    MissionCommand { number: DO_JUMP_TAG, step: jump_to_tag, place: PlaceRule::None, needed: &[1, 2], whole: &[1, 2], ranges: &[
        (1, "tag", 0.0, LARGEST_TAG), (2, "repeats", -1.0, LAST)] },
    MissionCommand { number: DO_CHANGE_SPEED, step: change_speed, place: PlaceRule::None, needed: &[2], whole: &[1], ranges: &[
        (1, "kind of speed", 0.0, 3.0), (2, "speed", -2.0, FASTEST_M_S)] },
    MissionCommand { number: DO_SET_HOME, step: set_home, place: PlaceRule::Mark, needed: &[], whole: &[], ranges: &[
        (1, "use current", 0.0, 1.0), (4, "yaw", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: DO_SET_ROI_LOCATION, step: |source| Step::Do(Do::Look(source.look_at(source.item))),
        place: PlaceRule::Mark, needed: &[5, 6], whole: &[], ranges: &[] },
    MissionCommand { number: DO_SET_ROI_WPNEXT_OFFSET, step: look_ahead, place: PlaceRule::None, needed: &[], whole: &[], ranges: &[
        (7, "yaw offset", ANGLE.0, ANGLE.1)] },
    MissionCommand { number: DO_SET_ROI_NONE, step: |_| Step::Do(Do::Look(None)),
        place: PlaceRule::None, needed: &[], whole: &[], ranges: &[] },
    MissionCommand { number: DO_SET_ROI, step: region_of_interest, place: PlaceRule::None, needed: &[], whole: &[1], ranges: &[
        (1, "kind", 0.0, 3.0)] },
    // What DO_SET_ROI was before.
    MissionCommand { number: NAV_ROI, step: region_of_interest, place: PlaceRule::None, needed: &[], whole: &[1], ranges: &[
        (1, "kind", 0.0, 3.0)] },
];

/// The numbers of all commands that missions, fences and rally points may have.
pub fn command_numbers() -> impl Iterator<Item = u16> {
    let of_missions = MISSION_COMMANDS.iter().chain(EQUIPMENT_COMMANDS).map(|command| command.number);
    of_missions.chain(FENCE_COMMANDS).chain([NAV_RALLY_POINT])
}

/// The command of missions with a number.
pub(super) fn mission_command(number: u16) -> Option<&'static MissionCommand> {
    MISSION_COMMANDS.iter().chain(EQUIPMENT_COMMANDS).find(|command| command.number == number)
}

impl Source<'_> {
    /// A parameter; zero if it was not given.
    pub(super) fn value(&self, number: usize) -> f64 {
        self.item.parameter_or(number, 0.0)
    }

    /// A parameter in degrees as rad, if it was given.
    pub(super) fn angle_rad(&self, number: usize) -> Option<f64> {
        Some(self.item.parameter(number).to_radians()).filter(|angle_rad| angle_rad.is_finite())
    }

    /// The heading of a step that is flown. ArduPilot's have none, and clients leave zeros there.
    fn heading_rad(&self) -> Option<f64> {
        if self.site.identity.is_ardupilot() { None } else { self.angle_rad(4) }
    }

    fn place(&self) -> Place {
        self.site.place(self.item).unwrap_or_default()
    }

    /// The place of a step that is flown to: ArduPilot takes an altitude of exactly zero for the present one.
    fn way_place(&self) -> Place {
        let keeps = self.site.identity.is_ardupilot() && self.item.position[2] == 0.0;
        let place = self.place();
        Place { altitude: place.altitude.filter(|_| !keeps), ..place }
    }

    fn look_at(&self, item: &MissionItem) -> Option<Look> {
        self.site.place(item).map(Look::At)
    }
}

fn waypoint(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::Waypoint(Waypoint {
        place: source.way_place(),
        hold_s: source.value(1),
        acceptance_radius_m: Some(source.value(2)).filter(|radius_m| *radius_m > 0.0),
        heading_rad: source.heading_rad(),
    }))
}

fn loiter(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::Loiter { place: source.way_place(), heading_rad: source.heading_rad() })
}

fn turns(source: &Source<'_>) -> Step {
    let radius_m = Some(source.value(3)).filter(|radius_m| *radius_m != 0.0);
    Step::Navigate(Navigate::LoiterTurns(Turns {
        place: source.way_place(),
        turns: source.value(1),
        radius_m,
    }))
}

fn loiter_time(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::LoiterTime { place: source.way_place(), time_s: source.value(1) })
}

fn land(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::Land { place: source.place(), heading_rad: source.heading_rad() })
}

fn takeoff(source: &Source<'_>) -> Step {
    let travels = !source.site.identity.is_ardupilot();
    Step::Navigate(Navigate::Takeoff { place: source.place(), travels })
}

/// A delay of −1 stands for the time of day behind it. ArduPilot's zero does, too, unless that is all zeros as well, as clients leave
/// them.
fn delay(source: &Source<'_>) -> Step {
    let delay_s = source.value(1);
    let part = |number: usize| Some(source.item.parameter_or(number, -1.0)).filter(|value| *value >= 0.0);
    let time = [2, 3, 4].map(part);
    let named = time != [None; 3] && time != [Some(0.0); 3];
    let until = delay_s < 0.0 || delay_s == 0.0 && named && source.site.identity.is_ardupilot();
    Step::Navigate(Navigate::Delay(if until {
        Delay::Until(TimeOfDay(time.map(|part| part.map(|value| value as u64))))
    } else {
        Delay::For(delay_s)
    }))
}

/// CONDITION_YAW: angle, rate (0: as fast as the vehicle can), direction (0: the short way; a relative angle turns clockwise then),
/// relative or not.
fn turn(source: &Source<'_>) -> Step {
    let angle_rad = source.angle_rad(1).unwrap_or_default();
    let direction = match source.value(3) {
        direction if direction < 0.0 => TurnDirection::CounterClockwise,
        direction if direction > 0.0 => TurnDirection::Clockwise,
        _ => TurnDirection::Shortest,
    };
    let to = match (source.value(4) > 0.5, direction) {
        (true, TurnDirection::CounterClockwise) => TurnTo::By(-angle_rad),
        (true, _) => TurnTo::By(angle_rad),
        (false, _) => TurnTo::Heading(angle_rad % core::f64::consts::TAU, direction),
    };
    let rate_rad_s = source.angle_rad(2).filter(|rate_rad_s| *rate_rad_s > 0.0);
    Step::Condition(Condition::Yaw(Turn { to, rate_rad_s }))
}

fn spline(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::Spline { place: source.way_place(), hold_s: source.value(1) })
}

/// NAV_PAYLOAD_PLACE: how far it may descend below its altitude; 0: to the ground.
fn place_payload(source: &Source<'_>) -> Step {
    let descent_m = Some(source.value(1)).filter(|descent_m| *descent_m > 0.0);
    Step::Navigate(Navigate::PlacePayload { place: source.way_place(), descent_m })
}

fn jump(source: &Source<'_>) -> Step {
    Step::Jump(Jump { to: source.value(1) as usize, repeats: repeats(source) })
}

/// DO_JUMP_TAG: as DO_JUMP, to the item behind a tag.
fn jump_to_tag(source: &Source<'_>) -> Step {
    tagged_item(source.items, source.value(1))
        .map_or(Step::Pass, |to| Step::Jump(Jump { to, repeats: repeats(source) }))
}

/// How often a jump is taken; a negative number stands for always.
fn repeats(source: &Source<'_>) -> Option<u32> {
    Some(source.value(2)).filter(|repeats| *repeats >= 0.0).map(|repeats| repeats as u32)
}

fn change_speed(source: &Source<'_>) -> Step {
    ChangeSpeed::of(source.value(1), source.item.parameter_or(2, -1.0))
        .map_or(Step::Pass, |change| Step::Do(Do::ChangeSpeed(change)))
}

fn set_home(source: &Source<'_>) -> Step {
    let named = source.value(1) < 0.5;
    let place = source.site.place(source.item).filter(|place| named && place.horizontal_m.is_some());
    Step::Do(Do::SetHome(place))
}

/// CONDITION_GATE: where the plane lies that is to be crossed.
fn gate(source: &Source<'_>) -> Step {
    source.place().horizontal_m.map_or(Step::Pass, |place_m| Step::Condition(Condition::Gate(place_m)))
}

fn look_ahead(source: &Source<'_>) -> Step {
    Step::Do(Do::Look(Some(Look::NextWaypoint { offset_rad: source.angle_rad(7).unwrap_or_default() })))
}

/// DO_SET_ROI: the kind (MAV_ROI), then the number of an item or a place.
fn region_of_interest(source: &Source<'_>) -> Step {
    let item = source.item;
    Step::Do(Do::Look(match source.value(1) as u8 {
        1 => Some(Look::NextWaypoint { offset_rad: 0.0 }),
        2 => source.items.get(item.parameter(2) as usize).and_then(|item| source.look_at(item)),
        3 => source.look_at(item),
        // ArduPilot's clients send the place without saying that it is one.
        0 if item.position.iter().any(|value| *value != 0.0) => source.look_at(item),
        _ => None,
    }))
}

#[cfg(test)]
mod tests;
