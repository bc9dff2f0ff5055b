//! AUTOPILOT_VERSION and PROTOCOL_VERSION: what this is and what it can do.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    AUTOPILOT_VERSION_DATA, MavMessage, MavProtocolCapability, PROTOCOL_VERSION_DATA,
};
use vehicle::Vehicle;
use vehicle::identity::Identity;

use super::Service;
use crate::stream::{Build, Component, Stream};

/// Our own: "LM" and "PC".
const VENDOR_ID: u16 = 0x4c4d;
const PRODUCT_ID: u16 = 0x5043;

const STREAMS: &[Stream] = &[
    Stream::on_request(AUTOPILOT_VERSION_DATA::ID, Build::Component(autopilot_version)),
    Stream::on_request(PROTOCOL_VERSION_DATA::ID, Build::Vehicle(protocol_version)),
];

/// Tells versions and capabilities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Identification;

impl Service for Identification {
    fn summary(&self) -> &'static str {
        "What it is and can do"
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_MAVLINK2
    }
}

/// Versions of the autopilots whose conventions are kept: what clients ask for before they use them. The last byte is that of a release.
const PX4_CONVENTIONS: u32 = u32::from_be_bytes([1, 16, 0, RELEASE]);
const ARDUPILOT_CONVENTIONS: u32 = u32::from_be_bytes([4, 6, 0, RELEASE]);
const RELEASE: u8 = 255;

/// The version of an autopilot that a client may take this one for.
fn conventions(identity: Identity) -> u32 {
    match identity {
        Identity::Px4 => PX4_CONVENTIONS,
        Identity::ArduPilot => ARDUPILOT_CONVENTIONS,
        Identity::Generic => version(),
    }
}

/// AUTOPILOT_VERSION. The flight software's version is that of the conventions, by which clients judge what they may ask for; the
/// middleware's is this program's, and vendor, product and commit are nobody else's.
fn autopilot_version(component: &Component<'_>) -> MavMessage {
    MavMessage::AUTOPILOT_VERSION(AUTOPILOT_VERSION_DATA {
        capabilities: component.capabilities,
        uid: u64::from(VENDOR_ID) << 48
            | u64::from(PRODUCT_ID) << 32
            | u64::from(component.parameters.system_id()),
        flight_sw_version: conventions(component.vehicle.identity()),
        middleware_sw_version: version(),
        vendor_id: VENDOR_ID,
        product_id: PRODUCT_ID,
        ..AUTOPILOT_VERSION_DATA::default()
    })
}

/// This program's version as PX4 numbers releases: major, minor, patch and the type of the release (0: development), a byte
/// each.
pub fn version() -> u32 {
    let number = |text: &str| text.parse::<u8>().unwrap_or(0);
    u32::from_be_bytes([
        number(env!("CARGO_PKG_VERSION_MAJOR")),
        number(env!("CARGO_PKG_VERSION_MINOR")),
        number(env!("CARGO_PKG_VERSION_PATCH")),
        0,
    ])
}

/// PROTOCOL_VERSION: MAVLink 1 is understood, 2 is spoken.
fn protocol_version(_vehicle: &Vehicle) -> MavMessage {
    MavMessage::PROTOCOL_VERSION(PROTOCOL_VERSION_DATA {
        version: 200,
        min_version: 100,
        max_version: 200,
        ..PROTOCOL_VERSION_DATA::default()
    })
}
