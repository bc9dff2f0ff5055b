//! Open Drone ID, with ArduPilot's DID_* and PX4's COM_ARM_ODID.

use crate::common::Bench;
use crate::common::failsafe_bench::set;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;

const FAILED: u8 = 4;
const ARM: [f32; 7] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

fn latest<T>(bench: &Bench, of: impl Fn(&MavMessage) -> Option<T>) -> Option<T> {
    let typed = |message: &Message| match message {
        Message::Typed(message) => of(message),
        _ => None,
    };
    bench.heard.iter().rev().find_map(typed)
}

fn arm_status(bench: &Bench) -> Option<(MavOdidArmStatus, String)> {
    latest(bench, |message| match message {
        MavMessage::OPEN_DRONE_ID_ARM_STATUS(told) => {
            Some((told.status, told.error.to_str().unwrap_or_default().to_owned()))
        }
        _ => None,
    })
}

/// What a ground station of ArduPilot sends.
fn identify(bench: &mut Bench) {
    let mut uas_id = [0; 20];
    uas_id[..6].copy_from_slice(b"SN0042");
    bench.send(MavMessage::OPEN_DRONE_ID_BASIC_ID(OPEN_DRONE_ID_BASIC_ID_DATA {
        id_type: MavOdidIdType::MAV_ODID_ID_TYPE_SERIAL_NUMBER,
        ua_type: MavOdidUaType::MAV_ODID_UA_TYPE_HELICOPTER_OR_MULTIROTOR,
        uas_id,
        ..OPEN_DRONE_ID_BASIC_ID_DATA::default()
    }));
    bench.send(MavMessage::OPEN_DRONE_ID_SYSTEM(OPEN_DRONE_ID_SYSTEM_DATA {
        operator_latitude: 473_977_000,
        operator_longitude: 85_456_000,
        operator_altitude_geo: 490.0,
        operator_location_type: MavOdidOperatorLocationType::MAV_ODID_OPERATOR_LOCATION_TYPE_LIVE_GNSS,
        timestamp: 123_456,
        ..OPEN_DRONE_ID_SYSTEM_DATA::default()
    }));
}

#[test]
fn arming_waits_for_it_only_if_the_option_says_so() {
    let mut bench = Bench::new(Identity::ArduPilot);
    bench.heard.clear();
    bench.fly(1.5);
    assert_eq!(arm_status(&bench), None, "off by default");
    set(&mut bench, "DID_ENABLE", 1.0);
    bench.fly(1.1);
    let (status, error) = arm_status(&bench).expect("once a second");
    assert_eq!(status, MavOdidArmStatus::MAV_ODID_ARM_STATUS_PRE_ARM_FAIL_GENERIC);
    assert!(error.starts_with("remote ID: no aircraft type"), "{error}");
    set(&mut bench, "DID_OPTIONS", 1.0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), FAILED);
    assert!(bench.texts().concat().contains("OPEN_DRONE_ID_BASIC_ID"), "{:?}", bench.texts());
    identify(&mut bench);
    bench.fly(1.1);
    assert_eq!(arm_status(&bench).expect("told").0, MavOdidArmStatus::MAV_ODID_ARM_STATUS_GOOD_TO_ARM);
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), 0);
}

#[test]
fn what_was_told_is_broadcast_with_the_motion() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    set(&mut bench, "DID_ENABLE", 1.0);
    identify(&mut bench);
    bench.heard.clear();
    bench.fly(1.1);
    let basic = latest(&bench, |message| match message {
        MavMessage::OPEN_DRONE_ID_BASIC_ID(told) => Some(told.clone()),
        _ => None,
    });
    assert!(basic.expect("once a second").uas_id.starts_with(b"SN0042"));
    let system = latest(&bench, |message| match message {
        MavMessage::OPEN_DRONE_ID_SYSTEM(told) => Some(told.clone()),
        _ => None,
    });
    let system = system.expect("once a second");
    assert!(system.operator_latitude.abs_diff(473_977_000) < 20, "{system:?}");
    assert_eq!(system.timestamp, 123_456);
    let location = latest(&bench, |message| match message {
        MavMessage::OPEN_DRONE_ID_LOCATION(told) => Some(told.clone()),
        _ => None,
    });
    let location = location.expect("once a second");
    assert_eq!(location.status, MavOdidStatus::MAV_ODID_STATUS_AIRBORNE);
    assert!(
        (location.height - 10.0).abs() < 0.1 && (location.altitude_geodetic - 498.0).abs() < 0.1,
        "{location:?}"
    );
}

/// PX4 fills in what it knows itself, so that nothing is missing.
#[test]
fn px4_identifies_itself() {
    let mut bench = Bench::new(Identity::Px4);
    set(&mut bench, "COM_ARM_ODID", 2.0);
    bench.heard.clear();
    bench.fly(1.1);
    assert_eq!(arm_status(&bench).expect("told").0, MavOdidArmStatus::MAV_ODID_ARM_STATUS_GOOD_TO_ARM);
    let system = latest(&bench, |message| match message {
        MavMessage::OPEN_DRONE_ID_SYSTEM(told) => Some(told.clone()),
        _ => None,
    });
    assert!(system.expect("once a second").operator_latitude.abs_diff(473_977_420) < 20, "the takeoff");
    bench.arm();
}
