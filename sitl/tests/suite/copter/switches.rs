//! What switches of the radio do.

use super::flier::*;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage, MavSysStatusSensor, RC_CHANNELS_OVERRIDE_DATA};
use vehicle::plan::PlanKind;

const CIRCLE: u32 = 7;
const ACRO: u32 = 1;
const BRAKE: u32 = 17;

/// Suite: SetModesViaModeSwitch.
#[test]
fn the_mode_switch_has_six_modes() {
    let mut flier = Flier::new();
    flier.rc(5, 1000);
    flier.fly(0.5);
    let modes = [(4, 1165), (2, 1295), (6, 1425), (7, 1555), (1, 1685), (17, 1815)];
    for (number, (mode, _)) in (1..).zip(modes) {
        flier.set(&format!("FLTMODE{number}"), f64::from(mode));
    }
    for (mode, pulse) in modes.iter().rev().chain(&modes) {
        flier.rc(5, *pulse);
        flier.wait_mode(*mode, 2.0);
    }
    assert_eq!([CIRCLE, ACRO, BRAKE], [7, 1, 17]);
}

/// Suite: SetModesViaAuxSwitch.
#[test]
fn a_switch_that_is_let_go_gives_the_mode_back() {
    let mut flier = Flier::new();
    flier.rc(5, 1000);
    flier.wait_mode(CIRCLE, 2.0);
    flier.set_all(&[("RC9_OPTION", 18.0), ("RC10_OPTION", 55.0)]);
    flier.fly(1.0);
    flier.rc(9, 1900);
    flier.wait_mode(LAND, 2.0);
    flier.rc(10, 1900);
    flier.wait_mode(GUIDED, 2.0);
    flier.rc(10, 1000);
    flier.wait_mode(CIRCLE, 2.0);
}

/// Suite: AuxSwitchOptions.
#[test]
fn a_switch_clears_the_mission_and_another_one_begins_it_anew() {
    let rows = [(22, 0.0, 0.0, 10.0), (16, 20.0, 0.0, 10.0), (16, 40.0, 0.0, 10.0), (20, 0.0, 0.0, 0.0)];
    let mut flier = with_mission(&rows);
    flier.set("RC7_OPTION", 24.0);
    flier.fly(0.5);
    assert_eq!(
        flier.command(MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, [4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ACCEPTED
    );
    flier.wait("item 4", 5.0, |flier| flier.vehicle().mission_status().current == 4);
    flier.rc(7, 2000);
    flier.wait("the first item", 5.0, |flier| flier.vehicle().mission_status().current == 0);
    flier.rc(7, 1000);
    flier.fly(0.5);
    flier.set("RC7_OPTION", 58.0);
    flier.fly(0.5);
    assert_eq!(flier.vehicle().plans().get(PlanKind::Mission).items().len(), 5);
    flier.rc(7, 2000);
    flier.fly(1.0);
    assert!(flier.vehicle().plans().get(PlanKind::Mission).items().is_empty());
}

/// Suite: RangeFinder.
#[test]
fn a_switch_switches_the_rangefinder() {
    let mut flier = Flier::new();
    flier.set_all(&[
        ("RNGFND1_TYPE", 1.0),
        ("RNGFND1_MIN_CM", 0.0),
        ("RNGFND1_MAX_CM", 4000.0),
        ("RNGFND1_SCALING", 12.12),
        ("RNGFND1_PIN", 0.0),
        ("RC9_OPTION", 10.0),
    ]);
    flier.fly(0.5);
    for (pulse, on) in [(2000, true), (1000, false), (2000, true)] {
        flier.rc(9, pulse);
        flier.bench.heard.clear();
        flier.fly(2.1);
        let [present, enabled, healthy] =
            states(&flier, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_LASER_POSITION);
        assert!(present && enabled == on && healthy == on, "{on}: {enabled} {healthy}");
    }
}

/// Suite: Button. A change is told at once and then each second; a button does what a switch does.
#[test]
fn buttons_are_told_and_do_what_switches_do() {
    let mut flier = Flier::new();
    flier.set_all(&[("SIM_PIN_MASK", 0.0), ("BTN_ENABLE", 1.0), ("BTN_PIN4", 3.0)]);
    let states = |flier: &Flier| {
        flier.all(|message| match message {
            MavMessage::BUTTON_CHANGE(change) => Some((change.state, change.last_change_ms)),
            _ => None,
        })
    };
    flier.bench.heard.clear();
    flier.fly(1.0);
    assert!(states(&flier).is_empty());
    flier.set("SIM_PIN_MASK", 8.0);
    flier.bench.heard.clear();
    flier.fly(20.0);
    let pressed = states(&flier);
    assert!((10..=11).contains(&pressed.len()) && pressed.iter().all(|(state, _)| *state == 8));
    flier.set("SIM_PIN_MASK", 0.0);
    flier.fly(0.1);
    let (state, changed_ms) = *states(&flier).last().expect("told at once");
    assert!(state == 0 && changed_ms > pressed[0].1);

    flier.set("BTN_FUNC4", 41.0);
    for armed in [true, false] {
        flier.set("SIM_PIN_MASK", if armed { 8.0 } else { 0.0 });
        flier.fly(0.1);
        assert_eq!(flier.is_armed(), armed);
    }
    flier.set("BTN_FUNC4", 4.0);
    flier.set("SIM_PIN_MASK", 8.0);
    flier.wait_mode(RTL, 1.0);
    flier.set("SIM_PIN_MASK", 0.0);
    flier.wait_mode(STABILIZE, 1.0);
}

/// Whether SYS_STATUS shows a sensor as present, enabled and healthy.
fn states(flier: &Flier, sensor: MavSysStatusSensor) -> [bool; 3] {
    let states = flier.latest(|message| match message {
        MavMessage::SYS_STATUS(status) => Some([
            status.onboard_control_sensors_present,
            status.onboard_control_sensors_enabled,
            status.onboard_control_sensors_health,
        ]),
        _ => None,
    });
    states.expect("a status").map(|sensors| sensors.contains(sensor))
}

/// RC_CHANNELS_OVERRIDE of the sticks.
fn override_sticks(flier: &mut Flier, [chan1_raw, chan2_raw, chan3_raw, chan4_raw]: [u16; 4]) {
    let none = u16::MAX;
    flier.bench.send(MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        chan1_raw,
        chan2_raw,
        chan3_raw,
        chan4_raw,
        chan5_raw: none,
        chan6_raw: none,
        chan7_raw: none,
        chan8_raw: none,
        ..RC_CHANNELS_OVERRIDE_DATA::default()
    }));
}

/// Suite: RCOverridesNoRCReceiver: a ground station's joystick flies a vehicle whose receiver has failed, and is missed after three seconds.
#[test]
fn a_joystick_flies_without_a_receiver() {
    let mut flier = Flier::new();
    flier.set("SIM_RC_FAIL", 1.0);
    flier.reboot();
    let fly = |flier: &mut Flier, seconds: f64, sticks: [u16; 4]| {
        for _ in 0..(seconds * 10.0) as usize {
            override_sticks(flier, sticks);
            flier.fly(0.1);
        }
    };
    fly(&mut flier, 1.0, [1500, 1500, 1000, 1500]);
    flier.change_mode(LOITER);
    flier.arm();
    fly(&mut flier, 8.0, [1500, 1500, 1800, 1500]);
    assert!(flier.height_m() > 5.0, "{} m", flier.height_m());
    let before_deg = flier.heading_deg();
    fly(&mut flier, 2.0, [1500, 1500, 1500, 1400]);
    assert!(!flier.heads(before_deg, 5.0), "{before_deg} deg");
    flier.fly(5.0);
    assert!(flier.has_said("Radio Failsafe"), "{:?}", flier.bench.texts());
}

/// Suite: RCOverridesClearByPilotInput: switch 46 takes overrides, or keeps them off.
#[test]
fn a_switch_keeps_overrides_off() {
    let mut flier = Flier::new();
    flier.set("RC9_OPTION", 46.0);
    let third = |flier: &Flier| flier.vehicle().pilot().pulses.map(|pulses| pulses[2]);
    for (pulse, taken) in [(2000, 1300), (1000, 1000), (2000, 1300)] {
        flier.rc(9, pulse);
        flier.fly(0.5);
        override_sticks(&mut flier, [u16::MAX, u16::MAX, 1300, u16::MAX]);
        flier.fly(0.1);
        assert_eq!(third(&flier), Some(taken), "{pulse}");
    }
    // What is there is given back at once.
    flier.rc(9, 1000);
    flier.fly(0.5);
    assert_eq!(third(&flier), Some(1000));
}
