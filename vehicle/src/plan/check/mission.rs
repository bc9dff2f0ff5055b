//! What is taken into a mission.

use super::super::{FaultCode, MissionItem, PlanFault, Site, command};
use super::{ItemFault, place};

/// What the checks know of a command.
struct Rule {
    command: u16,
    /// Whether parameters 5 to 7 are a place.
    place: PlaceRule,
    /// Ranges of parameters; one that was not given (NaN) is in every range.
    ranges: &'static [(u8, &'static str, f64, f64)],
    /// Parameters that have to be given.
    needed: &'static [u8],
}

#[derive(Clone, Copy, PartialEq)]
enum PlaceRule {
    /// None.
    None,
    /// One that is flown to.
    Goal,
    /// One on the ground, whose altitude is not flown to.
    Ground,
    /// One that is looked at, or remembered.
    Mark,
}

/// Longest time, s.
const LONGEST_S: f64 = 86_400.0;
/// Largest radius, m.
const WIDEST_M: f64 = 1000.0;
/// Most turns.
const TURNS: f64 = 1000.0;
/// An angle, degrees.
const ANGLE: (f64, f64) = (-360.0, 360.0);
/// Fastest speed, m/s: what the limits of the closed loop can be set to; −1 keeps it, −2 is the parameter's.
const SPEED: (f64, f64) = (-2.0, 50.0);
/// Highest number of an item.
const LAST: f64 = u16::MAX as f64;

#[rustfmt::skip] // One line per command reads as the table that it is.
static RULES: &[Rule] = &[
    Rule { command: command::NAV_WAYPOINT, place: PlaceRule::Goal, needed: &[], ranges: &[
        (1, "hold time", 0.0, LONGEST_S), (2, "acceptance radius", 0.0, WIDEST_M),
        (3, "pass-by radius", -WIDEST_M, WIDEST_M), (4, "yaw", ANGLE.0, ANGLE.1)] },
    Rule { command: command::NAV_LOITER_UNLIM, place: PlaceRule::Goal, needed: &[], ranges: &[
        (3, "radius", -WIDEST_M, WIDEST_M), (4, "yaw", ANGLE.0, ANGLE.1)] },
    Rule { command: command::NAV_LOITER_TURNS, place: PlaceRule::Goal, needed: &[1], ranges: &[
        (1, "turns", 0.0, TURNS), (3, "radius", -WIDEST_M, WIDEST_M)] },
    Rule { command: command::NAV_LOITER_TIME, place: PlaceRule::Goal, needed: &[1], ranges: &[
        (1, "time", 0.0, LONGEST_S), (3, "radius", -WIDEST_M, WIDEST_M)] },
    Rule { command: command::NAV_RETURN_TO_LAUNCH, place: PlaceRule::None, needed: &[], ranges: &[] },
    Rule { command: command::NAV_LAND, place: PlaceRule::Ground, needed: &[], ranges: &[
        (4, "yaw", ANGLE.0, ANGLE.1)] },
    Rule { command: command::NAV_TAKEOFF, place: PlaceRule::Goal, needed: &[], ranges: &[
        (4, "yaw", ANGLE.0, ANGLE.1)] },
    Rule { command: command::NAV_DELAY, place: PlaceRule::None, needed: &[1], ranges: &[
        (1, "delay", -1.0, LONGEST_S), (2, "hour", -1.0, 23.0), (3, "minute", -1.0, 59.0), (4, "second", -1.0, 59.0)] },
    Rule { command: command::CONDITION_DELAY, place: PlaceRule::None, needed: &[1], ranges: &[
        (1, "delay", 0.0, LONGEST_S)] },
    Rule { command: command::CONDITION_DISTANCE, place: PlaceRule::None, needed: &[1], ranges: &[
        (1, "distance", 0.0, 1e5)] },
    Rule { command: command::CONDITION_YAW, place: PlaceRule::None, needed: &[1], ranges: &[
        (1, "angle", ANGLE.0, ANGLE.1), (2, "rate", 0.0, 360.0), (3, "direction", -1.0, 1.0),
        (4, "relative", 0.0, 1.0)] },
    Rule { command: command::DO_JUMP, place: PlaceRule::None, needed: &[1, 2], ranges: &[
        (1, "item", 0.0, LAST), (2, "repeats", -1.0, LAST)] },
    Rule { command: command::DO_CHANGE_SPEED, place: PlaceRule::None, needed: &[2], ranges: &[
        (1, "kind of speed", 0.0, 3.0), (2, "speed", SPEED.0, SPEED.1)] },
    Rule { command: command::DO_SET_HOME, place: PlaceRule::Mark, needed: &[], ranges: &[
        (1, "use current", 0.0, 1.0), (4, "yaw", ANGLE.0, ANGLE.1)] },
    Rule { command: command::DO_SET_ROI_LOCATION, place: PlaceRule::Mark, needed: &[5, 6], ranges: &[] },
    Rule { command: command::DO_SET_ROI_WPNEXT_OFFSET, place: PlaceRule::None, needed: &[], ranges: &[
        (7, "yaw offset", ANGLE.0, ANGLE.1)] },
    Rule { command: command::DO_SET_ROI_NONE, place: PlaceRule::None, needed: &[], ranges: &[] },
    Rule { command: command::DO_SET_ROI, place: PlaceRule::None, needed: &[], ranges: &[
        (1, "kind", 0.0, 3.0)] },
];

/// Whether an item of a mission has a place that is flown to, in contrast to one that is looked at or remembered.
pub fn is_flown_to(item: &MissionItem) -> bool {
    RULES
        .iter()
        .any(|rule| rule.command == item.command && matches!(rule.place, PlaceRule::Goal | PlaceRule::Ground))
}

/// Checks an item by itself. In ArduPilot's convention the first one is home, whatever it says.
pub fn item(index: usize, item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    if site.identity.is_ardupilot() && index == 0 {
        return Ok(());
    }
    let Some(rule) = RULES.iter().find(|rule| rule.command == item.command) else {
        return Err((FaultCode::Unsupported, format!("command {} is not supported", item.command)));
    };
    for (number, name, low, high) in rule.ranges {
        let value = item.parameter(usize::from(*number));
        if !value.is_nan() && !(*low..=*high).contains(&value) {
            let reason = format!("{name} {value} is outside [{low}, {high}]");
            return Err((FaultCode::InvalidParameter(*number), reason));
        }
    }
    if let Some(number) = rule.needed.iter().find(|number| item.parameter(usize::from(**number)).is_nan()) {
        return Err((FaultCode::InvalidParameter(*number), format!("parameter {number} is needed")));
    }
    particular(item, site)?;
    check_place(rule.place, item, site)
}

/// What is particular to a command.
fn particular(item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    let wrong = |number: u8, reason: String| Err((FaultCode::InvalidParameter(number), reason));
    let whole: &[u8] = match item.command {
        command::DO_JUMP => &[1, 2],
        command::DO_CHANGE_SPEED | command::DO_SET_ROI => &[1],
        command::NAV_DELAY => &[2, 3, 4],
        _ => &[],
    };
    for number in whole {
        let value = item.parameter_or(usize::from(*number), 0.0);
        if value.fract() != 0.0 {
            return wrong(*number, format!("{value} is not a whole number"));
        }
    }
    let speed_m_s = item.parameter(2);
    if item.command == command::DO_CHANGE_SPEED && speed_m_s < 0.1 && speed_m_s != -1.0 && speed_m_s != -2.0 {
        return wrong(2, format!("speed {speed_m_s} is outside [0.1, {}]", SPEED.1));
    }
    let delay_s = item.parameter(1);
    if item.command == command::NAV_DELAY && delay_s < 0.0 {
        // −1 stands for the time of day behind it.
        if delay_s != -1.0 {
            return wrong(1, format!("delay {delay_s} is outside [0, {LONGEST_S}]"));
        }
        if [2, 3, 4].iter().all(|number| item.parameter_or(*number, -1.0) < 0.0) {
            return wrong(2, "a delay until a time of day needs an hour, a minute or a second".to_owned());
        }
    }
    let remembers = item.command == command::DO_SET_HOME && item.parameter_or(1, 0.0) == 0.0;
    if remembers && site.place(item).is_some_and(|place| place.horizontal_m.is_none()) {
        return wrong(5, "home needs a latitude and a longitude".to_owned());
    }
    Ok(())
}

fn check_place(rule: PlaceRule, item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    if rule == PlaceRule::None && item.command != command::DO_SET_ROI {
        return Ok(());
    }
    // Only the kind that is a place has one; where the present place counts, none is needed.
    const LOCATION: f64 = 3.0;
    let named = match item.command {
        command::DO_SET_ROI => item.parameter_or(1, 0.0) == LOCATION,
        command::DO_SET_HOME => item.parameter_or(1, 0.0) == 0.0,
        _ => true,
    };
    if !named {
        return Ok(());
    }
    let place = place(item, site)?;
    match place.down_m {
        Some(down_m) if rule == PlaceRule::Goal && down_m > 0.0 => {
            let reason = format!("altitude {} is {down_m:.1} m below the ground", item.position[2]);
            Err((FaultCode::InvalidParameter(7), reason))
        }
        _ => Ok(()),
    }
}

/// Checks how the items belong together: a jump goes to an item that there is.
pub fn whole(items: &[MissionItem]) -> Result<(), PlanFault> {
    for (index, item) in items.iter().enumerate() {
        let target = match item.command {
            command::DO_JUMP => Some((1, item.parameter(1))),
            command::DO_SET_ROI if item.parameter(1) == 2.0 => Some((2, item.parameter(2))),
            _ => None,
        };
        let Some((number, target)) = target else { continue };
        let exists = target >= 0.0 && target.fract() == 0.0 && (target as usize) < items.len();
        if !exists {
            let reason = format!("there is no item {target} among {}", items.len());
            return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(number), reason));
        }
    }
    Ok(())
}
