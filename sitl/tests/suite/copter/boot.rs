//! What a boot begins with, and what only another one mends.

use super::flier::*;
use mavlink::dialects::ardupilotmega::*;
use mavlink::{Message as _, MessageData as _};

/// Boots by the command alone: the radio says nothing new.
fn boot(flier: &mut Flier) {
    let parameters = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, parameters), ACCEPTED);
    flier.fly(2.0);
}

/// How many boots it tells.
fn boots_told(flier: &mut Flier) -> f32 {
    let mut id = [0; 16];
    id[..b"STAT_BOOTCNT".len()].copy_from_slice(b"STAT_BOOTCNT");
    flier.bench.heard.clear();
    flier.bench.send(MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        target_system: 1,
        target_component: 1,
        param_index: -1,
        param_id: id.into(),
    }));
    flier.bench.parameters().last().expect("an answer").param_value
}

/// A radio that goes on sending the same pulses is received after a boot, too.
#[test]
fn a_radio_that_does_not_change_is_received_after_a_boot() {
    let mut flier = Flier::new();
    flier.set("RC9_OPTION", 10.0);
    flier.set("RNGFND1_TYPE", 1.0);
    flier.rc(9, 2000);
    flier.fly(0.5);
    boot(&mut flier);
    assert_eq!(flier.mode(), STABILIZE, "as the switch says");
    flier.change_mode(GUIDED);
    flier.rc(3, 1400);
    flier.fly(1.0);
    assert_eq!(flier.mode(), GUIDED, "the switch has not moved");
}

/// Suite: InitialMode.
#[test]
fn a_boot_without_a_radio_begins_in_the_mode_that_is_set() {
    let mut flier = Flier::new();
    flier.set("SIM_RC_FAIL", 1.0);
    flier.set("INITIAL_MODE", 9.0);
    boot(&mut flier);
    assert_eq!(flier.mode(), LAND);
    flier.set("SIM_RC_FAIL", 0.0);
    flier.wait_mode(STABILIZE, 5.0);
}

/// Suite: ConfigErrorLoop.
#[test]
fn without_a_barometer_it_is_told_until_the_next_boot() {
    let mut flier = Flier::new();
    flier.set("STAT_BOOTCNT", 0.0);
    flier.set("SIM_BARO_COUNT", -1.0);
    flier.bench.heard.clear();
    boot(&mut flier);
    assert_eq!(boots_told(&mut flier), 1.0);
    flier.wait_text("Config Error", 6.0);
    assert!(flier.obstacles().iter().any(|text| text.contains("Config Error")));
    flier.set("SERVO8_MIN", 1105.0);
    flier.set("SIM_BARO_COUNT", 2.0);
    boot(&mut flier);
    assert!(flier.obstacles().is_empty());
    flier.arm();
}

/// Suite: CPUFailsafe.
#[test]
fn a_main_loop_that_hangs_stops_the_rotors() {
    let mut flier = Flier::new();
    flier.arm();
    let parameters = [42.0, 24.0, 71.0, 93.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, parameters), ACCEPTED);
    flier.wait_disarmed(3.0);
    assert!(!flier.obstacles().is_empty());
    boot(&mut flier);
    assert!(flier.obstacles().is_empty());
}

/// What a request for a message brings.
fn asked(flier: &mut Flier, id: u32) -> Vec<MavMessage> {
    flier.bench.heard.clear();
    let parameters = [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters);
    flier.all(|message| (message.message_id() == id).then(|| message.clone()))
}

/// Suite: BaroDrivers. As many barometers as there are tell the same pressure.
#[test]
fn each_barometer_tells_its_pressure() {
    let mut flier = Flier::new();
    for (inner, outer, count) in [(2.0, 0.0, 2), (2.0, 4.0, 3), (1.0, 0.0, 1)] {
        flier.set_all(&[("SIM_BARO_COUNT", inner), ("BARO_PROBE_EXT", outer)]);
        let ids = [SCALED_PRESSURE_DATA::ID, SCALED_PRESSURE2_DATA::ID, SCALED_PRESSURE3_DATA::ID];
        let told: Vec<_> = ids.into_iter().flat_map(|id| asked(&mut flier, id)).collect();
        let pressures_hpa = told.iter().map(|message| match message {
            MavMessage::SCALED_PRESSURE(pressure) => pressure.press_abs,
            MavMessage::SCALED_PRESSURE2(pressure) => pressure.press_abs,
            MavMessage::SCALED_PRESSURE3(pressure) => pressure.press_abs,
            other => panic!("{other:?}"),
        });
        let pressures_hpa: Vec<_> = pressures_hpa.collect();
        assert_eq!(pressures_hpa.len(), count);
        assert!(pressures_hpa.iter().all(|pressure| (pressure - pressures_hpa[0]).abs() < 0.5));
    }
}

/// Suite: PIDTuning. What loops are asked for and reach is told if GCS_PID_MASK says so.
#[test]
fn loops_are_told_as_the_mask_says() {
    let mut flier = Flier::new();
    assert!(asked(&mut flier, PID_TUNING_DATA::ID).is_empty());
    flier.set("GCS_PID_MASK", 5.0);
    let axes = asked(&mut flier, PID_TUNING_DATA::ID).into_iter().map(|message| match message {
        MavMessage::PID_TUNING(tuning) => tuning.axis,
        other => panic!("{other:?}"),
    });
    assert!(axes.eq([PidTuningAxis::PID_TUNING_ROLL, PidTuningAxis::PID_TUNING_YAW]));
}
