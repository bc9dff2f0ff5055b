//! Servos, relays, gripper, camera and gimbal by their commands and messages, as MAVLink specifies them.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common::{Bench, command_long, ftp_client, settings};
use autopilot::codec::{Frame, Message, Version};
use autopilot::envelope::{Destination, Outgoing};
use mavlink::dialects::ardupilotmega::*;
use mavlink::{Message as _, MessageData};
use nalgebra::{Quaternion, UnitQuaternion};
use vehicle::VehicleSettings;
use vehicle::equipment::EquipmentVoice;
use vehicle::identity::Identity;

const NAN: f32 = f32::NAN;
const ACCEPTED: u8 = MavResult::MAV_RESULT_ACCEPTED as u8;
const DENIED: u8 = MavResult::MAV_RESULT_DENIED as u8;
const UNSUPPORTED: u8 = MavResult::MAV_RESULT_UNSUPPORTED as u8;
const FAILED: u8 = MavResult::MAV_RESULT_FAILED as u8;
const CAMERA: u8 = 100;
const GIMBAL: u8 = 154;

/// The latest message of a kind that was heard.
macro_rules! heard {
    ($bench:expr, $kind:ident) => {
        $bench
            .heard
            .iter()
            .rev()
            .find_map(|message| match message {
                Message::Typed(MavMessage::$kind(data)) => Some(data.clone()),
                _ => None,
            })
            .expect(stringify!($kind))
    };
}

/// Asks for a message, and returns it.
macro_rules! asked {
    ($bench:expr, $kind:ident, $data:ident) => {{
        let id = <$data as mavlink::MessageData>::ID as f32;
        assert_eq!(
            $bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [id, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ACCEPTED
        );
        heard!($bench, $kind)
    }};
}

/// Sends a command to a component; the result, and the components that have sent something.
fn command_to(
    bench: &mut Bench,
    component: u8,
    number: MavCmd,
    parameters: [f32; 7],
) -> (u8, Vec<(u32, u8)>) {
    let MavMessage::COMMAND_LONG(long) = command_long(number, parameters, 0) else { unreachable!() };
    let long = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { target_component: component, ..long });
    let frame = bench.frame(long);
    bench.autopilot.receive(&Bench::origin(), &frame);
    let outgoing: Vec<_> = bench.autopilot.take_outgoing().collect();
    // Who is new is greeted with a heartbeat and a line of text.
    let answers = outgoing.iter().filter(|outgoing| {
        outgoing.to == Destination::Peer(Bench::origin().peer) && ![0, 253].contains(&outgoing.message.id())
    });
    let senders = answers.map(|outgoing| (outgoing.message.id(), outgoing.component)).collect();
    bench.heard = outgoing.into_iter().map(|outgoing| outgoing.message).collect();
    (bench.acks().last().expect("every command is answered").result, senders)
}

fn servo(bench: &mut Bench, channel: usize) -> u16 {
    let raw = asked!(bench, SERVO_OUTPUT_RAW, SERVO_OUTPUT_RAW_DATA);
    match channel {
        5 => raw.servo5_raw,
        8 => raw.servo8_raw,
        9 => raw.servo9_raw,
        _ => panic!("{channel}"),
    }
}

#[test]
fn servos_are_seen_where_they_were_put() {
    let mut bench = Bench::new(Identity::ArduPilot);
    let set = |bench: &mut Bench, channel: f32, pulse: f32| {
        bench.command(MavCmd::MAV_CMD_DO_SET_SERVO, [channel, pulse, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    assert_eq!(set(&mut bench, 9.0, 1900.0), ACCEPTED);
    assert_eq!(servo(&mut bench, 9), 1900);
    assert_eq!(set(&mut bench, 1.0, 1900.0), FAILED, "a rotor's");
    assert_eq!(set(&mut bench, 9.0, 9000.0), DENIED);
    let repeat = [8.0, 1200.0, 2.0, 1.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPEAT_SERVO, repeat), ACCEPTED);
    let mut seen = Vec::new();
    for _ in 0..30 {
        bench.fly(0.1);
        let pulse = servo(&mut bench, 8);
        if seen.last() != Some(&pulse) {
            seen.push(pulse);
        }
    }
    assert_eq!(seen, [1200, 1500, 1200, 1500]);
    let actuators = [0.5, NAN, NAN, NAN, NAN, NAN, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ACTUATOR, actuators), ACCEPTED);
    assert_eq!(servo(&mut bench, 5), 1750);
}

#[test]
fn relays_are_switched_one_by_one_and_a_gripper_says_what_it_does() {
    let mut bench = Bench::new(Identity::ArduPilot);
    let relay = |bench: &mut Bench, number: f32, state: f32| {
        bench.command(MavCmd::MAV_CMD_DO_SET_RELAY, [number, state, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    let on = |bench: &mut Bench| asked!(bench, RELAY_STATUS, RELAY_STATUS_DATA).on;
    assert_eq!((relay(&mut bench, 0.0, 1.0), on(&mut bench)), (ACCEPTED, 0b01));
    assert_eq!((relay(&mut bench, 1.0, 1.0), on(&mut bench)), (ACCEPTED, 0b11));
    assert_eq!((relay(&mut bench, 0.0, 0.0), on(&mut bench)), (ACCEPTED, 0b10));
    assert_eq!((relay(&mut bench, 1.0, -1.0), on(&mut bench)), (ACCEPTED, 0b00));
    assert_eq!(relay(&mut bench, 9.0, 1.0), FAILED);
    let repeat = [0.0, 3.0, 0.2, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPEAT_RELAY, repeat), ACCEPTED);
    let mut changes = 0;
    let mut last = on(&mut bench);
    for _ in 0..200 {
        bench.fly(0.01);
        let now = on(&mut bench);
        changes += u32::from(now != last);
        last = now;
    }
    assert_eq!((changes, last), (6, 0), "three times there and back");
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GRIPPER, [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
    bench.fly(1.1);
    assert!(
        bench.texts().ends_with(&["Gripper load grabbing".to_owned(), "Gripper load grabbed".to_owned()])
    );
}

#[test]
fn the_camera_takes_images_one_by_one_and_at_an_interval() {
    let mut bench = Bench::hovering(Identity::Px4);
    let information = asked!(bench, CAMERA_INFORMATION, CAMERA_INFORMATION_DATA);
    assert!(information.flags.contains(CameraCapFlags::CAMERA_CAP_FLAGS_CAPTURE_IMAGE));
    assert!(!information.flags.contains(CameraCapFlags::CAMERA_CAP_FLAGS_HAS_VIDEO_STREAM));
    assert_eq!(information.cam_definition_uri.to_str().unwrap_or(""), "mftp://camera.xml");
    let start = |interval: f32, count: f32| [0.0, interval, count, 1.0, NAN, NAN, NAN];
    assert_eq!(bench.command(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, start(0.0, 1.0)), ACCEPTED);
    bench.fly(0.01);
    let image = heard!(bench, CAMERA_IMAGE_CAPTURED);
    assert_eq!((image.image_index, image.capture_result), (0, MavBool::MAV_BOOL_TRUE));
    let place =
        bench.autopilot.vehicle().frame().to_geodetic(&bench.autopilot.vehicle().outputs().position_m);
    assert!((f64::from(image.lat) / 1e7 - place.latitude_deg).abs() < 1e-6);
    assert!((image.relative_alt - 10_000).abs() < 300, "{}", image.relative_alt);
    // Three, half a second apart.
    assert_eq!(bench.command(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, start(0.5, 3.0)), ACCEPTED);
    bench.fly(0.7);
    let status = asked!(bench, CAMERA_CAPTURE_STATUS, CAMERA_CAPTURE_STATUS_DATA);
    assert_eq!((status.image_status, status.image_interval, status.image_count), (3, 0.5, 3));
    bench.fly(2.0);
    let status = asked!(bench, CAMERA_CAPTURE_STATUS, CAMERA_CAPTURE_STATUS_DATA);
    assert_eq!((status.image_status, status.image_count), (0, 4));
    // Without an end, until it is stopped.
    assert_eq!(bench.command(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, start(0.2, 0.0)), ACCEPTED);
    assert_ne!(
        bench.command(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, start(0.3, 0.0)),
        ACCEPTED,
        "one at a time"
    );
    bench.fly(1.0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_IMAGE_STOP_CAPTURE, [0.0; 7]), ACCEPTED);
    let count = asked!(bench, CAMERA_CAPTURE_STATUS, CAMERA_CAPTURE_STATUS_DATA).image_count;
    bench.fly(1.0);
    assert_eq!(asked!(bench, CAMERA_CAPTURE_STATUS, CAMERA_CAPTURE_STATUS_DATA).image_count, count);
    assert!((9..=10).contains(&count), "{count}");
    // What was missed can be asked for again.
    let id = 263.0;
    assert_eq!(bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [id, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
    assert_eq!(heard!(bench, CAMERA_IMAGE_CAPTURED).image_index, 1);
    let storage = asked!(bench, STORAGE_INFORMATION, STORAGE_INFORMATION_DATA);
    assert_eq!(storage.used_capacity, 8.0 * count as f32);
    assert_eq!(bench.command(MavCmd::MAV_CMD_STORAGE_FORMAT, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
    assert_eq!(heard!(bench, STORAGE_INFORMATION).used_capacity, 0.0);
    assert_eq!(asked!(bench, CAMERA_CAPTURE_STATUS, CAMERA_CAPTURE_STATUS_DATA).image_count, 0);
}

/// QGroundControl asks the camera, MAVSDK the autopilot.
#[test]
fn the_definition_is_read_from_who_is_asked() {
    let mut bench = Bench::new(Identity::Px4);
    for component in [CAMERA, 1] {
        let name = b"/camera.xml";
        let request = ftp_client::request(0, ftp_client::OPEN, 0, name.len() as u8, 0, name);
        let MavMessage::FILE_TRANSFER_PROTOCOL(request) = request else { unreachable!() };
        let request = FILE_TRANSFER_PROTOCOL_DATA { target_component: component, ..request };
        let frame = bench.frame(MavMessage::FILE_TRANSFER_PROTOCOL(request));
        bench.autopilot.receive(&Bench::origin(), &frame);
        bench.autopilot.transfer(1, |_| Some(true));
        let outgoing: Vec<_> = bench.autopilot.take_outgoing().collect();
        let answers = |outgoing: &&Outgoing| outgoing.message.id() == FILE_TRANSFER_PROTOCOL_DATA::ID;
        let senders: Vec<u8> = outgoing.iter().filter(answers).map(|outgoing| outgoing.component).collect();
        assert_eq!(senders, [component]);
        let heard: Vec<_> = outgoing.into_iter().map(|outgoing| outgoing.message).collect();
        assert!(ftp_client::answers(&heard)[0].result.is_ok(), "it is there");
    }
}

#[test]
fn mode_zoom_and_focus_are_what_was_asked_for_and_there_is_no_video_stream() {
    let mut bench = Bench::new(Identity::Px4);
    let set = |bench: &mut Bench, number, first: f32, second: f32| {
        bench.command(number, [first, second, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_SET_CAMERA_MODE, 0.0, 1.0), ACCEPTED);
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_SET_CAMERA_ZOOM, 2.0, 40.0), ACCEPTED);
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_SET_CAMERA_FOCUS, 3.0, 1.0), ACCEPTED);
    let settings = asked!(bench, CAMERA_SETTINGS, CAMERA_SETTINGS_DATA);
    assert_eq!(
        (settings.mode_id, settings.zoomLevel, settings.focusLevel),
        (CameraMode::CAMERA_MODE_VIDEO, 40.0, 50.0)
    );
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_SET_CAMERA_MODE, 0.0, 7.0), DENIED);
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_VIDEO_START_CAPTURE, 0.0, 0.0), ACCEPTED);
    bench.fly(1.5);
    let status = asked!(bench, CAMERA_CAPTURE_STATUS, CAMERA_CAPTURE_STATUS_DATA);
    assert_eq!((status.video_status, status.recording_time_ms), (1, 1500));
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_VIDEO_STOP_CAPTURE, 0.0, 0.0), ACCEPTED);
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_REQUEST_VIDEO_STREAM_INFORMATION, 0.0, 1.0), UNSUPPORTED);
    assert_eq!(set(&mut bench, MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS, 1.0, 0.0), ACCEPTED);
    let settings = asked!(bench, CAMERA_SETTINGS, CAMERA_SETTINGS_DATA);
    assert_eq!((settings.mode_id, settings.zoomLevel), (CameraMode::CAMERA_MODE_IMAGE, 0.0));
}

/// Roll, pitch and yaw of the gimbal, degrees, and its flags.
fn gimbal(bench: &mut Bench) -> ([f64; 3], GimbalDeviceFlags) {
    let status = asked!(bench, GIMBAL_DEVICE_ATTITUDE_STATUS, GIMBAL_DEVICE_ATTITUDE_STATUS_DATA);
    let [w, x, y, z] = status.q.map(f64::from);
    let (roll, pitch, yaw) = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).euler_angles();
    ([roll, pitch, yaw].map(f64::to_degrees), status.flags)
}

fn near(one: [f64; 3], other: [f64; 3]) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() < 0.5)
}

const TAKE_CONTROL: [f32; 7] = [255.0, 190.0, -1.0, -1.0, NAN, NAN, 0.0];
const GIVE_UP: [f32; 7] = [-3.0, -3.0, -3.0, -3.0, NAN, NAN, 0.0];

#[test]
fn only_who_is_in_control_points_the_gimbal() {
    let mut bench = Bench::hovering(Identity::Px4);
    let down = [-45.0, 30.0, NAN, NAN, 12.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, down), DENIED);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, TAKE_CONTROL), ACCEPTED);
    let status = heard!(bench, GIMBAL_MANAGER_STATUS);
    assert_eq!((status.primary_control_sysid, status.primary_control_compid), (255, 190), "told at once");
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, down), ACCEPTED);
    bench.fly(2.0);
    let (angles, flags) = gimbal(&mut bench);
    assert!(near(angles, [0.0, -45.0, 30.0]), "{angles:?}");
    assert!(flags.contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME));
    // The message of the manager, with the yaw kept from north while the vehicle turns.
    bench.send(MavMessage::GIMBAL_MANAGER_SET_PITCHYAW(GIMBAL_MANAGER_SET_PITCHYAW_DATA {
        flags: GimbalManagerFlags::GIMBAL_MANAGER_FLAGS_YAW_LOCK,
        pitch: -0.5,
        yaw: 1.0,
        pitch_rate: NAN,
        yaw_rate: NAN,
        target_system: 1,
        target_component: 1,
        gimbal_device_id: 1,
    }));
    let turn = [0.0, 0.0, 0.0, 2.0, NAN, NAN, NAN];
    assert_eq!(
        bench.command(MavCmd::MAV_CMD_DO_REPOSITION, [-1.0, 1.0, 0.0, turn[3], NAN, NAN, NAN]),
        ACCEPTED
    );
    bench.fly(6.0);
    let (angles, flags) = gimbal(&mut bench);
    assert!(near(angles, [0.0, f64::to_degrees(-0.5), f64::to_degrees(1.0)]), "{angles:?}");
    assert!(flags.contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_LOCK));
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, GIVE_UP), ACCEPTED);
    assert_eq!(heard!(bench, GIMBAL_MANAGER_STATUS).primary_control_sysid, 0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, down), DENIED);
    // ArduPilot asks nobody.
    let mut bench = Bench::new(Identity::ArduPilot);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, down), ACCEPTED);
}

#[test]
fn the_gimbal_turns_by_rates_and_says_where_it_ends() {
    let mut bench = Bench::new(Identity::ArduPilot);
    let information = asked!(bench, GIMBAL_MANAGER_INFORMATION, GIMBAL_MANAGER_INFORMATION_DATA);
    let device = asked!(bench, GIMBAL_DEVICE_INFORMATION, GIMBAL_DEVICE_INFORMATION_DATA);
    assert_eq!(information.pitch_max, device.pitch_max);
    assert_eq!(
        (information.gimbal_device_id, device.gimbal_device_id),
        (1, 1),
        "one that is the autopilot's"
    );
    let up = [NAN, NAN, 10.0, 0.0, 12.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, up), ACCEPTED);
    bench.fly(2.0);
    let (angles, _) = gimbal(&mut bench);
    assert!(near(angles, [0.0, 20.0, 0.0]), "{angles:?}");
    bench.fly(10.0);
    let status = asked!(bench, GIMBAL_DEVICE_ATTITUDE_STATUS, GIMBAL_DEVICE_ATTITUDE_STATUS_DATA);
    assert!(status.failure_flags.contains(GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_PITCH_LIMIT));
    assert!((gimbal(&mut bench).0[1].to_radians() as f32 - information.pitch_max).abs() < 1e-3);
    let retract = [NAN, NAN, NAN, NAN, 1.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, retract), ACCEPTED);
    assert!(gimbal(&mut bench).1.contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_RETRACT));
    let mount = [-30.0, 0.0, 60.0, 0.0, 0.0, 0.0, 2.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_MOUNT_CONTROL, mount), ACCEPTED);
    bench.fly(2.0);
    let status = asked!(bench, MOUNT_STATUS, MOUNT_STATUS_DATA);
    assert_eq!((status.pointing_a, status.pointing_b, status.pointing_c), (-3000, 0, 6000));
}

#[test]
fn the_gimbal_looks_at_a_place_and_at_another_system() {
    let mut bench = Bench::hovering(Identity::Px4);
    let here = bench.autopilot.vehicle().outputs().position_m;
    let place =
        bench.autopilot.vehicle().frame().to_geodetic(&(here + nalgebra::Vector3::new(0.0, 10.0, 10.0)));
    let [lat, lon, alt] =
        [place.latitude_deg, place.longitude_deg, place.altitude_m].map(|value| value as f32);
    let roi = [0.0, 0.0, 0.0, 0.0, lat, lon, alt];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, roi), ACCEPTED);
    bench.fly(4.0);
    let (angles, flags) = gimbal(&mut bench);
    assert!((angles[1] + 45.0).abs() < 5.0 && (angles[2] - 90.0).abs() < 5.0, "{angles:?}");
    assert!(flags.contains(GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_LOCK));
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI_NONE, [0.0; 7]), ACCEPTED);
    bench.fly(3.0);
    assert!(near(gimbal(&mut bench).0, [0.0; 3]), "ahead again");
    // MAVSDK sends altitudes above sea level in a frame that is relative, and PX4 does not look at the frame.
    bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command: MavCmd::MAV_CMD_DO_SET_ROI_LOCATION,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: alt,
        ..COMMAND_INT_DATA::default()
    }));
    bench.fly(4.0);
    let (angles, _) = gimbal(&mut bench);
    assert!((angles[1] + 45.0).abs() < 5.0 && (angles[2] - 90.0).abs() < 5.0, "{angles:?}");
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI_NONE, [0.0; 7]), ACCEPTED);
    bench.fly(3.0);
    // Another system says where it is: 20 m south, on the ground.
    let follow = [7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI_SYSID, follow), ACCEPTED);
    let place =
        bench.autopilot.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(here.x - 20.0, here.y, 0.0));
    let position = MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        lat: (place.latitude_deg * 1e7) as i32,
        lon: (place.longitude_deg * 1e7) as i32,
        alt: (place.altitude_m * 1e3) as i32,
        ..GLOBAL_POSITION_INT_DATA::default()
    });
    let frame = Frame::encode(&position.into(), Version::Two, 0, (7, 1)).expect("a frame");
    let origin = autopilot::envelope::Origin { system: 7, component: 1, ..Bench::origin() };
    bench.autopilot.receive(&origin, &frame);
    bench.fly(4.0);
    let (angles, _) = gimbal(&mut bench);
    assert!((angles[1] + 26.6).abs() < 2.0 && angles[2].abs() > 178.0, "{angles:?}");
}

#[test]
fn components_answer_for_themselves_and_are_heard_only_if_they_may() {
    let request = |id: u32| [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let (information, device) = (CAMERA_INFORMATION_DATA::DEFAULT, GIMBAL_DEVICE_INFORMATION_DATA::DEFAULT);
    let information = MavMessage::CAMERA_INFORMATION(information).message_id();
    let device = MavMessage::GIMBAL_DEVICE_INFORMATION(device).message_id();
    const ACK: u32 = 77;
    for voice in [EquipmentVoice::Autopilot, EquipmentVoice::Own] {
        let own = voice == EquipmentVoice::Own;
        let mut bench = Bench::of(&VehicleSettings { equipment: voice, ..settings(Identity::Px4) });
        let number = MavCmd::MAV_CMD_REQUEST_MESSAGE;
        // Who is asked answers.
        let to_camera = command_to(&mut bench, CAMERA, number, request(information));
        assert_eq!(to_camera, (ACCEPTED, vec![(ACK, CAMERA), (information, CAMERA)]));
        let to_gimbal = command_to(&mut bench, GIMBAL, number, request(device));
        assert_eq!(to_gimbal, (ACCEPTED, vec![(ACK, GIMBAL), (device, GIMBAL)]));
        assert_eq!(command_to(&mut bench, CAMERA, number, request(device)).0, UNSUPPORTED, "it is no gimbal");
        let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(command_to(&mut bench, CAMERA, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm).0, UNSUPPORTED);
        assert!(!bench.autopilot.vehicle().is_armed());
        // The autopilot answers what is for it, or for all.
        let speaks = if own { CAMERA } else { 1 };
        for component in [0, 1] {
            let (result, senders) = command_to(&mut bench, component, number, request(information));
            assert_eq!((result, senders), (ACCEPTED, vec![(ACK, 1), (information, speaks)]));
        }
        let mut beats = Vec::new();
        for _ in 0..2500 {
            bench.autopilot.tick().expect("the flight goes on");
            let outgoing = bench.autopilot.take_outgoing();
            beats.extend(
                outgoing.filter(|outgoing| outgoing.message.id() == 0).map(|outgoing| outgoing.component),
            );
        }
        let of = |component: u8| beats.iter().filter(|sender| **sender == component).count();
        let expected = if own { (2, 2, 2) } else { (2, 0, 0) };
        assert_eq!((of(1), of(CAMERA), of(GIMBAL)), expected, "{voice:?}");
    }
}
