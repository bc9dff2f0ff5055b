//! The whole vehicle as MAVLink sees it, without a socket and without a clock: received frames and ticks of simulation
//! time go in, messages come out.

use std::vec::Drain;

use mavlink::dialects::ardupilotmega::MavType;
use quadrotor::ConfigurationError;
use vehicle::identity::Identity;
use vehicle::parameters::{FileFormat, ParameterTable, SPEED_PARAMETER, Speed, Value};
use vehicle::{FlightError, LandedState, Pulses, Severity, TICK_US, Vehicle, VehicleSettings};

use crate::codec::{Frame, Message, id, target_of};
use crate::context::Context;
use crate::envelope::{Destination, LinkProfile, Origin, Outgoing, PeerId};
use crate::file_store::Nothing;
use crate::file_work::{FileWorker, Immediate};
use crate::log_queue::LogQueue;
use crate::outbox::Outbox;
use crate::parameters::Parameters;
use crate::service::registry::Registry;
use crate::service::{heartbeat, parameter, traffic};

/// For how long a vehicle at rest is left alone after the end of its long tick of 20 ms, µs.
const LONGER_REST_US: u64 = 30_000;
/// Regular messages that are due within multiples of this leave together, µs.
const TOGETHER_US: u64 = 5_000;

/// A vehicle with its services.
#[derive(Debug)]
pub struct Autopilot {
    context: Context,
    services: Registry,
    /// How long the boots before the present one have lasted, µs.
    before_us: u64,
    boots: u32,
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
        Ok(Self::of(Vehicle::new(settings)?, settings, system_id, speed, links, unix_start_us))
    }

    /// The same for a vehicle that has been made from these settings.
    pub fn of(
        mut vehicle: Vehicle,
        settings: &VehicleSettings,
        system_id: u8,
        speed: Speed,
        links: &[LinkProfile],
        unix_start_us: u64,
    ) -> Self {
        let mut services = Registry::new();
        vehicle.set_unix_start_us(unix_start_us);
        let mut context = Context {
            parameters: Parameters::new(settings, &vehicle, system_id, speed),
            vehicle,
            outbox: Outbox::new(system_id).with_voice(settings.equipment),
            files: Box::new(Immediate(Nothing)),
            streams: services.streams(settings.identity),
            capabilities: services.capabilities(settings.identity),
            links: links.to_vec(),
            log_queue: LogQueue::default(),
            reboot_us: None,
            quiet_until_us: 0,
            rests: false,
        };
        context.parameters.statistics_mut().reset(unix_start_us / 1_000_000);
        services.start(&mut context);
        Self { context, services, before_us: 0, boots: 1 }
    }

    /// Takes a received frame in. What is for somebody else, or means nothing here, changes nothing; a command for a component that is
    /// not there is refused.
    pub fn receive(&mut self, origin: &Origin, frame: &Frame) {
        // Whatever it asks for may be due at once.
        self.context.quiet_until_us = 0;
        self.services.hear(&mut self.context, origin);
        let Some(asked) = target_of(frame).speaker(self.system_id()) else {
            self.services.decline(&mut self.context, origin, frame);
            return;
        };
        self.services.receive(&mut self.context, origin, frame, asked);
        self.services.announce(&mut self.context);
    }

    /// Flies one tick on and sends what is due then.
    ///
    /// # Errors
    /// [`FlightError`]: the flight cannot go on.
    pub fn tick(&mut self) -> Result<(), FlightError> {
        self.fly(1).map(drop)
    }

    /// Flies on, sends what is due then, and returns by how many ticks: one, or up to `most` until a regular message is due, if the vehicle
    /// [hovers](Vehicle::fly) and nothing happens to it.
    ///
    /// # Errors
    /// [`FlightError`]: the flight cannot go on.
    pub fn fly(&mut self, most: u64) -> Result<u64, FlightError> {
        let time_us = self.context.vehicle.time_us();
        if self.context.reboot_us.is_some_and(|due_us| time_us >= due_us) {
            self.reboot()?;
        }
        let ticks = self.context.vehicle.fly(most.min(self.ticks_to_be_alone()))?;
        self.count(ticks * TICK_US);
        self.services.tick(&mut self.context);
        self.services.announce(&mut self.context);
        self.services.stream(&mut self.context);
        Ok(ticks)
    }

    /// Ticks after which something is to be done beside the flight.
    fn ticks_to_be_alone(&self) -> u64 {
        self.alone_until_us().saturating_sub(self.context.vehicle.time_us()).div_ceil(TICK_US)
    }

    /// Until when nothing is to be done beside the flight, µs since the boot; not later than now if there is something.
    fn alone_until_us(&self) -> u64 {
        let is_awaited = self.context.reboot_us.is_some() || self.services.are_busy();
        if is_awaited { 0 } else { self.context.quiet_until_us }
    }

    /// Until when it need not be flown on, µs, because the vehicle [rests](Vehicle::rests_until_us) and no service waits for a time of its own:
    /// it does not matter when that is flown, if it is before anything is handed in. It ends within 5 ms after the next regular message is
    /// due. What the vehicle decides by itself meanwhile is told later, by 50 ms at most.
    pub fn rests_until_us(&self) -> Option<u64> {
        let vehicle = &self.context.vehicle;
        let alone_until_us = self.alone_until_us();
        if alone_until_us <= vehicle.time_us() {
            return None;
        }
        let end_us = vehicle.rests_until_us()?;
        let until_us = alone_until_us.next_multiple_of(TOGETHER_US).min(end_us + LONGER_REST_US);
        Some(self.before_us + until_us)
    }

    #[cfg(test)]
    pub(crate) fn context_mut(&mut self) -> &mut Context {
        &mut self.context
    }

    /// Boots again: with its parameters, its plans and its clients' files, and nothing else.
    // Not within a tick: a whole vehicle is made on the stack, and each tick would touch every page of the room for it.
    #[cold]
    #[inline(never)]
    fn reboot(&mut self) -> Result<(), FlightError> {
        let context = &mut self.context;
        let settings = context.vehicle.settings_of_reboot(context.parameters.settings());
        let lasted_us = context.vehicle.time_us();
        let unix_start_us = context.vehicle.unix_start_us() + lasted_us;
        let radio = context.vehicle.radio();
        context.vehicle = Vehicle::new(&settings).map_err(FlightError::from)?;
        context.vehicle.set_unix_start_us(unix_start_us);
        // The radio goes on sending what it sends, which is told only when it changes.
        if let Some(pulses) = radio {
            context.vehicle.receive_radio(pulses);
        }
        (context.reboot_us, context.quiet_until_us) = (None, 0);
        context.outbox.restart();
        context.log_queue.close();
        context.parameters.statistics_mut().boots += 1;
        self.before_us += lasted_us;
        self.boots += 1;
        self.services = Registry::new();
        self.services.start(context);
        Ok(())
    }

    fn count(&mut self, flown_us: u64) {
        let flies = self.context.vehicle.landed_state() != LandedState::OnGround;
        let vehicle = &self.context.vehicle;
        let takes_off = vehicle.flight_times().took_off_us == Some(vehicle.time_us());
        let statistics = self.context.parameters.statistics_mut();
        statistics.flights += u32::from(takes_off);
        statistics.run_us += flown_us;
        statistics.flight_us += if flies { flown_us } else { 0 };
    }

    /// Simulation time since the program has started, µs: that of the vehicle begins anew with each boot.
    pub fn time_us(&self) -> u64 {
        self.before_us + self.context.vehicle.time_us()
    }

    /// How often it has booted.
    pub fn boots(&self) -> u32 {
        self.boots
    }

    /// Whether a frame shows that the ground station is there. PX4 knows one by its type, ArduPilot by its system id.
    pub fn shows_ground_station(&self, frame: &Frame) -> bool {
        const TYPE: usize = 4;
        if self.identity().is_ardupilot() {
            let stations = &self.context.vehicle.conduct().ground_stations;
            let counts =
                matches!(frame.message_id(), id::HEARTBEAT | id::MANUAL_CONTROL | id::RC_CHANNELS_OVERRIDE);
            return counts && stations.include(frame.system());
        }
        let station = MavType::MAV_TYPE_GCS as u8;
        frame.message_id() == id::HEARTBEAT && frame.payload().u8(TYPE) == station
    }

    /// Tells whether a ground station is heard: that is judged by the wall clock, which is outside.
    pub fn hear_ground_station(&mut self, heard: bool) {
        self.context.vehicle.hear_ground_station(heard);
    }

    /// The pilot's radio sends these pulses from now on, µs; 0 where there is no channel.
    pub fn receive_radio(&mut self, pulses: Pulses) {
        self.context.vehicle.receive_radio(pulses);
    }

    /// A heartbeat beside the regular ones: a link must not look dead while simulation time stands still.
    pub fn keep_alive(&mut self) {
        self.context.outbox.send(Destination::Everyone, heartbeat::message(&self.context.vehicle));
    }

    /// Tells everyone that the simulation has failed and nothing will follow: a text, and a last heartbeat with
    /// MAV_STATE_FLIGHT_TERMINATION.
    pub fn give_up(&mut self) {
        self.context.say(Severity::Critical, "Simulation failed: vehicle lost");
        self.context.outbox.send(Destination::Everyone, heartbeat::last_message(&self.context.vehicle));
    }

    /// A message of the table of streams, to one client, beside the regular ones.
    pub fn report(&mut self, id: u32, to: PeerId) {
        let stream = self.context.streams.get(id);
        if let Some(message) = stream.and_then(|stream| stream.message(&self.context.component())) {
            self.context.outbox.send(Destination::Peer(to), message);
        }
    }

    /// What its transponder tells to other vehicles.
    pub fn transponder_report(&self) -> Message {
        traffic::own_report(&self.context.vehicle, self.system_id()).into()
    }

    /// Lines for the pilot since the last call, with their times, µs.
    pub fn take_texts(&mut self) -> Vec<(u64, Severity, String)> {
        self.context.outbox.take_lines()
    }

    /// The log that a client gets while it is written.
    pub fn log_queue(&self) -> &LogQueue {
        &self.context.log_queue
    }

    /// The same, to be filled. It changes nothing of the flight.
    pub fn log_queue_mut(&mut self) -> &mut LogQueue {
        &mut self.context.log_queue
    }

    /// Gives clients files to reach. They change nothing of the flight.
    pub fn share(&mut self, files: Box<dyn FileWorker>) {
        self.context.files = files;
    }

    /// Goes on with long answers (lists, downloads, files): sends as many messages as each service's pace allows in `turns` turns, to
    /// peers that have room for them (`None`: the peer is gone). How fast they go is a matter of links, disks and wall clocks, not of
    /// the flight. Call it after received messages and from time to time, even if `turns` is zero.
    pub fn transfer(&mut self, turns: usize, has_room: impl Fn(PeerId) -> Option<bool>) {
        self.services.transfer(&mut self.context, turns, &has_room);
    }

    /// Whether a long answer is under way, so that [`Self::transfer`] has something to go on with.
    pub fn is_answering(&self) -> bool {
        self.services.are_answering()
    }

    /// Tells everyone what has happened around the vehicle. It changes nothing of the flight.
    pub fn announce(&mut self, severity: Severity, text: &str) {
        self.context.say(severity, text);
    }

    /// Messages to be sent since the last call.
    pub fn take_outgoing(&mut self) -> Drain<'_, Outgoing> {
        self.context.outbox.take()
    }

    /// The vehicle.
    pub fn vehicle(&self) -> &Vehicle {
        &self.context.vehicle
    }

    /// Whose conventions it follows.
    pub fn identity(&self) -> Identity {
        self.context.identity()
    }

    /// Its system id.
    pub fn system_id(&self) -> u8 {
        self.context.system_id()
    }

    /// The pace that is asked for.
    pub fn speed(&self) -> Speed {
        self.context.parameters.speed()
    }

    /// Another pace, which its clients are told.
    pub fn set_speed(&mut self, speed: Speed) {
        self.context.parameters.set_speed(speed);
        parameter::tell(&mut self.context, SPEED_PARAMETER);
    }

    /// Time of the wall clock at the start, µs since 1970.
    pub fn unix_start_us(&self) -> u64 {
        self.context.vehicle.unix_start_us()
    }

    /// What it was started with.
    pub fn settings(&self) -> &VehicleSettings {
        self.context.parameters.settings()
    }

    /// All parameters in their order.
    pub fn parameter_table(&self) -> &ParameterTable {
        self.context.parameters.table()
    }

    /// All parameters with their values, in the order of the table.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static str, Value)> {
        self.context.parameters.all(&self.context.vehicle)
    }

    /// The values that parameters had at the start, in the order of the table.
    pub fn initial_parameters(&self) -> &[Value] {
        self.context.parameters.initial()
    }

    /// The parameters as the text of a file, if one has changed since the last call.
    pub fn take_changed_parameters(&mut self, format: FileFormat) -> Option<String> {
        self.context.parameters.take_changed(format, &self.context.vehicle)
    }
}
