//! What speaks against arming, and a battery that is gone.

use super::flier::*;
use mavlink::dialects::ardupilotmega::{MavCmd, MavResult};
use vehicle::identity::Identity;
use vehicle::plan::{Plan, PlanKind};

const ARM: [f32; 7] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

fn has(flier: &mut Flier, text: &str) -> bool {
    flier.obstacles().iter().any(|told| told == &format!("PreArm: {text}"))
}

/// Suite: ParameterValidation, ParameterChecks. What refuses to arm fails.
#[test]
fn values_that_no_vehicle_has_forbid_arming() {
    let motors = "Motors: Check MOT_PWM_MIN and MOT_PWM_MAX";
    for (parameters, text) in [
        (&[("MOT_PWM_MIN", 100.0), ("MOT_PWM_MAX", 50.0)][..], motors),
        (&[("MOT_PWM_MIN", 100.0), ("MOT_PWM_MAX", 100.0)], motors),
        (
            &[("MOT_PWM_MIN", 1000.0), ("MOT_PWM_MAX", 2000.0), ("MOT_SPIN_MIN", 0.5)],
            "Motors: MOT_SPIN_MIN too high 0.50 > 0.3",
        ),
        (&[("MOT_SPIN_MIN", 0.1), ("MOT_SPIN_ARM", 0.2)], "Motors: MOT_SPIN_ARM > MOT_SPIN_MIN"),
        (&[("MOT_SPIN_MIN", 0.15), ("MOT_SPIN_ARM", 0.1), ("PSC_POSXY_P", -1.0)], "PSC_POSXY_P must be > 0"),
    ] {
        let mut flier = Flier::new();
        flier.set_all(parameters);
        assert!(has(&mut flier, text), "{text}: {:?}", flier.bench.texts());
        assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), FAILED);
    }
}

/// Suite: BatteryMissing.
#[test]
fn a_battery_that_is_gone_forbids_arming_and_is_told_in_flight() {
    let mut flier = Flier::new();
    flier.set("BATT_VOLT_PIN", -1.0);
    assert!(has(&mut flier, "Battery 1 unhealthy"));
    flier.set("BATT_VOLT_PIN", 13.0);
    flier.take_off(10.0, LOITER);
    flier.set("BATT_VOLT_PIN", -1.0);
    flier.wait_text("Battery 1 is missing", 5.0);
    flier.land();
}

/// Suite: NoRCOnBootPreArmFailure.
#[test]
fn a_radio_that_fails_from_the_start_forbids_arming() {
    for (failure, text) in [(1.0, "RC not found"), (2.0, "Throttle below failsafe")] {
        let mut flier = Flier::new();
        flier.set("SIM_RC_FAIL", failure);
        flier.reboot();
        assert!(has(&mut flier, text), "{text}: {:?}", flier.bench.texts());
    }
}

/// Suite: TakeoffCheck.
#[test]
fn rotors_that_idle_at_another_speed_do_not_take_off() {
    for (least, most) in [(1000.0, 0.0), (1.0, 3.0)] {
        for mode in [STABILIZE, 1, LOITER, ALT_HOLD, GUIDED, 16] {
            let mut flier = Flier::new();
            flier.set_all(&[
                ("SIM_ESC_TELEM", 1.0),
                ("SIM_ESC_ARM_RPM", 500.0),
                ("TKOFF_RPM_MIN", least),
                ("TKOFF_RPM_MAX", most),
            ]);
            flier.change_mode(mode);
            flier.arm();
            if mode == GUIDED {
                let parameters = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0];
                assert_eq!(flier.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), ACCEPTED);
            } else {
                flier.rc(3, 1700);
            }
            flier.wait_text("Takeoff blocked: ESC RPM out of range", 5.0);
            flier.fly(1.0);
            assert!(flier.height_m() < 0.05);
            flier.rc(3, 1000);
            let parameters = [0.0; 7];
            assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, parameters), ACCEPTED);
        }
    }
}

/// As on a board without a safety switch: switching it off changes nothing, switching it on fails, and no other state exists.
#[test]
fn there_is_no_safety_switch_to_be_switched_on() {
    let mut flier = Flier::new();
    for (state, result) in [
        (1.0, MavResult::MAV_RESULT_ACCEPTED),
        (0.0, MavResult::MAV_RESULT_FAILED),
        (2.0, MavResult::MAV_RESULT_DENIED),
    ] {
        let parameters = [state, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let answer = flier.command(MavCmd::MAV_CMD_DO_SET_SAFETY_SWITCH_STATE, parameters);
        assert_eq!(answer, result as u8, "{state}");
    }
    flier.change_mode(GUIDED);
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), ACCEPTED);
}

/// Suite: TerrainDBPreArm: a mission above the ground needs something that knows the ground.
#[test]
fn a_mission_above_an_unknown_ground_forbids_arming() {
    let mut start = crate::common::settings(Identity::ArduPilot);
    let mut items = mission(&start, &[(22, 0.0, 0.0, 20.0), (16, 20.0, 0.0, 20.0)]).items().to_vec();
    items[2].frame = vehicle::plan::frame::GLOBAL_TERRAIN;
    start.plans.set(PlanKind::Mission, Plan::new(items));
    let mut flier = Flier::with(&start);
    let disabled = |flier: &mut Flier| {
        flier.fly(6.0);
        flier.obstacles().iter().any(|text| text.contains("terrain disabled"))
    };
    flier.set("RNGFND1_TYPE", 1.0);
    assert!(!disabled(&mut flier));
    flier.set("TERRAIN_ENABLE", 0.0);
    assert!(!disabled(&mut flier), "a rangefinder knows it");
    flier.set("WP_RFND_USE", 0.0);
    assert!(disabled(&mut flier));
    flier.set_all(&[("WP_RFND_USE", 1.0), ("RNGFND1_TYPE", 0.0)]);
    assert!(disabled(&mut flier), "there is none");
}

/// ModeBrake::allows_arming.
#[test]
fn brake_is_not_armable() {
    const BRAKE: u32 = 17;
    let mut flier = Flier::new();
    flier.change_mode(BRAKE);
    assert!(has(&mut flier, "Brake mode not armable"), "{:?}", flier.bench.texts());
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), FAILED);
}
