//! A way around the areas to stay out of.

use super::polygon::Side;
use super::{Shape, Zones};

/// So far around corners, m.
const CLEARANCE_M: f64 = 2.0;
/// Corners of the polygon that stands for a circle on the way around it.
const CIRCLE_CORNERS: usize = 16;
/// With more corners than this the search would hold the flight up.
const MOST_NODES: usize = 250;

/// The shortest way between two points that keeps out of the areas to stay out of and does not cross the borders of those to stay in:
/// the points to fly to after the start, the goal last. `None` if there is none.
///
/// The corners of all areas, moved outward, and the two ends see one another or not; the way is the shortest one over those that
/// do (visibility graph, Dijkstra). Areas that the start is in do not count: it has to leave them anyway.
pub fn route_m(zones: &Zones, start: [f64; 2], goal: [f64; 2]) -> Option<Vec<[f64; 2]>> {
    let free = |way: &Side| {
        zones.zones.iter().all(|zone| {
            let left = zone.forbids(start);
            let crossed = match (&zone.shape, zone.inclusion) {
                (shape, false) => shape.is_entered_by(way),
                (Shape::Polygon(polygon), true) => polygon.is_met_by(way),
                (shape @ Shape::Circle { .. }, true) => !shape.contains(way.0) || !shape.contains(way.1),
            };
            left || !crossed
        })
    };
    if free(&(start, goal)) {
        return Some(vec![goal]);
    }
    let mut nodes = vec![start, goal];
    nodes.extend(zones.zones.iter().filter(|zone| !zone.inclusion).flat_map(|zone| around(&zone.shape)));
    if nodes.len() > MOST_NODES {
        return None;
    }
    shortest(&nodes, free)
}

/// Dijkstra's algorithm from the first to the second node over the ways that are free.
fn shortest(nodes: &[[f64; 2]], free: impl Fn(&Side) -> bool) -> Option<Vec<[f64; 2]>> {
    const GOAL: usize = 1;
    let mut open: Vec<usize> = (0..nodes.len()).collect();
    let mut lengths_m = vec![f64::INFINITY; nodes.len()];
    let mut before = vec![0; nodes.len()];
    *lengths_m.first_mut()? = 0.0;
    loop {
        let next = (0..open.len()).min_by(|one, other| {
            let length = |place: &usize| open.get(*place).and_then(|node| lengths_m.get(*node)).copied();
            length(one).unwrap_or(f64::INFINITY).total_cmp(&length(other).unwrap_or(f64::INFINITY))
        })?;
        let node = open.swap_remove(next);
        let (from, length_m) = (*nodes.get(node)?, *lengths_m.get(node)?);
        if length_m.is_infinite() {
            return None;
        }
        if node == GOAL {
            break;
        }
        for other in &open {
            let to = *nodes.get(*other)?;
            let through_m = length_m + libm::hypot(to[0] - from[0], to[1] - from[1]);
            if through_m < *lengths_m.get(*other)? && free(&(from, to)) {
                *lengths_m.get_mut(*other)? = through_m;
                *before.get_mut(*other)? = node;
            }
        }
    }
    let mut way = Vec::new();
    let mut node = GOAL;
    while node != 0 {
        way.push(*nodes.get(node)?);
        node = *before.get(node)?;
    }
    way.reverse();
    Some(way)
}

/// Points around an area, outside of it.
fn around(shape: &Shape) -> Vec<[f64; 2]> {
    match shape {
        Shape::Circle { centre_m: [x, y], radius_m } => {
            let step = core::f64::consts::TAU / CIRCLE_CORNERS as f64;
            // The sides between them keep clear of the circle.
            let far_m = (radius_m + CLEARANCE_M) / libm::cos(step / 2.0);
            let point = |index: usize| {
                let angle = index as f64 * step;
                [x + far_m * libm::cos(angle), y + far_m * libm::sin(angle)]
            };
            (0..CIRCLE_CORNERS).map(point).collect()
        }
        Shape::Polygon(polygon) => {
            let corners = polygon.corners();
            let count = corners.len();
            let corner = |index: usize| corners.get(index % count).copied().unwrap_or_default();
            let outward = |index: usize| {
                let (before, here, after) = (corner(index + count - 1), corner(index), corner(index + 1));
                let unit = |to: [f64; 2]| {
                    let (dx, dy) = (to[0] - here[0], to[1] - here[1]);
                    let length = libm::hypot(dx, dy).max(1e-9);
                    [dx / length, dy / length]
                };
                let (one, other) = (unit(before), unit(after));
                let mut away = [-one[0] - other[0], -one[1] - other[1]];
                let length = libm::hypot(away[0], away[1]);
                // A corner on a straight side is passed at a right angle.
                away = if length < 1e-6 { [-one[1], one[0]] } else { [away[0] / length, away[1] / length] };
                let place = |side: f64| {
                    [here[0] + side * CLEARANCE_M * away[0], here[1] + side * CLEARANCE_M * away[1]]
                };
                if polygon.contains(place(1.0)) { place(-1.0) } else { place(1.0) }
            };
            (0..count).map(outward).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{Polygon, Zone};
    use super::*;

    fn length_m(start: [f64; 2], way: &[[f64; 2]]) -> f64 {
        let from = core::iter::once(&start).chain(way);
        from.zip(way).map(|(a, b)| libm::hypot(a[0] - b[0], a[1] - b[1])).sum()
    }

    fn wall() -> Zone {
        let corners = vec![[10.0, -20.0], [10.0, 30.0], [14.0, 30.0], [14.0, -20.0]];
        Zone { shape: Shape::Polygon(Polygon::new(corners).expect("a wall")), inclusion: false }
    }

    #[test]
    fn goes_around_a_wall_on_its_short_side() {
        let zones = Zones { zones: vec![wall()], return_m: None };
        let way = route_m(&zones, [0.0, 0.0], [24.0, 0.0]).expect("a way");
        // Around two corners at y = -20, a clearance off.
        assert_eq!(way.len(), 3, "{way:?}");
        assert!(way.iter().take(2).all(|[_, y]| (*y + 20.0 + 2.0_f64.sqrt()).abs() < 1e-9), "{way:?}");
        assert_eq!(route_m(&zones, [0.0, 0.0], [5.0, 5.0]), Some(vec![[5.0, 5.0]]));
    }

    #[test]
    fn there_is_no_way_through_a_closed_border() {
        let square = |r: f64| vec![[-r, -r], [-r, r], [r, r], [r, -r]];
        let zone =
            Zone { shape: Shape::Polygon(Polygon::new(square(10.0)).expect("square")), inclusion: true };
        let zones = Zones { zones: vec![zone], return_m: None };
        assert_eq!(route_m(&zones, [0.0, 0.0], [20.0, 0.0]), None);
    }

    proptest! {
        /// Around a circle: at least the geodesic of two tangents and an arc, and little more; nowhere inside.
        #[test]
        fn the_way_around_a_circle_is_short_and_free(radius in 3.0..30.0, far in 2.0..60.0, off in -0.9..0.9_f64) {
            let shape = Shape::Circle { centre_m: [0.0, 0.0], radius_m: radius };
            let zones = Zones { zones: vec![Zone { shape: shape.clone(), inclusion: false }], return_m: None };
            let reach: f64 = radius + 3.0 + far;
            let (start, goal) = ([-reach, off * radius], [reach, off * radius]);
            let way = route_m(&zones, start, goal).expect("a way");
            for (a, b) in core::iter::once(&start).chain(&way).zip(&way) {
                prop_assert!(!shape.is_entered_by(&(*a, *b)));
            }
            let tangent = |p: [f64; 2]| libm::hypot(p[0], p[1]);
            let d = tangent(start);
            let arc = core::f64::consts::PI - 2.0 * libm::acos(radius / d) - 2.0 * libm::asin(off.abs() * radius / d);
            let least = 2.0 * libm::sqrt(d * d - radius * radius) + radius * arc.max(0.0);
            let length = length_m(start, &way);
            prop_assert!(length >= least - 1e-6 && length <= least + 8.0 + 0.06 * radius, "{length} {least}");
        }
    }
}
