//! What is taken into a plan: item by item as they come, then the plan as a whole.

mod fence;
mod mission;
mod rally;

use super::{FaultCode, MissionItem, PlanFault, PlanKind, Site, frame};
use crate::world::FARTHEST_M;

/// No latitude and longitude is farther from another one than this in a local frame, m. How far a place may be to be flown to counts when
/// a mission begins.
const AROUND_M: f64 = 30_000_000.0;

/// Checks an item by itself.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn item(kind: PlanKind, index: usize, item: &MissionItem, site: &Site) -> Result<(), PlanFault> {
    let result = match kind {
        PlanKind::Mission => mission::item(index, item, site),
        PlanKind::Fence => fence::item(item, site),
        PlanKind::Rally => rally::item(item, site),
    };
    result.map_err(|(code, reason)| PlanFault {
        command: Some(item.command),
        ..PlanFault::of_item(index, code, reason)
    })
}

/// Checks a plan: every item, and how they belong together.
///
/// # Errors
/// [`PlanFault`] of the first item, or of the plan.
pub fn plan(kind: PlanKind, items: &[MissionItem], site: &Site) -> Result<(), PlanFault> {
    if items.len() > kind.capacity() {
        let reason = format!("{} items; at most {} fit", items.len(), kind.capacity());
        return Err(PlanFault::of_plan(FaultCode::NoSpace, reason));
    }
    for (index, one) in items.iter().enumerate() {
        item(kind, index, one, site)?;
    }
    match kind {
        PlanKind::Mission => mission::whole(items),
        PlanKind::Fence => fence::whole(items, site),
        PlanKind::Rally => rally::whole(items, site),
    }
}

/// What is wrong with an item.
type ItemFault = (FaultCode, String);

/// Checks the place of an item: its frame, latitude and longitude.
fn place(item: &MissionItem, site: &Site) -> Result<super::Place, ItemFault> {
    if !Site::knows(item.frame) {
        let reason = format!("frame {} is not supported; allowed 0, 1, 3, 5, 6, 10, 11", item.frame);
        return Err((FaultCode::UnsupportedFrame, reason));
    }
    let [x, y, z] = item.position;
    let local = item.frame == frame::LOCAL_NED;
    // What is not a number leaves the place open; latitudes and longitudes have ranges of their own.
    for (parameter, name, value) in [(5, "north", x), (6, "east", y), (7, "altitude", z)] {
        let name = if local && parameter == 7 { "down" } else { name };
        let limited = if parameter == 7 { value.abs() > FARTHEST_M } else { local && value.is_infinite() };
        if limited {
            let reason = format!("{name} = {value} m; allowed -{FARTHEST_M} to {FARTHEST_M} m");
            return Err((FaultCode::InvalidParameter(parameter), reason));
        }
    }
    let Some(place) = site.place(item) else {
        let (parameter, name, value, most) =
            if x.abs() <= 90.0 { (6, "longitude", y, 180) } else { (5, "latitude", x, 90) };
        let reason = format!("{name} = {value}; allowed -{most} to {most} degrees");
        return Err((FaultCode::InvalidParameter(parameter), reason));
    };
    if let Some([north, east]) = place.horizontal_m {
        let distance_m = libm::hypot(north, east);
        if distance_m > AROUND_M {
            let parameter = if north.abs() > east.abs() { 5 } else { 6 };
            let reason = format!(
                "the place is {:.0} km away, which is nowhere on the earth; allowed up to {:.0} km",
                distance_m / 1e3,
                AROUND_M / 1e3
            );
            return Err((FaultCode::InvalidParameter(parameter), reason));
        }
    }
    Ok(place)
}

/// Checks that a command is one of a few.
fn one_of(item: &MissionItem, commands: &[u16]) -> Result<(), ItemFault> {
    if commands.contains(&item.command) {
        return Ok(());
    }
    Err((FaultCode::Unsupported, "not supported".to_owned()))
}
