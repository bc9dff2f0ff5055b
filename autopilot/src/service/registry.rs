//! The list of all services, and which of them takes which message and command.

use std::collections::BTreeMap;

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use vehicle::identity::Identity;

use super::command::CommandProtocol;
use super::{Repetition, Service};
use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::envelope::{Origin, PeerId};
use crate::speaker::Speaker;
use crate::stream::StreamTable;

/// All services. They are called in this order, which is also the order of what they send in one tick.
fn all() -> Vec<Box<dyn Service>> {
    vec![
        Box::new(super::mission::Missions::default()),
        Box::new(super::calibration::Calibrations::default()),
        Box::new(super::notice::Notices),
        Box::new(super::heartbeat::Heartbeat::default()),
        Box::new(super::greeting::Greeting::default()),
        Box::new(super::identification::Identification),
        Box::new(super::component_metadata::ComponentMetadata),
        Box::new(super::time_synchronization::TimeSynchronization),
        Box::new(super::parameter::ParameterProtocol::default()),
        Box::new(super::custom_mode::CustomModes),
        Box::new(super::standard_mode::StandardModes),
        Box::new(super::action::Actions),
        Box::new(super::orbit::Orbits),
        Box::new(super::follow::Follow::default()),
        Box::new(super::set_point::SetPoints),
        Box::new(super::equipment::EquipmentHeartbeats::default()),
        Box::new(super::equipment::Outputs),
        Box::new(super::equipment::CameraProtocol::default()),
        Box::new(super::equipment::CameraParameters),
        Box::new(super::equipment::GimbalManager::default()),
        Box::new(super::equipment::TrackedSystem::default()),
        Box::new(super::mission_jump::MissionJumps),
        Box::new(super::reboot::Reboots),
        Box::new(super::safety_switch::SafetySwitch),
        Box::new(super::estimator_source::EstimatorSources),
        Box::new(super::motor_test::MotorTests),
        Box::new(super::magnetometer_calibration::MagnetometerCalibrations::default()),
        Box::new(super::flight_information::FlightInformation),
        Box::new(super::high_latency::HighLatency::default()),
        Box::new(super::manual_control::ManualControl),
        Box::new(super::global_origin::GlobalOrigin),
        Box::new(super::home_message::HomeMessages),
        Box::new(super::file_transfer::FileServer::default()),
        Box::new(super::log::LogServer::default()),
        Box::new(super::log_stream::LogStreams::default()),
        Box::new(super::telemetry::Telemetry),
        Box::new(super::event::Events::default()),
        Box::new(super::range::Ranges),
        Box::new(super::terrain::Terrain),
        Box::new(super::shell::Shell),
        Box::new(super::landing_target::LandingTargets),
        Box::new(super::gps_input::GpsInput::default()),
        Box::new(super::vision::Vision::default()),
        Box::new(super::button::Buttons::default()),
        Box::new(super::tuning_knob::TuningKnobs::default()),
        Box::new(super::tune::Tunes),
        Box::new(super::traffic::Traffic),
        Box::new(super::remote_id::RemoteIdentification),
        Box::new(super::message_request::MessageRequests),
        Box::new(super::message_interval::MessageIntervals::default()),
    ]
}

/// All services, found by what they take.
#[derive(Debug)]
pub struct Registry {
    services: Vec<Box<dyn Service>>,
    /// Positions of services by identifiers of messages.
    messages: BTreeMap<u32, usize>,
    /// Positions of services that listen, by identifiers of messages.
    listeners: Vec<(u32, usize)>,
    /// Positions of services by numbers of commands.
    commands: BTreeMap<u16, (usize, Repetition)>,
    protocol: CommandProtocol,
    /// Those whose turn comes with each tick, each change, each tick's end and each look at the links.
    ticking: Rota,
    announcing: Rota,
    streaming: Rota,
    transferring: Rota,
}

/// Positions of services that have something to do whenever they are called: few of all.
#[derive(Debug)]
struct Rota(Vec<usize>);

impl Rota {
    /// Calls each in its order. One that rests is not called again.
    fn call(
        &mut self,
        services: &mut [Box<dyn Service>],
        context: &mut Context,
        mut call: impl FnMut(&mut dyn Service, &mut Context),
    ) {
        let mut place = 0;
        while let Some(service) = self.0.get(place).and_then(|index| services.get_mut(*index)) {
            context.rests = false;
            call(service.as_mut(), context);
            if context.rests {
                self.0.remove(place);
            } else {
                place += 1;
            }
        }
    }
}

impl Registry {
    /// All services as they start.
    pub fn new() -> Self {
        let services = all();
        let (mut messages, mut commands) = (BTreeMap::new(), BTreeMap::new());
        let mut listeners = Vec::new();
        for (index, service) in services.iter().enumerate() {
            messages.extend(service.messages().iter().map(|id| (*id, index)));
            listeners.extend(service.listens().iter().map(|id| (*id, index)));
            let entries = service.commands().iter();
            commands.extend(entries.map(|entry| (entry.number, (index, entry.repetition))));
        }
        let everyone = || Rota((0..services.len()).collect());
        let (ticking, announcing, streaming, transferring) = (everyone(), everyone(), everyone(), everyone());
        let protocol = CommandProtocol::default();
        Self {
            services,
            messages,
            listeners,
            commands,
            protocol,
            ticking,
            announcing,
            streaming,
            transferring,
        }
    }

    /// The services, for what they claim.
    pub fn services(&self) -> impl Iterator<Item = &dyn Service> {
        self.services.iter().map(|service| service.as_ref())
    }

    /// The table of all messages that the services make in an identity.
    pub fn streams(&self, identity: Identity) -> StreamTable {
        let streams = self.services.iter().flat_map(|service| service.streams());
        StreamTable::new(streams.filter(|stream| !stream.ardupilot_only || identity.is_ardupilot()))
    }

    /// What the services can do together.
    pub fn capabilities(&self, identity: Identity) -> MavProtocolCapability {
        let capabilities = self.services.iter().map(|service| service.capabilities(identity));
        capabilities.fold(self.protocol.capabilities(), |all, one| all | one)
    }

    fn each(&mut self, mut call: impl FnMut(&mut dyn Service)) {
        for service in &mut self.services {
            call(service.as_mut());
        }
    }

    /// The vehicle has just started.
    pub fn start(&mut self, context: &mut Context) {
        self.each(|service| service.start(context));
    }

    /// A frame was received, whoever it is for.
    pub fn hear(&mut self, context: &mut Context, origin: &Origin) {
        self.protocol.hear(context.system_id(), origin);
        self.each(|service| service.hear(context, origin));
    }

    /// Takes a frame for a component that is none of ours: a command is refused if nobody else can answer it.
    pub fn decline(&self, context: &mut Context, origin: &Origin, frame: &Frame) {
        self.protocol.refuse_for_absent(context, origin, frame);
    }

    /// Hands a message or a command for a component to the service that takes it there.
    pub fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame, asked: Speaker) {
        context.outbox.answer_as(asked);
        self.take(context, origin, frame, asked);
        context.outbox.answer_as(Speaker::Autopilot);
    }

    fn take(&mut self, context: &mut Context, origin: &Origin, frame: &Frame, asked: Speaker) {
        if let Some(command) = Command::read(frame) {
            let entry = self.commands.get(&command.number).copied();
            let taker = entry.and_then(|(index, repetition)| {
                let service = self.services.get_mut(index)?;
                service.speakers().contains(&asked).then_some(())?;
                Some((repetition, service.as_mut() as &mut dyn Service))
            });
            self.protocol.handle(context, origin, frame, &command, taker);
            return;
        }
        let index = self.messages.get(&frame.message_id()).copied();
        let service = index.and_then(|index| self.services.get_mut(index));
        if let Some(service) = service.filter(|service| service.speakers().contains(&asked)) {
            service.receive(context, origin, frame);
        }
        for (id, index) in &self.listeners {
            if let (true, Some(service)) = (*id == frame.message_id(), self.services.get_mut(*index)) {
                service.receive(context, origin, frame);
            }
        }
    }

    /// Whether one of them is to be called after every tick.
    pub fn are_busy(&self) -> bool {
        self.ticking.0.iter().any(|index| self.services.get(*index).is_some_and(|service| service.is_busy()))
    }

    /// A tick of simulation time is over.
    pub fn tick(&mut self, context: &mut Context) {
        self.ticking.call(&mut self.services, context, |service, context| service.tick(context));
    }

    /// Tells clients what has changed.
    pub fn announce(&mut self, context: &mut Context) {
        self.announcing.call(&mut self.services, context, |service, context| service.announce(context));
    }

    /// Sends what is due regularly.
    pub fn stream(&mut self, context: &mut Context) {
        self.streaming.call(&mut self.services, context, |service, context| service.stream(context));
    }

    /// Whether a long answer of one of them is under way.
    pub fn are_answering(&self) -> bool {
        let mut transferring = self.transferring.0.iter().filter_map(|index| self.services.get(*index));
        transferring.any(|service| service.is_answering())
    }

    /// Goes on with long answers.
    pub fn transfer(
        &mut self,
        context: &mut Context,
        turns: usize,
        has_room: &dyn Fn(PeerId) -> Option<bool>,
    ) {
        self.transferring.call(&mut self.services, context, |service, context| {
            service.transfer(context, turns, has_room);
        });
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fmt::Debug;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};

    use mavlink::Message as _;

    use vehicle::identity::Identity;
    use vehicle::parameters::Speed;

    use vehicle::{Vehicle, VehicleSettings};

    use super::{Registry, Rota, all};
    use crate::Autopilot;
    use crate::codec::id;
    use crate::context::Context;
    use crate::parameters::Parameters;
    use crate::service::Service;
    use crate::stream::{Build, Component};

    fn assert_unique<T: Ord + Debug>(claims: impl Iterator<Item = T>) {
        let mut seen = BTreeSet::new();
        for claim in claims {
            let text = format!("{claim:?}");
            assert!(seen.insert(claim), "{text} is claimed twice");
        }
    }

    /// Otherwise one of two services would never be asked.
    #[test]
    fn nothing_is_claimed_twice() {
        let services = all();
        assert_unique(services.iter().flat_map(|service| service.messages()));
        assert_unique(services.iter().flat_map(|service| service.commands()).map(|entry| entry.number));
        assert_unique(services.iter().flat_map(|service| service.streams()).map(|stream| stream.id));
    }

    /// The identifier of a row and its maker agree.
    #[test]
    fn every_row_makes_its_message() {
        let settings = VehicleSettings::new(Identity::Px4);
        let vehicle = Vehicle::new(&settings).expect("valid settings");
        let parameters = Parameters::new(&settings, &vehicle, 1, Speed::Factor(1.0));
        let registry = Registry::new();
        let capabilities = registry.capabilities(settings.identity);
        let component = Component { vehicle: &vehicle, parameters: &parameters, capabilities };
        for stream in registry.streams(Identity::ArduPilot).iter() {
            let messages = stream.messages(&component, 0);
            let sometimes = matches!(stream.build, Build::Several(_) | Build::Perhaps(_));
            assert!(sometimes || !messages.is_empty(), "{}", stream.id);
            assert!(messages.iter().all(|message| message.message_id() == stream.id), "{}", stream.id);
        }
    }

    /// Whoever does nothing is called once; whoever overrides a method is called each time, in the order of the list.
    #[test]
    fn only_services_that_have_something_to_do_are_called() {
        #[derive(Debug)]
        struct Counting(Arc<AtomicU32>);
        impl Service for Counting {
            fn tick(&mut self, _context: &mut Context) {
                self.0.fetch_add(1, Ordering::Relaxed);
            }
        }
        #[derive(Debug)]
        struct Idle;
        impl Service for Idle {}
        let calls = Arc::new(AtomicU32::new(0));
        let mut services: Vec<Box<dyn Service>> = vec![
            Box::new(Idle),
            Box::new(Counting(calls.clone())),
            Box::new(Idle),
            Box::new(Counting(calls.clone())),
        ];
        let mut rota = Rota((0..services.len()).collect());
        let settings = VehicleSettings::new(Identity::Px4);
        let mut autopilot = Autopilot::new(&settings, 1, Speed::Factor(1.0), &[], 0).expect("valid settings");
        for _ in 0..3 {
            rota.call(&mut services, autopilot.context_mut(), |service, context| service.tick(context));
        }
        assert_eq!((calls.load(Ordering::Relaxed), rota.0), (6, vec![1, 3]));
    }

    /// Commands have their own protocol: a service would never see these.
    #[test]
    fn no_service_takes_the_messages_of_commands() {
        let services = all();
        let mut messages = services.iter().flat_map(|service| service.messages());
        assert!(!messages.any(|message| [id::COMMAND_INT, id::COMMAND_LONG].contains(message)));
    }
}
