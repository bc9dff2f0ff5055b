//! What is taken into a fence.

use super::super::{MissionItem, PlanFault, Site, command, zones};
use super::{ItemFault, one_of, place};

const COMMANDS: [u16; 5] = [
    command::NAV_FENCE_RETURN_POINT,
    command::NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    command::NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
    command::NAV_FENCE_CIRCLE_INCLUSION,
    command::NAV_FENCE_CIRCLE_EXCLUSION,
];

/// Checks an item by itself.
pub fn item(item: &MissionItem, site: &Site) -> Result<(), ItemFault> {
    one_of(item, &COMMANDS)?;
    place(item, site).map(drop)
}

/// Checks how the items belong together.
pub fn whole(items: &[MissionItem], site: &Site) -> Result<(), PlanFault> {
    zones(items, site).map(drop)
}
