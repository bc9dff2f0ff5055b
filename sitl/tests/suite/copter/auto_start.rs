//! How Auto begins: by which mode, throttle or command; takeoffs by command in other modes; and which ground station flies.

use super::flier::*;
use crate::common::{Bench, failsafe_bench, settings};
use autopilot::codec::{Frame, Version};
use autopilot::envelope::Origin;
use mavlink::dialects::ardupilotmega::*;
use vehicle::VehicleSettings;
use vehicle::identity::Identity;
use vehicle::plan::{PlanKind, command};

const ARM: [f32; 7] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// With a mission, and with ArduPilot's own options of Auto.
fn flier(takes_off: bool) -> Flier {
    let mut start = settings(Identity::ArduPilot);
    start.conduct.auto_options = VehicleSettings::new(Identity::ArduPilot).conduct.auto_options;
    let rows = [(command::NAV_TAKEOFF, 0.0, 0.0, 10.0), (command::NAV_WAYPOINT, 10.0, 0.0, 10.0)];
    let rows = if takes_off { &rows[..] } else { &rows[1..] };
    start.plans.set(PlanKind::Mission, mission(&start, rows));
    Flier::with(&start)
}

/// ArduCopter: Auto is no mode to arm in unless AUTO_OPTIONS has bit 0.
#[test]
fn auto_is_armed_in_only_by_its_option() {
    let mut flier = flier(true);
    flier.change_mode(AUTO);
    assert!(flier.obstacles().iter().any(|text| text == "PreArm: Auto mode not armable"));
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), FAILED);
    flier.set("AUTO_OPTIONS", 1.0);
    flier.arm();
    flier.fly(3.0);
    assert!(flier.height_m() < 0.1, "it waits for the throttle");
    flier.rc(3, 1500);
    flier.wait("a takeoff", 20.0, |flier| flier.height_m() > 9.5);
}

/// Armed elsewhere it waits in Auto: for MISSION_START, a raised throttle or bit 1 of AUTO_OPTIONS, and disarms if nobody comes.
#[test]
fn auto_takes_off_once_it_is_asked_to() {
    for way in ["throttle", "command", "option", "nothing"] {
        let mut flier = flier(true);
        flier.set("AUTO_OPTIONS", if way == "option" { 2.0 } else { 0.0 });
        flier.change_mode(GUIDED);
        flier.arm();
        flier.change_mode(AUTO);
        flier.fly(3.0);
        assert_eq!(flier.height_m() > 0.5, way == "option", "{way}: {} m", flier.height_m());
        match way {
            "throttle" => flier.rc(3, 1200),
            "command" => assert_eq!(flier.command(MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), ACCEPTED),
            _ => {}
        }
        if way == "nothing" {
            flier.wait("its disarming", 15.0, |flier| !flier.is_armed());
        } else {
            flier.wait(way, 20.0, |flier| flier.height_m() > 9.5);
        }
    }
}

/// ArduCopter does not switch an armed vehicle on the ground to a mission that does not take off.
#[test]
fn a_mission_without_a_takeoff_does_not_start_on_the_ground() {
    let mut flier = flier(false);
    flier.change_mode(GUIDED);
    flier.arm();
    assert_eq!(flier.ask_mode(AUTO), FAILED);
    flier.wait_text("Auto: Missing Takeoff Cmd", 1.0);
    assert_eq!(flier.command(MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), FAILED);
    assert_eq!(flier.mode(), GUIDED);
}

/// NAV_TAKEOFF: Loiter and Guided climb; AltHold and PosHold only where the pilot may hold the place; the others do not.
#[test]
fn takeoffs_by_command_depend_on_the_mode() {
    const POSHOLD: u32 = 16;
    for (mode, by_pilot, result) in [
        (GUIDED, 0.0, ACCEPTED),
        (LOITER, 0.0, ACCEPTED),
        (LOITER, 1.0, ACCEPTED),
        (ALT_HOLD, 0.0, FAILED),
        (ALT_HOLD, 1.0, ACCEPTED),
        (POSHOLD, 0.0, FAILED),
        (POSHOLD, 1.0, ACCEPTED),
        (STABILIZE, 1.0, FAILED),
    ] {
        let mut flier = flier(true);
        let takeoff = [0.0, 0.0, by_pilot, 0.0, 0.0, 0.0, 6.0];
        flier.change_mode(mode);
        assert_eq!(flier.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), FAILED, "{mode}: not armed");
        flier.arm();
        flier.rc(3, 1500);
        flier.fly(0.2);
        assert_eq!(flier.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), result, "{mode} {by_pilot}");
        if result == ACCEPTED {
            flier.wait("a takeoff", 20.0, |flier| flier.height_m() > 5.8);
            flier.fly(3.0);
            assert!((flier.height_m() - 6.0).abs() < 0.3, "{mode}: {} m", flier.height_m());
            assert_eq!(flier.mode(), mode);
            assert_eq!(flier.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), FAILED, "{mode}: in the air");
        }
    }
}

/// Without a pilot, too, Loiter climbs to the height and stays there.
#[test]
fn loiter_takes_off_without_a_pilot() {
    let mut bench = Bench::new(Identity::ArduPilot);
    bench.arm();
    let takeoff = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), ACCEPTED);
    bench.fly(12.0);
    let height_m = -bench.autopilot.vehicle().outputs().position_m.z;
    assert!((height_m - 5.0).abs() < 0.2, "{height_m}");
}

/// A frame of another system than ours.
fn frame_of(system: u8, message: MavMessage) -> Frame {
    Frame::encode(&message.into(), Version::Two, 1, (system, 190)).expect("a message of MAVLink 2")
}

/// MAV_GCS_SYSID: overrides and MANUAL_CONTROL of another ground station move nothing, and its heartbeats do not count.
#[test]
fn only_the_own_ground_station_flies() {
    let sticks = MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
        target: 1,
        z: 1000,
        ..MANUAL_CONTROL_DATA::default()
    });
    let overrides = MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        target_system: 1,
        target_component: 1,
        chan3_raw: 1900,
        ..RC_CHANNELS_OVERRIDE_DATA::default()
    });
    let station = MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        mavtype: MavType::MAV_TYPE_GENERIC,
        ..HEARTBEAT_DATA::default()
    });
    // Of which system they come, and the parameter by its old and its new name.
    for (name, own, last, system, counts) in [
        ("MAV_GCS_SYSID", 255.0, 0.0, 255, true),
        ("MAV_GCS_SYSID", 255.0, 0.0, 245, false),
        ("SYSID_MYGCS", 245.0, 0.0, 245, true),
        ("SYSID_MYGCS", 245.0, 0.0, 255, false),
        ("MAV_GCS_SYSID", 240.0, 250.0, 245, true),
    ] {
        for message in [&sticks, &overrides, &station] {
            let mut bench = Bench::new(Identity::ArduPilot);
            failsafe_bench::set(&mut bench, name, own);
            failsafe_bench::set(&mut bench, "MAV_GCS_SYSID_HI", last);
            let frame = frame_of(system, message.clone());
            let origin = Origin { system, ..Bench::origin() };
            bench.autopilot.receive(&origin, &frame);
            bench.fly(0.1);
            let moved = bench.autopilot.vehicle().pilot().sticks.is_some();
            let flies = !matches!(message, MavMessage::HEARTBEAT(_));
            assert_eq!(moved, counts && flies, "{name} = {own}, {last}: {system}: {message:?}");
            assert_eq!(bench.autopilot.shows_ground_station(&frame), counts, "{name} = {own}: {system}");
        }
    }
    let px4 = Bench::new(Identity::Px4);
    assert!(!px4.autopilot.shows_ground_station(&frame_of(255, station)), "PX4 looks at the type");
}
