//! The fence, and sticks that do not lead over it.

use super::flier::*;
use crate::common::plan_client::{result, upload};
use crate::common::settings;
use mavlink::dialects::ardupilotmega::{COMMAND_INT_DATA, MavCmd, MavFrame, MavMessage};
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, command, frame};

/// Suite: HorizontalAvoidFence, with twice its deflection: a stick near its centre is slower here, and the margin is approached from
/// inside.
#[test]
fn sticks_do_not_lead_over_the_circle() {
    for behaviour in [1.0, 0.0] {
        let mut flier = Flier::new();
        flier.change_mode(LOITER);
        flier.set_all(&[
            ("FENCE_ENABLE", 1.0),
            ("FENCE_TYPE", 2.0),
            ("FENCE_RADIUS", 15.0),
            ("FENCE_MARGIN", 3.0),
            ("AVOID_ENABLE", 1.0),
            ("AVOID_BEHAVE", behaviour),
            ("RC10_OPTION", 40.0),
        ]);
        flier.rc(10, 2000);
        flier.arm();
        flier.rc(3, 1700);
        flier.wait("10 m", 30.0, |flier| flier.height_m() > 10.0);
        flier.rc(3, 1500);
        flier.rc(2, 1300);
        flier.wait("the margin", 60.0, |flier| flier.distance_m() > 11.5);
        for _ in 0..70 {
            flier.fly(1.0);
            assert_eq!(flier.mode(), LOITER, "{:?}", flier.bench.texts());
            assert!((11.0..13.0).contains(&flier.distance_m()), "{}", flier.distance_m());
        }
        flier.rc(2, 1500);
        flier.return_home();
    }
}

/// Suite: HorizontalFence.
#[test]
fn the_fence_is_armed_inside_of_and_returned_from() {
    let mut start = settings(Identity::ArduPilot);
    let corner = |latitude_deg: f64, longitude_deg: f64| MissionItem {
        frame: frame::GLOBAL_RELATIVE,
        command: command::NAV_FENCE_POLYGON_VERTEX_INCLUSION,
        parameters: [4.0, 0.0, 0.0, 0.0],
        position: [latitude_deg, longitude_deg, 0.0],
        autocontinue: true,
    };
    let nowhere = [corner(1.0, 1.0), corner(1.0, 1.01), corner(1.01, 1.01), corner(1.01, 1.0)];
    start.plans.set(PlanKind::Fence, Plan::new(nowhere.to_vec()));
    let mut flier = Flier::with(&start);
    flier.set_all(&[("FENCE_ENABLE", 1.0), ("AVOID_ENABLE", 0.0)]);
    flier.change_mode(LOITER);
    flier.fly(1.0);
    assert!(flier.obstacles().contains(&"PreArm: Vehicle breaching Polygon fence".to_owned()));
    let mut flier = Flier::new();
    flier.set_all(&[("FENCE_ENABLE", 1.0), ("AVOID_ENABLE", 0.0)]);
    flier.change_mode(LOITER);
    for (name, words) in [
        ("FENCE_RADIUS", "Invalid Circle FENCE_RADIUS value"),
        ("FENCE_ALT_MAX", "Invalid FENCE_ALT_MAX value"),
    ] {
        flier.set(name, -1.0);
        assert_eq!(flier.obstacles(), [format!("PreArm: {words}")]);
        flier.set(name, 100.0);
    }
    flier.set_all(&[("FENCE_TYPE", 2.0), ("FENCE_RADIUS", 40.0)]);
    flier.take_off(10.0, LOITER);
    flier.rc(2, 1100);
    flier.wait_mode(RTL, 60.0);
    flier.rc(2, 1475);
    flier.wait_home();
}

/// Suite: MaxAltFence, MinAltFence.
#[test]
fn ceiling_and_floor_return() {
    let mut flier = Flier::new();
    flier.take_off(10.0, LOITER);
    flier.set_all(&[
        ("FENCE_ENABLE", 1.0),
        ("AVOID_ENABLE", 0.0),
        ("FENCE_TYPE", 1.0),
        ("FENCE_ALT_MAX", 30.0),
    ]);
    flier.rc(3, 1800);
    flier.wait_mode(RTL, 120.0);
    flier.wait_home();
    let mut flier = Flier::new();
    flier.take_off(30.0, LOITER);
    flier.set_all(&[
        ("AVOID_ENABLE", 0.0),
        ("FENCE_ENABLE", 1.0),
        ("FENCE_TYPE", 8.0),
        ("FENCE_ALT_MIN", 20.0),
    ]);
    flier.rc(3, 1200);
    flier.wait_mode(RTL, 120.0);
    flier.wait_home();
}

/// Suite: MaxAltFenceAvoid, MinAltFenceAvoid, AvoidanceAltFence.
#[test]
fn sticks_do_not_lead_over_ceiling_or_floor_and_back_away_gently() {
    let mut flier = Flier::new();
    flier.take_off(30.0, LOITER);
    flier.set_all(&[
        ("FENCE_ENABLE", 1.0),
        ("FENCE_TYPE", 9.0),
        ("FENCE_ALT_MIN", 20.0),
        ("FENCE_ALT_MAX", 60.0),
        ("FENCE_ACTION", 0.0),
    ]);
    let backs_at = 0.75;
    for (pulse, name, bound, reached) in
        [(1920, "FENCE_ALT_MAX", 50.0, 49.0), (1120, "FENCE_ALT_MIN", 30.0, 31.0)]
    {
        flier.rc(3, pulse);
        flier.fly(40.0);
        let before = flier.height_m();
        assert!((20.0..60.0).contains(&before), "{before}");
        flier.set(name, bound);
        for _ in 0..600 {
            flier.fly(0.1);
            let climb = flier.climb_m_s();
            assert!(climb.abs() < backs_at * 1.1, "{climb}");
        }
        let after = flier.height_m();
        assert!((after - reached).abs() < 2.0, "{after}");
    }
    flier.rc(3, 1500);
    flier.return_home();
}

/// Suite: FenceFloorEnabledLanding.
#[test]
fn one_may_land_below_the_floor() {
    let mut flier = Flier::new();
    flier.set_all(&[
        ("AVOID_ENABLE", 0.0),
        ("FENCE_ENABLE", 1.0),
        ("FENCE_TYPE", 15.0),
        ("FENCE_ALT_MIN", 20.0),
        ("FENCE_ALT_MAX", 30.0),
    ]);
    flier.take_off(25.0, GUIDED);
    flier.wait("25 m", 30.0, |flier| flier.height_m() > 24.5);
    flier.change_mode(LOITER);
    flier.rc(3, 1800);
    flier.wait_mode(RTL, 120.0);
    flier.rc(3, 1500);
    flier.wait("below the floor", 60.0, |flier| flier.height_m() < 15.0);
    flier.change_mode(LOITER);
    flier.fly(15.0);
    flier.rc(3, 1300);
    flier.wait("the ground", 60.0, |flier| flier.height_m() < 0.5);
    flier.rc(3, 1000);
    flier.wait_disarmed(60.0);
    assert_eq!(flier.mode(), LOITER);
    assert!(flier.vehicle().fence().is_some() && flier.vehicle().fence_record().now.is_none());
    let parameters = [0.0; 7];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_FENCE_ENABLE, parameters), ACCEPTED);
    assert!(flier.vehicle().fence().is_none());
}

/// Suite: FenceFloorAutoDisableLanding, FenceFloorAutoEnableOnArming.
#[test]
fn a_fence_that_switches_itself_on_is_off_after_the_landing() {
    for start in [1.0, 3.0] {
        let mut flier = Flier::new();
        flier.set_all(&[
            ("AVOID_ENABLE", 0.0),
            ("FENCE_TYPE", 11.0),
            ("FENCE_ALT_MIN", 10.0),
            ("FENCE_ALT_MAX", 20.0),
            ("FENCE_AUTOENABLE", start),
        ]);
        assert!(flier.vehicle().fence().is_none());
        flier.take_off(15.0, GUIDED);
        flier.wait("15 m", 30.0, |flier| flier.height_m() > 14.8);
        flier.fly(1.0);
        assert!(flier.vehicle().fence().is_some());
        flier.change_mode(LOITER);
        flier.rc(3, 1800);
        flier.wait_mode(RTL, 120.0);
        assert!(flier.vehicle().fence_record().now.is_some());
        flier.wait_disarmed(120.0);
        flier.fly(0.1);
        assert!(flier.vehicle().fence().is_none(), "{start}");
    }
}

/// Suite: MaxAltFence, FenceAltFrameComparison: what the limits are above.
#[test]
fn heights_of_the_fence_are_above_what_is_said() {
    const SEA_LEVEL: f64 = 0.0;
    let mut flier = Flier::new();
    let home_m = flier.vehicle().frame().origin().altitude_m;
    flier.set_all(&[("FENCE_ENABLE", 1.0), ("AVOID_ENABLE", 0.0), ("FENCE_TYPE", 9.0)]);
    flier.set_all(&[
        ("FENCE_ALT_MAX", 100.0),
        ("FENCE_ALT_MIN_TP", SEA_LEVEL),
        ("FENCE_ALT_MIN", home_m + 20.0),
    ]);
    assert_eq!(flier.obstacles(), [] as [&str; 0], "20 m above home is below 100 m");
    flier.set("FENCE_ALT_MIN", home_m + 150.0);
    assert!(flier.obstacles().iter().any(|text| text.contains("FENCE_ALT_MAX < FENCE_ALT_MIN")));
    // Home lies 15 m above the origin from here on.
    flier.set_all(&[("FENCE_TYPE", 1.0), ("FENCE_ALT_MIN_TP", 1.0), ("FENCE_ALT_MIN", -10.0)]);
    let origin = flier.vehicle().frame().origin();
    let raised =
        [0.0, 0.0, 0.0, 0.0, origin.latitude_deg as f32, origin.longitude_deg as f32, (home_m + 15.0) as f32];
    for (datum, limit_m, above_origin_m) in
        [(SEA_LEVEL, home_m + 40.0, 40.0), (1.0, 30.0, 45.0), (2.0, 40.0, 40.0), (3.0, 35.0, 35.0)]
    {
        flier.set_all(&[("FENCE_ALT_MAX_TP", datum), ("FENCE_ALT_MAX", limit_m)]);
        flier.take_off(10.0, LOITER);
        assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_HOME, raised), ACCEPTED);
        flier.rc(3, 1800);
        flier.wait_mode(RTL, 120.0);
        let height_m = -flier.vehicle().truth().position_m.z;
        assert!((height_m - above_origin_m).abs() < 3.0, "{datum}: {height_m} m");
        flier.rc(3, 1000);
        flier.wait_disarmed(300.0);
    }
}

/// Circles around home of some radii, m.
fn home_circles(flier: &mut Flier, radii_m: &[f64]) {
    let circle = |radius_m: &f64| MissionItem {
        frame: frame::GLOBAL,
        command: 5005,
        parameters: [*radius_m, 0.0, 0.0, 0.0],
        position: [0.0; 3],
        autocontinue: false,
    };
    let items: Vec<_> = radii_m.iter().map(circle).collect();
    let heard = upload(&mut flier.bench, PlanKind::Fence, &items);
    assert_eq!(result(&heard), Some(ACCEPTED), "{:?}", flier.bench.texts());
    assert_eq!(flier.vehicle().plans().get(PlanKind::Fence).items().len(), radii_m.len());
}

/// Moves home north and east, m, from where it is.
fn move_home(flier: &mut Flier, [north_m, east_m]: [f64; 2]) {
    let home_m = flier.vehicle().home().position_m;
    let place = flier.vehicle().frame().to_geodetic(&(home_m + Vector3::new(north_m, east_m, 0.0)));
    let set_home = COMMAND_INT_DATA {
        param1: 0.0,
        param2: 0.0,
        param3: 0.0,
        param4: 0.0,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: place.altitude_m as f32,
        command: MavCmd::MAV_CMD_DO_SET_HOME,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        current: 0,
        autocontinue: 0,
    };
    flier.bench.heard.clear();
    flier.bench.send(MavMessage::COMMAND_INT(set_home));
    assert_eq!(flier.bench.acks().last().map(|ack| ack.result), Some(ACCEPTED));
}

const POLYGONS: [(&str, f64); 3] = [("FENCE_ENABLE", 1.0), ("FENCE_ACTION", 1.0), ("FENCE_TYPE", 4.0)];

/// Suite: HomeCircleInclusionFence: a mission is taken that leads over the fence, and flown up to it.
#[test]
fn a_mission_is_flown_up_to_a_circle_around_home() {
    const WAYPOINT: u16 = 16;
    let rows = [(22, 0.0, 0.0, 20.0), (WAYPOINT, -25.0, -25.0, 25.0), (WAYPOINT, -100.0, -100.0, 25.0)];
    let mut flier = Flier::new();
    home_circles(&mut flier, &[50.0]);
    flier.set_all(&POLYGONS);
    flier.set("AUTO_OPTIONS", 3.0);
    flier.reboot();
    let items = mission(&settings(Identity::ArduPilot), &rows).items().to_vec();
    let heard = upload(&mut flier.bench, PlanKind::Mission, &items);
    assert_eq!(result(&heard), Some(ACCEPTED), "{:?}", flier.bench.texts());
    flier.change_mode(AUTO);
    flier.arm();
    flier.bench.heard.clear();
    flier.wait_text("Polygon fence breached", 90.0);
    assert!((48.0..60.0).contains(&flier.distance_m()), "{}", flier.distance_m());
    flier.wait_mode(RTL, 1.0);
    flier.rc(3, 1500);
    flier.wait_home();
}

/// Suite: HomeCircleInclusionFence_SetHome, HomeCircleInclusionFence_MultipleHomeCircle.
#[test]
fn a_circle_around_home_moves_with_it_and_the_innermost_counts() {
    let mut flier = Flier::new();
    flier.set_all(&POLYGONS);
    home_circles(&mut flier, &[50.0]);
    flier.take_off(5.0, LOITER);
    flier.fly(2.0);
    assert_eq!(flier.mode(), LOITER);
    move_home(&mut flier, [60.0, 0.0]);
    flier.wait_text("Polygon fence breached", 3.0);
    flier.wait_mode(RTL, 1.0);
    flier.rc(3, 1500);
    flier.wait_home();
    let mut flier = Flier::new();
    flier.set_all(&POLYGONS);
    // Its pilot flies in Stabilize, where nothing keeps the sticks inside.
    flier.set("AVOID_ENABLE", 0.0);
    home_circles(&mut flier, &[50.0, 100.0]);
    flier.take_off(5.0, LOITER);
    flier.rc(2, 1200);
    flier.bench.heard.clear();
    flier.wait_text("Polygon fence breached", 60.0);
    assert!((40.0..60.0).contains(&flier.distance_m()), "{}", flier.distance_m());
    flier.rc(2, 1500);
    flier.wait_home();
}

/// Suite: HomeCircleInclusionFence_Avoidance_SetHome.
#[test]
fn sticks_do_not_lead_over_a_circle_around_home() {
    let mut flier = Flier::new();
    home_circles(&mut flier, &[20.0]);
    flier.set_all(&POLYGONS);
    flier.set_all(&[
        ("FENCE_ACTION", 0.0),
        ("FENCE_MARGIN", 2.0),
        ("AVOID_ENABLE", 1.0),
        ("AVOID_BEHAVE", 0.0),
    ]);
    flier.take_off(10.0, LOITER);
    flier.rc(2, 1300);
    for step_m in [0.0, 10.0] {
        move_home(&mut flier, [step_m, 0.0]);
        flier.fly(20.0);
        for _ in 0..20 {
            flier.fly(1.0);
            assert!((17.0..21.0).contains(&flier.distance_m()), "{}", flier.distance_m());
        }
        assert!(flier.speed_m_s() < 0.5);
    }
}

/// PX4 has a parameter in its place.
#[test]
fn a_circle_around_home_is_ardupilots() {
    let mut bench = crate::common::Bench::new(Identity::Px4);
    let circle = MissionItem {
        frame: frame::GLOBAL,
        command: 5005,
        parameters: [50.0, 0.0, 0.0, 0.0],
        position: [0.0; 3],
        autocontinue: false,
    };
    let heard = upload(&mut bench, PlanKind::Fence, &[circle]);
    assert_eq!(result(&heard), Some(3), "MAV_MISSION_UNSUPPORTED");
    bench.heard = heard;
    assert!(bench.texts().iter().any(|text| text.contains("GF_MAX_HOR_DIST")), "{:?}", bench.texts());
}

/// Suite: FenceMargin. Borders that come near are told, then the fence acts, and on the way back the margin is left.
#[test]
fn borders_that_come_near_are_told() {
    let mut start = settings(Identity::ArduPilot);
    let corners = [(-110.0, -110.0), (110.0, -110.0), (110.0, 110.0), (-110.0, 110.0)];
    let rows = corners.map(|(north_m, east_m)| (5001, north_m, east_m, 0.0));
    let mut items = mission(&start, &rows).items()[1..].to_vec();
    items.iter_mut().for_each(|item| item.parameters[0] = 4.0);
    start.plans.set(PlanKind::Fence, Plan::new(items));
    let mut flier = Flier::with(&start);
    flier.set_all(&[
        ("FENCE_ENABLE", 1.0),
        ("FENCE_TYPE", 6.0),
        ("FENCE_MARGIN", 45.0),
        ("FENCE_RADIUS", 150.0),
        ("AVOID_ENABLE", 0.0),
        ("FENCE_OPTIONS", 4.0),
    ]);
    flier.take_off(10.0, LOITER);
    flier.rc(4, 1580);
    flier.wait_heading(160.0);
    flier.rc(4, 1500);
    flier.rc(2, 1100);
    flier.wait_text("Polygon fence in 4", 30.0);
    flier.wait_text("Circle and Polygon fences in ", 30.0);
    flier.wait_mode(RTL, 30.0);
    flier.wait_text("Circle fence cleared margin breach", 60.0);
}
