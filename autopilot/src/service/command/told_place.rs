//! Where a command means something to be.

use nalgebra::Vector3;
use vehicle::plan::{frame, is_global};
use vehicle::world::Geodetic;
use vehicle::{Refusal, Vehicle};

use crate::codec::{Command, CommandKind};

/// The frame in which a command's place is meant: COMMAND_LONG has none and means latitude, longitude and sea level.
pub fn told_frame(command: &Command) -> u8 {
    match command.kind {
        CommandKind::Long { .. } => frame::GLOBAL,
        CommandKind::Int { frame } => frame,
    }
}

/// The same, if it is one of latitude and longitude.
pub fn global_frame(command: &Command) -> Result<u8, Refusal> {
    match told_frame(command) {
        frame if is_global(frame) => Ok(frame),
        frame => Err(Refusal::UnsupportedFrame(format!(
            "Frame {frame} is not supported: a place has a global one"
        ))),
    }
}

/// A command's latitude and longitude in the local frame, m, on the height of its origin.
pub fn told_place(command: &Command, vehicle: &Vehicle) -> Result<Vector3<f64>, Refusal> {
    let altitude_m = vehicle.frame().origin().altitude_m;
    let place = Geodetic { latitude_deg: command.x, longitude_deg: command.y, altitude_m };
    if !place.is_valid() {
        return Err(Refusal::denied(format!(
            "Invalid position: latitude {}, longitude {}",
            command.x, command.y
        )));
    }
    Ok(vehicle.frame().to_local_m(&place))
}
