//! What is taken into the rally points.

use super::super::{MissionItem, PlanFault, Site, command};
use super::{ItemFault, one_of, place};

/// Checks an item by itself.
pub fn item(item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    one_of(item, &[command::NAV_RALLY_POINT])?;
    place(item, site).map(drop)
}

/// Checks how the items belong together.
pub fn whole(_items: &[MissionItem], _site: &Site) -> Result<(), PlanFault> {
    Ok(())
}
