//! The camera protocol: images, modes, zoom, focus and storage.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_IMAGE_CAPTURED_DATA, CAMERA_INFORMATION_DATA, CAMERA_SETTINGS_DATA,
    MavCmd, STORAGE_INFORMATION_DATA,
};
use vehicle::Refusal;
use vehicle::equipment::{Image, Operation};

use super::camera_messages as messages;
use super::operate::operate;
use crate::codec::{Command, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::service::message_request;
use crate::service::{CommandEntry, Outcome, Progress, Service};
use crate::speaker::Speaker;
use crate::stream::{Build, Stream};

const REQUEST_CAMERA_INFORMATION: u16 = MavCmd::MAV_CMD_REQUEST_CAMERA_INFORMATION as u16;
const REQUEST_CAMERA_SETTINGS: u16 = MavCmd::MAV_CMD_REQUEST_CAMERA_SETTINGS as u16;
const REQUEST_STORAGE_INFORMATION: u16 = MavCmd::MAV_CMD_REQUEST_STORAGE_INFORMATION as u16;
const REQUEST_CAMERA_CAPTURE_STATUS: u16 = MavCmd::MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS as u16;
const REQUEST_CAMERA_IMAGE_CAPTURE: u16 = MavCmd::MAV_CMD_REQUEST_CAMERA_IMAGE_CAPTURE as u16;
const STORAGE_FORMAT: u16 = MavCmd::MAV_CMD_STORAGE_FORMAT as u16;
const RESET_CAMERA_SETTINGS: u16 = MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS as u16;

const COMMANDS: &[CommandEntry] = &[
    CommandEntry::question(REQUEST_CAMERA_INFORMATION),
    CommandEntry::question(REQUEST_CAMERA_SETTINGS),
    CommandEntry::question(REQUEST_STORAGE_INFORMATION),
    CommandEntry::question(REQUEST_CAMERA_CAPTURE_STATUS),
    CommandEntry::question(REQUEST_CAMERA_IMAGE_CAPTURE),
    CommandEntry::action(STORAGE_FORMAT),
    CommandEntry::action(RESET_CAMERA_SETTINGS),
    CommandEntry::action(MavCmd::MAV_CMD_SET_CAMERA_MODE as u16),
    CommandEntry::action(MavCmd::MAV_CMD_SET_CAMERA_ZOOM as u16),
    CommandEntry::action(MavCmd::MAV_CMD_SET_CAMERA_FOCUS as u16),
    CommandEntry::action(MavCmd::MAV_CMD_IMAGE_START_CAPTURE as u16),
    CommandEntry::action(MavCmd::MAV_CMD_IMAGE_STOP_CAPTURE as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_TRIGGER_CONTROL as u16),
    CommandEntry::action(MavCmd::MAV_CMD_VIDEO_START_CAPTURE as u16),
    CommandEntry::action(MavCmd::MAV_CMD_VIDEO_STOP_CAPTURE as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_DIGICAM_CONTROL as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_SET_CAM_TRIGG_DIST as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL as u16),
    CommandEntry::action(MavCmd::MAV_CMD_OBLIQUE_SURVEY as u16),
];

const STREAMS: &[Stream] = &[
    Stream::on_request(CAMERA_INFORMATION_DATA::ID, Build::Component(messages::information))
        .from(Speaker::Camera),
    Stream::on_request(CAMERA_SETTINGS_DATA::ID, Build::Vehicle(messages::settings)).from(Speaker::Camera),
    Stream::on_request(STORAGE_INFORMATION_DATA::ID, Build::Vehicle(messages::storage)).from(Speaker::Camera),
    Stream::on_request(CAMERA_CAPTURE_STATUS_DATA::ID, Build::Vehicle(messages::capture_status))
        .from(Speaker::Camera),
    Stream::on_request(CAMERA_IMAGE_CAPTURED_DATA::ID, Build::Numbered(messages::image_captured))
        .from(Speaker::Camera),
];

/// The protocol, with the number of the last image that was told.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraProtocol {
    told: u32,
}

impl Service for CameraProtocol {
    fn summary(&self) -> &'static str {
        "Camera"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn speakers(&self) -> &'static [Speaker] {
        &[Speaker::Autopilot, Speaker::Camera]
    }

    fn answers(&self) -> &'static [u32] {
        &[id::CAMERA_TRIGGER, id::CAMERA_FEEDBACK]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        if let Some((id, number)) = requested(command) {
            let asked = Speaker::of(command.component).unwrap_or_default();
            message_request::send_once(context, origin, asked, id, number)?;
            return Ok(Progress::Done);
        }
        match command.number {
            STORAGE_FORMAT => format(context, command)?,
            RESET_CAMERA_SETTINGS if command.parameter(1) == 0.0 => {}
            RESET_CAMERA_SETTINGS => context.vehicle.operate(&Operation::ResetCamera)?,
            _ => operate(&mut context.vehicle, command)?,
        }
        tell_status(context);
        Ok(Progress::Done)
    }

    /// Every image is told at once: where and when it was taken.
    fn announce(&mut self, context: &mut Context) {
        let camera = context.vehicle.equipment().camera();
        if camera.triggers() == self.told {
            return;
        }
        let images: Vec<Image> = camera.images_after(self.told).copied().collect();
        self.told = camera.triggers();
        for image in images {
            let vehicle = &context.vehicle;
            let captured = messages::of_image(vehicle, &image);
            let (trigger, feedback) =
                (messages::trigger(vehicle, &image), messages::feedback(vehicle, &image));
            context.outbox.send_as(Speaker::Autopilot, Destination::Everyone, trigger);
            context.outbox.send_as(Speaker::Autopilot, Destination::Everyone, feedback);
            context.outbox.send_as(Speaker::Camera, Destination::Everyone, captured);
        }
    }
}

/// The message that one of the older commands asks for, and which of several; `None` for other commands.
fn requested(command: &Command) -> Option<(u32, u32)> {
    let id = match command.number {
        REQUEST_CAMERA_INFORMATION => CAMERA_INFORMATION_DATA::ID,
        REQUEST_CAMERA_SETTINGS => CAMERA_SETTINGS_DATA::ID,
        REQUEST_STORAGE_INFORMATION => STORAGE_INFORMATION_DATA::ID,
        REQUEST_CAMERA_CAPTURE_STATUS => CAMERA_CAPTURE_STATUS_DATA::ID,
        REQUEST_CAMERA_IMAGE_CAPTURE => {
            return Some((CAMERA_IMAGE_CAPTURED_DATA::ID, command.whole(1).unwrap_or(0)));
        }
        _ => return None,
    };
    Some((id, 0))
}

/// STORAGE_FORMAT: storage (0: all), whether to format, whether to count images anew.
fn format(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let storage = command.parameter(1);
    if !matches!(storage, 0.0 | 1.0) {
        return Err(Refusal::denied(format!("Storage {storage} does not exist; allowed 0 (all) or 1")));
    }
    if command.parameter(2) != 1.0 {
        return Ok(());
    }
    let reset_count = command.parameter(3) == 1.0;
    context.vehicle.operate(&Operation::Format { reset_count })?;
    let storage = messages::storage(&context.vehicle);
    context.outbox.send_as(Speaker::Camera, Destination::Everyone, storage);
    Ok(())
}

/// Tells everyone what the camera is set to, and what it does.
pub fn tell_status(context: &mut Context) {
    for message in [messages::settings(&context.vehicle), messages::capture_status(&context.vehicle)] {
        context.outbox.send_as(Speaker::Camera, Destination::Everyone, message);
    }
}
