//! What speaks against arming, and a battery that is gone.

use super::flier::*;
use mavlink::dialects::ardupilotmega::*;
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

/// Switches the safety switch as clients have done before there was a command: by a base mode of the value of this flag.
#[allow(deprecated)]
fn set_by_mode(flier: &mut Flier, state: u32) {
    let base_mode = MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED;
    let data = SET_MODE_DATA { custom_mode: state, target_system: 1, base_mode };
    flier.bench.send(MavMessage::SET_MODE(data));
}

/// Suite: SafetySwitch. SYS_STATUS tells the switch as whether the motors' outputs are enabled.
#[test]
fn nothing_turns_while_the_safety_switch_is_on() {
    let mut flier = Flier::new();
    let command = |flier: &mut Flier, state: f32| {
        flier.command(MavCmd::MAV_CMD_DO_SET_SAFETY_SWITCH_STATE, [state, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    let pulse_us = |flier: &mut Flier, on: bool| {
        flier.bench.heard.clear();
        flier.fly(2.0);
        let enabled = flier.latest(|message| match message {
            MavMessage::SYS_STATUS(told) => Some(told.onboard_control_sensors_enabled),
            _ => None,
        });
        let outputs = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS;
        assert_eq!(enabled.map(|enabled| enabled.contains(outputs)), Some(!on));
        flier.latest(|message| match message {
            MavMessage::SERVO_OUTPUT_RAW(told) => Some(told.servo1_raw),
            _ => None,
        })
    };
    assert_eq!(pulse_us(&mut flier, false), Some(1000));
    assert_eq!(command(&mut flier, 2.0), MavResult::MAV_RESULT_DENIED as u8);
    assert_eq!(command(&mut flier, 0.0), ACCEPTED);
    assert_eq!(pulse_us(&mut flier, true), Some(0));
    assert!(flier.obstacles().iter().any(|text| text.contains("Hardware safety switch")));
    let forced = [1.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_ne!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, forced), ACCEPTED);
    let test = [1.0, 0.0, 20.0, 1.0, 1.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_MOTOR_TEST, test), MavResult::MAV_RESULT_FAILED as u8);
    set_by_mode(&mut flier, 0);
    assert_eq!(pulse_us(&mut flier, false), Some(1000));
    flier.change_mode(GUIDED);
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), ACCEPTED);
    set_by_mode(&mut flier, 1);
    assert!(flier.has_said("disarm first"));
    assert_eq!(command(&mut flier, 0.0), MavResult::MAV_RESULT_FAILED as u8, "the rotors turn");
    assert!(!flier.vehicle().is_safe());
    let mut flier = Flier::new();
    flier.set("BRD_SAFETY_DEFLT", 1.0);
    assert_eq!(pulse_us(&mut flier, false), Some(1000), "not before the next start");
    flier.reboot();
    assert_eq!(pulse_us(&mut flier, true), Some(0));
}

/// Suite: REQUIRE_LOCATION_FOR_ARMING.
#[test]
fn a_place_can_be_required_to_arm_in_any_mode() {
    let mut flier = Flier::new();
    let lacks_place = |flier: &mut Flier| {
        flier.fly(1.0);
        flier.obstacles().iter().any(|text| text.contains("Need Position Estimate"))
    };
    flier.set("SIM_GPS1_ENABLE", 0.0);
    flier.change_mode(STABILIZE);
    assert!(!lacks_place(&mut flier));
    flier.set("ARMING_NEED_LOC", 1.0);
    assert!(lacks_place(&mut flier));
    assert_ne!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), ACCEPTED);
    flier.set("SIM_GPS1_ENABLE", 1.0);
    assert!(!lacks_place(&mut flier));
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
