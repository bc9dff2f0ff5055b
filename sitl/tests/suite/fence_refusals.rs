//! What the fence refuses ahead of a flight.

use crate::common::fence_bench::{DENIED, FAILED, go_to, hovering, item, polygon, set_cast, square};
use crate::common::plan_client::{result, upload};
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, command};
use vehicle::{Mode, VehicleSettings};

#[test]
fn what_leads_outside_is_refused_with_the_reason() {
    let start = settings(Identity::Px4);
    let wall = polygon(&start, false, &[[5.0, -5.0], [8.0, -5.0], [8.0, 5.0], [5.0, 5.0]]);
    let fence = [square(&start, 30.0), wall].concat();
    let mut bench = hovering(&start, fence, Vec::new());
    for (north, why) in
        [(31.0, "Reposition rejected: outside the fence"), (6.0, "Reposition rejected: in an exclusion zone")]
    {
        assert_eq!(go_to(&mut bench, north, 0.0), DENIED);
        assert!(bench.texts().iter().any(|text| text == why), "{north}: {:?}", bench.texts());
    }
    // Set-points that lead outside count as none.
    let mut target = SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_truncate(0b1101_1111_1000),
        x: -5.0,
        z: -10.0,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    };
    bench.send(MavMessage::SET_POSITION_TARGET_LOCAL_NED(target.clone()));
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    target.x = -40.0;
    bench.heard.clear();
    bench.stream(8.0, |bench| bench.send(MavMessage::SET_POSITION_TARGET_LOCAL_NED(target.clone())));
    let told = "Set-point rejected: outside the fence";
    assert!(bench.texts().iter().any(|text| text == told), "{:?}", bench.texts());
    let [x, y, _] = bench.position();
    assert!((-6.0..-2.0).contains(&x) && y.abs() < 0.1, "{x} {y}");
    assert_eq!(bench.mode(), Mode::Hold, "refused ones are none");
}

/// A fence that comes after the mission: it is told at once, and the mission is not begun.
#[test]
fn a_mission_that_a_later_fence_forbids_is_not_begun() {
    let mut start = settings(Identity::Px4);
    let waypoint = |north| MissionItem {
        position: {
            let [latitude, longitude, _] = item(&start, command::NAV_WAYPOINT, 0.0, [north, 0.0]).position;
            [latitude, longitude, 5.0]
        },
        ..item(&start, command::NAV_WAYPOINT, 0.0, [north, 0.0])
    };
    let takeoff = MissionItem { command: command::NAV_TAKEOFF, ..waypoint(0.0) };
    let mission = vec![takeoff, waypoint(10.0), waypoint(40.0)];
    start.plans.set(PlanKind::Mission, Plan::new(mission));
    let mut bench = Bench::of(&start);
    bench.heard = upload(&mut bench, PlanKind::Fence, &square(&start, 30.0));
    assert_eq!(result(&bench.heard), Some(0));
    let told = "Mission cannot be flown: item 3: outside the fence";
    assert!(bench.texts().iter().any(|text| text == told), "{:?}", bench.texts());
    let reason = "Mission rejected: item 3: outside the fence";
    assert_eq!(bench.command(MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), DENIED);
    assert!(bench.texts().iter().any(|text| text == reason), "{:?}", bench.texts());
    assert_eq!(bench.set_mode(Mode::Mission), DENIED);
    assert!(!bench.autopilot.vehicle().is_armed());
    // In flight neither.
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
    bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
    assert_eq!(bench.set_mode(Mode::Mission), DENIED);
    assert_eq!(bench.mode(), Mode::Hold);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_FENCE_ENABLE, [0.0; 7]), 0);
    assert_eq!(bench.set_mode(Mode::Mission), 0);
}

/// What is looked at or remembered is not flown to, and ArduPilot's first item is home, wherever it was planned.
#[test]
fn what_is_only_looked_at_may_lie_outside() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut start = settings(identity);
        start.conduct.failsafe.fence_enabled = true;
        start.plans.set(PlanKind::Fence, Plan::new(square(&start, 30.0)));
        let mut bench = Bench::of(&start);
        let far = |command: u16| item(&start, command, 0.0, [100.0, 0.0]);
        let mut mission = vec![
            item(&start, command::NAV_WAYPOINT, 0.0, [10.0, 0.0]),
            far(command::DO_SET_ROI_LOCATION),
            MissionItem { parameters: [3.0, 0.0, 0.0, 0.0], ..far(command::DO_SET_ROI) },
            MissionItem { position: [5.0, 5.0, 45.0], ..far(command::DO_SET_ROI_WPNEXT_OFFSET) },
            far(command::DO_SET_HOME),
            item(&start, command::NAV_WAYPOINT, 0.0, [20.0, 0.0]),
        ];
        if identity.is_ardupilot() {
            mission.insert(0, far(command::NAV_WAYPOINT));
        }
        let heard = upload(&mut bench, PlanKind::Mission, &mission);
        assert_eq!(result(&heard), Some(0), "{identity:?}: {heard:?}");
        mission.push(far(command::NAV_LOITER_UNLIM));
        let heard = upload(&mut bench, PlanKind::Mission, &mission);
        // ArduPilot flies up to the fence.
        let expected = if identity.is_ardupilot() { 0 } else { 14 };
        assert_eq!(result(&heard), Some(expected), "{identity:?}: {heard:?}");
    }
}

/// ArduPilot stays where all inclusion zones are unless FENCE_OPTIONS says that one is enough; PX4 in any of them.
#[test]
fn inclusion_zones_combine_as_the_autopilot_does_it() {
    let zones = |start: &VehicleSettings| {
        let beside = polygon(start, true, &[[-30.0, -10.0], [-30.0, 60.0], [30.0, 60.0], [30.0, -10.0]]);
        [square(start, 40.0), beside].concat()
    };
    let mut start = settings(Identity::ArduPilot);
    start.conduct.failsafe.fence_enabled = true;
    let mut bench = Bench::hovering_with(&start);
    assert_eq!(result(&upload(&mut bench, PlanKind::Fence, &zones(&start))), Some(0));
    assert_eq!(go_to(&mut bench, 0.0, 50.0), FAILED, "in one of them only");
    assert_eq!(go_to(&mut bench, 20.0, 20.0), 0, "{:?}", bench.texts());
    assert_eq!(set_cast(&mut bench, "FENCE_OPTIONS", 3.0), Some(3.0));
    assert_eq!(go_to(&mut bench, 0.0, 50.0), 0, "{:?}", bench.texts());
    assert_eq!(set_cast(&mut bench, "FENCE_OPTIONS", 0.0), Some(0.0));
    assert_eq!(go_to(&mut bench, 0.0, 50.0), FAILED);
    let start = settings(Identity::Px4);
    let mut bench = hovering(&start, zones(&start), Vec::new());
    assert_eq!(go_to(&mut bench, 0.0, 50.0), 0, "{:?}", bench.texts());
}

/// Many clients repeat the first vertex at the end of the ring.
#[test]
fn a_polygon_may_be_closed_by_its_first_vertex() {
    let mut start = settings(Identity::ArduPilot);
    start.conduct.failsafe.fence_enabled = true;
    let ring =
        polygon(&start, true, &[[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0], [-20.0, -20.0]]);
    let mut bench = Bench::hovering_with(&start);
    assert_eq!(result(&upload(&mut bench, PlanKind::Fence, &ring)), Some(0), "{:?}", bench.texts());
    assert_eq!(bench.autopilot.vehicle().plans().get(PlanKind::Fence).items().len(), 5, "as it came");
    assert_eq!((go_to(&mut bench, 25.0, 0.0), go_to(&mut bench, 15.0, 0.0)), (FAILED, 0));
}

/// A mission that comes in flight begins where the vehicle is: a wall between it and home is in the way of what is near home.
#[test]
fn a_mission_that_comes_in_flight_begins_where_the_vehicle_is() {
    let start = settings(Identity::Px4);
    let wall = polygon(&start, false, &[[5.0, -5.0], [8.0, -5.0], [8.0, 5.0], [5.0, 5.0]]);
    let mut bench = hovering(&start, wall, Vec::new());
    for [north, east] in [[0.0, 20.0], [20.0, 20.0], [20.0, 0.0]] {
        assert_eq!(go_to(&mut bench, north, east), 0, "{:?}", bench.texts());
        bench.fly_until("around the wall", 60.0, |bench| {
            let [x, y, _] = bench.position();
            (x - north).hypot(y - east) < 0.3
        });
    }
    let mission = |north: f64| {
        let waypoint = item(&start, command::NAV_WAYPOINT, 0.0, [north, 0.0]);
        let [latitude, longitude, _] = waypoint.position;
        [MissionItem { position: [latitude, longitude, 10.0], ..waypoint }]
    };
    bench.heard = upload(&mut bench, PlanKind::Mission, &mission(2.0));
    assert_ne!(result(&bench.heard), Some(0), "behind the wall");
    bench.heard = upload(&mut bench, PlanKind::Mission, &mission(12.0));
    assert_eq!(result(&bench.heard), Some(0), "{:?}", bench.texts());
    assert_eq!(bench.set_mode(Mode::Mission), 0, "{:?}", bench.texts());
    bench.fly_until("there", 60.0, |bench| (bench.position()[0] - 12.0).abs() < 0.5);
}
