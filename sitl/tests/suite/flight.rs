//! The vehicle's states, driven by messages in simulation time.

use crate::common;
use crate::common::requests;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{
    AttitudeTargetTypemask, MANUAL_CONTROL_DATA, MavCmd, MavFrame, MavMessage, SET_ATTITUDE_TARGET_DATA,
};
use vehicle::identity::Identity;
use vehicle::{LandedState, Mode};

const NOTHING: [f32; 7] = [0.0; 7];
const UNSUPPORTED: u8 = 3;
const FAILED: u8 = 4;
const TEMPORARILY_REJECTED: u8 = 1;
const DENIED: u8 = 2;
const UNSUPPORTED_MAV_FRAME: u8 = 9;

#[test]
fn it_is_armable_from_the_start() {
    let bench = Bench::new(Identity::Px4);
    assert!(bench.autopilot.vehicle().arming_obstacles().is_empty());
    assert!(bench.texts()[0].contains("simulated"), "it says what it is: {:?}", bench.texts());
}

#[test]
fn takes_off_holds_lands_and_disarms() {
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(bench.mode(), Mode::Hold);
    assert!(bench.is_near([0.0, 0.0, -10.0]), "{:?}", bench.position());
    assert_eq!(bench.autopilot.vehicle().landed_state(), LandedState::InAir);
    // In the air nothing but force disarms.
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, NOTHING), TEMPORARILY_REJECTED);
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_LAND, NOTHING), 0);
    bench.fly(0.5);
    assert_eq!(bench.autopilot.vehicle().landed_state(), LandedState::Landing);
    let mut fastest: f64 = 0.0;
    while bench.autopilot.vehicle().landed_state() == LandedState::Landing {
        bench.fly(0.01);
        if bench.position()[2] > -0.3 {
            fastest = fastest.max(bench.velocity()[2]);
        }
    }
    assert!(fastest < 1.0, "touches down at {fastest} m/s");
    assert!(bench.autopilot.vehicle().is_armed());
    bench.fly(2.5);
    assert!(!bench.autopilot.vehicle().is_armed() && bench.position()[2].abs() < 0.02);
    assert!(bench.texts().iter().any(|text| text == "Disarmed after landing"), "{:?}", bench.texts());
}

#[test]
fn takeoff_before_arming_waits_for_it() {
    let mut bench = Bench::new(Identity::Px4);
    let parameters = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 493.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), 0);
    bench.fly(1.0);
    assert!(bench.position()[2] > -0.01);
    bench.arm();
    bench.fly_until("5 m", 15.0, |bench| bench.is_near([0.0, 0.0, -5.0]));
}

#[test]
fn nothing_happens_after_arming_disarms() {
    let mut bench = Bench::new(Identity::Px4);
    bench.arm();
    bench.fly(9.9);
    assert!(bench.autopilot.vehicle().is_armed() && bench.position()[2] > -0.01);
    bench.fly(0.2);
    assert!(!bench.autopilot.vehicle().is_armed());
}

/// With the delays at zero it stays armed, before a flight and after it.
#[test]
fn a_delay_of_zero_never_disarms() {
    let mut start = settings(Identity::ArduPilot);
    start.conduct.disarm_before_takeoff_s = 0.0;
    start.conduct.disarm_after_landing_s = 0.0;
    let mut bench = Bench::of(&start);
    bench.set_mode(Mode::Offboard);
    bench.arm();
    bench.fly(30.0);
    assert!(bench.autopilot.vehicle().is_armed());
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0]), 0);
    bench.fly(6.0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_LAND, NOTHING), 0);
    bench.fly(30.0);
    assert!(bench.autopilot.vehicle().is_armed() && bench.position()[2].abs() < 0.02);
}

/// An attitude with next to no thrust is how offboard programs land: PX4 disarms then, too.
#[test]
fn attitudes_without_thrust_on_the_ground_disarm() {
    let mut bench = Bench::new(Identity::Px4);
    let thrust = |bench: &mut Bench, thrust: f32| {
        bench.send(MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            target_system: 1,
            q: [1.0, 0.0, 0.0, 0.0],
            type_mask: AttitudeTargetTypemask::from_bits_retain(0b111),
            thrust,
            ..SET_ATTITUDE_TARGET_DATA::default()
        }));
    };
    thrust(&mut bench, 0.0);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.arm();
    let airframe = bench.autopilot.vehicle().simulation().configuration().airframe;
    let hover = (airframe.weight_n() / airframe.thrust_range_n().1) as f32;
    // Never let off, but about to: it is not disarmed.
    bench.stream(12.0, |bench| thrust(bench, 0.9 * hover));
    assert!(
        bench.autopilot.vehicle().is_armed()
            && bench.autopilot.vehicle().landed_state() == LandedState::OnGround
    );
    bench.stream(0.7, |bench| thrust(bench, 1.1 * hover));
    bench.stream(2.0, |bench| thrust(bench, 0.7 * hover));
    assert!(bench.texts().iter().any(|text| text == "Landing detected"), "{:?}", bench.texts());
    bench.stream(2.5, |bench| thrust(bench, 0.0));
    assert!(!bench.autopilot.vehicle().is_armed() && bench.mode() == Mode::Offboard);
}

#[test]
fn a_refused_arming_says_why() {
    let mut bench = Bench::new(Identity::Px4);
    // The position mode of a set-point that nobody has sent.
    assert_eq!(bench.set_mode(Mode::Offboard), TEMPORARILY_REJECTED);
    assert_eq!(bench.set_mode(Mode::Return), 0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 1);
    assert!(
        bench.texts().iter().any(|text| text == "Arming denied: Return mode is active"),
        "{:?}",
        bench.texts()
    );
    assert_eq!(
        bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        DENIED
    );
}

#[test]
fn a_mode_that_there_is_not_names_those_that_there_are() {
    // PX4's rattitude mode, which is gone, and ArduPilot's AUTOTUNE.
    for (identity, main, result, told) in [
        (
            Identity::Px4,
            9.0,
            UNSUPPORTED,
            "Mode 0x90000 is not available; available: Manual, Stabilized, Acro, Altitude, Position, Hold, Takeoff, Mission, Return, Land, Offboard, Orbit, Follow Me",
        ),
        (
            Identity::ArduPilot,
            99.0,
            FAILED,
            "Mode 99 is not available; available: Stabilize, Acro, AltHold, Loiter, PosHold, Brake, Auto, Auto RTL, RTL, Land, Guided, Guided NoGPS, Circle, Follow, Smart RTL, Throw, Flip, ZigZag",
        ),
    ] {
        let mut bench = Bench::new(identity);
        let mode = [1.0, main, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_MODE, mode), result);
        assert_eq!(bench.texts().last().map(String::as_str), Some(told));
    }
}

#[test]
fn returns_over_its_height_and_lands_at_home() {
    let mut start = settings(Identity::Px4);
    start.conduct.return_height_m = 15.0;
    let mut bench = Bench::of(&start);
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
    bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
    let place = bench.autopilot.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(20.0, -10.0, -5.0));
    let [latitude, longitude] = [place.latitude_deg as f32, place.longitude_deg as f32];
    let goal = [-1.0, 1.0, 0.0, f32::NAN, latitude, longitude, 493.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPOSITION, goal), 0);
    // A float's degree is good for a metre.
    bench.fly_until("there", 40.0, |bench| {
        (bench.position()[0] - 20.0).abs() < 1.0 && bench.velocity()[0].abs() < 0.05
    });
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, NOTHING), 0);
    let mut highest: f64 = 0.0;
    while bench.autopilot.vehicle().is_armed() {
        bench.fly(0.05);
        highest = highest.max(-bench.position()[2]);
        assert!(bench.autopilot.vehicle().time_us() < 200_000_000, "still not home: {:?}", bench.position());
    }
    assert!((highest - 15.0).abs() < 0.5, "{highest}");
    let [x, y, z] = bench.position();
    assert!(x.hypot(y) < 0.2 && z.abs() < 0.02, "{x} {y} {z}");
}

#[test]
fn hold_brakes_on_the_way_and_stays_at_the_goal() {
    let mut bench = Bench::hovering(Identity::Px4);
    let set_point =
        |bench: &Bench| nalgebra::Vector3::from(bench.autopilot.vehicle().outputs().setpoint.position_m);
    let go = |bench: &mut Bench| reposition(bench, MavFrame::MAV_FRAME_GLOBAL, 498.0);
    // Within the same instant nothing moves yet: it is on its way all the same.
    assert_eq!((go(&mut bench), bench.set_mode(Mode::Hold)), (0, 0));
    bench.fly(4.0);
    assert!(bench.position()[0].abs() < 0.1, "{:?}", bench.position());
    assert_eq!(go(&mut bench), 0);
    bench.fly(2.0);
    let passed_m = bench.position()[0];
    assert_eq!(bench.set_mode(Mode::Hold), 0);
    bench.fly(6.0);
    assert!(
        passed_m > 1.0 && (passed_m..passed_m + 9.0).contains(&bench.position()[0]),
        "{passed_m} {:?}",
        bench.position()
    );
    assert!(bench.velocity()[0].abs() < 0.02);

    assert_eq!(go(&mut bench), 0);
    bench.fly(20.0);
    let goal = set_point(&bench);
    assert_eq!(bench.set_mode(Mode::Hold), 0);
    bench.fly(2.0);
    assert!((set_point(&bench) - goal).norm() < 1e-9, "{}", set_point(&bench));
    assert!((goal.x - 20.0).abs() < 0.01 && bench.is_near(goal.into()), "{:?}", bench.position());
}

#[test]
fn a_place_in_a_frame_that_is_not_global_is_refused() {
    let mut bench = Bench::hovering(Identity::Px4);
    for frame in [MavFrame::MAV_FRAME_LOCAL_NED, MavFrame::MAV_FRAME_MISSION, MavFrame::MAV_FRAME_BODY_FRD] {
        assert_eq!(reposition(&mut bench, frame, 12.0), UNSUPPORTED_MAV_FRAME, "{frame:?}");
    }
    assert!(
        bench.texts().iter().any(|text| text.contains("is not supported: a place")),
        "{:?}",
        bench.texts()
    );
    bench.fly(3.0);
    assert!(bench.is_near([0.0, 0.0, -10.0]), "{:?}", bench.position());
    // 12 m above home, and above the ground.
    for frame in [MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT, MavFrame::MAV_FRAME_GLOBAL_TERRAIN_ALT] {
        assert_eq!(reposition(&mut bench, frame, 12.0), 0);
    }
}

/// DO_REPOSITION to 20 m north of the start, as COMMAND_INT.
fn reposition(bench: &mut Bench, frame: MavFrame, altitude_m: f32) -> u8 {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(20.0, 0.0, 0.0));
    let message = requests::reposition(&place, frame, altitude_m);
    bench.heard.clear();
    bench.send(message);
    bench.acks().last().expect("an answer").result
}

#[test]
fn sticks_fly_the_position_mode_and_their_loss_holds() {
    let mut start = settings(Identity::Px4);
    start.conduct.failsafe.pilot_lost = vehicle::radio::RadioLossAction::Hold;
    let mut bench = Bench::hovering_with(&start);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let forward = MANUAL_CONTROL_DATA { target: 1, x: 1000, z: 500, ..MANUAL_CONTROL_DATA::default() };
    bench.stream(4.0, |bench| bench.send(MavMessage::MANUAL_CONTROL(forward.clone())));
    let [north, east, down] = bench.velocity();
    assert!((north - 5.0).abs() < 0.2 && east.abs() < 0.05 && down.abs() < 0.1, "{:?}", bench.velocity());
    bench.fly(5.0);
    assert!(bench.velocity()[0].abs() < 0.05, "{:?}", bench.velocity());
    assert!(bench.texts().iter().any(|text| text.starts_with("Manual control lost")), "{:?}", bench.texts());
    // Down to the ground with the stick.
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let down = MANUAL_CONTROL_DATA { z: 0, ..forward };
    let down = MANUAL_CONTROL_DATA { x: 0, ..down };
    bench.stream(15.0, |bench| bench.send(MavMessage::MANUAL_CONTROL(down.clone())));
    assert!(
        !bench.autopilot.vehicle().is_armed() && bench.position()[2].abs() < 0.02,
        "{:?}",
        bench.position()
    );
}

#[test]
fn every_command_is_answered() {
    let mut bench = Bench::new(Identity::Px4);
    // A number that no enumeration has, in both messages.
    for number in [0_u16, 31_999, 65_535, 16, 301, 421] {
        for id in [76_u8, 75] {
            let mut payload = vec![0; 35];
            payload[28..30].copy_from_slice(&number.to_le_bytes());
            (payload[30], payload[31]) = (1, 1);
            let frame = raw_frame(id, &payload);
            bench.heard.clear();
            bench.receive(&frame);
            let ack = bench.acks()[0];
            assert_eq!((ack.command, ack.result, ack.target_system), (number, UNSUPPORTED, 255));
        }
    }
}

/// A frame of MAVLink 2 made by hand.
fn raw_frame(id: u8, payload: &[u8]) -> autopilot::codec::Frame {
    use mavlink::Message as _;
    let mut bytes = vec![0xfd, payload.len() as u8, 0, 0, 0, 255, 190, id, 0, 0];
    bytes.extend(payload);
    let extra = MavMessage::extra_crc(u32::from(id));
    let checksum = mavlink::calculate_crc(&bytes[1..], extra);
    bytes.extend(checksum.to_le_bytes());
    autopilot::codec::Frame::parse(&bytes).expect("a right frame")
}

#[test]
fn a_retry_turns_once() {
    let mut bench = Bench::hovering(Identity::Px4);
    let turn = [90.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    bench.heard.clear();
    for confirmation in 0..3 {
        bench.send(common::command_long(MavCmd::MAV_CMD_CONDITION_YAW, turn, confirmation));
        bench.fly(0.2);
    }
    assert_eq!(bench.acks().len(), 3, "each is answered");
    bench.fly(12.0);
    let yaw = bench.autopilot.vehicle().outputs().attitude_rad.z;
    assert!((yaw - core::f64::consts::FRAC_PI_2).abs() < 0.02, "{yaw}");
}

/// Results with their progress.
fn results(bench: &Bench) -> Vec<(u8, u8)> {
    bench.acks().iter().map(|ack| (ack.result, ack.progress)).collect()
}

#[test]
fn a_calibration_tells_its_progress_and_can_be_cancelled() {
    const ACCEPTED: u8 = 0;
    const IN_PROGRESS: u8 = 5;
    const CANCELLED: u8 = 6;
    let gyro = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let calibrate =
        |bench: &mut Bench, parameters| bench.command(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, parameters);
    let mut bench = Bench::new(Identity::Px4);
    assert_eq!(calibrate(&mut bench, gyro), IN_PROGRESS);
    bench.fly(1.0);
    // A retry is told how far it is, another one to wait.
    bench.send(common::command_long(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, gyro, 1));
    let accelerometer = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    bench.send(common::command_long(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, accelerometer, 0));
    bench.fly(1.5);
    let progress = [0, 20, 40].map(|percent| (IN_PROGRESS, percent));
    let rest =
        [(IN_PROGRESS, 40), (TEMPORARILY_REJECTED, 0), (IN_PROGRESS, 60), (IN_PROGRESS, 80), (ACCEPTED, 0)];
    assert_eq!(results(&bench), [&progress[..], &rest].concat());
    let texts = bench.texts();
    assert!(texts.contains(&"[cal] calibration done: gyro".to_owned()), "{texts:?}");

    // Cancelled, by its own message and by asking for nothing.
    assert_eq!(calibrate(&mut bench, gyro), IN_PROGRESS);
    let mut payload = vec![241, 0, 1, 1];
    bench.receive(&raw_frame(80, &payload));
    assert_eq!(results(&bench).last(), Some(&(CANCELLED, 0)));
    bench.heard.clear();
    bench.fly(3.0);
    payload[0] = 22;
    bench.receive(&raw_frame(80, &payload));
    assert!(bench.acks().is_empty(), "nothing is under way");
    assert_eq!(calibrate(&mut bench, accelerometer), IN_PROGRESS);
    calibrate(&mut bench, [0.0; 7]);
    assert_eq!(results(&bench), [(ACCEPTED, 0), (CANCELLED, 0)]);

    // What moves, or cannot be calibrated, is not.
    assert_eq!(calibrate(&mut bench, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), UNSUPPORTED);
    assert_eq!(calibrate(&mut bench, gyro), IN_PROGRESS);
    bench.arm();
    bench.fly(0.1);
    assert!(results(&bench).contains(&(FAILED, 0)), "{:?}", results(&bench));
    assert_eq!(calibrate(&mut bench, gyro), TEMPORARILY_REJECTED);
}

#[test]
fn heartbeats_come_every_second_and_at_once_after_a_change() {
    let mut bench = Bench::new(Identity::Px4);
    // A peer that is heard for the first time gets one more.
    bench.command(MavCmd::MAV_CMD_RUN_PREARM_CHECKS, [0.0; 7]);
    let beats = |bench: &Bench| bench.heard.iter().filter(|message| message.id() == 0).count();
    bench.heard.clear();
    bench.fly(5.0);
    assert_eq!(beats(&bench), 5);
    bench.heard.clear();
    bench.arm();
    assert_eq!(beats(&bench), 1);
}

#[test]
fn messages_keep_their_rates() {
    let mut bench = Bench::new(Identity::Px4);
    let set = |bench: &mut Bench, id: f32, interval: f32| {
        bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [id, interval, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    assert_eq!(set(&mut bench, 31.0, 7000.0), 0);
    assert_eq!(set(&mut bench, 33.0, -1.0), 0);
    assert_eq!(set(&mut bench, 9999.0, 1000.0), UNSUPPORTED);
    bench.fly(1.0);
    bench.heard.clear();
    bench.fly(10.0);
    let count = |id: u32| bench.heard.iter().filter(|message| message.id() == id).count();
    assert_eq!(count(30), 150, "ATTITUDE at 15 Hz");
    assert!((1428..=1429).contains(&count(31)), "{}", count(31));
    assert_eq!(count(33), 0);
    assert_eq!(count(32), 100, "LOCAL_POSITION_NED at 10 Hz");
}

/// A height above home, sent as the altitude above sea level that PX4 takes it for.
#[test]
fn an_altitude_below_home_is_explained() {
    let mut bench = Bench::new(Identity::Px4);
    let [zero, nan] = [0.0, f32::NAN];
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [zero, zero, zero, nan, nan, nan, 10.0]), 0);
    let told = "Takeoff altitude 10.0 m above sea level, home is at 488.0 m: using default";
    assert!(bench.texts().contains(&told.to_owned()), "{:?}", bench.texts());
}
