//! Zones out of the items of a fence plan.

use super::{FaultCode, MissionItem, PlanFault, PlanKind, Site, command};
use crate::fence::{Polygon, Shape, Zone, Zones};

/// Range of the radius of a circle, m: a smaller one is below the accuracy of latitudes and longitudes.
const SMALLEST_RADIUS_M: f64 = 0.1;
const LARGEST_RADIUS_M: f64 = 100_000.0;

/// The zones of the items of a plan. The corners of a polygon follow one another; each tells how many there are.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn zones(items: &[MissionItem], site: &Site) -> Result<Zones, PlanFault> {
    let mut zones = Zones::default();
    let mut index = 0;
    while let Some(item) = items.get(index) {
        match item.command {
            command::NAV_FENCE_RETURN_POINT => {
                zones.return_m = Some(point(index, item, site)?);
                index += 1;
            }
            command::NAV_FENCE_CIRCLE_INCLUSION
            | command::NAV_FENCE_CIRCLE_EXCLUSION
            | command::NAV_FENCE_HOME_CIRCLE_INCLUSION => {
                zones.zones.push(circle(index, item, site)?);
                index += 1;
            }
            _ => {
                let count = corner_count(index, item)?;
                zones.zones.push(polygon(index, count, items, site)?);
                index += count;
            }
        }
    }
    Ok(zones)
}

fn point(index: usize, item: &MissionItem, site: &Site) -> Result<[f64; 2], PlanFault> {
    let place = site.place(item).and_then(|place| place.horizontal_m);
    place.ok_or_else(|| {
        PlanFault::of_item(index, FaultCode::InvalidParameter(5), "latitude and longitude are required")
    })
}

fn circle(index: usize, item: &MissionItem, site: &Site) -> Result<Zone, PlanFault> {
    let radius_m = item.parameter(1);
    // NaN is in no range.
    if !(SMALLEST_RADIUS_M..=LARGEST_RADIUS_M).contains(&radius_m) {
        let reason = format!("radius = {radius_m} m; allowed {SMALLEST_RADIUS_M} to {LARGEST_RADIUS_M} m");
        return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(1), reason));
    }
    let centre_m = match item.command {
        command::NAV_FENCE_HOME_CIRCLE_INCLUSION => [site.home_m.x, site.home_m.y],
        _ => point(index, item, site)?,
    };
    let inclusion = item.command != command::NAV_FENCE_CIRCLE_EXCLUSION;
    Ok(Zone { shape: Shape::Circle { centre_m, radius_m }, inclusion })
}

fn corner_count(index: usize, item: &MissionItem) -> Result<usize, PlanFault> {
    let count = item.parameter(1);
    // NaN is in no range.
    let most = PlanKind::Fence.capacity();
    if (3.0..=most as f64).contains(&count) && libm::trunc(count) == count {
        Ok(count as usize)
    } else {
        let reason = format!("corner count = {count}; allowed: an integer from 3 to {most}");
        Err(PlanFault::of_item(index, FaultCode::InvalidParameter(1), reason))
    }
}

fn polygon(first: usize, count: usize, items: &[MissionItem], site: &Site) -> Result<Zone, PlanFault> {
    let of_first = items.get(first).map(|item| item.command);
    let mut corners = Vec::with_capacity(count);
    for index in first..first + count {
        let corner = items.get(index).filter(|item| Some(item.command) == of_first);
        let Some(item) = corner.filter(|item| item.parameter(1) == count as f64) else {
            let reason = format!("this polygon needs {count} consecutive corners of the same kind");
            return Err(PlanFault::of_item(index.min(items.len() - 1), FaultCode::Invalid, reason));
        };
        corners.push(point(index, item, site)?);
    }
    // Many clients close the ring by its first corner.
    if corners.len() > 3 && corners.first() == corners.last() {
        corners.pop();
    }
    let polygon = Polygon::new(corners).map_err(|fault| {
        PlanFault::of_item(first, FaultCode::Invalid, format!("invalid polygon: {fault}"))
    })?;
    let inclusion = of_first == Some(command::NAV_FENCE_POLYGON_VERTEX_INCLUSION);
    Ok(Zone { shape: Shape::Polygon(polygon), inclusion })
}
