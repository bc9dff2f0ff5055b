//! The commands of plans: their numbers (MAV_CMD), and for those of missions what is taken and the step that is made of it. A new
//! command of missions begins here.

use super::equipment_commands::EQUIPMENT_COMMANDS;
use super::step::{Condition, Delay, Do, Jump, Navigate, Step, Turn, TurnDirection, TurnTo, Turns, Waypoint};
use nalgebra::Vector3;

use super::{ChangeSpeed, Look, MissionItem, Place, Site, TimeOfDay, frame};

pub const NAV_WAYPOINT: u16 = 16;
pub const NAV_LOITER_UNLIM: u16 = 17;
pub const NAV_LOITER_TURNS: u16 = 18;
pub const NAV_LOITER_TIME: u16 = 19;
pub const NAV_RETURN_TO_LAUNCH: u16 = 20;
pub const NAV_LAND: u16 = 21;
pub const NAV_TAKEOFF: u16 = 22;
pub const NAV_LOITER_TO_ALT: u16 = 31;
pub const NAV_SPLINE_WAYPOINT: u16 = 82;
pub const NAV_GUIDED_ENABLE: u16 = 92;
pub const NAV_DELAY: u16 = 93;
pub const NAV_PAYLOAD_PLACE: u16 = 94;
pub const CONDITION_DELAY: u16 = 112;
pub const CONDITION_DISTANCE: u16 = 114;
pub const CONDITION_YAW: u16 = 115;
pub const DO_JUMP: u16 = 177;
pub const DO_CHANGE_SPEED: u16 = 178;
pub const DO_SET_HOME: u16 = 179;
pub const DO_SET_RELAY: u16 = 181;
pub const DO_REPEAT_RELAY: u16 = 182;
pub const DO_SET_SERVO: u16 = 183;
pub const DO_REPEAT_SERVO: u16 = 184;
pub const DO_SET_ACTUATOR: u16 = 187;
pub const DO_RETURN_PATH_START: u16 = 188;
pub const DO_LAND_START: u16 = 189;
pub const DO_SET_REVERSE: u16 = 194;
pub const DO_SET_ROI_LOCATION: u16 = 195;
pub const DO_SET_ROI_WPNEXT_OFFSET: u16 = 196;
pub const DO_SET_ROI_NONE: u16 = 197;
pub const DO_CONTROL_VIDEO: u16 = 200;
pub const DO_SET_ROI: u16 = 201;
pub const DO_DIGICAM_CONFIGURE: u16 = 202;
pub const DO_DIGICAM_CONTROL: u16 = 203;
pub const DO_MOUNT_CONFIGURE: u16 = 204;
pub const DO_MOUNT_CONTROL: u16 = 205;
pub const DO_SET_CAM_TRIGG_DIST: u16 = 206;
pub const DO_FENCE_ENABLE: u16 = 207;
pub const DO_PARACHUTE: u16 = 208;
pub const DO_INVERTED_FLIGHT: u16 = 210;
pub const DO_GRIPPER: u16 = 211;
pub const DO_AUTOTUNE_ENABLE: u16 = 212;
pub const DO_SET_CAM_TRIGG_INTERVAL: u16 = 214;
pub const DO_SET_RESUME_REPEAT_DIST: u16 = 215;
pub const DO_SPRAYER: u16 = 216;
pub const DO_SEND_SCRIPT_MESSAGE: u16 = 217;
pub const DO_AUX_FUNCTION: u16 = 218;
pub const DO_GUIDED_LIMITS: u16 = 222;
pub const DO_ENGINE_CONTROL: u16 = 223;
pub const OBLIQUE_SURVEY: u16 = 260;
pub const SET_CAMERA_MODE: u16 = 530;
pub const SET_CAMERA_ZOOM: u16 = 531;
pub const SET_CAMERA_FOCUS: u16 = 532;
pub const SET_CAMERA_SOURCE: u16 = 534;
pub const JUMP_TAG: u16 = 600;
pub const DO_JUMP_TAG: u16 = 601;
pub const DO_GIMBAL_MANAGER_PITCHYAW: u16 = 1000;
pub const DO_GIMBAL_MANAGER_CONFIGURE: u16 = 1001;
pub const IMAGE_START_CAPTURE: u16 = 2000;
pub const IMAGE_STOP_CAPTURE: u16 = 2001;
pub const DO_TRIGGER_CONTROL: u16 = 2003;
pub const VIDEO_START_CAPTURE: u16 = 2500;
pub const VIDEO_STOP_CAPTURE: u16 = 2501;
pub const DO_VTOL_TRANSITION: u16 = 3000;
pub const NAV_FENCE_RETURN_POINT: u16 = 5000;
pub const NAV_FENCE_POLYGON_VERTEX_INCLUSION: u16 = 5001;
pub const NAV_FENCE_POLYGON_VERTEX_EXCLUSION: u16 = 5002;
pub const NAV_FENCE_CIRCLE_INCLUSION: u16 = 5003;
pub const NAV_FENCE_CIRCLE_EXCLUSION: u16 = 5004;
pub const NAV_RALLY_POINT: u16 = 5100;
pub const NAV_SCRIPT_TIME: u16 = 42702;
pub const DO_WINCH: u16 = 42600;
pub const AIRFRAME_CONFIGURATION: u16 = 2520;

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
    MissionCommand { number: CONDITION_YAW, step: turn, place: PlaceRule::None, needed: &[1], whole: &[], ranges: &[
        (1, "angle", -TURNED, TURNED), (2, "rate", 0.0, 360.0), (3, "direction", -1.0, 1.0),
        (4, "relative", 0.0, 1.0)] },
    MissionCommand { number: DO_JUMP, step: jump, place: PlaceRule::None, needed: &[1, 2], whole: &[1, 2], ranges: &[
        (1, "item", 0.0, LAST), (2, "repeats", -1.0, LAST)] },
    MissionCommand { number: DO_JUMP_TAG, step: jump_to_tag, place: PlaceRule::None, needed: &[1, 2], whole: &[1, 2], ranges: &[
        (1, "tag", 0.0, LAST), (2, "repeats", -1.0, LAST)] },
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
];

/// The numbers of all commands that missions, fences and rally points may have.
pub fn command_numbers() -> impl Iterator<Item = u16> {
    let of_missions = MISSION_COMMANDS.iter().map(|command| command.number);
    of_missions.chain(FENCE_COMMANDS).chain([NAV_RALLY_POINT])
}

/// Commands of fences.
pub(super) const FENCE_COMMANDS: [u16; 5] = [
    NAV_FENCE_RETURN_POINT,
    NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
    NAV_FENCE_CIRCLE_INCLUSION,
    NAV_FENCE_CIRCLE_EXCLUSION,
];

/// The command of missions with a number.
pub(super) fn mission_command(number: u16) -> Option<&'static MissionCommand> {
    MISSION_COMMANDS.iter().chain(EQUIPMENT_COMMANDS).find(|command| command.number == number)
}

/// The largest number of a tag.
pub const LARGEST_TAG: f64 = LAST;

/// Number of the item that has a tag, if there is one.
pub fn tagged_item(items: &[MissionItem], tag: f64) -> Option<usize> {
    items.iter().position(|item| item.command == JUMP_TAG && item.parameter(1) == tag)
}

/// Number of the item at which a landing begins that is nearest to a place, NED, m: the place of DO_LAND_START counts, or else that of
/// the next item that has one.
pub fn landing_start(items: &[MissionItem], site: &Site, near_m: &Vector3<f64>) -> Option<usize> {
    let place = |index: usize| {
        let places = items.iter().skip(index).filter_map(|item| site.place(item)?.horizontal_m);
        places.map(|[x, y]| (x - near_m.x).hypot(y - near_m.y)).next().unwrap_or(f64::INFINITY)
    };
    let starts =
        (0..items.len()).filter(|index| items.get(*index).is_some_and(|item| item.command == DO_LAND_START));
    starts.min_by(|one, other| place(*one).total_cmp(&place(*other)))
}

impl MissionItem {
    /// The number of the item that a jump leads to, if it is one.
    pub fn jump_target_mut(&mut self) -> Option<&mut f64> {
        let [target, ..] = &mut self.parameters;
        (self.command == DO_JUMP).then_some(target)
    }

    /// Home as an item: latitude and longitude, degrees, and altitude above sea level, m.
    pub fn home(position: [f64; 3]) -> Self {
        Self {
            frame: frame::GLOBAL,
            command: NAV_WAYPOINT,
            parameters: [0.0; 4],
            position,
            autocontinue: true,
        }
    }
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

    fn look_at(&self, item: &MissionItem) -> Option<Look> {
        self.site.place(item).map(Look::At)
    }
}

fn waypoint(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::Waypoint(Waypoint {
        place: source.place(),
        hold_s: source.value(1),
        acceptance_radius_m: Some(source.value(2)).filter(|radius_m| *radius_m > 0.0),
        heading_rad: source.heading_rad(),
    }))
}

fn loiter(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::Loiter { place: source.place(), heading_rad: source.heading_rad() })
}

fn turns(source: &Source<'_>) -> Step {
    let radius_m = Some(source.value(3)).filter(|radius_m| *radius_m != 0.0);
    Step::Navigate(Navigate::LoiterTurns(Turns { place: source.place(), turns: source.value(1), radius_m }))
}

fn loiter_time(source: &Source<'_>) -> Step {
    Step::Navigate(Navigate::LoiterTime { place: source.place(), time_s: source.value(1) })
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
    Step::Navigate(Navigate::Spline { place: source.place(), hold_s: source.value(1) })
}

/// NAV_PAYLOAD_PLACE: how far it may descend below its altitude; 0: to the ground.
fn place_payload(source: &Source<'_>) -> Step {
    let descent_m = Some(source.value(1)).filter(|descent_m| *descent_m > 0.0);
    Step::Navigate(Navigate::PlacePayload { place: source.place(), descent_m })
}

/// DO_JUMP_TAG: as DO_JUMP, to the item behind a tag.
fn jump_to_tag(source: &Source<'_>) -> Step {
    let Some(to) = tagged_item(source.items, source.value(1)) else { return Step::Pass };
    let repeats = source.value(2);
    Step::Jump(Jump { to, repeats: if repeats < 0.0 { None } else { Some(repeats as u32) } })
}

fn jump(source: &Source<'_>) -> Step {
    let repeats = source.value(2);
    Step::Jump(Jump {
        to: source.value(1) as usize,
        repeats: if repeats < 0.0 { None } else { Some(repeats as u32) },
    })
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
mod tests {
    use core::f64::consts::{FRAC_PI_2, PI};

    use nalgebra::Vector3;

    use super::*;
    use crate::identity::Identity;
    use crate::plan::{Altitude, PlanKind, SpeedKind, SpeedTarget, check};
    use crate::world::{Geodetic, LocalFrame};

    const NAN: f64 = f64::NAN;

    fn item(command: u16, parameters: [f64; 4], position: [f64; 3]) -> MissionItem {
        MissionItem { frame: frame::LOCAL_NED, command, parameters, position, autocontinue: true }
    }

    fn place([x, y, z]: [f64; 3]) -> Place {
        Place { horizontal_m: Some([x, y]), altitude: Some(Altitude::Down(z)) }
    }

    /// The step of an item that is checked, behind one that it may name.
    fn step(item: &MissionItem, site: &Site) -> Step {
        let items = [self::item(NAV_WAYPOINT, [0.0; 4], [7.0, 8.0, -9.0]), *item];
        check::plan(PlanKind::Mission, &items, site).unwrap();
        (mission_command(item.command).unwrap().step)(&Source { item, items: &items, site })
    }

    #[test]
    fn every_command_becomes_its_step() {
        const AT: [f64; 3] = [30.0, -40.0, -10.0];
        let waypoint = |hold_s, acceptance_radius_m, heading_rad| {
            Navigate::Waypoint(Waypoint { place: place(AT), hold_s, acceptance_radius_m, heading_rad })
        };
        let delay = |time| Step::Navigate(Navigate::Delay(time));
        let turn = |to, rate_rad_s| Step::Condition(Condition::Yaw(Turn { to, rate_rad_s }));
        let speed = |kind, target| Step::Do(Do::ChangeSpeed(ChangeSpeed { kind, target }));
        let ahead = |offset_rad| Step::Do(Do::Look(Some(Look::NextWaypoint { offset_rad })));
        let nothing = Step::Do(Do::Look(None));
        let at = Step::Do(Do::Look(Some(Look::At(place(AT)))));
        let cases: Vec<(u16, [f64; 4], [f64; 3], Step)> = vec![
            (
                NAV_WAYPOINT,
                [5.0, 2.5, 0.0, 90.0],
                AT,
                Step::Navigate(waypoint(5.0, Some(2.5), Some(FRAC_PI_2))),
            ),
            (NAV_WAYPOINT, [NAN; 4], AT, Step::Navigate(waypoint(0.0, None, None))),
            (NAV_WAYPOINT, [0.0; 4], AT, Step::Navigate(waypoint(0.0, None, Some(0.0)))),
            (
                NAV_LOITER_UNLIM,
                [0.0, 0.0, 5.0, -180.0],
                AT,
                Step::Navigate(Navigate::Loiter { place: place(AT), heading_rad: Some(-PI) }),
            ),
            (
                NAV_LOITER_TURNS,
                [1.5, 0.0, -20.0, NAN],
                AT,
                Step::Navigate(Navigate::LoiterTurns(Turns {
                    place: place(AT),
                    turns: 1.5,
                    radius_m: Some(-20.0),
                })),
            ),
            (
                NAV_LOITER_TURNS,
                [2.0, 0.0, 0.0, NAN],
                AT,
                Step::Navigate(Navigate::LoiterTurns(Turns { place: place(AT), turns: 2.0, radius_m: None })),
            ),
            (
                NAV_LOITER_TIME,
                [12.0, 0.0, 5.0, 0.0],
                AT,
                Step::Navigate(Navigate::LoiterTime { place: place(AT), time_s: 12.0 }),
            ),
            (NAV_RETURN_TO_LAUNCH, [0.0; 4], [0.0; 3], Step::Navigate(Navigate::ReturnToLaunch)),
            (
                NAV_LAND,
                [0.0, 0.0, 0.0, NAN],
                [NAN; 3],
                Step::Navigate(Navigate::Land { place: Place::default(), heading_rad: None }),
            ),
            (
                NAV_TAKEOFF,
                [15.0, 0.0, 0.0, 10.0],
                AT,
                Step::Navigate(Navigate::Takeoff { place: place(AT), travels: true }),
            ),
            (
                NAV_LOITER_TO_ALT,
                [0.0, 25.0, 0.0, 0.0],
                AT,
                Step::Navigate(Navigate::LoiterToAltitude { place: place(AT) }),
            ),
            (
                NAV_SPLINE_WAYPOINT,
                [3.0, 0.0, 0.0, 0.0],
                AT,
                Step::Navigate(Navigate::Spline { place: place(AT), hold_s: 3.0 }),
            ),
            (
                NAV_PAYLOAD_PLACE,
                [4.0, 0.0, 0.0, 0.0],
                AT,
                Step::Navigate(Navigate::PlacePayload { place: place(AT), descent_m: Some(4.0) }),
            ),
            (NAV_GUIDED_ENABLE, [0.0; 4], [0.0; 3], Step::Do(Do::Mark)),
            (NAV_SCRIPT_TIME, [1.0, 20.0, 0.0, 0.0], [0.0; 3], delay(Delay::For(20.0))),
            (NAV_DELAY, [3.5, -1.0, -1.0, -1.0], [0.0; 3], delay(Delay::For(3.5))),
            (
                NAV_DELAY,
                [-1.0, 13.0, NAN, 30.0],
                [0.0; 3],
                delay(Delay::Until(TimeOfDay([Some(13), None, Some(30)]))),
            ),
            (CONDITION_DELAY, [4.0, NAN, NAN, NAN], [NAN; 3], Step::Condition(Condition::Delay(4.0))),
            (CONDITION_DISTANCE, [15.0, NAN, NAN, NAN], [NAN; 3], Step::Condition(Condition::Distance(15.0))),
            (
                CONDITION_YAW,
                [180.0, 90.0, -1.0, 0.0],
                [0.0; 3],
                turn(TurnTo::Heading(PI, TurnDirection::CounterClockwise), Some(FRAC_PI_2)),
            ),
            (
                CONDITION_YAW,
                [90.0, NAN, NAN, NAN],
                [0.0; 3],
                turn(TurnTo::Heading(FRAC_PI_2, TurnDirection::Shortest), None),
            ),
            (CONDITION_YAW, [90.0, 0.0, -1.0, 1.0], [0.0; 3], turn(TurnTo::By(-FRAC_PI_2), None)),
            (CONDITION_YAW, [90.0, 0.0, 0.0, 1.0], [0.0; 3], turn(TurnTo::By(FRAC_PI_2), None)),
            (DO_JUMP, [0.0, 3.0, NAN, NAN], [0.0; 3], Step::Jump(Jump { to: 0, repeats: Some(3) })),
            (DO_JUMP, [1.0, -1.0, NAN, NAN], [0.0; 3], Step::Jump(Jump { to: 1, repeats: None })),
            (
                DO_CHANGE_SPEED,
                [1.0, 3.5, -1.0, 0.0],
                [0.0; 3],
                speed(SpeedKind::Horizontal, SpeedTarget::Limit(3.5)),
            ),
            (
                DO_CHANGE_SPEED,
                [0.0, -1.0, 0.0, 0.0],
                [0.0; 3],
                speed(SpeedKind::Horizontal, SpeedTarget::Keep),
            ),
            (DO_CHANGE_SPEED, [2.0, -2.0, 0.0, 0.0], [0.0; 3], speed(SpeedKind::Up, SpeedTarget::Default)),
            (
                DO_CHANGE_SPEED,
                [3.0, 1.0, 0.0, 0.0],
                [0.0; 3],
                speed(SpeedKind::Down, SpeedTarget::Limit(1.0)),
            ),
            (DO_SET_HOME, [0.0, 0.0, 0.0, NAN], AT, Step::Do(Do::SetHome(Some(place(AT))))),
            (DO_SET_HOME, [1.0, 0.0, 0.0, NAN], AT, Step::Do(Do::SetHome(None))),
            (DO_SET_ROI_LOCATION, [0.0; 4], AT, at),
            (DO_SET_ROI_WPNEXT_OFFSET, [0.0; 4], [0.0, 0.0, 90.0], ahead(FRAC_PI_2)),
            (DO_SET_ROI_NONE, [0.0; 4], AT, nothing),
            (DO_SET_ROI, [0.0; 4], AT, at),
            (DO_SET_ROI, [0.0; 4], [0.0; 3], nothing),
            (DO_SET_ROI, [1.0, 0.0, 0.0, 0.0], AT, ahead(0.0)),
            (
                DO_SET_ROI,
                [2.0, 0.0, 0.0, 0.0],
                AT,
                Step::Do(Do::Look(Some(Look::At(place([7.0, 8.0, -9.0]))))),
            ),
            (DO_SET_ROI, [3.0, 0.0, 0.0, 0.0], AT, at),
        ];
        let origin = Geodetic { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };
        let frame = LocalFrame::new(origin);
        let site = Site { identity: Identity::Px4, frame, home_m: Vector3::new(1.0, 2.0, -3.0) };
        for (command, parameters, position, expected) in &cases {
            let item = item(*command, *parameters, *position);
            assert_eq!(step(&item, &site), *expected, "{item:?}");
        }
        let items = [item(JUMP_TAG, [7.0, 0.0, 0.0, 0.0], AT), item(DO_JUMP_TAG, [7.0, 2.0, 0.0, 0.0], AT)];
        check::plan(PlanKind::Mission, &items, &site).unwrap();
        let source = Source { item: &items[1], items: &items, site: &site };
        assert_eq!(jump_to_tag(&source), Step::Jump(Jump { to: 0, repeats: Some(2) }));
        let fault = check::plan(PlanKind::Mission, &items[1..], &site).unwrap_err();
        assert_eq!(fault.reason, "no item has tag 7");
        let tested = |number| number == DO_JUMP_TAG || cases.iter().any(|(command, ..)| *command == number);
        let known = MISSION_COMMANDS.iter().map(|command| command.number);
        let untested: Vec<u16> = known.filter(|number| !tested(*number)).collect();
        assert!(untested.is_empty(), "commands without a case: {untested:?}");
    }
}
