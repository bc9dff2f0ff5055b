//! What the vehicle carries: servo outputs, a landing gear, a parachute and a mount.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use super::flier::*;
use crate::common::Bench;
use crate::common::requests::local_target;
use autopilot::codec::{Frame, Version};
use mavlink::dialects::ardupilotmega::*;
use vehicle::plan::PlanKind;

/// MAV_MOUNT_MODE.
const NEUTRAL: f32 = 1.0;
const COMMANDS: f32 = 2.0;
const RADIO: f32 = 3.0;
const PLACE: f32 = 4.0;
const SYSTEM: f32 = 5.0;

/// The pulse of an output that SERVO_OUTPUT_RAW shows.
fn servo7_us(flier: &Flier) -> Option<u16> {
    flier.latest(|message| match message {
        MavMessage::SERVO_OUTPUT_RAW(servos) => Some(servos.servo7_raw),
        _ => None,
    })
}

/// Suite: ThrottleFailsafePassthrough.
#[test]
fn an_output_that_follows_the_radio_never_shows_what_a_lost_one_says() {
    let mut flier = Flier::new();
    flier.set_all(&[
        ("RC7_MIN", 1000.0),
        ("RC7_MAX", 2000.0),
        ("SERVO7_MIN", 1000.0),
        ("SERVO7_MAX", 2000.0),
        ("SERVO7_TRIM", 1450.0),
        ("SERVO7_FUNCTION", 146.0),
        ("FS_THR_ENABLE", 1.0),
        ("RC_FS_TIMEOUT", 10.0),
        ("SERVO_RC_FS_MSK", 64.0),
    ]);
    flier.reboot();
    let interval = [36.0, 5000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, interval), ACCEPTED);
    flier.rc(7, 1799);
    flier.fly(0.5);
    // The scaled pulse that ArduPilot's test expects.
    assert_eq!(servo7_us(&flier), Some(1778));
    flier.rc_all(&[(3, 800), (7, 1300)]);
    flier.bench.heard.clear();
    flier.fly(10.0);
    assert_eq!(servo7_us(&flier), Some(1450));
    let shown: Vec<u16> = flier.all(|message| match message {
        MavMessage::SERVO_OUTPUT_RAW(servos) => Some(servos.servo7_raw),
        _ => None,
    });
    assert!(shown.len() > 1900 && shown.iter().all(|pulse| [1778, 1450].contains(pulse)));
    // Commands are for outputs that follow nothing.
    let asked = [7.0, 1200.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_SERVO, asked), FAILED);
    assert!(flier.has_said("set SERVO7_FUNCTION to 0"));
}

/// With a parachute on output 9, and a switch for it or none.
fn with_parachute(option: f64) -> Flier {
    let mut start = crate::common::settings(vehicle::identity::Identity::ArduPilot);
    let rows = [(22, 0.0, 0.0, 20.0), (16, 5.0, 0.0, 20.0), (208, 0.0, 0.0, 0.0), (16, 90.0, 0.0, 20.0)];
    let mut plan = mission(&start, &rows).items().to_vec();
    plan[3].parameters[0] = 2.0;
    start.plans.set(PlanKind::Mission, vehicle::plan::Plan::new(plan));
    let mut flier = Flier::with(&start);
    flier.rc(9, 1000);
    flier.set_all(&[
        ("CHUTE_ENABLED", 1.0),
        ("CHUTE_TYPE", 10.0),
        ("SERVO9_FUNCTION", 27.0),
        ("SIM_PARA_ENABLE", 1.0),
        ("SIM_PARA_PIN", 9.0),
        ("RC9_OPTION", option),
    ]);
    flier.fly(1.0);
    flier
}

const DEPLOYED: &str = "BANG!  Parachute deployed";

fn order(flier: &mut Flier, action: f32) {
    let parameters = [action, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_PARACHUTE, parameters), ACCEPTED);
}

fn stays_closed(flier: &mut Flier) {
    flier.fly(2.0);
    assert!(!flier.has_said("BANG") && flier.is_armed(), "{:?}", flier.bench.texts());
}

/// Suite: Parachute, in a mission and by command. It comes down at the sink rate of a parachute.
#[test]
fn a_parachute_opens_in_a_mission_and_by_command() {
    let mut flier = with_parachute(0.0);
    flier.change_mode(LOITER);
    flier.arm();
    flier.change_mode(AUTO);
    flier.rc(3, 1600);
    flier.wait_text(DEPLOYED, 60.0);
    assert!(!flier.is_armed() && flier.has_said("Parachute: Released"));
    flier.fly(2.0);
    assert!((flier.climb_m_s() + 4.5).abs() < 0.5, "{}", flier.climb_m_s());
    let mut flier = with_parachute(0.0);
    flier.take_off(20.0, STABILIZE);
    order(&mut flier, 2.0);
    flier.wait_text(DEPLOYED, 5.0);
}

/// Suite: Parachute, with a switch. It is disabled where that is found low.
#[test]
fn a_switch_enables_and_releases_the_parachute() {
    let mut flier = with_parachute(23.0);
    flier.take_off(20.0, STABILIZE);
    flier.rc(9, 2000);
    flier.wait_text(DEPLOYED, 5.0);

    let mut flier = with_parachute(23.0);
    flier.reboot();
    assert!(!flier.vehicle().conduct().equipment.parachute.enabled);
    flier.take_off(20.0, STABILIZE);
    order(&mut flier, 2.0);
    stays_closed(&mut flier);
    order(&mut flier, 1.0);
    stays_closed(&mut flier);
    order(&mut flier, 2.0);
    flier.wait_text(DEPLOYED, 2.0);
}

/// Suite: Parachute, with rotors that fail: it opens only if it may.
#[test]
fn a_parachute_opens_by_itself_where_the_rotors_cannot_carry_the_vehicle() {
    let mut flier = with_parachute(23.0);
    flier.take_off(40.0, STABILIZE);
    flier.rc(9, 1500);
    flier.fly(0.5);
    flier.set("SIM_ENGINE_FAIL", 5.0);
    flier.wait_text(DEPLOYED, 60.0);

    let mut flier = with_parachute(23.0);
    flier.take_off(10.0, LOITER);
    flier.rc(9, 1100);
    flier.fly(0.5);
    flier.set("SIM_ENGINE_FAIL", 2.0);
    flier.fly(5.0);
    assert!(!flier.has_said("BANG"));
}

/// A mount of servos, as the suite sets it up.
fn with_mount() -> Flier {
    let mut flier = Flier::new();
    flier.rc(6, 1500);
    for channel in [11, 12, 13] {
        flier.rc(channel, 1500);
    }
    flier.set_all(&[
        ("MNT1_TYPE", 1.0),
        ("MNT1_PITCH_MIN", -45.0),
        ("MNT1_PITCH_MAX", 45.0),
        ("RC6_OPTION", 213.0),
        ("SERVO5_FUNCTION", 8.0),
        ("SERVO6_FUNCTION", 7.0),
        ("SERVO7_FUNCTION", 6.0),
        ("SERVO7_MIN", 1000.0),
        ("SERVO7_MAX", 2000.0),
    ]);
    flier.reboot();
    flier
}

/// Roll, pitch and yaw of the mount as GIMBAL_DEVICE_ATTITUDE_STATUS has them, degrees.
fn mount_deg(flier: &mut Flier) -> [f64; 3] {
    flier.bench.heard.clear();
    let request = [285.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, request), ACCEPTED);
    let q = flier.latest(|message| match message {
        MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(status) => Some(status.q.map(f64::from)),
        _ => None,
    });
    let [w, x, y, z] = q.expect("an attitude");
    let turn = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
    let (roll, pitch, yaw) = turn.euler_angles();
    [roll, pitch, yaw].map(f64::to_degrees)
}

fn pitches(flier: &mut Flier, mode: f32, pitch_deg: f64, within_deg: f64) {
    let parameters = [mode, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_MOUNT_CONFIGURE, parameters), ACCEPTED);
    flier.fly(0.2);
    let [_, pitch, _] = mount_deg(flier);
    assert!((pitch - pitch_deg).abs() <= within_deg, "{pitch} instead of {pitch_deg}");
}

/// Latitude and longitude of a place north and east of the vehicle, m.
fn place(flier: &Flier, north_m: f64, east_m: f64) -> [f64; 2] {
    let here_m = flier.vehicle().outputs().position_m;
    let there_m = here_m + nalgebra::Vector3::new(north_m, east_m, 0.0);
    let place = flier.vehicle().frame().to_geodetic(&there_m);
    [place.latitude_deg, place.longitude_deg]
}

/// Another system says where it is.
fn hear_system(flier: &mut Flier, [latitude, longitude]: [f64; 2], altitude_m: f64) {
    let position = MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        lat: (latitude * 1e7) as i32,
        lon: (longitude * 1e7) as i32,
        alt: (altitude_m * 1e3) as i32,
        ..GLOBAL_POSITION_INT_DATA::default()
    });
    let frame = Frame::encode(&position.into(), Version::Two, 0, (7, 1)).expect("a frame");
    let origin = autopilot::envelope::Origin { system: 7, component: 1, ..Bench::origin() };
    flier.bench.autopilot.receive(&origin, &frame);
}

/// Suite: Mount, the modes without a place.
#[test]
fn a_mount_is_pointed_by_commands_and_by_the_radio() {
    let mut flier = with_mount();
    pitches(&mut flier, NEUTRAL, 0.0, 0.0);
    assert_eq!(mount_deg(&mut flier), [0.0; 3]);
    flier.take_off(30.0, GUIDED);
    pitches(&mut flier, RADIO, 0.0, 1.0);
    for angle in [-20.0, -30.0] {
        let asked = [angle, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(flier.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, asked), ACCEPTED);
        pitches(&mut flier, COMMANDS, f64::from(angle), 1.0);
    }
    flier.set_all(&[
        ("RC6_OPTION", 0.0),
        ("RC11_OPTION", 212.0),
        ("RC12_OPTION", 213.0),
        ("RC13_OPTION", 214.0),
        ("RC12_MIN", 1100.0),
        ("RC12_MAX", 1900.0),
    ]);
    for (pulse_us, pitch_deg) in [(1500, 0.0), (1400, -11.25), (1800, 33.75)] {
        flier.rc(12, pulse_us);
        pitches(&mut flier, RADIO, pitch_deg, 0.1);
    }
    flier.set_all(&[
        ("RC12_MIN", 1000.0),
        ("RC12_MAX", 2000.0),
        ("MNT1_PITCH_MIN", -90.0),
        ("MNT1_PITCH_MAX", 10.0),
    ]);
    for (pulse_us, pitch_deg) in [(1000, -90.0), (2000, 10.0), (1500, -40.0)] {
        flier.rc(12, pulse_us);
        pitches(&mut flier, RADIO, pitch_deg, 0.1);
    }
    // With a rate it goes on from there, until the radio fails; with an angle it stays where it was then.
    flier.set_all(&[("MNT1_PITCH_MIN", -45.0), ("MNT1_PITCH_MAX", 45.0), ("MNT1_RC_RATE", 10.0)]);
    flier.rc(12, 1750);
    flier.fly(4.0);
    let [_, before, _] = mount_deg(&mut flier);
    assert!((before + 19.0).abs() < 3.0, "{before}");
    flier.set("SIM_RC_FAIL", 2.0);
    flier.fly(0.5);
    let [_, stays, _] = mount_deg(&mut flier);
    flier.fly(3.0);
    let [_, still, _] = mount_deg(&mut flier);
    assert!(stays >= before && still == stays, "{before} {stays} {still}");
}

/// Suite: MountRCFailAngle.
#[test]
fn a_servo_of_the_mount_stays_where_the_radio_left_it() {
    let mut flier = with_mount();
    flier.set("RC12_OPTION", 214.0);
    flier.rc(12, 1200);
    flier.fly(0.5);
    assert_eq!(flier.vehicle().output_us(7), 1200);
    flier.set("SIM_RC_FAIL", 2.0);
    flier.fly(5.0);
    assert_eq!(flier.vehicle().output_us(7), 1200);
}

/// Suite: Mount, what it looks at.
#[test]
fn a_mount_looks_at_places_and_at_other_systems_within_its_limits() {
    let mut flier = with_mount();
    flier.take_off(30.0, GUIDED);
    flier.fly(5.0);
    let [latitude, longitude] = place(&flier, 10.0, 20.0);
    let at = [0.0, 0.0, 0.0, 0.0, latitude as f32, longitude as f32, 0.0];
    flier.set("MNT1_PITCH_MIN", -90.0);
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, at), ACCEPTED);
    pitches(&mut flier, PLACE, -52.0, 5.0);
    flier.set("MNT1_PITCH_MIN", -45.0);
    pitches(&mut flier, PLACE, -45.0, 0.1);
    // Suite: clear_roi. A place of zeros is none, too.
    for none in [MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, MavCmd::MAV_CMD_DO_SET_ROI_NONE] {
        assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, at), ACCEPTED);
        pitches(&mut flier, PLACE, -45.0, 0.1);
        assert_eq!(flier.command(none, [0.0; 7]), ACCEPTED);
        flier.fly(0.2);
        let [_, pitch, _] = mount_deg(&mut flier);
        assert!(pitch.abs() < 1.0, "the radio points it again: {pitch}");
    }

    let track = [7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let ground_m = flier.vehicle().frame().origin().altitude_m;
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_ROI_SYSID, track), ACCEPTED);
    hear_system(&mut flier, [latitude, longitude], ground_m + 60.0);
    pitches(&mut flier, SYSTEM, 45.0, 0.1);
    hear_system(&mut flier, [latitude, longitude], ground_m + 40.0);
    flier.fly(0.2);
    let [_, seen, _] = mount_deg(&mut flier);
    assert!((seen - 24.0).abs() < 3.0, "{seen}");
    // It is not heard any more: the mount stays where it is, while the vehicle climbs.
    flier.fly(3.5);
    let [_, held, _] = mount_deg(&mut flier);
    flier.bench.send(local_target(0x0df8, [0.0, 0.0, -50.0], [0.0; 3]));
    flier.wait("50 m", 30.0, |flier| flier.height_m() > 49.0);
    let [_, still, _] = mount_deg(&mut flier);
    assert!((still - held).abs() < 0.1, "{held} {still}");
    hear_system(&mut flier, [latitude, longitude], ground_m + 40.0);
    flier.fly(0.2);
    let [_, tracks, _] = mount_deg(&mut flier);
    assert!(tracks < 0.0, "it looks down now: {tracks}");
}

/// Suite: MountPOIFromAuxFunction.
#[test]
fn a_switch_locks_the_mount_on_what_it_sees() {
    let mut flier = with_mount();
    flier.set("RC10_OPTION", 186.0);
    flier.rc(10, 1500);
    flier.take_off(10.0, GUIDED);
    flier.rc(6, 1000);
    flier.fly(0.5);
    let [_, pitch, _] = mount_deg(&mut flier);
    assert!((pitch + 45.0).abs() < 1.0, "{pitch}");
    flier.rc(10, 1900);
    flier.fly(1.0);
    flier.rc(10, 1500);
    flier.fly(1.0);
    let heading_rad = flier.vehicle().outputs().attitude_rad.z;
    flier.bench.send(local_target(0x0df8, [60.0, 0.0, -40.0], [0.0; 3]));
    flier.wait("there", 60.0, |flier| flier.distance_m() > 59.5 && flier.speed_m_s() < 0.1);
    let [_, pitch, yaw] = mount_deg(&mut flier);
    assert!((pitch + 45.0).abs() < 1.0 && yaw.abs() < 1.0, "{pitch} {yaw}");
    flier.rc(10, 1900);
    flier.fly(0.5);
    // The place is 10 m ahead of where it was seen from.
    let (sin, cos) = heading_rad.sin_cos();
    let here_m = flier.vehicle().outputs().position_m;
    let way = nalgebra::Vector2::new(10.0 * cos - here_m.x, 10.0 * sin - here_m.y);
    let expected_deg = -(-here_m.z).atan2(way.norm()).to_degrees();
    let bearing_deg = (way.y.atan2(way.x) - flier.vehicle().outputs().attitude_rad.z).to_degrees();
    let [_, pitch, yaw] = mount_deg(&mut flier);
    assert!((pitch - expected_deg).abs() < 1.0, "{pitch} {expected_deg}");
    assert!(((yaw - bearing_deg + 540.0) % 360.0 - 180.0).abs() < 1.5, "{yaw} {bearing_deg}");
}

/// DO_MOUNT_CONTROL: its seven parameters, and what is answered.
fn control(flier: &mut Flier, parameters: [f32; 7]) -> u8 {
    let answer = flier.command(MavCmd::MAV_CMD_DO_MOUNT_CONTROL, parameters);
    flier.fly(0.2);
    answer
}

/// Suite: MAV_CMD_DO_MOUNT_CONTROL.
#[test]
fn one_command_points_a_mount_by_its_mode() {
    let mut flier = with_mount();
    flier.set_all(&[("MNT1_RETRACT_X", 13.0), ("MNT1_RETRACT_Y", 23.0), ("MNT1_RETRACT_Z", 33.0)]);
    flier.take_off(20.0, GUIDED);
    flier.fly(5.0);
    let [latitude, longitude] = place(&flier, 20.0, 0.0).map(|degrees| degrees as f32);
    assert_eq!(control(&mut flier, [0.0, 0.0, 0.0, 0.0, latitude, longitude, PLACE]), ACCEPTED);
    assert!((mount_deg(&mut flier)[1] + 45.0).abs() < 5.0);
    flier.set("MNT1_PITCH_MIN", -90.0);
    assert_eq!(control(&mut flier, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 6.0]), ACCEPTED);
    assert!((mount_deg(&mut flier)[1] + 90.0).abs() < 5.0, "home is below");
    assert_eq!(control(&mut flier, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 87.0]), FAILED);
    assert_eq!(control(&mut flier, [20.0, 15.0, 30.0, 0.0, 0.0, 0.0, COMMANDS]), ACCEPTED);
    let near = |angles: [f64; 3], expected: [f64; 3]| {
        angles.iter().zip(expected).all(|(angle, expected)| (angle - expected).abs() < 1.0)
    };
    assert!(near(mount_deg(&mut flier), [15.0, 20.0, 30.0]));
    assert_eq!(control(&mut flier, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, RADIO]), ACCEPTED);
    flier.rc(6, 2000);
    flier.fly(0.2);
    assert!((mount_deg(&mut flier)[1] - 45.0).abs() < 0.1);
    assert_eq!(control(&mut flier, [0.0; 7]), ACCEPTED);
    assert!(near(mount_deg(&mut flier), [13.0, 23.0, 33.0]));
}

/// Suite: MAV_CMD_AIRFRAME_CONFIGURATION. The gear hangs loose until it is moved.
#[test]
fn a_landing_gear_moves_between_the_ends_of_its_output() {
    let mut flier = Flier::new();
    let gear = |flier: &mut Flier, position: f32| {
        let parameters = [-1.0, position, 0.0, 0.0, 0.0, 0.0, 0.0];
        flier.command(MavCmd::MAV_CMD_AIRFRAME_CONFIGURATION, parameters)
    };
    assert_eq!(gear(&mut flier, 0.0), FAILED);
    flier.set_all(&[
        ("LGR_ENABLE", 1.0),
        ("SERVO10_FUNCTION", 29.0),
        ("SERVO10_MIN", 1001.0),
        ("SERVO10_MAX", 1999.0),
    ]);
    flier.reboot();
    assert_eq!(flier.vehicle().output_us(10), 0);
    for (position, pulse_us) in [(0.0, 1999), (1.0, 1001), (0.0, 1999)] {
        assert_eq!(gear(&mut flier, position), ACCEPTED);
        assert_eq!(flier.vehicle().output_us(10), pulse_us);
    }
}
