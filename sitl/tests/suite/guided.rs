//! ArduPilot's guided mode: what takes over from a takeoff, turns, pauses, targets as items, commanded speeds and sticks that end.

#![allow(deprecated)] // Clients use what the dialect calls deprecated.

use crate::common::Bench;
use crate::common::plan_client::result;
use crate::common::requests::{local_target, reposition};
use autopilot::codec::{Message, MissionItemMessage, Target};
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::{Mode, Vehicle};

const FAILED: u8 = 4;
const DENIED: u8 = 2;
const VELOCITY_ONLY: u16 = 0b1101_1100_0111;

/// Armed in the guided mode, and told to take off to 10 m.
fn taking_off() -> Bench {
    let mut bench = Bench::new(Identity::ArduPilot);
    bench.set_mode(Mode::Offboard);
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0]), 0);
    bench
}

fn vehicle(bench: &Bench) -> &Vehicle {
    bench.autopilot.vehicle()
}

fn heading_deg(bench: &Bench) -> f64 {
    vehicle(bench).outputs().attitude_rad.z.to_degrees()
}

/// A velocity, NED, m/s, as a DroneKit script sends it: with FORCE_SET and without an acceleration.
fn velocity(bench: &mut Bench, [vx, vy, vz]: [f32; 3]) {
    bench.send(local_target(0x0fc7, [0.0; 3], [vx, vy, vz]));
}

/// MISSION_ITEM_INT, as DroneKit's `simple_goto` sends the older MISSION_ITEM: north and east of the origin, m, and a height above home, m.
/// Returns the result.
fn item(bench: &mut Bench, current: u8, number: u16, [north, east]: [f64; 2], height_m: f64) -> Option<u8> {
    let place = vehicle(bench).frame().to_geodetic(&Vector3::new(north, east, 0.0));
    let message = MissionItemMessage {
        sequence: 0,
        item: MissionItem {
            frame: frame::GLOBAL_RELATIVE,
            command: number,
            parameters: [0.0; 4],
            position: [place.latitude_deg, place.longitude_deg, height_m],
            autocontinue: false,
        },
        current,
        kind: PlanKind::Mission.number(),
        target: Target { system: 0, component: 0 },
        int: true,
    };
    let frame = bench.frame(Message::MissionItem(message));
    bench.heard.clear();
    bench.receive(&frame);
    result(&bench.heard)
}

fn go_to(bench: &mut Bench, place: [f64; 2], height_m: f64) {
    assert_eq!(item(bench, 2, command::NAV_WAYPOINT, place, height_m), Some(0), "{:?}", bench.texts());
}

#[test]
fn a_velocity_takes_over_from_a_takeoff() {
    let mut bench = taking_off();
    bench.fly(1.2);
    bench.stream(4.0, |bench| velocity(bench, [0.0, 2.0, 0.0]));
    let [north, east, down] = bench.velocity();
    assert!(north.abs() < 0.05 && (east - 2.0).abs() < 0.05 && down.abs() < 0.05, "{:?}", bench.velocity());
    assert!(-bench.position()[2] < 9.0 && bench.mode() == Mode::Offboard, "{:?}", bench.position());
}

#[test]
fn a_target_takes_over_from_a_takeoff_that_has_just_been_asked_for() {
    let mut bench = taking_off();
    go_to(&mut bench, [8.0, -6.0], 5.0);
    bench.fly_until("there", 20.0, |bench| bench.is_near([8.0, -6.0, -5.0]));
}

#[test]
fn a_turn_and_a_speed_hold_during_a_takeoff() {
    let mut bench = taking_off();
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, [2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_CONDITION_YAW, [90.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]), 0);
    let mut fastest_m_s: f64 = 0.0;
    for _ in 0..1500 {
        bench.fly(0.01);
        fastest_m_s = fastest_m_s.max(-bench.velocity()[2]);
    }
    assert!(bench.is_near([0.0, 0.0, -10.0]), "{:?}", bench.position());
    assert!((fastest_m_s - 1.0).abs() < 0.08, "{fastest_m_s}");
    assert!((heading_deg(&bench) - 90.0).abs() < 1.0, "{}", heading_deg(&bench));
}

#[test]
fn a_turn_has_its_rate_and_its_direction_whatever_is_flown() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    // The first velocity after a takeoff would end the turn.
    bench.stream(0.2, |bench| velocity(bench, [1.0, 0.0, 0.0]));
    // The long way round: 270° counter-clockwise at 10°/s, less 4.9° that it turns slower at first, by 10.3°/s².
    assert_eq!(bench.command(MavCmd::MAV_CMD_CONDITION_YAW, [90.0, 10.0, -1.0, 0.0, 0.0, 0.0, 0.0]), 0);
    bench.stream(9.0, |bench| velocity(bench, [1.0, 0.0, 0.0]));
    assert!((heading_deg(&bench) + 85.1).abs() < 1.0, "{}", heading_deg(&bench));
    bench.stream(20.0, |bench| velocity(bench, [1.0, 0.0, 0.0]));
    assert!((heading_deg(&bench) - 90.0).abs() < 1.0, "{}", heading_deg(&bench));
    assert!((bench.velocity()[0] - 1.0).abs() < 0.05, "{:?}", bench.velocity());
    // By 30° from there, by a command without a rate.
    assert_eq!(bench.command(MavCmd::MAV_CMD_CONDITION_YAW, [30.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]), 0);
    bench.fly(9.0);
    assert!((heading_deg(&bench) - 120.0).abs() < 1.0, "{}", heading_deg(&bench));
}

#[test]
fn a_pause_holds_until_it_goes_on() {
    let pause = |bench: &mut Bench, what: f32| {
        bench.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, [what, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(pause(&mut bench, 1.0), DENIED, "nothing is paused");
    go_to(&mut bench, [60.0, 0.0], 10.0);
    bench.fly(4.0);
    assert_eq!(pause(&mut bench, 0.0), 0);
    bench.fly(5.0);
    let [held, ..] = bench.position();
    bench.fly(3.0);
    assert!((bench.position()[0] - held).abs() < 0.05 && (5.0..50.0).contains(&held), "{held}");
    assert_eq!(bench.mode(), Mode::Offboard);
    assert_eq!(pause(&mut bench, 1.0), 0);
    bench.fly_until("there", 30.0, |bench| bench.is_near([60.0, 0.0, -10.0]));
    assert_eq!(pause(&mut bench, 2.0), DENIED);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    assert_eq!(pause(&mut bench, 0.0), FAILED, "in the loiter mode");
}

#[test]
fn items_are_targets_in_the_guided_mode_only() {
    const ERROR: u8 = 1;
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(item(&mut bench, 2, command::NAV_LAND, [0.0; 2], 0.0), Some(ERROR), "no waypoint");
    // The altitude alone.
    assert_eq!(item(&mut bench, 3, command::NAV_WAYPOINT, [50.0, 50.0], 13.0), Some(0));
    bench.fly_until("higher", 20.0, |bench| bench.is_near([0.0, 0.0, -13.0]));
    assert_eq!(bench.set_mode(Mode::Position), 0);
    assert_eq!(item(&mut bench, 2, command::NAV_WAYPOINT, [5.0, 0.0], 10.0), Some(ERROR));
    assert!(bench.texts().iter().any(|text| text.contains("needs Guided mode")), "{:?}", bench.texts());
    assert!(vehicle(&bench).plans().get(PlanKind::Mission).items().is_empty());
}

/// The fastest of a flight to a place 150 m away, m/s, at 5 m/s.
fn fastest_m_s(bench: &mut Bench, begin: impl FnOnce(&mut Bench)) -> f64 {
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, [1.0, 5.0, -1.0, 0.0, 0.0, 0.0, 0.0]), 0);
    begin(bench);
    bench.fly(15.0);
    let [north, east, _] = bench.velocity();
    north.hypot(east)
}

#[test]
fn a_commanded_speed_is_flown_as_it_is() {
    let mut guided = Bench::hovering(Identity::ArduPilot);
    let speed_m_s = fastest_m_s(&mut guided, |bench| go_to(bench, [120.0, -90.0], 10.0));
    assert!((speed_m_s - 5.0).abs() < 0.01, "{speed_m_s}");
    let mut px4 = Bench::hovering(Identity::Px4);
    let speed_m_s = fastest_m_s(&mut px4, |bench| {
        let place = vehicle(bench).frame().to_geodetic(&Vector3::new(120.0, -90.0, -10.0));
        bench.send(reposition(&place, MavFrame::MAV_FRAME_GLOBAL, place.altitude_m as f32));
    });
    assert!((speed_m_s - 5.0).abs() < 0.01, "{speed_m_s}");
}

/// RC_OVERRIDE_TIME is 3 s, COM_RC_LOSS_T half a second.
#[test]
fn overrides_end_after_their_time() {
    for (identity, kept_s) in [(Identity::ArduPilot, 3.0), (Identity::Px4, 0.5)] {
        let mut bench = Bench::hovering(identity);
        assert_eq!(bench.set_mode(Mode::Position), 0);
        let forward = RC_CHANNELS_OVERRIDE_DATA {
            target_system: 1,
            target_component: 1,
            chan1_raw: 1500,
            chan2_raw: 1200,
            chan3_raw: 1500,
            chan4_raw: 1500,
            ..RC_CHANNELS_OVERRIDE_DATA::default()
        };
        bench.stream(3.0, |bench| bench.send(MavMessage::RC_CHANNELS_OVERRIDE(forward.clone())));
        let [before_m_s, ..] = bench.velocity();
        bench.fly(kept_s - 0.1);
        assert!(before_m_s > 1.0 && bench.velocity()[0] > 0.9 * before_m_s, "{identity:?}");
        bench.fly(if identity.is_ardupilot() { 8.0 } else { 3.0 });
        // PX4 then returns, and ArduPilot stops.
        let stopped = bench.velocity()[0].abs() < 0.1;
        assert!(
            if identity.is_ardupilot() { stopped } else { bench.mode() == Mode::Return },
            "{identity:?}: {:?}",
            bench.velocity()
        );
    }
}

/// PX4 loses the offboard mode when set-points are refused for a second.
#[test]
fn px4_stays_in_the_offboard_mode_with_the_force_bit() {
    let mut bench = Bench::hovering(Identity::Px4);
    velocity(&mut bench, [1.0, 0.0, 0.0]);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.stream(4.0, |bench| velocity(bench, [1.0, 0.0, 0.0]));
    assert!(bench.mode() == Mode::Offboard && (bench.velocity()[0] - 1.0).abs() < 0.05);
    let masks = [0x0ff8, VELOCITY_ONLY | 1 << 9];
    for mask in masks {
        bench.heard.clear();
        bench.send(MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            target_system: 1,
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
            type_mask: PositionTargetTypemask::from_bits_retain(mask),
            z: -10.0,
            ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
        }));
        assert!(bench.texts().is_empty(), "{mask:#x}: {:?}", bench.texts());
    }
}
