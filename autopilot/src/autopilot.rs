//! The whole vehicle as MAVLink sees it, without a socket and without a clock: received frames and ticks of simulation
//! time go in, messages come out.

use std::collections::VecDeque;

use mavlink::dialects::common::GPS_GLOBAL_ORIGIN_DATA;
use quadrotor::{ConfigurationError, SimulationError};
use vehicle::identity::Identity;
use vehicle::parameters::{Change, ParameterTable, ParameterValues, SPEED_PARAMETER, SetError, Speed, Value};
use vehicle::{MissionStatus, Refusal, Severity, Vehicle, VehicleSettings};

use crate::codec::{Frame, Message, id, parameter_hash, target_of};
use crate::file_store::{FileStore, Nothing};
use crate::service::command::Retries;
use crate::service::command::calibration::Calibration;
use crate::service::file_transfer::FileServer;
use crate::service::heartbeat::Heartbeat;
use crate::service::log::LogServer;
use crate::service::message_interval::Streams;
use crate::service::mission::Uploads;
use crate::service::status_text::StatusTexts;
use crate::service::{
    Destination, LinkProfile, Origin, Outgoing, PeerId, command, file_transfer, heartbeat, log,
    manual_control, message_interval, mission, parameter, set_point, status_text, telemetry,
    time_synchronization,
};

/// Component id of an autopilot.
pub const COMPONENT: u8 = 1;

/// What this is, for whoever takes it for a flying one.
const INTRODUCTION: &str =
    concat!("lmpc-sitl ", env!("CARGO_PKG_VERSION"), ": simulated quadrotor, Laguerre MPC");
/// Peers that are remembered as told so.
const MOST_GREETED: usize = 256;

/// A vehicle with its services.
#[derive(Debug)]
pub struct Autopilot {
    system_id: u8,
    settings: VehicleSettings,
    speed: Speed,
    parameters_changed: bool,
    initial_parameters: Vec<Value>,
    outbox: Vec<Outgoing>,
    greeted: VecDeque<PeerId>,
    pub(crate) vehicle: Vehicle,
    pub(crate) table: ParameterTable,
    pub(crate) streams: Vec<Streams>,
    pub(crate) heartbeat: Heartbeat,
    pub(crate) status_texts: StatusTexts,
    pub(crate) retries: Retries,
    pub(crate) calibration: Option<Calibration>,
    pub(crate) files: FileServer,
    pub(crate) uploads: Uploads,
    pub(crate) mission_told: Option<MissionStatus>,
    pub(crate) store: Box<dyn FileStore>,
    pub(crate) logs: LogServer,
}

impl Autopilot {
    /// A vehicle that has just started.
    ///
    /// # Errors
    /// [`ConfigurationError`] when the closed loop cannot be built.
    pub fn new(
        settings: &VehicleSettings,
        system_id: u8,
        speed: Speed,
        links: &[LinkProfile],
        unix_start_us: u64,
    ) -> Result<Self, ConfigurationError> {
        let mut autopilot = Self {
            system_id,
            settings: settings.clone(),
            speed,
            parameters_changed: false,
            initial_parameters: Vec::new(),
            outbox: Vec::new(),
            greeted: VecDeque::new(),
            vehicle: Vehicle::new(settings)?,
            table: ParameterTable::new(settings.identity),
            streams: links.iter().map(|profile| Streams::new(*profile)).collect(),
            heartbeat: Heartbeat::default(),
            status_texts: StatusTexts::default(),
            retries: Retries::default(),
            calibration: None,
            files: FileServer::default(),
            uploads: Uploads::default(),
            mission_told: None,
            store: Box::new(Nothing),
            logs: LogServer::default(),
        };
        autopilot.vehicle.set_unix_start_us(unix_start_us);
        autopilot.initial_parameters = autopilot.parameters().map(|(_, value)| value).collect();
        heartbeat::update(&mut autopilot);
        status_text::send(&mut autopilot, Severity::Info, INTRODUCTION);
        Ok(autopilot)
    }

    /// Takes a received frame in. What is for somebody else, or means nothing here, changes nothing.
    pub fn receive(&mut self, origin: &Origin, frame: &Frame) {
        self.greet(origin);
        if !target_of(frame).is_autopilot(self.system_id) {
            return;
        }
        match frame.message_id() {
            id::PING => time_synchronization::ping(self, origin, frame),
            id::SET_MODE => command::set_mode(self, origin, frame),
            id::PARAM_REQUEST_READ => parameter::request_read(self, origin, frame),
            id::PARAM_REQUEST_LIST => parameter::request_list(self, origin),
            id::PARAM_SET => parameter::set(self, origin, frame),
            id::MISSION_REQUEST_LIST => mission::request_list(self, origin, frame),
            id::MISSION_REQUEST | id::MISSION_REQUEST_INT => mission::request(self, origin, frame),
            id::MISSION_REQUEST_PARTIAL_LIST => mission::request_partial_list(self, origin, frame),
            id::MISSION_WRITE_PARTIAL_LIST => mission::write_partial_list(self, origin, frame),
            id::MISSION_COUNT => mission::count(self, origin, frame),
            id::MISSION_ITEM | id::MISSION_ITEM_INT => mission::item(self, origin, frame),
            id::MISSION_ACK => mission::acknowledge(self, origin, frame),
            id::MISSION_SET_CURRENT => mission::set_current(self, frame),
            id::MISSION_CLEAR_ALL => mission::clear_all(self, origin, frame),
            id::SET_GPS_GLOBAL_ORIGIN => self.refuse_origin(origin),
            id::REQUEST_DATA_STREAM => message_interval::request_data_stream(self, origin, frame),
            id::MANUAL_CONTROL => manual_control::manual_control(self, frame),
            id::RC_CHANNELS_OVERRIDE => manual_control::channels_override(self, frame),
            id::COMMAND_CANCEL => command::calibration::cancel(self, frame),
            id::COMMAND_INT | id::COMMAND_LONG => command::handle(self, origin, frame),
            id::SET_ATTITUDE_TARGET => set_point::attitude(self, frame),
            id::SET_POSITION_TARGET_LOCAL_NED | id::SET_POSITION_TARGET_GLOBAL_INT => {
                set_point::position(self, frame);
            }
            id::FILE_TRANSFER_PROTOCOL => file_transfer::handle(self, origin, frame),
            id::TIMESYNC => time_synchronization::timesync(self, origin, frame),
            id::LOG_REQUEST_LIST => log::request_list(self, origin, frame),
            id::LOG_REQUEST_DATA => log::request_data(self, origin, frame),
            id::LOG_REQUEST_END => log::request_end(self, origin),
            id::LOG_ERASE => log::erase(self, origin),
            _ => {}
        }
        self.tell_changes();
    }

    /// Tells a peer that is heard for the first time what this is.
    fn greet(&mut self, origin: &Origin) {
        if self.greeted.contains(&origin.peer) {
            return;
        }
        if self.greeted.len() >= MOST_GREETED {
            self.greeted.pop_front();
        }
        self.greeted.push_back(origin.peer);
        let to = Destination::Peer(origin.peer);
        self.send(to, heartbeat::message(&self.vehicle));
        for message in status_text::messages(Severity::Info, INTRODUCTION, &mut 0) {
            self.send(to, message);
        }
    }

    /// Flies one tick on and sends what is due then.
    ///
    /// # Errors
    /// [`SimulationError`]: the flight cannot go on.
    pub fn tick(&mut self) -> Result<(), SimulationError> {
        self.vehicle.tick()?;
        mission::update(self);
        command::calibration::step(self);
        self.tell_changes();
        message_interval::stream(self);
        Ok(())
    }

    /// Tells whether a ground station is heard: that is judged by the wall clock, which is outside.
    pub fn hear_ground_station(&mut self, heard: bool) {
        self.vehicle.hear_ground_station(heard);
    }

    /// A heartbeat beside the regular ones: a link must not look dead while simulation time stands still.
    pub fn keep_alive(&mut self) {
        heartbeat::beat(self);
    }

    /// Lines for the pilot since the last call, with their times, µs.
    pub fn take_texts(&mut self) -> Vec<(u64, Severity, String)> {
        self.status_texts.take_unlogged()
    }

    /// Gives clients files to reach. They change nothing of the flight.
    pub fn share(&mut self, store: Box<dyn FileStore>) {
        self.store = store;
    }

    /// Sends up to this many messages of logs that are being downloaded, to peers that have room for them (`None`: the
    /// peer is gone). How fast they go is a matter of links and wall clocks, not of the flight.
    pub fn send_logs(&mut self, messages: usize, has_room: impl Fn(PeerId) -> Option<bool>) {
        log::send(self, messages, has_room);
    }

    /// Tells everyone what has happened around the vehicle. It changes nothing of the flight.
    pub fn announce(&mut self, severity: Severity, text: &str) {
        status_text::send(self, severity, text);
    }

    fn tell_changes(&mut self) {
        mission::update_progress(self);
        status_text::send_notices(self);
        heartbeat::update(self);
    }

    /// The origin of the local frame is where the flight began: it is told again.
    fn refuse_origin(&mut self, origin: &Origin) {
        const GPS_GLOBAL_ORIGIN: u32 = <GPS_GLOBAL_ORIGIN_DATA as mavlink::MessageData>::ID;
        status_text::send(self, Severity::Warning, "The origin is set at the start, by --home");
        if let Some(message) = telemetry::message(self, GPS_GLOBAL_ORIGIN) {
            self.send(Destination::Peer(origin.peer), message);
        }
    }

    pub(crate) fn send(&mut self, to: Destination, message: impl Into<Message>) {
        self.outbox.push(Outgoing { to, message: message.into() });
    }

    /// A place in the order of what is to be sent: behind everything so far.
    pub(crate) fn mark(&self) -> usize {
        self.outbox.len()
    }

    /// Moves the last message to a mark.
    pub(crate) fn last_to(&mut self, mark: usize) {
        if let Some(message) = self.outbox.pop() {
            self.outbox.insert(mark.min(self.outbox.len()), message);
        }
    }

    /// Messages to be sent since the last call.
    pub fn take_outgoing(&mut self) -> Vec<Outgoing> {
        std::mem::take(&mut self.outbox)
    }

    /// The vehicle.
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Whose conventions it follows.
    pub fn identity(&self) -> Identity {
        self.settings.identity
    }

    /// Its system id.
    pub fn system_id(&self) -> u8 {
        self.system_id
    }

    /// The pace that is asked for.
    pub fn speed(&self) -> Speed {
        self.speed
    }

    /// Another pace, which its clients are told.
    pub fn set_speed(&mut self, speed: Speed) {
        self.speed = speed;
        parameter::tell(self, SPEED_PARAMETER);
    }

    /// Time of the wall clock at the start, µs since 1970.
    pub fn unix_start_us(&self) -> u64 {
        self.vehicle.unix_start_us()
    }

    /// What it was started with.
    pub fn settings(&self) -> &VehicleSettings {
        &self.settings
    }

    /// All parameters in their order.
    pub fn parameter_table(&self) -> &ParameterTable {
        &self.table
    }

    /// What its parameters are read from.
    fn parameter_values(&self) -> ParameterValues {
        ParameterValues {
            configuration: self.vehicle.kept_configuration(),
            conduct: *self.vehicle.conduct(),
            system_id: self.system_id,
            speed: self.speed,
        }
    }

    /// Value of the parameter at a position of the table.
    pub fn parameter_value(&self, index: usize) -> Option<Value> {
        self.table.value(index, &self.parameter_values())
    }

    /// All parameters with their values, in the order of the table.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, Value)> {
        self.table.values(self.parameter_values())
    }

    /// Parameters as they were at the start, in the order of the table.
    pub(crate) fn initial_parameters(&self) -> &[Value] {
        &self.initial_parameters
    }

    pub(crate) fn parameter_hash(&self) -> u32 {
        parameter_hash(self.parameters())
    }

    /// Changes a parameter.
    pub(crate) fn set_parameter(&mut self, id: &str, value: f64) -> Result<(), SetError> {
        let mut values = self.parameter_values();
        if self.table.set(id, value, &mut values)? != Change::Nothing {
            let adopted = self.vehicle.adopt(&values.configuration, &values.conduct);
            adopted.map_err(|source| SetError::refused(id, source))?;
            self.speed = values.speed;
        }
        self.parameters_changed = true;
        Ok(())
    }

    /// All parameters as at the start.
    pub(crate) fn reset_parameters(&mut self) -> Result<(), Refusal> {
        if self.vehicle.is_armed() {
            return Err(Refusal::later("Parameters are not reset while armed"));
        }
        let mut configuration = self.settings.configuration;
        let now = self.vehicle.simulation().configuration();
        (configuration.initial, configuration.environment) = (now.initial, now.environment);
        configuration.reference = now.reference;
        let adopted = self.vehicle.adopt(&configuration, &self.settings.conduct);
        adopted.map_err(|error| Refusal::denied(error.to_string()))?;
        self.parameters_changed = true;
        Ok(())
    }

    /// The parameters as the text of a file, if one has changed since the last call.
    pub fn take_changed_parameters(&mut self) -> Option<String> {
        if !std::mem::take(&mut self.parameters_changed) {
            return None;
        }
        Some(vehicle::parameters::render(&self.table, &self.parameter_values()))
    }
}
