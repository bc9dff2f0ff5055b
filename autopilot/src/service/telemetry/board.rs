//! What ArduPilot's ground stations show of the board. There is none here: its figures are those of ArduPilot's simulation.

use mavlink::dialects::ardupilotmega::{
    HWSTATUS_DATA, MEMINFO_DATA, MavMessage, MavPowerStatus, POWER_STATUS_DATA,
};
use vehicle::Vehicle;

/// Voltage of the supply, mV.
const SUPPLY_MV: u16 = 5000;
/// Free memory, bytes; the old field of the message holds no more than this.
const FREE_BYTES: u32 = 131_072;

/// POWER_STATUS.
pub fn power_status(_vehicle: &Vehicle) -> MavMessage {
    let flags = MavPowerStatus::MAV_POWER_STATUS_BRICK_VALID | MavPowerStatus::MAV_POWER_STATUS_SERVO_VALID;
    MavMessage::POWER_STATUS(POWER_STATUS_DATA { Vcc: SUPPLY_MV, Vservo: SUPPLY_MV, flags })
}

/// MEMINFO.
pub fn memory(_vehicle: &Vehicle) -> MavMessage {
    MavMessage::MEMINFO(MEMINFO_DATA { brkval: 0, freemem: u16::MAX, freemem32: FREE_BYTES })
}

/// HWSTATUS.
pub fn hardware_status(_vehicle: &Vehicle) -> MavMessage {
    MavMessage::HWSTATUS(HWSTATUS_DATA { Vcc: SUPPLY_MV, I2Cerr: 0 })
}
