//! The target of the follow mode: PX4 hears FOLLOW_TARGET, ArduPilot also GLOBAL_POSITION_INT of the system that it is to follow.

use mavlink::dialects::ardupilotmega::MavCmd;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use vehicle::plan::frame;
use vehicle::world::Geodetic;
use vehicle::{Refusal, TargetReport, Vehicle};

use super::parameter;
use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Frame, Payload, degrees, id};
use crate::context::Context;
use crate::envelope::Origin;

/// Parts of a FOLLOW_TARGET that are known (est_capabilities).
const POSITION: u8 = 1;
const VELOCITY: u8 = 2;
const ACCELERATION: u8 = 4;
const ATTITUDE: u8 = 8;
/// A system that was found by itself is forgotten when it is silent for so long, µs.
const FORGOTTEN_US: u64 = 10_000_000;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_DO_FOLLOW as u16)];

/// Hears the target.
#[derive(Clone, Copy, Debug, Default)]
pub struct Follow {
    /// The system that was found where none is named, and when it was heard last, µs.
    found: Option<(u8, u64)>,
    /// Whether it tells itself as FOLLOW_TARGET: then GLOBAL_POSITION_INT tells nothing.
    as_target: bool,
}

impl Service for Follow {
    fn summary(&self) -> &'static str {
        "The target of the follow mode"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::GLOBAL_POSITION_INT, id::FOLLOW_TARGET]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let as_target = frame.message_id() == id::FOLLOW_TARGET;
        let ardupilot = context.identity().is_ardupilot();
        if origin.system == context.system_id() || !ardupilot && !as_target {
            return;
        }
        if ardupilot && !self.is_target(context, origin.system, as_target) {
            return;
        }
        let read = if as_target { follow_target } else { global_position };
        if let Some(report) = read(&frame.payload(), &context.vehicle) {
            context.vehicle.hear_target(&report);
            if ardupilot {
                self.found = Some((origin.system, context.vehicle.time_us()));
                self.as_target = as_target;
            }
        }
    }

    /// ArduPilot: whom to follow.
    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        if !context.identity().is_ardupilot() {
            let instead = "enter the mode Follow Me and send FOLLOW_TARGET";
            return Err(Refusal::Unsupported(format!("DO_FOLLOW is not supported: {instead}")));
        }
        let system = command.whole(1).filter(|system| (1..=255).contains(system));
        let system = system.ok_or_else(|| Refusal::denied("DO_FOLLOW requires a system id from 1 to 255"))?;
        let mut conduct = *context.vehicle.conduct();
        conduct.follow.system_id = system as u8;
        let kept = context.vehicle.kept_configuration();
        context.vehicle.adopt(&kept, &conduct).map_err(|error| Refusal::denied(error.to_string()))?;
        parameter::tell(context, "FOLL_SYSID");
        Ok(Progress::Done)
    }
}

impl Follow {
    /// Whether ArduPilot takes a system for its target: the one that it is told, or the first one that it hears.
    fn is_target(&mut self, context: &Context, system: u8, as_target: bool) -> bool {
        let settings = &context.vehicle.conduct().follow;
        let time_us = context.vehicle.time_us();
        if self.found.is_some_and(|(_, heard_us)| time_us > heard_us + FORGOTTEN_US) {
            *self = Self::default();
        }
        let wanted = match settings.system_id {
            0 => self.found.map(|(system, _)| system),
            told => Some(told),
        };
        settings.enabled && wanted.is_none_or(|wanted| wanted == system) && (as_target || !self.as_target)
    }
}

/// FOLLOW_TARGET, if it tells a place.
fn follow_target(payload: &Payload, vehicle: &Vehicle) -> Option<TargetReport> {
    let known = payload.u8(92);
    let parts = |part: u8| known & part != 0;
    // PX4 reads the place whatever is said to be known.
    if vehicle.identity().is_ardupilot() && !parts(POSITION) {
        return None;
    }
    let vector = |part: u8, offset: usize| {
        let vector = Vector3::from(payload.reals::<3>(offset));
        Some(vector).filter(|vector| parts(part) && vector.iter().all(|value| value.is_finite()))
    };
    // PX4 reads a velocity whatever is said to be known: MAVSDK tells one, and claims the place only.
    let velocity_m_s = if vehicle.identity().is_ardupilot() {
        vector(VELOCITY, 28)
    } else {
        Some(Vector3::from(payload.reals::<3>(28))).filter(|v| v.iter().all(|value| value.is_finite()))
    };
    let [w, x, y, z] = payload.reals::<4>(52);
    let attitude = Quaternion::new(w, x, y, z);
    let has_attitude = parts(ATTITUDE) && (0.9..=1.1).contains(&attitude.norm());
    Some(TargetReport {
        position_m: place_m(payload, 16, f64::from(payload.f32(24)), frame::GLOBAL, vehicle)?,
        velocity_m_s,
        acceleration_m_s2: vector(ACCELERATION, 40),
        heading_rad: has_attitude.then(|| UnitQuaternion::new_normalize(attitude).euler_angles().2),
    })
}

/// GLOBAL_POSITION_INT.
fn global_position(payload: &Payload, vehicle: &Vehicle) -> Option<TargetReport> {
    const HEADINGS: u16 = 36_000;
    let (offset, frame) = if vehicle.conduct().follow.relative_height {
        (16, frame::GLOBAL_RELATIVE)
    } else {
        (12, frame::GLOBAL)
    };
    let altitude_m = f64::from(payload.i32(offset)) / 1e3;
    let velocity = [20, 22, 24].map(|offset| f64::from(payload.i16(offset)) / 100.0);
    let heading = Some(payload.u16(26)).filter(|heading| *heading <= HEADINGS);
    Some(TargetReport {
        position_m: place_m(payload, 4, altitude_m, frame, vehicle)?,
        velocity_m_s: Some(Vector3::from(velocity)),
        acceleration_m_s2: None,
        heading_rad: heading.map(|heading| (f64::from(heading) / 100.0).to_radians()),
    })
}

/// Latitude and longitude at an offset with an altitude, NED, m; `None` for no place.
fn place_m(
    payload: &Payload,
    offset: usize,
    altitude_m: f64,
    frame: u8,
    vehicle: &Vehicle,
) -> Option<Vector3<f64>> {
    let [latitude, longitude] = [payload.i32(offset), payload.i32(offset + 4)];
    let origin_m = vehicle.frame().origin().altitude_m;
    let place =
        Geodetic { latitude_deg: degrees(latitude), longitude_deg: degrees(longitude), altitude_m: origin_m };
    if (latitude, longitude) == (0, 0) || !place.is_valid() || !altitude_m.is_finite() {
        return None;
    }
    let mut place_m = vehicle.frame().to_local_m(&place);
    place_m.z = vehicle.site().down_m(frame, altitude_m, [place_m.x, place_m.y]);
    Some(place_m)
}
