//! The table of messages that are sent regularly or asked for.

use mavlink::dialects::ardupilotmega::{MavMessage, MavProtocolCapability};
use vehicle::Vehicle;

use crate::envelope::LinkProfile;
use crate::parameters::Parameters;
use crate::speaker::Speaker;

/// Groups of REQUEST_DATA_STREAM (MAV_DATA_STREAM).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Instruments.
    RawSensors = 1,
    /// State of the vehicle.
    ExtendedStatus = 2,
    /// Inputs and outputs.
    RcChannels = 3,
    /// Position.
    Position = 6,
    /// Attitude.
    Extra1 = 10,
    /// What a pilot looks at.
    Extra2 = 11,
    /// The rest.
    Extra3 = 12,
}

impl Group {
    /// All groups, by their numbers.
    pub const ALL: [Self; 7] = [
        Self::RawSensors,
        Self::ExtendedStatus,
        Self::RcChannels,
        Self::Position,
        Self::Extra1,
        Self::Extra2,
        Self::Extra3,
    ];
}

/// What messages are made from.
#[derive(Clone, Copy, Debug)]
pub struct Component<'a> {
    /// The vehicle.
    pub vehicle: &'a Vehicle,
    /// Its parameters.
    pub parameters: &'a Parameters,
    /// What its services can do.
    pub capabilities: MavProtocolCapability,
}

/// How a message is made from the present state.
#[derive(Clone, Copy, Debug)]
pub enum Build {
    /// From the vehicle.
    Vehicle(fn(&Vehicle) -> MavMessage),
    /// From the vehicle, its parameters and its capabilities.
    Component(fn(&Component<'_>) -> MavMessage),
    /// From the vehicle, if there is something to tell.
    Perhaps(fn(&Vehicle) -> Option<MavMessage>),
    /// None, one or several, as there is something to tell.
    Several(fn(&Component<'_>) -> Vec<MavMessage>),
    /// One or several, chosen by parameter 2 of MAV_CMD_REQUEST_MESSAGE. It is sent on request only.
    Numbered(fn(&Vehicle, u32) -> Vec<MavMessage>),
}

/// A row of the table: a message with its rates, its group and how it is made.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    /// Identifier of the message.
    pub id: u32,
    /// Rates at the start, Hz, on a ground station's link and on an onboard one; zero: not sent.
    pub rates_hz: [f64; 2],
    /// The group of REQUEST_DATA_STREAM that it belongs to.
    pub group: Option<Group>,
    /// How it is made.
    pub build: Build,
    /// Who says it.
    pub speaker: Speaker,
    /// Whether only ArduPilot has it.
    pub ardupilot_only: bool,
}

impl Stream {
    /// A message made from the vehicle, with its rates on a ground station's link and on an onboard one, Hz.
    pub const fn new(id: u32, rates_hz: [f64; 2], build: fn(&Vehicle) -> MavMessage) -> Self {
        Self {
            id,
            rates_hz,
            group: None,
            build: Build::Vehicle(build),
            speaker: Speaker::Autopilot,
            ardupilot_only: false,
        }
    }

    /// A message that is sent when there is something to tell, with its rates.
    pub const fn when(id: u32, rates_hz: [f64; 2], build: Build) -> Self {
        Self { id, rates_hz, group: None, build, speaker: Speaker::Autopilot, ardupilot_only: false }
    }

    /// A message that is sent only when it is asked for.
    pub const fn on_request(id: u32, build: Build) -> Self {
        Self {
            id,
            rates_hz: [0.0; 2],
            group: None,
            build,
            speaker: Speaker::Autopilot,
            ardupilot_only: false,
        }
    }

    /// Puts it into a group of REQUEST_DATA_STREAM.
    pub const fn of(self, group: Group) -> Self {
        Self { group: Some(group), ..self }
    }

    /// Lets a component say it.
    pub const fn from(self, speaker: Speaker) -> Self {
        Self { speaker, ..self }
    }

    /// Only ArduPilot has it: in other identities it can neither be streamed nor asked for.
    pub const fn of_ardupilot(self) -> Self {
        Self { ardupilot_only: true, ..self }
    }

    /// Interval at the start on a link of this profile, µs; `None` if it is not sent there.
    pub fn default_interval_us(&self, profile: LinkProfile) -> Option<u64> {
        let [ground, onboard] = self.rates_hz;
        let rate = match profile {
            LinkProfile::Ground => ground,
            LinkProfile::Onboard => onboard,
        };
        (rate > 0.0).then(|| (1e6 / rate).round() as u64)
    }

    /// The message, from the present state; `None` if there is nothing to tell, and for those that may be several.
    pub fn message(&self, component: &Component<'_>) -> Option<MavMessage> {
        match self.build {
            Build::Vehicle(build) => Some(build(component.vehicle)),
            Build::Component(build) => Some(build(component)),
            Build::Perhaps(build) => build(component.vehicle),
            Build::Several(_) | Build::Numbered(_) => None,
        }
    }

    /// What answers a request with this number as its parameter 2.
    pub fn messages(&self, component: &Component<'_>, number: u32) -> Vec<MavMessage> {
        match self.build {
            Build::Numbered(build) => build(component.vehicle, number),
            Build::Several(build) => build(component),
            _ => self.message(component).into_iter().collect(),
        }
    }

    /// Whether it can be sent regularly.
    pub fn is_regular(&self) -> bool {
        !matches!(self.build, Build::Numbered(_))
    }
}

/// The table, ordered by identifiers.
#[derive(Clone, Debug, Default)]
pub struct StreamTable(Vec<&'static Stream>);

impl StreamTable {
    /// A table of these rows. Identifiers must differ; a test of the registry checks it.
    pub fn new(streams: impl IntoIterator<Item = &'static Stream>) -> Self {
        let mut streams: Vec<_> = streams.into_iter().collect();
        streams.sort_by_key(|stream| stream.id);
        Self(streams)
    }

    /// The row of an identifier.
    pub fn get(&self, id: u32) -> Option<&'static Stream> {
        let place = self.0.binary_search_by_key(&id, |stream| stream.id).ok()?;
        self.0.get(place).copied()
    }

    /// All rows, ordered by identifiers.
    pub fn iter(&self) -> impl Iterator<Item = &'static Stream> + '_ {
        self.0.iter().copied()
    }
}
