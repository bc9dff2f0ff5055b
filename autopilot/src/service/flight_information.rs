//! When the vehicle was armed, took off and landed, and which flight this is.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{FLIGHT_INFORMATION_DATA, MavMessage};

use super::Service;
use crate::codec::boot_ms;
use crate::stream::{Build, Component, Stream};

const STREAMS: &[Stream] = &[Stream::on_request(FLIGHT_INFORMATION_DATA::ID, Build::Component(message))];

/// Tells the times of the flight.
#[derive(Clone, Copy, Debug)]
pub struct FlightInformation;

impl Service for FlightInformation {
    fn summary(&self) -> &'static str {
        "Times and number of the flight"
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }
}

/// The times count from the boot, in spite of the names of their fields; so says the protocol. Zero: it has not happened.
fn message(component: &Component<'_>) -> MavMessage {
    let vehicle = component.vehicle;
    let times = vehicle.flight_times();
    MavMessage::FLIGHT_INFORMATION(FLIGHT_INFORMATION_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        arming_time_utc: times.armed_us.unwrap_or(0),
        takeoff_time_utc: times.took_off_us.unwrap_or(0),
        landing_time: times.landed_us.map_or(0, |us| (us / 1000) as u32),
        flight_uuid: u64::from(component.parameters.statistics().flights),
    })
}
