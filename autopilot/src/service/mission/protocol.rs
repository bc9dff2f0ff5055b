//! Which messages and commands are about missions, fences and rally points.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MISSION_CURRENT_DATA, MavCmd, MavProtocolCapability};
use vehicle::identity::Identity;

use super::download;
use super::progress::{self, MissionProgress};
use super::upload::Uploads;
use crate::codec::{Command, Frame, id};
use crate::context::Context;
use crate::envelope::Origin;
use crate::service::{CommandEntry, Outcome, Progress, Service};
use crate::stream::{Group, Stream};

const DO_SET_MISSION_CURRENT: u16 = MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT as u16;
const MISSION_START: u16 = MavCmd::MAV_CMD_MISSION_START as u16;

const MESSAGES: &[u32] = &[
    id::MISSION_REQUEST_LIST,
    id::MISSION_REQUEST,
    id::MISSION_REQUEST_INT,
    id::MISSION_REQUEST_PARTIAL_LIST,
    id::MISSION_WRITE_PARTIAL_LIST,
    id::MISSION_COUNT,
    id::MISSION_ITEM,
    id::MISSION_ITEM_INT,
    id::MISSION_ACK,
    id::MISSION_SET_CURRENT,
    id::MISSION_CLEAR_ALL,
];

const COMMANDS: &[CommandEntry] =
    &[CommandEntry::action(DO_SET_MISSION_CURRENT), CommandEntry::action(MISSION_START)];

const STREAMS: &[Stream] =
    &[Stream::new(MISSION_CURRENT_DATA::ID, [1.0, 1.0], progress::current).of(Group::ExtendedStatus)];

/// Plans to and from clients, and how far a mission has come.
#[derive(Clone, Debug, Default)]
pub struct Missions {
    uploads: Uploads,
    progress: MissionProgress,
}

impl Service for Missions {
    fn summary(&self) -> &'static str {
        "Plans: missions, fences, rally points, and where the mission is"
    }

    fn answers(&self) -> &'static [u32] {
        &[
            id::MISSION_ACK,
            id::MISSION_COUNT,
            id::MISSION_ITEM,
            id::MISSION_ITEM_INT,
            id::MISSION_REQUEST,
            id::MISSION_REQUEST_INT,
            id::MISSION_ITEM_REACHED,
            id::MISSION_CURRENT,
        ]
    }

    fn messages(&self) -> &'static [u32] {
        MESSAGES
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT
            | MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MISSION_INT
            | MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
            | MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MISSION_RALLY
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::MISSION_REQUEST_LIST => download::request_list(context, origin, frame),
            id::MISSION_REQUEST | id::MISSION_REQUEST_INT => download::request(context, origin, frame),
            id::MISSION_REQUEST_PARTIAL_LIST => download::request_partial_list(context, origin, frame),
            id::MISSION_WRITE_PARTIAL_LIST => self.uploads.write_partial_list(context, origin, frame),
            id::MISSION_COUNT => self.uploads.count(context, origin, frame),
            id::MISSION_ITEM | id::MISSION_ITEM_INT => self.uploads.item(context, origin, frame),
            id::MISSION_ACK => self.uploads.acknowledge(context, origin, frame),
            id::MISSION_SET_CURRENT => self.progress.set_current(context, frame),
            id::MISSION_CLEAR_ALL => self.uploads.clear_all(context, origin, frame),
            _ => {}
        }
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        match command.number {
            DO_SET_MISSION_CURRENT => self.progress.set_current_by_command(context, command)?,
            _ => progress::start(context, command)?,
        }
        Ok(Progress::Done)
    }

    fn is_busy(&self) -> bool {
        self.uploads.are_under_way()
    }

    fn tick(&mut self, context: &mut Context) {
        self.uploads.update(context);
    }

    fn announce(&mut self, context: &mut Context) {
        self.progress.update(context);
    }
}
