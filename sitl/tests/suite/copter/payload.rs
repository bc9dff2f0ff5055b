//! What is carried and put down.

use super::flier::*;

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
