//! Orbits: MAV_CMD_DO_ORBIT, and ORBIT_EXECUTION_STATUS while one is flown. ArduPilot's circle is a mode, and has no command.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MavCmd, MavFrame, MavMessage, ORBIT_EXECUTION_STATUS_DATA};
use vehicle::plan::frame;
use vehicle::{OrbitHeading, OrbitRequest, Refusal, Vehicle};

use super::command::told_place;
use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, scaled_degrees};
use crate::context::Context;
use crate::envelope::Origin;
use crate::stream::{Build, Stream};

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_DO_ORBIT as u16)];

/// PX4's rates of the status, Hz.
const STREAMS: &[Stream] =
    &[Stream::when(ORBIT_EXECUTION_STATUS_DATA::ID, [2.0, 5.0], Build::Perhaps(status))];

/// Takes orbits, and tells of them.
#[derive(Clone, Copy, Debug)]
pub struct Orbits;

impl Service for Orbits {
    fn summary(&self) -> &'static str {
        "Flight around a centre"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let vehicle = &mut context.vehicle;
        if vehicle.identity().is_ardupilot() {
            let instead = "ArduPilot flies circles in its CIRCLE mode, by CIRCLE_RADIUS and CIRCLE_RATE";
            return Err(Refusal::Unsupported(format!("DO_ORBIT is not supported: {instead}")));
        }
        let request = request(command, vehicle)?;
        vehicle.orbit(&request)?;
        Ok(Progress::Done)
    }
}

/// Radius, m, speed, m/s, ORBIT_YAW_BEHAVIOUR, way around, rad, centre. What is no number is left open. The altitude is above sea level
/// whatever the frame says: so PX4 has it, and MAVSDK sends one above sea level in a frame of heights above home.
fn request(command: &Command, vehicle: &Vehicle) -> Result<OrbitRequest, Refusal> {
    let given = |number: usize| Some(command.parameter(number)).filter(|value| value.is_finite());
    let heading = match given(3) {
        None => None,
        // Unchanged.
        Some(5.0) => None,
        Some(number) => {
            let known = OrbitHeading::ALL.iter().zip(0_i32..);
            let mut found = known.filter(|(_, known)| f64::from(*known) == number);
            let (heading, _) = found.next().ok_or_else(|| {
                Refusal::denied(format!("Unknown yaw behaviour {number}: 0 to 5 are allowed"))
            })?;
            Some(*heading)
        }
    };
    let nowhere = command.x.is_nan() || command.y.is_nan();
    let centre_m = if nowhere { None } else { Some(told_place(command, vehicle)?) };
    Ok(OrbitRequest {
        centre_m: centre_m.map(|place_m| [place_m.x, place_m.y]),
        down_m: Some(command.z)
            .filter(|z| z.is_finite())
            .map(|z| vehicle.site().down_m(frame::GLOBAL, z, [0.0; 2])),
        radius_m: given(1),
        speed_m_s: given(2),
        heading,
        way_rad: given(4).filter(|way_rad| *way_rad > 0.0),
    })
}

/// ORBIT_EXECUTION_STATUS, while an orbit is flown.
fn status(vehicle: &Vehicle) -> Option<MavMessage> {
    let status = vehicle.orbit_status()?;
    let place = vehicle.place_of(&status.centre_m);
    Some(MavMessage::ORBIT_EXECUTION_STATUS(ORBIT_EXECUTION_STATUS_DATA {
        time_usec: vehicle.time_us(),
        radius: status.radius_m as f32,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        x: scaled_degrees(place.latitude_deg),
        y: scaled_degrees(place.longitude_deg),
        z: place.altitude_m as f32,
    }))
}
