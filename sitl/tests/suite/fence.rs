//! The fence and the safe points in flight.

use crate::common::fence_bench::{
    DENIED, TEMPORARILY_REJECTED, forward, go_to, hovering, item, polygon, set_cast, square, there,
};
use crate::common::plan_client::{result, upload};
use crate::common::requests::local_target;
use crate::common::{Bench, settings};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::fence::Breach;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, command};
use vehicle::{Action, Mode, VehicleSettings};

/// With full stick towards the border it comes to rest in front of it, and again when the pilot insists.
#[test]
fn it_stops_in_front_of_the_border() {
    let start = settings(Identity::Px4);
    let mut bench = hovering(&start, square(&start, 30.0), Vec::new());
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let (mut farthest, mut fastest): (f64, f64) = (0.0, 0.0);
    bench.stream(20.0, |bench| {
        forward(bench);
        farthest = farthest.max(bench.autopilot.vehicle().truth().position_m.x);
        fastest = fastest.max(bench.velocity()[0]);
    });
    assert!(fastest > 3.0, "{fastest} m/s");
    assert!((26.0..30.0).contains(&farthest), "{farthest} m");
    assert_eq!(bench.mode(), Mode::Hold);
    assert!(bench.texts().iter().any(|text| text == "Fence ahead: holding"), "{:?}", bench.texts());
    assert_eq!(bench.set_mode(Mode::Position), 0);
    bench.stream(5.0, |bench| {
        forward(bench);
        farthest = farthest.max(bench.autopilot.vehicle().truth().position_m.x);
    });
    assert!(farthest < 30.0, "{farthest} m");
    there(&mut bench, 0.0, 0.0);
}

#[test]
fn an_exclusion_and_the_height_are_kept() {
    let mut start = settings(Identity::Px4);
    start.conduct.failsafe.fence_height_m = 20.0;
    let circle = item(&start, command::NAV_FENCE_CIRCLE_EXCLUSION, 8.0, [25.0, 0.0]);
    let mut bench = hovering(&start, vec![circle], Vec::new());
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut farthest: f64 = 0.0;
    bench.stream(15.0, |bench| {
        forward(bench);
        farthest = farthest.max(bench.position()[0]);
    });
    assert!((13.0..17.0).contains(&farthest), "{farthest} m");
    bench.fly(2.0);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut highest: f64 = 0.0;
    bench.stream(15.0, |bench| {
        let up = MANUAL_CONTROL_DATA { target: 1, z: 1000, ..MANUAL_CONTROL_DATA::default() };
        bench.send(MavMessage::MANUAL_CONTROL(up));
        highest = highest.max(-bench.position()[2]);
    });
    assert!((18.0..20.0).contains(&highest), "{highest} m");
}

#[test]
fn a_return_goes_round_an_exclusion_to_the_nearest_allowed_point() {
    let mut start = settings(Identity::Px4);
    start.conduct.return_height_m = 12.0;
    // A wall between the vehicle and home, and a rally point inside it.
    let wall = polygon(&start, false, &[[10.0, -15.0], [20.0, -15.0], [20.0, 15.0], [10.0, 15.0]]);
    let inside = item(&start, command::NAV_RALLY_POINT, 0.0, [15.0, 0.0]);
    let mut bench = hovering(&start, wall.clone(), vec![inside]);
    there(&mut bench, 0.0, 25.0);
    there(&mut bench, 30.0, 25.0);
    there(&mut bench, 30.0, 5.0);
    assert_eq!(bench.set_mode(Mode::Return), 0);
    while bench.autopilot.vehicle().is_armed() {
        bench.fly(0.05);
        let [x, y, _] = bench.position();
        assert!(!((10.0..20.0).contains(&x) && (-15.0..15.0).contains(&y)), "inside the wall at {x}, {y}");
        assert!(bench.autopilot.vehicle().time_us() < 250_000_000, "not home: {:?}", bench.position());
    }
    let [x, y, _] = bench.position();
    assert!(x.hypot(y) < 0.3, "{x} {y}");

    // With a rally point on this side of the wall it goes there.
    let near = item(&start, command::NAV_RALLY_POINT, 0.0, [35.0, 0.0]);
    let mut bench = hovering(&start, wall, vec![inside, near]);
    there(&mut bench, 0.0, 25.0);
    there(&mut bench, 30.0, 25.0);
    assert_eq!(bench.set_mode(Mode::Return), 0);
    bench.fly_until("landed", 120.0, |bench| !bench.autopilot.vehicle().is_armed());
    let [x, y, _] = bench.position();
    assert!((x - 35.0).hypot(y) < 0.3, "{x} {y}");
}

fn fence_status(bench: &Bench) -> FENCE_STATUS_DATA {
    let told = bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(MavMessage::FENCE_STATUS(status)) => Some(status.clone()),
        _ => None,
    });
    told.expect("FENCE_STATUS")
}

/// Many circles, near and far: the way back keeps its distance from all of them. Without any way it lands where it is.
#[test]
fn a_return_keeps_out_of_many_exclusions_or_lands() {
    let mut start = settings(Identity::Px4);
    start.conduct.return_height_m = 12.0;
    let mut circles: Vec<([f64; 2], f64)> = Vec::new();
    for index in 0..60 {
        let (row, column) = (f64::from(index / 10), f64::from(index % 10));
        // Rows that are staggered, in the way; and some far away.
        circles.push(([12.0 + 10.0 * row, 10.0 * column - 45.0 + 5.0 * (row % 2.0)], 2.5));
        circles.push(([2000.0 + 10.0 * row, 10.0 * column], 2.5));
    }
    let fence = circles
        .iter()
        .map(|(centre, radius)| item(&start, command::NAV_FENCE_CIRCLE_EXCLUSION, *radius, *centre));
    let mut bench = hovering(&start, fence.collect(), Vec::new());
    // There it is led around the rows.
    for (north, east) in [(0.0, 70.0), (80.0, 70.0), (80.0, 3.0)] {
        there(&mut bench, north, east);
    }
    assert_eq!(bench.set_mode(Mode::Return), 0);
    let (mut nearest, mut slowest) = (f64::INFINITY, 0);
    for step in 0..1800 {
        bench.fly(0.1);
        let position = bench.autopilot.vehicle().truth().position_m;
        for ([north, east], radius) in &circles {
            nearest = nearest.min((position.x - north).hypot(position.y - east) - radius);
        }
        if bench.autopilot.vehicle().is_armed() {
            slowest = step;
        }
    }
    assert!(nearest > 1.5, "{nearest} m from a circle");
    assert!(slowest < 1500 && bench.position()[0].hypot(bench.position()[1]) < 0.5, "{:?}", bench.position());

    // A ring around it.
    let ring = (0..24).map(|index| {
        let angle = f64::from(index) * std::f64::consts::TAU / 24.0;
        let centre = [60.0 + 20.0 * angle.cos(), 20.0 * angle.sin()];
        item(&start, command::NAV_FENCE_CIRCLE_EXCLUSION, 4.0, centre)
    });
    let ring: Vec<_> = ring.collect();
    let mut bench = hovering(&start, Vec::new(), Vec::new());
    there(&mut bench, 60.0, 0.0);
    bench.heard = upload(&mut bench, PlanKind::Fence, &ring);
    assert_eq!(result(&bench.heard), Some(0));
    assert_eq!(bench.set_mode(Mode::Return), 0);
    bench.fly_until("landing", 60.0, |bench| !bench.autopilot.vehicle().is_armed());
    let told = "No route home around the fence: landing here";
    assert!(bench.texts().iter().any(|text| text == told), "{:?}", bench.texts());
    assert!((bench.position()[0] - 60.0).hypot(bench.position()[1]) < 1.0, "{:?}", bench.position());
}

/// Full stick northwards against a circle of 20 m. Returns how far it came within some seconds.
fn push(bench: &mut Bench, seconds: f64) -> f64 {
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut farthest: f64 = 0.0;
    bench.stream(seconds, |bench| {
        forward(bench);
        farthest = farthest.max(bench.autopilot.vehicle().truth().position_m.x);
    });
    farthest
}

/// Every GF_ACTION, flown against the border, and what clients are told.
#[test]
fn each_action_is_taken_at_the_border() {
    for action in [Action::None, Action::Warn, Action::Hold, Action::Return, Action::Terminate, Action::Land]
    {
        let mut start = settings(Identity::Px4);
        start.conduct.failsafe.fence = action;
        let circle = item(&start, command::NAV_FENCE_CIRCLE_INCLUSION, 20.0, [0.0, 0.0]);
        let mut bench = hovering(&start, vec![circle], Vec::new());
        bench.fly(2.0);
        assert_eq!(
            fence_status(&bench),
            FENCE_STATUS_DATA {
                breach_type: FenceBreach::FENCE_BREACH_NONE,
                breach_mitigation: FenceMitigate::FENCE_MITIGATE_NONE,
                ..FENCE_STATUS_DATA::default()
            }
        );
        let farthest = push(&mut bench, 15.0);
        // Terminated it falls across the border, which is another breach.
        let fell = action == Action::Terminate;
        let beyond = matches!(action, Action::None | Action::Warn | Action::Terminate);
        assert_eq!(farthest > 20.0, beyond, "{action:?}: {farthest} m");
        assert!(farthest > 16.0, "{action:?}: {farthest} m");
        let status = fence_status(&bench);
        // A breach that is only just prevented is one, and is over when it has been.
        let expected = (if fell { 2 } else { 1 }, u8::from(beyond));
        assert_eq!((status.breach_count, status.breach_status), expected, "{action:?}");
        assert_eq!(status.breach_type, FenceBreach::FENCE_BREACH_BOUNDARY);
        assert!((1000..bench.autopilot.vehicle().time_us() as u32 / 1000).contains(&status.breach_time));
        let texts = bench.texts();
        let told = texts.into_iter().filter(|text| text.starts_with("Fence"));
        let told: Vec<_> = told.take(if fell { 1 } else { usize::MAX }).collect();
        match action {
            Action::None => assert!(told.is_empty(), "{told:?}"),
            Action::Warn => assert_eq!(told, ["Fence ahead", "Fence breached (outside the fence)"]),
            _ => {
                let action = action.doing();
                assert_eq!(told, [format!("Fence ahead: {action}")]);
            }
        }
        match action {
            Action::Return | Action::Land => {
                bench.fly_until("landed", 120.0, |bench| !bench.autopilot.vehicle().is_armed());
                let home = bench.position()[0].abs() < 0.3;
                assert_eq!(home, action == Action::Return, "{action:?}: {:?}", bench.position());
            }
            Action::Terminate => assert!(!bench.autopilot.vehicle().is_armed()),
            Action::Hold => assert_eq!(bench.mode(), Mode::Hold),
            _ => assert_eq!(bench.mode(), Mode::Position),
        }
    }
}

/// Without GF_PREDICT it acts when it is beyond, not before.
#[test]
fn without_prediction_it_acts_beyond_the_border() {
    let mut start = settings(Identity::Px4);
    start.conduct.failsafe.fence_ahead = false;
    let circle = item(&start, command::NAV_FENCE_CIRCLE_INCLUSION, 20.0, [0.0, 0.0]);
    let mut bench = hovering(&start, vec![circle], Vec::new());
    let farthest = push(&mut bench, 8.0);
    assert!((20.5..30.0).contains(&farthest), "{farthest} m");
    assert_eq!(bench.mode(), Mode::Hold);
    assert_eq!(fence_status(&bench).breach_status, 1);
}

/// SYS_STATUS tells whether there is a fence, whether it is on, and whether it holds.
#[test]
fn the_fence_is_part_of_the_health() {
    let fence = MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE;
    let told = |bench: &mut Bench| {
        bench.heard.clear();
        bench.fly(1.1);
        let status = bench.heard.iter().rev().find_map(|message| match message {
            Message::Typed(MavMessage::SYS_STATUS(status)) => Some(status.clone()),
            _ => None,
        });
        let status = status.expect("SYS_STATUS");
        [
            status.onboard_control_sensors_present,
            status.onboard_control_sensors_enabled,
            status.onboard_control_sensors_health,
        ]
        .map(|bits| bits.contains(fence))
    };
    let start = settings(Identity::Px4);
    let mut bench = Bench::of(&start);
    assert_eq!(told(&mut bench), [false, false, true]);
    let circle = |radius_m| vec![item(&start, command::NAV_FENCE_CIRCLE_EXCLUSION, radius_m, [30.0, 0.0])];
    bench.autopilot = with_fence(&start, circle(20.0));
    assert_eq!(told(&mut bench), [true; 3]);
    let disable = [0.0; 7];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_FENCE_ENABLE, disable), 0);
    assert_eq!(told(&mut bench), [true, false, true]);
    bench.autopilot = with_fence(&start, circle(40.0));
    assert_eq!(told(&mut bench), [true, true, false]);
    // There it is not armed, either.
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), TEMPORARILY_REJECTED);
    assert!(bench.texts().iter().any(|text| text == "Arming denied: failsafe: fence breached"));
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_FENCE_ENABLE, disable), 0);
    bench.fly(1.1);
    bench.arm();
}

fn with_fence(settings: &VehicleSettings, fence: Vec<MissionItem>) -> autopilot::Autopilot {
    let mut settings = settings.clone();
    settings.plans.set(PlanKind::Fence, Plan::new(fence));
    Bench::of(&settings).autopilot
}

/// FENCE_ENABLE and FENCE_TYPE say what of the fence is looked at; DO_FENCE_ENABLE is told as the parameter.
#[test]
fn ardupilots_parameters_choose_what_of_the_fence_counts() {
    let mut start = settings(Identity::ArduPilot);
    start.conduct.failsafe.fence_height_m = 8.0;
    let circle = item(&start, command::NAV_FENCE_CIRCLE_EXCLUSION, 5.0, [0.0, 0.0]);
    start.plans.set(PlanKind::Fence, Plan::new(vec![circle]));
    start.conduct.failsafe.fence_enabled = false;
    let mut bench = Bench::hovering_with(&start);
    let breached = |bench: &mut Bench| {
        bench.fly(0.1);
        bench.autopilot.vehicle().fence_record().now
    };
    assert_eq!(set_cast(&mut bench, "FENCE_ACTION", 0.0), Some(0.0));
    assert_eq!(breached(&mut bench), None);
    assert_eq!(set_cast(&mut bench, "FENCE_ENABLE", 1.0), Some(1.0));
    assert_eq!(breached(&mut bench), Some(Breach::Height(8.0)));
    assert_eq!(set_cast(&mut bench, "FENCE_TYPE", 6.0), Some(6.0));
    assert_eq!(breached(&mut bench), Some(Breach::Inside(0)));
    assert_eq!(set_cast(&mut bench, "FENCE_TYPE", 2.0), Some(2.0));
    assert_eq!(breached(&mut bench), None);
    assert_eq!(set_cast(&mut bench, "FENCE_TYPE", 16.0), Some(2.0), "there is no such part");
    assert_eq!(set_cast(&mut bench, "FENCE_TYPE", 1.0), Some(1.0));
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_FENCE_ENABLE, [0.0; 7]), 0);
    assert_eq!(bench.parameters().pop().map(|told| told.param_value), Some(0.0));
    assert_eq!(breached(&mut bench), None);
    // PX4's names of the same are not there.
    assert_eq!(set_cast(&mut bench, "GF_ACTION", 1.0), None);
}

/// A wall that is thinner than the way to a stop: goals and missions behind it are refused, a stick stops before it.
#[test]
fn nothing_leads_through_a_thin_wall() {
    let mut start = settings(Identity::Px4);
    // When the sticks are let go.
    start.conduct.failsafe.pilot_lost = vehicle::radio::RadioLossAction::None;
    let wall = polygon(&start, false, &[[20.0, -40.0], [20.0, 40.0], [20.5, 40.0], [20.5, -40.0]]);
    let mut bench = hovering(&start, wall, Vec::new());
    assert_eq!(go_to(&mut bench, 40.0, 0.0), DENIED);
    assert!(
        bench.texts().iter().any(|text| text.contains("through an exclusion zone")),
        "{:?}",
        bench.texts()
    );
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut farthest: f64 = 0.0;
    bench.stream(15.0, |bench| {
        forward(bench);
        farthest = farthest.max(bench.autopilot.vehicle().truth().position_m.x);
    });
    assert!((15.0..20.0).contains(&farthest), "{farthest} m");
    // On a goal beside it nothing is in the way.
    there(&mut bench, 18.5, 20.0);
    there(&mut bench, 0.0, 0.0);
}

/// Bit 0 of FENCE_OPTIONS: nobody chooses another mode before the vehicle is back from a breach.
#[test]
fn ardupilot_keeps_the_mode_that_comes_back_from_a_breach() {
    const FAILED: u8 = 4;
    for (options, chosen) in [(1.0, FAILED), (0.0, 0)] {
        let mut start = settings(Identity::ArduPilot);
        start.conduct.failsafe.fence_enabled = true;
        start.conduct.failsafe.fence_ahead = false;
        let mut bench = Bench::hovering_with(&start);
        assert_eq!(set_cast(&mut bench, "FENCE_OPTIONS", options), Some(options));
        assert_eq!(go_to(&mut bench, 60.0, 0.0), 0);
        bench.fly_until("under way", 20.0, |bench| bench.position()[0] > 20.0);
        // A fence that it is outside of.
        assert_eq!(result(&upload(&mut bench, PlanKind::Fence, &square(&start, 15.0))), Some(0));
        bench.fly_until("comes back", 5.0, |bench| bench.mode() == Mode::Return);
        assert_eq!(bench.set_mode(Mode::Position), chosen, "{options}: {:?}", bench.texts());
        if chosen == FAILED {
            bench.fly_until("is inside", 60.0, |bench| bench.position()[0] < 10.0);
            bench.fly(3.0);
            assert_eq!(bench.set_mode(Mode::Position), 0, "{:?}", bench.texts());
        }
    }
}

/// Along and towards a border at 8 m/s, Loiter begins with the stick held towards it and back: none of what that asks for takes a share of
/// the braking.
#[test]
fn who_enters_loiter_fast_stops_before_the_border() {
    let mut start = settings(Identity::ArduPilot);
    start.conduct.failsafe.fence_enabled = true;
    let corners = [[-100.0, -300.0], [40.0, -300.0], [40.0, 300.0], [-100.0, 300.0]];
    start.plans.set(PlanKind::Fence, Plan::new(polygon(&start, true, &corners)));
    start.conduct.failsafe.fence_radius_m = 500.0;
    let mut bench = Bench::hovering_with(&start);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    for _ in 0..300 {
        if bench.position()[0] >= 29.0 {
            break;
        }
        bench.send(local_target(0b1101_1100_0111, [0.0; 3], [4.0, 7.0, 0.0]));
        bench.fly(0.1);
        assert_eq!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
    }
    assert!((29.0..31.0).contains(&bench.position()[0]), "{:?}", bench.position());
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut farthest: f64 = 0.0;
    bench.stream(15.0, |bench| {
        let stick =
            MANUAL_CONTROL_DATA { target: 1, x: 1000, y: -1000, z: 500, ..MANUAL_CONTROL_DATA::default() };
        bench.send(MavMessage::MANUAL_CONTROL(stick));
        farthest = farthest.max(bench.position()[0]);
    });
    assert!(bench.mode() == Mode::Position && farthest < 39.0, "{farthest} m");
}
