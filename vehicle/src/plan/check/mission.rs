//! What is taken into a mission.

use super::super::item_search::tagged_item;
use super::super::mission_command::{
    FASTEST_M_S, LONGEST_S, MissionCommand, PlaceRule, ROI_ITEM, ROI_LOCATION, mission_command,
};
use super::super::{FaultCode, MissionItem, PlanFault, Site, command};
use super::{ItemFault, place};

/// Checks an item by itself. In ArduPilot's convention the first one is home, whatever it says.
pub fn item(index: usize, item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    if site.identity.is_ardupilot() && index == 0 {
        return Ok(());
    }
    let Some(rule) = mission_command(item.command) else {
        return Err((FaultCode::Unsupported, "not supported".to_owned()));
    };
    for (number, name, low, high) in rule.ranges {
        let value = item.parameter(usize::from(*number));
        if !value.is_nan() && !(*low..=*high).contains(&value) {
            let reason = format!("{name} = {value}; allowed {low} to {high}");
            return Err((FaultCode::InvalidParameter(*number), reason));
        }
    }
    if let Some(number) = rule.needed.iter().find(|number| item.parameter(usize::from(**number)).is_nan()) {
        return Err((FaultCode::InvalidParameter(*number), format!("parameter {number} is required")));
    }
    check_whole(rule, item)?;
    particular(item, site)?;
    check_place(rule.place, item, site)
}

fn check_whole(rule: &MissionCommand, item: &MissionItem) -> Result<(), ItemFault> {
    for number in rule.whole {
        let value = item.parameter_or(usize::from(*number), 0.0);
        if value.fract() != 0.0 {
            let reason = format!("parameter {number} = {value} must be a whole number");
            return Err((FaultCode::InvalidParameter(*number), reason));
        }
    }
    Ok(())
}

/// What is particular to a command.
fn particular(item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    let wrong = |number: u8, reason: String| Err((FaultCode::InvalidParameter(number), reason));
    let speed_m_s = item.parameter(2);
    if item.command == command::DO_CHANGE_SPEED && speed_m_s < 0.1 && speed_m_s != -1.0 && speed_m_s != -2.0 {
        return wrong(2, format!("speed = {speed_m_s} m/s; allowed 0.1 to {} m/s", FASTEST_M_S));
    }
    let delay_s = item.parameter(1);
    if item.command == command::NAV_DELAY && delay_s < 0.0 {
        // −1 stands for the time of day behind it.
        if delay_s != -1.0 {
            return wrong(1, format!("delay = {delay_s} s; allowed 0 to {LONGEST_S} s"));
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
    let is_region = matches!(item.command, command::DO_SET_ROI | command::NAV_ROI);
    if rule == PlaceRule::None && !is_region {
        return Ok(());
    }
    // Only the kind that is a place has one; where the present place counts, none is needed.
    let named = match item.command {
        command::DO_SET_ROI | command::NAV_ROI => item.parameter_or(1, 0.0) == ROI_LOCATION,
        command::DO_SET_HOME => item.parameter_or(1, 0.0) == 0.0,
        _ => true,
    };
    if !named {
        return Ok(());
    }
    place(item, site)?;
    // PX4's convention leaves the height as it is; ArduPilot has none that is open.
    if site.identity.is_ardupilot() && item.position[2].is_nan() {
        return Err((FaultCode::InvalidParameter(7), "an altitude is required".to_owned()));
    }
    Ok(())
}

/// Checks how the items belong together: a jump goes to an item that there is.
pub fn whole(items: &[MissionItem]) -> Result<(), PlanFault> {
    for (index, item) in items.iter().enumerate() {
        if item.command == command::DO_JUMP_TAG && tagged_item(items, item.parameter(1)).is_none() {
            let reason = format!("no item has tag {}", item.parameter(1));
            return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(1), reason));
        }
        let target = match item.command {
            command::DO_JUMP => Some((1, item.parameter(1))),
            command::DO_SET_ROI | command::NAV_ROI if item.parameter(1) == ROI_ITEM => {
                Some((2, item.parameter(2)))
            }
            _ => None,
        };
        let Some((number, target)) = target else { continue };
        let exists = target >= 0.0 && target.fract() == 0.0 && (target as usize) < items.len();
        if !exists {
            let reason = format!("no item has sequence number {target}; the plan has {} items", items.len());
            return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(number), reason));
        }
    }
    Ok(())
}
