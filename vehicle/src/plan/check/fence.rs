//! What is taken into a fence.

use super::super::{MissionItem, PlanFault, Site, command, zones};
use super::{ItemFault, one_of, place};

/// Checks an item by itself.
pub fn item(item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    one_of(item, &command::FENCE_COMMANDS)?;
    place(item, site).map(drop)
}

/// Checks how the items belong together.
pub fn whole(items: &[MissionItem], site: &Site) -> Result<(), PlanFault> {
    zones(items, site).map(drop)
}
