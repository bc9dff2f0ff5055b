//! What is taken into a fence.

use super::super::{FaultCode, MissionItem, PlanFault, Site, command, zones};
use super::{ItemFault, one_of, place};

/// Checks an item by itself.
pub fn item(item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    one_of(item, &command::FENCE_COMMANDS)?;
    if item.command == command::NAV_FENCE_HOME_CIRCLE_INCLUSION {
        // Its centre is home, whatever its place says.
        return if site.identity.is_ardupilot() { Ok(()) } else { Err(no_home_circle()) };
    }
    place(item, site).map(drop)
}

/// PX4 has a parameter instead.
fn no_home_circle() -> ItemFault {
    let instead = "not supported: set GF_MAX_HOR_DIST to keep within a distance from home";
    (FaultCode::Unsupported, instead.to_owned())
}

/// Checks how the items belong together.
pub fn whole(items: &[MissionItem], site: &Site) -> Result<(), PlanFault> {
    zones(items, site).map(drop)
}
