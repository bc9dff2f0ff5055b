//! Component metadata: what a ground station needs to show parameters that it does not know.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{COMPONENT_METADATA_DATA, MavMessage};

use super::Service;
use crate::codec::boot_ms;
use crate::stream::{Build, Component, Stream};

const GENERAL_URI: &str = "mftp:///metadata/general.json";

const STREAMS: &[Stream] = &[Stream::on_request(COMPONENT_METADATA_DATA::ID, Build::Component(message))];

/// Tells where the general file is. File transfer serves it.
#[derive(Clone, Copy, Debug)]
pub struct ComponentMetadata;

impl Service for ComponentMetadata {
    fn summary(&self) -> &'static str {
        "Where descriptions of parameters are"
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }
}

/// COMPONENT_METADATA: where the general file is, and its checksum.
fn message(component: &Component<'_>) -> MavMessage {
    MavMessage::COMPONENT_METADATA(COMPONENT_METADATA_DATA {
        time_boot_ms: boot_ms(component.vehicle.time_us()),
        file_crc: component.parameters.metadata().general_checksum,
        uri: GENERAL_URI.into(),
    })
}
