//! What is carried and put down.

use super::flier::*;
use mavlink::dialects::ardupilotmega::MavCmd;

/// A gripper on an output, as the suite sets it up.
fn with_gripper(rows: &[(u16, f64, f64, f64)]) -> Flier {
    let mut flier = with_mission(rows);
    flier.set_all(&[
        ("GRIP_ENABLE", 1.0),
        ("GRIP_TYPE", 1.0),
        ("SIM_GRPS_ENABLE", 1.0),
        ("SIM_GRPS_PIN", 8.0),
        ("SERVO8_FUNCTION", 28.0),
        ("RNGFND1_TYPE", 1.0),
    ]);
    flier.reboot();
    flier
}

/// Suite: PayloadPlaceMission: the load is put down where the mission says, and the mission goes on.
#[test]
fn a_mission_puts_a_load_down_at_its_place() {
    let mut flier = with_gripper(&[
        (22, 0.0, 0.0, 20.0),
        (16, 10.0, 12.0, 20.0),
        (94, -16.0, 32.0, 20.0),
        (16, -29.0, 39.0, 20.0),
        (21, -30.0, 55.0, 20.0),
    ]);
    flier.set("AUTO_OPTIONS", 3.0);
    flier.change_mode(AUTO);
    flier.arm();
    flier.wait_text("Gripper load releas", 90.0);
    let at_m = flier.vehicle().outputs().position_m - flier.vehicle().home().position_m;
    assert!((at_m.x + 16.0).hypot(at_m.y - 32.0) < 1.0 && flier.height_m() < 0.5, "{at_m:?}");
    flier.wait_disarmed(120.0);
}

/// ArduCopter's gripper has GRIP_NEUTRAL until it is first told something, and closes GRIP_AUTOCLOSE seconds after a release.
#[test]
fn a_gripper_waits_and_closes_by_itself() {
    let mut flier = with_gripper(&[]);
    flier.set_all(&[("GRIP_NEUTRAL", 1430.0), ("GRIP_AUTOCLOSE", 2.5)]);
    let pulse_us = |flier: &mut Flier, seconds: f64| {
        flier.fly(seconds);
        flier.vehicle().output_us(8)
    };
    assert_eq!(pulse_us(&mut flier, 3.0), 1430);
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_GRIPPER, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 0);
    assert_eq!(pulse_us(&mut flier, 2.4), 1100);
    assert!(flier.has_said("Gripper load released") && !flier.has_said("Gripper load grabbing"));
    assert_eq!(pulse_us(&mut flier, 0.2), 1900);
    flier.wait_text("Gripper load grabbed", 1.0);
    assert_eq!(pulse_us(&mut flier, 5.0), 1900, "once");
}

/// Suite: TestGripperMission: ArduPilot names what a mission has done beside what the gripper does.
#[test]
fn a_mission_tells_what_its_gripper_does() {
    let mut flier = with_gripper(&[(22, 0.0, 0.0, 10.0), (211, 0.0, 0.0, 0.0), (16, 10.0, 0.0, 10.0)]);
    flier.change_mode(LOITER);
    flier.arm();
    flier.change_mode(AUTO);
    flier.rc(3, 1500);
    flier.wait_text("Gripper Released", 60.0);
    flier.wait_text("Gripper load released", 5.0);
}
