//! The items of a mission that are named by what they are: by a tag, or as the beginning of a landing.

use nalgebra::Vector3;

use super::command::{DO_LAND_START, JUMP_TAG};
use super::{MissionItem, Site};

/// The largest number of a tag.
pub const LARGEST_TAG: f64 = u16::MAX as f64;

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
