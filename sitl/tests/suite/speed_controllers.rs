//! What the rotors' electronic speed controllers tell.

use crate::common::Bench;
use crate::common::settings;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{
    ESC_INFO_DATA, ESC_STATUS_DATA, ESC_TELEMETRY_1_TO_4_DATA, MavCmd, MavMessage,
};
use mavlink::{Message as _, MessageData};
use vehicle::identity::Identity;

const ACCEPTED: u8 = 0;
const UNSUPPORTED: u8 = 3;
const MOTOR: f32 = 101.0;
const OFF: f32 = 1.0;

fn asked(bench: &mut Bench, id: u32) -> MavMessage {
    let request = [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, request), ACCEPTED);
    let told = bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(message) if message.message_id() == id => Some(message.clone()),
        _ => None,
    });
    told.unwrap_or_else(|| panic!("{id}: {:?}", bench.heard))
}

fn status(bench: &mut Bench) -> ESC_STATUS_DATA {
    match asked(bench, ESC_STATUS_DATA::ID) {
        MavMessage::ESC_STATUS(status) => status,
        other => panic!("{other:?}"),
    }
}

fn online(bench: &mut Bench) -> u8 {
    match asked(bench, ESC_INFO_DATA::ID) {
        MavMessage::ESC_INFO(info) => info.info,
        other => panic!("{other:?}"),
    }
}

/// In hover each rotor carries a quarter of the weight, m g = 4 k₁ Ω², and is driven by its drag torque times its speed, k₂ Ω³, over the
/// efficiency of 0.75.
#[test]
fn they_tell_speed_voltage_and_current_in_hover() {
    let mut bench = Bench::hovering(Identity::Px4);
    let airframe = settings(Identity::Px4).configuration.airframe;
    let speed_rad_s = (airframe.mass_kg * 9.80665 / (4.0 * airframe.thrust_coefficient_n_s2)).sqrt();
    let power_w = airframe.torque_coefficient_n_m_s2 * speed_rad_s.powi(3) / 0.75;
    let status = status(&mut bench);
    for rotor in 0..4 {
        let expected_rpm = speed_rad_s * 60.0 / core::f64::consts::TAU;
        assert!((f64::from(status.rpm[rotor]) - expected_rpm).abs() < 0.01 * expected_rpm, "{status:?}");
        let drawn_w = f64::from(status.voltage[rotor]) * f64::from(status.current[rotor]);
        assert!((drawn_w - power_w).abs() < 0.03 * power_w, "{status:?}: {drawn_w} W, {power_w} W");
    }
}

#[test]
fn one_without_power_is_offline_and_its_rotor_stops() {
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(online(&mut bench), 0b1111);
    let third_off = [MOTOR, OFF, 3.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, third_off), ACCEPTED);
    bench.fly(0.5);
    assert_eq!(online(&mut bench), 0b1011);
    let status = status(&mut bench);
    assert!(status.rpm[2] < 10 && status.current[2] < 0.01, "{status:?}");
    // Its neighbours carry the vehicle.
    assert!(status.rpm[1] > 1000 && status.rpm[3] > 1000, "{status:?}");
}

#[test]
fn ardupilot_tells_them_in_a_message_of_its_own() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    let status = status(&mut bench);
    match asked(&mut bench, ESC_TELEMETRY_1_TO_4_DATA::ID) {
        MavMessage::ESC_TELEMETRY_1_TO_4(told) => {
            for rotor in 0..4 {
                assert_eq!(i32::from(told.rpm[rotor]), status.rpm[rotor]);
                assert!(
                    (f32::from(told.current[rotor]) / 100.0 - status.current[rotor]).abs() < 0.01,
                    "{told:?}"
                );
                assert!(
                    (f32::from(told.voltage[rotor]) / 100.0 - status.voltage[rotor]).abs() < 0.01,
                    "{told:?}"
                );
            }
        }
        other => panic!("{other:?}"),
    }
    let mut px4 = Bench::new(Identity::Px4);
    let request = [ESC_TELEMETRY_1_TO_4_DATA::ID as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(px4.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, request), UNSUPPORTED);
}
