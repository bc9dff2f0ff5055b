//! Ways around fences, against a search on a grid that knows nothing of corners.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use nalgebra::Vector3;
use proptest::prelude::*;
use vehicle::fence::{Fence, Inclusions, Polygon, Progress, RouteSearch, Shape, Zone, Zones};

type Place = [f64; 2];

fn circle(centre_m: Place, radius_m: f64, inclusion: bool) -> Zone {
    Zone { shape: Shape::Circle { centre_m, radius_m }, inclusion }
}

fn polygon(corners: &[Place], inclusion: bool) -> Zone {
    Zone { shape: Shape::Polygon(Polygon::new(corners.to_vec()).unwrap()), inclusion }
}

fn fence(zones: &Zones) -> Fence<'_> {
    Fence {
        zones: Some(zones),
        inclusions: Inclusions::Any,
        home_m: Vector3::zeros(),
        radius_m: 0.0,
        height_m: 0.0,
    }
}

/// The way and how many slices of 50,000 sides it took.
fn searched(fence: &Fence, start: Place, goal: Place) -> (Option<Vec<Place>>, u64) {
    let mut search = RouteSearch::new(fence, start, goal);
    for slice in 1.. {
        match search.advance(50_000) {
            Progress::Searching => {}
            Progress::Found(way) => return (Some(way), slice),
            Progress::None => return (None, slice),
        }
    }
    unreachable!()
}

fn route(zones: Vec<Zone>, start: Place, goal: Place) -> Option<Vec<Place>> {
    searched(&fence(&Zones { zones, return_m: None }), start, goal).0
}

fn distance([ax, ay]: Place, [bx, by]: Place) -> f64 {
    (ax - bx).hypot(ay - by)
}

fn legs(start: Place, way: &[Place]) -> impl Iterator<Item = (Place, Place)> {
    std::iter::once(start).chain(way.to_vec()).zip(way.to_vec())
}

fn length_m(start: Place, way: &[Place]) -> f64 {
    legs(start, way).map(|(from, to)| distance(from, to)).sum()
}

/// What forbids a point of a way, each 0.1 m.
fn breach(fence: &Fence, start: Place, way: &[Place]) -> Option<(Place, vehicle::fence::Breach)> {
    legs(start, way).find_map(|(from, to)| {
        let steps = (distance(from, to) * 10.0).ceil().max(1.0) as u32;
        (0..=steps).find_map(|step| {
            let share = f64::from(step) / f64::from(steps);
            let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            fence.breach(&Vector3::new(at[0], at[1], 0.0)).map(|breach| (at, breach))
        })
    })
}

/// Length of the shortest way over the points of a grid of 1 m within ±100 m and their eight neighbours, which keeps a clearance.
fn on_a_grid_m(zones: &[Zone], start: Place, goal: Place, clearance_m: f64) -> Option<f64> {
    const HALF: i64 = 100;
    const SIDE: usize = 2 * HALF as usize + 1;
    let place = |node: usize| [(node / SIDE) as f64 - HALF as f64, (node % SIDE) as f64 - HALF as f64];
    let node = |[x, y]: Place| ((x as i64 + HALF) as usize) * SIDE + (y as i64 + HALF) as usize;
    let near = |zone: &Zone, at: Place| zone.shape.contains(at) || zone.shape.distance_m(at) < clearance_m;
    let free: Vec<bool> = (0..SIDE * SIDE)
        .map(|node| {
            let at = place(node);
            let inclusions = || zones.iter().filter(|zone| zone.inclusion);
            let inside = |zone: &Zone| zone.shape.contains(at) && zone.shape.distance_m(at) > clearance_m;
            !zones.iter().any(|zone| !zone.inclusion && near(zone, at))
                && (inclusions().next().is_none() || inclusions().any(inside))
        })
        .collect();
    let (start, goal) = (node(start), node(goal));
    let mut lengths = vec![f64::INFINITY; SIDE * SIDE];
    lengths[start] = 0.0;
    let mut open = BinaryHeap::from([(Reverse(0_u64), start)]);
    while let Some((Reverse(micrometres), node)) = open.pop() {
        let length = micrometres as f64 / 1e6;
        if node == goal {
            return Some(length);
        }
        if length > lengths[node] + 1e-5 {
            continue;
        }
        let (row, column) = ((node / SIDE) as i64, (node % SIDE) as i64);
        for (dx, dy) in [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)] {
            let (x, y) = (row + dx, column + dy);
            if !(0..SIDE as i64).contains(&x) || !(0..SIDE as i64).contains(&y) {
                continue;
            }
            let next = x as usize * SIDE + y as usize;
            let through = length + ((dx * dx + dy * dy) as f64).sqrt();
            if free[next] && through + 1e-5 < lengths[next] {
                lengths[next] = through;
                open.push((Reverse((through * 1e6) as u64), next));
            }
        }
    }
    None
}

/// Areas within ±90 m: circles, and stars of few corners.
fn exclusion() -> impl Strategy<Value = Zone> {
    let place = || [-90.0..90.0_f64, -90.0..90.0_f64];
    prop_oneof![
        (place(), 2.0..15.0).prop_map(|(centre, radius)| circle(centre, radius, false)),
        (place(), prop::collection::vec(3.0..18.0_f64, 3..7)).prop_map(|([x, y], radii)| {
            let count = radii.len() as f64;
            let corner = |(index, radius): (usize, &f64)| {
                let angle = index as f64 * std::f64::consts::TAU / count;
                [x + radius * angle.cos(), y + radius * angle.sin()]
            };
            polygon(&radii.iter().enumerate().map(corner).collect::<Vec<_>>(), false)
        }),
    ]
}

#[test]
fn it_goes_around_a_wall_on_its_short_side() {
    let wall = || vec![polygon(&[[10.0, -20.0], [10.0, 30.0], [14.0, 30.0], [14.0, -20.0]], false)];
    let way = route(wall(), [0.0, 0.0], [24.0, 0.0]).unwrap();
    // Around two corners at y = -20, a clearance of 2 m off.
    assert_eq!(way.len(), 3, "{way:?}");
    assert!(way.iter().take(2).all(|[_, y]| (*y + 22.0).abs() < 1e-9), "{way:?}");
    assert_eq!(route(wall(), [0.0, 0.0], [5.0, 5.0]), Some(vec![[5.0, 5.0]]));
}

#[test]
fn there_is_no_way_through_a_closed_border() {
    let square = |r: f64| [[-r, -r], [-r, r], [r, r], [r, -r]];
    assert_eq!(route(vec![polygon(&square(10.0), true)], [0.0, 0.0], [20.0, 0.0]), None);
    // A ring of circles without a gap.
    let ring = (0..40).map(|index| {
        let angle = f64::from(index) * std::f64::consts::TAU / 40.0;
        circle([50.0 * angle.cos(), 50.0 * angle.sin()], 4.5, false)
    });
    assert_eq!(route(ring.collect(), [0.0, 0.0], [80.0, 0.0]), None);
}

/// The way around a bend of the area to stay in, through two areas that overlap, and from outside into them.
#[test]
fn it_stays_in_the_areas_to_stay_in() {
    let bend = [[0.0, 0.0], [60.0, 0.0], [60.0, 60.0], [40.0, 60.0], [40.0, 20.0], [0.0, 20.0]];
    let two = [circle([0.0, 0.0], 30.0, true), circle([50.0, 0.0], 30.0, true)];
    for (zones, start, goal, least_m) in [
        (vec![polygon(&bend, true)], [5.0, 15.0], [55.0, 55.0], 70.0),
        (two.to_vec(), [-10.0, 25.0], [50.0, 28.0], 60.0),
    ] {
        let zones = Zones { zones, return_m: None };
        let way = searched(&fence(&zones), start, goal).0.unwrap();
        assert_eq!(breach(&fence(&zones), start, &way), None, "{way:?}");
        let length_m = length_m(start, &way);
        assert!(way.len() > 1 && length_m >= least_m && length_m < 1.15 * least_m, "{length_m} {way:?}");
    }
    assert_eq!(route(two.to_vec(), [-40.0, 0.0], [70.0, 0.0]), Some(vec![[70.0, 0.0]]), "from outside");
}

/// The greatest distance from home bounds a detour, too.
#[test]
fn a_detour_stays_within_the_greatest_distance() {
    let zones = Zones {
        zones: vec![polygon(&[[10.0, -20.0], [10.0, 90.0], [14.0, 90.0], [14.0, -20.0]], false)],
        return_m: None,
    };
    let within = |radius_m: f64| Fence { radius_m, ..fence(&zones) };
    assert!(searched(&within(40.0), [0.0, 0.0], [24.0, 0.0]).0.is_some());
    assert_eq!(searched(&within(24.5), [0.0, 0.0], [24.0, 0.0]).0, None);
}

/// Where all inclusion areas are: the way keeps to the overlap, around an obstacle in it, and there is none where they do not meet.
#[test]
fn a_way_keeps_to_where_all_areas_are() {
    let square = |half_m: f64, [x, y]: Place| {
        polygon(
            &[
                [x - half_m, y - half_m],
                [x - half_m, y + half_m],
                [x + half_m, y + half_m],
                [x + half_m, y - half_m],
            ],
            true,
        )
    };
    let zones = Zones {
        zones: vec![square(40.0, [0.0, 0.0]), square(40.0, [0.0, 50.0]), circle([0.0, 25.0], 5.0, false)],
        return_m: None,
    };
    let any = fence(&zones);
    let all = Fence { inclusions: Inclusions::All, ..any };
    let (start, goal) = ([-20.0, 25.0], [20.0, 25.0]);
    let way = searched(&all, start, goal).0.expect("there is one");
    assert!(way.len() > 1 && breach(&all, start, &way).is_none(), "{way:?}");
    let (start, goal) = ([0.0, -20.0], [0.0, 70.0]);
    assert!(searched(&any, start, goal).0.is_some());
    assert_eq!(searched(&all, start, goal).0, None, "the goal is in one of them only");
}

/// As many areas as a fence can have: far away, with gaps, with narrow ones, with none so that the way leads around all of them, and
/// one comb. A slice takes about a millisecond; the bounds are twice what was measured.
#[test]
fn the_largest_fences_are_searched_in_slices() {
    let grid = |spacing: f64, radius: f64| -> Vec<Zone> {
        let place = |index: usize| ((index % 22) as f64 - 10.5, (index / 22) as f64 - 10.5);
        let circles = (0..484).map(place).map(|(x, y)| circle([spacing * x, spacing * y], radius, false));
        circles.collect()
    };
    let comb: Vec<Place> = (0..249)
        .flat_map(|tooth: u32| {
            let x = f64::from(tooth) - 125.0;
            if tooth.is_multiple_of(2) { [[x, -60.0], [x, 55.0]] } else { [[x, 55.0], [x, -60.0]] }
        })
        .chain([[125.0, 60.0], [-126.0, 60.0]])
        .collect();
    let far: Vec<Zone> = (0..500).map(|index| circle([5000.0 + f64::from(index), 0.0], 3.0, false)).collect();
    for (name, zones, most_slices) in [
        ("far", [far, vec![circle([0.0, 0.0], 10.0, false)]].concat(), 1),
        ("grid", grid(12.0, 3.0), 210),
        ("narrow", grid(12.0, 5.2), 2000),
        ("closed", grid(12.0, 6.1), 2000),
        ("comb", vec![polygon(&comb, false)], 25),
    ] {
        let zones = Zones { zones, return_m: None };
        let (start, goal) = ([-140.0, -131.0], [140.0, 134.0]);
        let (way, slices) = searched(&fence(&zones), start, goal);
        assert!(slices <= most_slices, "{name}: {slices} slices");
        assert_eq!(breach(&fence(&zones), start, &way.expect(name)), None, "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Never through an area, hardly longer than the way on the grid, and found wherever the grid has one.
    #[test]
    fn a_way_is_free_and_short(zones in prop::collection::vec(exclusion(), 0..60), inclusion in any::<bool>()) {
        let (start, goal) = ([-97.0, -3.0], [97.0, 8.0]);
        let outer = [[-100.0, -95.0], [-100.0, 95.0], [100.0, 95.0], [100.0, -95.0]];
        let border = inclusion.then(|| polygon(&outer, true));
        let zones: Vec<Zone> = zones.into_iter().chain(border).collect();
        prop_assume!(zones.iter().all(|zone| {
            [start, goal].iter().all(|end| !zone.forbids(*end) && zone.shape.distance_m(*end) > 2.5)
        }));
        let grid_m = on_a_grid_m(&zones, start, goal, 2.5);
        let near_m = on_a_grid_m(&zones, start, goal, 0.0);
        let zones = Zones { zones, return_m: None };
        let (way, slices) = searched(&fence(&zones), start, goal);
        prop_assert!(slices < 500, "{slices} slices");
        let Some(way) = way else {
            prop_assert!(grid_m.is_none(), "a way of {grid_m:?} m is not found");
            return Ok(());
        };
        prop_assert_eq!(breach(&fence(&zones), start, &way), None);
        let length_m = length_m(start, &way);
        if let Some(grid_m) = grid_m {
            prop_assert!(length_m <= 1.02 * grid_m + 1.0, "{length_m} m, {grid_m} m on the grid: {way:?}");
        }
        // A way over eight directions is at most by 8.24 % longer than the shortest.
        if let Some(near_m) = near_m {
            prop_assert!(length_m >= near_m / 1.0824 - 4.0, "{length_m} m, {near_m} m on the grid: {way:?}");
        }
    }

    /// Around a circle: at least two tangents and an arc, and little more.
    #[test]
    fn the_way_around_a_circle_is_short(radius in 3.0..30.0, far in 2.0..60.0, off in -0.9..0.9_f64) {
        let reach: f64 = radius + 3.0 + far;
        let (start, goal) = ([-reach, off * radius], [reach, off * radius]);
        let way = route(vec![circle([0.0, 0.0], radius, false)], start, goal).unwrap();
        let d = distance(start, [0.0; 2]);
        let arc = std::f64::consts::PI - 2.0 * (radius / d).acos() - 2.0 * (off.abs() * radius / d).asin();
        let least = 2.0 * (d * d - radius * radius).sqrt() + radius * arc.max(0.0);
        let length = length_m(start, &way);
        prop_assert!(length >= least - 1e-6 && length <= least + 8.0 + 0.06 * radius, "{length} {least}");
    }

    /// How the work is sliced changes nothing.
    #[test]
    fn slices_do_not_change_the_way(zones in prop::collection::vec(exclusion(), 0..40), slice in 1_u64..5000) {
        let zones = Zones { zones, return_m: None };
        let (start, goal) = ([-97.0, -3.0], [97.0, 8.0]);
        let mut search = RouteSearch::new(&fence(&zones), start, goal);
        let sliced = loop {
            match search.advance(slice) {
                Progress::Searching => {}
                Progress::Found(way) => break Some(way),
                Progress::None => break None,
            }
        };
        prop_assert_eq!(sliced, searched(&fence(&zones), start, goal).0);
    }
}
