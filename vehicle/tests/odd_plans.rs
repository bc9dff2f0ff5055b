//! Plans that no ground station would make: refused with the reason, or taken with places that can be flown to.

use std::time::Instant;

use nalgebra::Vector3;
use proptest::prelude::*;
use vehicle::identity::Identity;
use vehicle::plan::{FaultCode, MissionItem, PlanKind, Site, check, command, compile, frame, zones};
use vehicle::world::{FARTHEST_M, Geodetic, LocalFrame};

fn site() -> Site {
    let origin = Geodetic { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };
    Site {
        identity: Identity::Px4,
        frame: LocalFrame::new(origin),
        home_m: Vector3::new(1.0, 2.0, -3.0),
        terrain: vehicle::surroundings::Terrain::default(),
    }
}

fn item(command: u16, parameter: f64, position: [f64; 3]) -> MissionItem {
    MissionItem {
        frame: frame::LOCAL_NED,
        command,
        parameters: [parameter, 0.0, 0.0, 0.0],
        position,
        autocontinue: true,
    }
}

fn polygon(corners: &[[f64; 2]]) -> Vec<MissionItem> {
    let corner = |[x, y]: &[f64; 2]| {
        item(command::NAV_FENCE_POLYGON_VERTEX_EXCLUSION, corners.len() as f64, [*x, *y, 0.0])
    };
    corners.iter().map(corner).collect()
}

#[test]
fn what_is_beyond_all_measure_is_refused_with_its_value_and_range() {
    use command::{NAV_FENCE_CIRCLE_EXCLUSION, NAV_FENCE_RETURN_POINT, NAV_RALLY_POINT, NAV_WAYPOINT};
    const FAR: f64 = 1e9;
    let circle = |radius, place| vec![item(NAV_FENCE_CIRCLE_EXCLUSION, radius, place)];
    let far = "the place is 1000000 km away, which is nowhere on the earth; allowed up to 30000 km";
    let line = [[0.0, 0.0], [50.0, 50.0], [100.0, 100.005]];
    for (kind, items, code, reason) in [
        (PlanKind::Mission, vec![item(NAV_WAYPOINT, 0.0, [FAR, 0.0, -10.0])], 5, far),
        (
            PlanKind::Mission,
            vec![item(NAV_WAYPOINT, 0.0, [0.0, 0.0, -FAR])],
            7,
            "down = -1000000000 m; allowed -100000 to 100000 m",
        ),
        (
            PlanKind::Mission,
            vec![item(NAV_WAYPOINT, 0.0, [0.0, f64::INFINITY, -10.0])],
            6,
            "east = inf m; allowed -100000 to 100000 m",
        ),
        (
            PlanKind::Mission,
            vec![item(NAV_WAYPOINT, FAR, [0.0; 3])],
            1,
            "hold time = 1000000000; allowed 0 to 86400",
        ),
        (PlanKind::Fence, circle(5.0, [0.0, -FAR, 0.0]), 6, far),
        (PlanKind::Fence, circle(FAR, [0.0; 3]), 1, "radius = 1000000000 m; allowed 0.1 to 100000 m"),
        (PlanKind::Fence, circle(1e-3, [0.0; 3]), 1, "radius = 0.001 m; allowed 0.1 to 100000 m"),
        (PlanKind::Fence, vec![item(NAV_FENCE_RETURN_POINT, 0.0, [FAR, 0.0, 0.0])], 5, far),
        (PlanKind::Fence, polygon(&[[0.0, 0.0], [0.0, FAR], [50.0, 0.0]]), 6, far),
        (
            PlanKind::Fence,
            polygon(&line),
            0,
            "invalid polygon: all corners lie on one line; it must be at least 0.1 m wide",
        ),
        (PlanKind::Rally, vec![item(NAV_RALLY_POINT, 0.0, [0.0, FAR, 0.0])], 6, far),
    ] {
        let fault = check::plan(kind, &items, &site()).expect_err(reason);
        assert_eq!((fault.item.is_some(), fault.reason.as_str()), (true, reason));
        let expected = if code == 0 { FaultCode::Invalid } else { FaultCode::InvalidParameter(code) };
        assert_eq!(fault.code, expected, "{reason}");
    }
    // A global altitude is named as such.
    let high = MissionItem { frame: frame::GLOBAL_RELATIVE_INT, ..item(NAV_WAYPOINT, 0.0, [47.0, 8.0, FAR]) };
    let fault = check::plan(PlanKind::Mission, &[high], &site()).unwrap_err();
    assert_eq!(fault.reason, "altitude = 1000000000 m; allowed -100000 to 100000 m");
}

/// The most corners of a fence in one polygon: checked in a moment.
#[test]
fn the_largest_polygon_is_taken() {
    let corners: Vec<[f64; 2]> = (0..PlanKind::Fence.capacity())
        .map(|index| {
            let angle = index as f64 / PlanKind::Fence.capacity() as f64 * std::f64::consts::TAU;
            let radius = if index % 2 == 0 { 100.0 } else { 60.0 };
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    check::plan(PlanKind::Fence, &polygon(&corners), &site()).unwrap();
}

/// No place of the earth is farther from another one in a local frame, m.
const AROUND_M: f64 = 30_000_000.0;

/// Numbers of all sizes, and what is none.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -5.0..5.0_f64,
        2 => -400.0..400.0,
        2 => (-5_i32..10).prop_map(f64::from),
        3 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e9, -1e9, f64::from(f32::MAX), f64::MAX, f64::MIN_POSITIVE,
            5e-324, -0.0, 0.0, 90.0, 180.0, 65_535.0, 4_294_967_296.0,
        ]),
        1 => any::<f64>(),
    ]
}

prop_compose! {
    fn any_item()(
        command in prop_oneof![
            6 => prop::sample::select(vec![16_u16, 17, 18, 19, 20, 21, 22, 93, 112, 114, 115, 177, 178, 179, 195, 196, 197, 201]),
            4 => 5000_u16..5005,
            1 => Just(command::NAV_RALLY_POINT),
            1 => any::<u16>(),
        ],
        frame in prop_oneof![3 => Just(frame::LOCAL_NED), 2 => 0_u8..12, 1 => any::<u8>()],
        parameters in [number(), number(), number(), number()],
        position in prop_oneof![2 => [-50.0..50.0, -50.0..50.0, -50.0..0.0], 3 => [number(), number(), number()]],
        autocontinue in any::<bool>(),
    ) -> MissionItem {
        MissionItem { frame, command, parameters, position, autocontinue }
    }
}

/// A few items many times over: as many as a plan can have, and more.
fn items() -> impl Strategy<Value = Vec<MissionItem>> {
    (prop::collection::vec(any_item(), 1..8), prop_oneof![9 => 1_usize..4, 1 => 1_usize..400])
        .prop_map(|(items, times)| items.repeat(times))
}

proptest! {
    /// Whatever comes is refused or has bounded places, in less than a second (it takes milliseconds).
    #[test]
    fn random_plans_are_refused_or_bounded(items in items(), ardupilot in any::<bool>()) {
        let identity = if ardupilot { Identity::ArduPilot } else { Identity::Px4 };
        let site = Site { identity, ..site() };
        let begun = Instant::now();
        for kind in PlanKind::ALL {
            // Those that are taken by themselves, too, so that more than the first is looked at.
            let taken: Vec<MissionItem> =
                items.iter().filter(|item| check::item(kind, 1, item, &site).is_ok()).copied().collect();
            for items in [&items, &taken] {
                if let Err(fault) = check::plan(kind, items, &site) {
                    prop_assert!(!fault.reason.is_empty());
                    continue;
                }
                match kind {
                    PlanKind::Mission => {
                        let told = format!("{:?}", compile::mission(items, &site));
                        prop_assert!(!told.contains("NaN") && !told.contains("inf"), "{told}");
                    }
                    PlanKind::Fence => {
                        let zones = zones(items, &site).unwrap();
                        for zone in &zones.zones {
                            prop_assert!(zone.shape.distance_m([0.0; 2]) <= 2.0 * AROUND_M, "{zone:?}");
                        }
                    }
                    PlanKind::Rally => {
                        for place in compile::rally_points(items, &site) {
                            let [x, y] = place.horizontal_m.unwrap_or_default();
                            prop_assert!(x.hypot(y) <= AROUND_M, "{place:?}");
                            let down_m = place.down_m(0.0).unwrap_or_default();
                            prop_assert!(down_m.abs() <= FARTHEST_M + 1000.0, "{place:?}");
                        }
                    }
                }
            }
        }
        prop_assert!(begun.elapsed().as_secs_f64() < 1.0, "{:?} for {} items", begun.elapsed(), items.len());
    }
}
