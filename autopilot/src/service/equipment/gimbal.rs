//! The gimbal manager, which is in the autopilot, and the requests of its device.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, GIMBAL_DEVICE_INFORMATION_DATA, GIMBAL_MANAGER_INFORMATION_DATA,
    GIMBAL_MANAGER_STATUS_DATA, MOUNT_STATUS_DATA, MavCmd,
};
use nalgebra::{Quaternion, UnitQuaternion};
use vehicle::equipment::{Controller, GimbalControl, Operation, Pointing};
use vehicle::{Refusal, Vehicle};

use super::gimbal_messages as messages;
use super::mount_control::control_mount;
use super::operate::operate;
use crate::codec::{Command, Frame, Payload, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::service::{CommandEntry, Outcome, Progress, Service};
use crate::speaker::Speaker;
use crate::stream::{Build, Group, Stream};

const CONFIGURE: u16 = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE as u16;
const PITCHYAW: u16 = MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW as u16;
const MOUNT_CONTROL: u16 = MavCmd::MAV_CMD_DO_MOUNT_CONTROL as u16;

const COMMANDS: &[CommandEntry] = &[
    CommandEntry::action(CONFIGURE),
    CommandEntry::action(PITCHYAW),
    CommandEntry::action(MavCmd::MAV_CMD_DO_MOUNT_CONFIGURE as u16),
    CommandEntry::action(MOUNT_CONTROL),
];

const STREAMS: &[Stream] = &[
    Stream::on_request(GIMBAL_MANAGER_INFORMATION_DATA::ID, Build::Component(messages::manager_information)),
    Stream {
        rates_hz: [0.5, 0.5],
        ..Stream::on_request(GIMBAL_MANAGER_STATUS_DATA::ID, Build::Component(messages::manager_status))
    },
    Stream::on_request(GIMBAL_DEVICE_INFORMATION_DATA::ID, Build::Component(messages::device_information))
        .from(Speaker::Gimbal),
    Stream {
        rates_hz: [1.0, 5.0],
        ..Stream::on_request(
            GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::ID,
            Build::Component(messages::attitude_status),
        )
    }
    .of(Group::Extra3)
    .from(Speaker::Gimbal),
    Stream::new(MOUNT_STATUS_DATA::ID, [0.0, 0.0], messages::mount_status).of(Group::Extra3),
];

/// GIMBAL_MANAGER_FLAGS and GIMBAL_DEVICE_FLAGS.
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;
const YAW_LOCK: u32 = 16;
const YAW_IN_EARTH_FRAME: u32 = 64;

/// The manager, with who was told to be in control.
#[derive(Clone, Copy, Debug, Default)]
pub struct GimbalManager {
    told: GimbalControl,
}

impl Service for GimbalManager {
    fn summary(&self) -> &'static str {
        "Gimbal manager and gimbal"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::GIMBAL_MANAGER_SET_ATTITUDE, id::GIMBAL_MANAGER_SET_PITCHYAW, id::GIMBAL_DEVICE_SET_ATTITUDE]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn speakers(&self) -> &'static [Speaker] {
        &[Speaker::Autopilot, Speaker::Gimbal]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    /// Set-points of who is in control; those of others are dropped, as PX4 does. The device itself asks nobody.
    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let operation = match frame.message_id() {
            id::GIMBAL_DEVICE_SET_ATTITUDE => attitude(&payload, 0, 16, u32::from(payload.u16(28))),
            _ if may_point(&context.vehicle, origin).is_err() => None,
            id::GIMBAL_MANAGER_SET_ATTITUDE => attitude(&payload, 4, 20, payload.u32(0)),
            _ => Some(pitch_and_yaw(&payload)),
        };
        if let Some(operation) = operation {
            // Pointing is never refused.
            let _pointed = context.vehicle.operate(&operation);
        }
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        match command.number {
            CONFIGURE => configure(&mut context.vehicle, origin, command)?,
            PITCHYAW => {
                may_point(&context.vehicle, origin)?;
                operate(&mut context.vehicle, command)?;
            }
            number => {
                // The older commands take control.
                if number == MOUNT_CONTROL && context.vehicle.identity().is_ardupilot() {
                    control_mount(&mut context.vehicle, command)?;
                } else {
                    operate(&mut context.vehicle, command)?;
                }
                let control = context.vehicle.equipment().gimbal_control();
                let primary = Some(controller(origin));
                context.vehicle.give_gimbal_control(GimbalControl { primary, ..control });
            }
        }
        Ok(Progress::Done)
    }

    /// Who is in control is told at once.
    fn announce(&mut self, context: &mut Context) {
        let control = context.vehicle.equipment().gimbal_control();
        if control != self.told {
            self.told = control;
            let status = messages::manager_status(&context.component());
            context.outbox.send_as(Speaker::Autopilot, Destination::Everyone, status);
        }
    }
}

fn controller(origin: &Origin) -> Controller {
    Controller { system: origin.system, component: origin.component }
}

/// Whether a client may point it: PX4 wants it to take control first, ArduPilot does not.
fn may_point(vehicle: &Vehicle, origin: &Origin) -> Result<(), Refusal> {
    let client = controller(origin);
    if vehicle.identity().is_ardupilot() || vehicle.equipment().gimbal_control().has(client) {
        return Ok(());
    }
    Err(Refusal::denied(format!(
        "Gimbal denied: {}/{} is not in control; send DO_GIMBAL_MANAGER_CONFIGURE first",
        client.system, client.component
    )))
}

/// DO_GIMBAL_MANAGER_CONFIGURE: system and component of primary and secondary control. −1 leaves it, −2 is the sender, −3 gives up
/// what the sender has; 0 is nobody.
fn configure(vehicle: &mut Vehicle, origin: &Origin, command: &Command) -> Result<(), Refusal> {
    let sender = controller(origin);
    let control = vehicle.equipment().gimbal_control();
    let wanted = |first: usize, now: Option<Controller>| -> Result<Option<Controller>, Refusal> {
        let number = |at: usize| command.parameter(at);
        let id = |value: f64| (value.fract() == 0.0 && (0.0..=255.0).contains(&value)).then_some(value as u8);
        match (number(first), number(first + 1)) {
            (-1.0, _) | (_, -1.0) => Ok(now),
            (-2.0, _) | (_, -2.0) => Ok(Some(sender)),
            (-3.0, _) | (_, -3.0) => Ok(now.filter(|now| *now != sender)),
            (system, component) => match (id(system), id(component)) {
                (Some(0), Some(_)) => Ok(None),
                (Some(system), Some(component)) => Ok(Some(Controller { system, component })),
                _ => Err(Refusal::denied(format!(
                    "Gimbal control denied: {system}/{component}; allowed 0 to 255, -1 (as it is), -2 (the sender) \
                     or -3 (not the sender)"
                ))),
            },
        }
    };
    let (primary, secondary) = (wanted(1, control.primary)?, wanted(3, control.secondary)?);
    vehicle.give_gimbal_control(GimbalControl { primary, secondary });
    Ok(())
}

fn given(value: f32) -> Option<f64> {
    Some(f64::from(value)).filter(|value| value.is_finite())
}

fn of_flags(flags: u32) -> Option<Operation> {
    if flags & RETRACT != 0 {
        Some(Operation::RetractGimbal)
    } else {
        (flags & NEUTRAL != 0).then_some(Operation::CentreGimbal)
    }
}

fn locks(flags: u32) -> bool {
    flags & (YAW_LOCK | YAW_IN_EARTH_FRAME) != 0
}

/// A quaternion, or rates where that is NaN, at offsets of a payload; `None` if neither is given.
fn attitude(payload: &Payload<'_>, quaternion: usize, rates: usize, flags: u32) -> Option<Operation> {
    if let Some(operation) = of_flags(flags) {
        return Some(operation);
    }
    let [w, x, y, z]: [f64; 4] = payload.reals(quaternion);
    let turn = Quaternion::new(w, x, y, z);
    let angles = (turn.norm() > 0.5).then(|| UnitQuaternion::from_quaternion(turn).euler_angles());
    let (pitch_rate_rad_s, yaw_rate_rad_s) = (given(payload.f32(rates + 4)), given(payload.f32(rates + 8)));
    if angles.is_none() && pitch_rate_rad_s.is_none() && yaw_rate_rad_s.is_none() {
        return None;
    }
    Some(Operation::Point(Pointing {
        roll_rad: angles.map(|(roll, ..)| roll),
        pitch_rad: angles.map(|(_, pitch, _)| pitch),
        yaw_rad: angles.map(|(.., yaw)| yaw),
        pitch_rate_rad_s,
        yaw_rate_rad_s,
        yaw_lock: locks(flags),
    }))
}

/// GIMBAL_MANAGER_SET_PITCHYAW.
fn pitch_and_yaw(payload: &Payload<'_>) -> Operation {
    let flags = payload.u32(0);
    of_flags(flags).unwrap_or_else(|| {
        Operation::Point(Pointing {
            roll_rad: None,
            pitch_rad: given(payload.f32(4)),
            yaw_rad: given(payload.f32(8)),
            pitch_rate_rad_s: given(payload.f32(12)),
            yaw_rate_rad_s: given(payload.f32(16)),
            yaw_lock: locks(flags),
        })
    })
}
