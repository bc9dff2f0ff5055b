//! What the electronic speed controllers (ESC) of the rotors tell, in the order of SERVO_OUTPUT_RAW.

use mavlink::dialects::ardupilotmega::{
    ESC_INFO_DATA, ESC_STATUS_DATA, ESC_TELEMETRY_1_TO_4_DATA, EscConnectionType, MavMessage,
};
use quadrotor::RotorFault;
use vehicle::Vehicle;

/// They tell their state ten times a second.
const PERIOD_US: u64 = 100_000;
const RPM_PER_RAD_S: f64 = 30.0 / core::f64::consts::PI;

/// ESC_INFO: which of them are there. One without power is not.
pub fn esc_info(vehicle: &Vehicle) -> MavMessage {
    let faults = vehicle.faults().rotors();
    let has_power = |number: &usize| faults.get(*number) != Some(&Some(RotorFault::Off));
    MavMessage::ESC_INFO(ESC_INFO_DATA {
        time_usec: vehicle.outputs().time_us,
        counter: reports(vehicle),
        count: faults.len() as u8,
        connection_type: EscConnectionType::ESC_CONNECTION_TYPE_DSHOT,
        info: (0..faults.len()).filter(has_power).fold(0, |online, number| online | 1 << number),
        // Unknown.
        temperature: [i16::MAX; 4],
        ..ESC_INFO_DATA::DEFAULT
    })
}

/// ESC_STATUS: speed, voltage and current of each.
pub fn esc_status(vehicle: &Vehicle) -> MavMessage {
    MavMessage::ESC_STATUS(ESC_STATUS_DATA {
        time_usec: vehicle.outputs().time_us,
        rpm: speeds_rpm(vehicle).map(|speed| speed as i32),
        voltage: [vehicle.battery().voltage_v() as f32; 4],
        current: currents_a(vehicle).map(|current| current as f32),
        index: 0,
    })
}

/// ESC_TELEMETRY_1_TO_4: the same as ArduPilot tells it. A quarter of the battery's drawn charge is each rotor's.
pub fn esc_telemetry(vehicle: &Vehicle) -> MavMessage {
    let battery = vehicle.battery();
    MavMessage::ESC_TELEMETRY_1_TO_4(ESC_TELEMETRY_1_TO_4_DATA {
        voltage: [(battery.voltage_v() * 1e2).round() as u16; 4],
        current: currents_a(vehicle).map(|current| (current * 1e2).round() as u16),
        totalcurrent: [(battery.drawn_ah() * 1e3 / 4.0).round() as u16; 4],
        rpm: speeds_rpm(vehicle).map(|speed| speed as u16),
        count: [reports(vehicle); 4],
        // Unknown.
        temperature: [0; 4],
    })
}

/// How many reports have come from each, wrapping.
fn reports(vehicle: &Vehicle) -> u16 {
    (vehicle.outputs().time_us / PERIOD_US) as u16
}

/// The speed of each rotor, whole rounds a minute.
fn speeds_rpm(vehicle: &Vehicle) -> [f64; 4] {
    vehicle.outputs().rotor_speed_rad_s.map(|speed| (speed * RPM_PER_RAD_S).round())
}

/// The current of each rotor, A: its electric power over the battery's voltage.
fn currents_a(vehicle: &Vehicle) -> [f64; 4] {
    let airframe = &vehicle.simulation().configuration().airframe;
    let voltage_v = vehicle.battery().voltage_v();
    vehicle.outputs().rotor_speed_rad_s.map(|speed| {
        if voltage_v > 0.0 { airframe.electric_power_w(&[speed, 0.0, 0.0, 0.0]) / voltage_v } else { 0.0 }
    })
}
