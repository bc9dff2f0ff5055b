//! DO_MOUNT_CONTROL as ArduPilot takes it: by its mode.

use nalgebra::Vector3;
use vehicle::equipment::{GimbalMode, Operation};
use vehicle::world::Geodetic;
use vehicle::{Refusal, Vehicle};

use super::operate::operate;
use crate::codec::Command;

/// Degrees beyond this are counted in 1e-7.
const MOST_DEG: f64 = 1000.0;

/// Points the mount by MAV_MOUNT_MODE in the seventh parameter.
///
/// # Errors
/// [`Refusal`] of a mode or a place that there is not.
pub fn control_mount(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    let operation = match command.z {
        0.0 => Operation::RetractGimbal,
        1.0 => Operation::CentreGimbal,
        2.0 => return operate(vehicle, command),
        3.0 => Operation::SetGimbalMode(GimbalMode::Radio),
        4.0 => Operation::LookAt(place_m(vehicle, command)?),
        5.0 => Operation::SetGimbalMode(GimbalMode::Region),
        6.0 => Operation::SetGimbalMode(GimbalMode::Home),
        mode => {
            return Err(Refusal::Failed(format!("DO_MOUNT_CONTROL: mode = {mode}; allowed 0 to 6")));
        }
    };
    vehicle.operate(&operation)
}

/// Latitude and longitude, and in the fourth parameter the height above home, m: NED, m.
fn place_m(vehicle: &Vehicle, command: &Command) -> Result<Vector3<f64>, Refusal> {
    let degrees = |value: f64| if value.abs() > MOST_DEG { value / 1e7 } else { value };
    let place = Geodetic {
        latitude_deg: degrees(command.x),
        longitude_deg: degrees(command.y),
        altitude_m: vehicle.frame().origin().altitude_m,
    };
    if !place.is_valid() || !command.parameter(4).is_finite() {
        return Err(Refusal::Failed("DO_MOUNT_CONTROL requires a latitude, a longitude and a height".into()));
    }
    let on_ground_m = vehicle.frame().to_local_m(&place);
    let home_z_m = vehicle.home().position_m.z;
    Ok(Vector3::new(on_ground_m.x, on_ground_m.y, home_z_m - command.parameter(4)))
}
