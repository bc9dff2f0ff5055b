//! What is streamed, and how often: SRn_ parameters, the groups of REQUEST_DATA_STREAM, terrain and the board.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use super::flier::*;
use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::*;
use vehicle::plan::{PlanKind, command};

/// Messages of a second that a choice takes.
fn per_second(flier: &mut Flier, choose: impl Fn(&MavMessage) -> bool) -> usize {
    flier.bench.heard.clear();
    flier.fly(1.0);
    flier.all(|message| choose(message).then_some(())).len()
}

/// A second may begin or end with a message.
fn is_near(count: usize, rate_hz: usize) -> bool {
    count.abs_diff(rate_hz) <= 1
}

fn check_attitudes(flier: &mut Flier, rate_hz: usize, why: &str) {
    let count = per_second(flier, |message| matches!(message, MavMessage::ATTITUDE(_)));
    assert!(is_near(count, rate_hz), "{count}, not {rate_hz}: {why}");
}

/// Ground stations set the rates of the first link by parameters; what a client asks for itself comes first.
#[test]
fn rates_of_groups_follow_their_parameters() {
    let mut flier = Flier::new();
    flier.set("SR0_EXTRA1", 4.0);
    check_attitudes(&mut flier, 15, "shown as that before, and not set");
    flier.set("SR0_EXTRA1", 20.0);
    check_attitudes(&mut flier, 20, "as the parameter says");
    flier.set("SR1_EXTRA1", 50.0);
    check_attitudes(&mut flier, 20, "another link");
    flier.reboot();
    check_attitudes(&mut flier, 20, "kept over a reboot");
    let every_200_ms = [ATTITUDE_DATA::ID as f32, 200_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, every_200_ms), ACCEPTED);
    flier.set("SR0_EXTRA1", 10.0);
    check_attitudes(&mut flier, 5, "as the client has asked");
    let default = [ATTITUDE_DATA::ID as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, default), ACCEPTED);
    check_attitudes(&mut flier, 10, "the default is that of the parameter");
    flier.set("SR0_EXTRA1", 20.0);
    check_attitudes(&mut flier, 20, "and stays so");
    flier.set("SR0_EXT_STAT", 0.0);
    assert_eq!(per_second(&mut flier, |message| matches!(message, MavMessage::SYS_STATUS(_))), 0);
}

/// ArduCopter's groups: clients ask for one and wait for messages of it.
#[test]
#[allow(deprecated)] // MAVProxy and DroneKit send it.
fn groups_bring_what_arducopters_bring() {
    let groups: [(MavDataStream, &[u32]); 4] = [
        (
            MavDataStream::MAV_DATA_STREAM_EXTENDED_STATUS,
            &[
                SYS_STATUS_DATA::ID,
                POWER_STATUS_DATA::ID,
                MEMINFO_DATA::ID,
                MISSION_CURRENT_DATA::ID,
                GPS_RAW_INT_DATA::ID,
                NAV_CONTROLLER_OUTPUT_DATA::ID,
                FENCE_STATUS_DATA::ID,
            ],
        ),
        (MavDataStream::MAV_DATA_STREAM_EXTRA1, &[ATTITUDE_DATA::ID, SIMSTATE_DATA::ID, AHRS2_DATA::ID]),
        (
            MavDataStream::MAV_DATA_STREAM_EXTRA3,
            &[
                SYSTEM_TIME_DATA::ID,
                TERRAIN_REPORT_DATA::ID,
                BATTERY_STATUS_DATA::ID,
                EKF_STATUS_REPORT_DATA::ID,
                VIBRATION_DATA::ID,
            ],
        ),
        (
            MavDataStream::MAV_DATA_STREAM_POSITION,
            &[GLOBAL_POSITION_INT_DATA::ID, LOCAL_POSITION_NED_DATA::ID],
        ),
    ];
    for (group, ids) in groups {
        let mut flier = Flier::new();
        flier.bench.send(MavMessage::REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA {
            req_message_rate: 8,
            target_system: 1,
            target_component: 1,
            req_stream_id: group,
            start_stop: 1,
        }));
        for id in ids {
            let count = per_second(&mut flier, |message| mavlink::Message::message_id(message) == *id);
            assert!(is_near(count, 8), "{group:?}: {count} messages {id}");
        }
    }
}

/// The ground is flat, at the height of home: of the vehicle and of any place that is asked for.
#[test]
fn terrain_is_reported_and_checked() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    let ground_m = flier.vehicle().frame().origin().altitude_m;
    let report = |message: &MavMessage| match message {
        MavMessage::TERRAIN_REPORT(report) => Some(report.clone()),
        _ => None,
    };
    let asked = [TERRAIN_REPORT_DATA::ID as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, asked), ACCEPTED);
    let below = flier.latest(report).expect("a report");
    assert!((f64::from(below.terrain_height) - ground_m).abs() < 1e-3 && below.spacing > 0, "{below:?}");
    assert!((f64::from(below.current_height) - flier.height_m()).abs() < 0.1 && below.pending == 0);
    let (lat, lon) = (below.lat + 12_345, below.lon - 54_321);
    flier.bench.heard.clear();
    flier.bench.send(MavMessage::TERRAIN_CHECK(TERRAIN_CHECK_DATA { lat, lon }));
    let there = flier.latest(report).expect("an answer");
    assert_eq!((there.lat, there.lon, there.terrain_height), (lat, lon, below.terrain_height));
}

/// Mission Planner and older clients ask for these when they connect.
#[test]
fn it_introduces_itself_when_it_is_asked() {
    let mut flier = Flier::new();
    let banner = MavCmd::MAV_CMD_DO_SEND_BANNER;
    assert_eq!(flier.command(banner, [0.0; 7]), ACCEPTED);
    assert!(flier.has_said("simulated quadrotor"), "{:?}", flier.bench.texts());
    // DroneKit's tests look for the name of the vehicle.
    assert!(flier.has_said("ArduCopter"), "{:?}", flier.bench.texts());
    flier.bench.heard.clear();
    flier.bench.send(MavMessage::AUTOPILOT_VERSION_REQUEST(AUTOPILOT_VERSION_REQUEST_DATA {
        target_system: 1,
        target_component: 1,
    }));
    let version = flier.latest(|message| match message {
        MavMessage::AUTOPILOT_VERSION(version) => Some(version.flight_sw_version),
        _ => None,
    });
    assert!(version.is_some_and(|version| version >> 24 == 4), "{version:?}");
}

/// What a client that asks for it is told.
fn utm_position(flier: &mut Flier) -> UTM_GLOBAL_POSITION_DATA {
    let parameters = [UTM_GLOBAL_POSITION_DATA::ID as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    flier.bench.heard.clear();
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters), ACCEPTED);
    let told = flier.latest(|message| match message {
        MavMessage::UTM_GLOBAL_POSITION(position) => Some(position.clone()),
        _ => None,
    });
    told.expect("it was asked for")
}

/// Suite: UTMGlobalPosition, UTMGlobalPositionWaypoint.
#[test]
fn a_traffic_management_is_told_where_it_flies_to() {
    let mut flier = Flier::new();
    let next = UtmDataAvailFlags::UTM_DATA_AVAIL_FLAGS_NEXT_WAYPOINT_AVAILABLE;
    let ground = utm_position(&mut flier);
    assert_eq!(ground.flight_state, UtmFlightState::UTM_FLIGHT_STATE_GROUND);
    assert!(!ground.flags.contains(next) && ground.uas_id.iter().any(|byte| *byte != 0), "{ground:?}");
    flier.take_off(20.0, GUIDED);
    let place = crate::common::requests::local_target(0b1101_1111_1000, [100.0, 0.0, -20.0], [0.0; 3]);
    flier.bench.send(place);
    flier.fly(1.0);
    let flying = utm_position(&mut flier);
    assert_eq!(flying.flight_state, UtmFlightState::UTM_FLIGHT_STATE_AIRBORNE);
    // 100 m are 8993 units of latitude on a sphere, and within 1 % of that on the ellipsoid.
    let way = flying.next_lat - ground.lat;
    assert!(flying.flags.contains(next) && way.abs_diff(8993) < 90, "{way}");
    assert!((flying.relative_alt - 20_000).abs() < 1500 && flying.vx > 50, "{flying:?}");
}

/// Suite: UTMGlobalPositionWaypoint: as soon as a step of a mission is the current one.
#[test]
fn the_place_of_a_step_is_told_before_its_way_begins() {
    let mut flier =
        with_mission(&[(command::NAV_TAKEOFF, 0.0, 0.0, 20.0), (command::NAV_WAYPOINT, 100.0, 0.0, 20.0)]);
    flier.change_mode(AUTO);
    flier.arm();
    flier.wait("the place", 60.0, |flier| flier.vehicle().mission_status().current == 2);
    let told = utm_position(&mut flier);
    let place = flier.vehicle().plans().get(PlanKind::Mission).items()[2].position;
    assert!((f64::from(told.next_lat) - place[0] * 1e7).abs() < 2.0, "{told:?} {place:?}");
}

/// On a curve, too, it is told where that leads; off the line is off the curve, not off the straight way.
#[test]
fn on_a_spline_its_end_is_told() {
    let mut flier = with_mission(&[
        (command::NAV_TAKEOFF, 0.0, 0.0, 20.0),
        (command::NAV_SPLINE_WAYPOINT, 60.0, 0.0, 20.0),
        (command::NAV_SPLINE_WAYPOINT, 60.0, 60.0, 20.0),
    ]);
    flier.take_off(20.0, GUIDED);
    flier.change_mode(AUTO);
    flier.wait("the second place", 60.0, |flier| flier.vehicle().mission_status().current == 3);
    flier.fly(3.0);
    let told = utm_position(&mut flier);
    let items = flier.vehicle().plans().get(PlanKind::Mission).items();
    let place = items[3].position;
    assert!((f64::from(told.next_lat) - place[0] * 1e7).abs() < 2.0, "{told:?} {place:?}");
    assert!((f64::from(told.next_lon) - place[1] * 1e7).abs() < 2.0, "{told:?} {place:?}");
    let here_m = flier.vehicle().outputs().position_m;
    assert!(here_m.x > 61.0, "the curve leaves the straight way: {here_m}");
    let (_, cross_track_m) = flier.vehicle().leg_errors().expect("a leg");
    assert!(cross_track_m.abs() < 0.1, "{cross_track_m}");
}

/// PREFLIGHT_CALIBRATION, parameter 4: the ground station sees the pulses, and sticks arm nothing until it is over.
#[test]
fn a_radio_is_calibrated_without_steering() {
    let mut flier = Flier::new();
    flier.change_mode(STABILIZE);
    let radio = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, radio), ACCEPTED);
    flier.rc(4, 2000);
    flier.fly(3.0);
    let yaw = flier.latest(|message| match message {
        MavMessage::RC_CHANNELS(channels) => Some(channels.chan4_raw),
        _ => None,
    });
    assert_eq!((yaw, flier.is_armed()), (Some(2000), false));
    assert_eq!(flier.obstacles(), ["PreArm: RC calibrating"]);
    assert_eq!(flier.command(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, [0.0; 7]), ACCEPTED);
    flier.wait("armed by the rudder", 4.0, |flier| flier.is_armed());
}

/// Trims leave the radio as it is, and who arms by force ends a calibration.
#[test]
fn a_radio_steers_after_its_trims_and_once_it_is_armed() {
    let mut flier = Flier::new();
    flier.change_mode(STABILIZE);
    let trims = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, trims), ACCEPTED);
    flier.fly(0.1);
    assert!(flier.obstacles().is_empty());
    let radio = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION, radio), ACCEPTED);
    flier.fly(0.1);
    let by_force = [1.0, 2989.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, by_force), ACCEPTED);
    flier.rc(3, 1900);
    flier.wait("a climb by the stick", 5.0, |flier| flier.height_m() > 1.0);
}

/// GCS_MAVLINK::send_raw_imu: in mG and mgauss like SCALED_IMU. In hover that is a G up and the field of the place.
#[test]
fn raw_measurements_have_the_units_of_scaled_ones() {
    let mut flier = Flier::new();
    flier.take_off(10.0, LOITER);
    flier.fly(3.0);
    let every_100_ms = [RAW_IMU_DATA::ID as f32, 100_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, every_100_ms), ACCEPTED);
    flier.fly(1.0);
    let raw = |message: &MavMessage| match message {
        MavMessage::RAW_IMU(raw) => Some([raw.xmag, raw.ymag, raw.zmag, raw.zacc]),
        _ => None,
    };
    let [x, y, z, up] = flier.latest(raw).expect("RAW_IMU").map(f64::from);
    assert!((up + 1000.0).abs() < 20.0, "{up} mG");
    // 0.48 G near Zurich (WMM).
    let field = x.hypot(y).hypot(z);
    assert!((400.0..600.0).contains(&field), "{field} mgauss");
}

/// Tunes are shown, and their format is told.
#[test]
fn tunes_are_shown() {
    let mut flier = Flier::new();
    let ask = [SUPPORTED_TUNES_DATA::ID as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, ask), ACCEPTED);
    let format = flier.latest(|message| match message {
        MavMessage::SUPPORTED_TUNES(tunes) => Some(tunes.format),
        _ => None,
    });
    assert_eq!(format, Some(TuneFormat::TUNE_FORMAT_QBASIC1_1));
    let tune = "MFT200L4<cdefgab>".into();
    flier.bench.send(MavMessage::PLAY_TUNE(PLAY_TUNE_DATA {
        target_system: 1,
        tune,
        ..PLAY_TUNE_DATA::default()
    }));
    flier.fly(0.1);
    assert!(flier.has_said("Tune: MFT200L4<cdefgab>"), "{:?}", flier.bench.texts());
    for (format, said) in [
        (TuneFormat::TUNE_FORMAT_QBASIC1_1, "Tune: a2b2"),
        (TuneFormat::TUNE_FORMAT_MML_MODERN, "Tune rejected: only format 1"),
    ] {
        let tune = PLAY_TUNE_V2_DATA {
            target_system: 1,
            format,
            tune: "a2b2".into(),
            ..PLAY_TUNE_V2_DATA::default()
        };
        flier.bench.send(MavMessage::PLAY_TUNE_V2(tune));
        flier.fly(0.1);
        assert!(flier.has_said(said), "{:?}", flier.bench.texts());
    }
}
