//! What is printed at the start: what runs, where, and how to connect to it.

use autopilot::envelope::LinkProfile;

use crate::configuration::Settings;
use crate::fleet::{Fleet, Member};
use crate::hil::{HilSettings, Mount};
use crate::link::{Endpoint, LinkSpecification, Links};

/// What is running, where, and how to connect to it.
pub fn banner(settings: &Settings, fleet: &Fleet, view: Option<&str>) -> String {
    let Some(first) = fleet.members().first() else { return String::new() };
    let origin = first.autopilot().settings().origin;
    let what = match fleet.members() {
        [only] => format!("simulated quadrotor, system {}", only.autopilot().system_id()),
        many => format!("{} simulated quadrotors", many.len()),
    };
    let mut text = format!(
        "lmpc-sitl {}: {what}, as {}, at {:.6}, {:.6}, {:.0} m\n",
        env!("CARGO_PKG_VERSION"),
        first.autopilot().identity().name(),
        origin.latitude_deg,
        origin.longitude_deg,
        origin.altitude_m,
    );
    if fleet.members().len() > 1 {
        fleet.members().iter().for_each(|member| text.push_str(&start(member, settings, fleet)));
        if fleet.hubs().len() > 1 {
            text.push_str(&format!("Links of system {}:\n", first.autopilot().system_id()));
        }
    }
    for member in fleet.members() {
        if let Some(address) = member.radio_address() {
            text.push_str(&format!("  radio of system {}: UDP {address}\n", member.autopilot().system_id()));
        }
    }
    if let Some(url) = view {
        text.push_str(&format!("  live page: {url}\n"));
    }
    // How to connect to one shows how to connect to all.
    for (links, specifications) in fleet.hubs().iter().zip(&settings.hubs).take(1) {
        text.push_str(&ways(links, specifications));
    }
    text
}

/// The same for the simulator of an external autopilot.
pub fn hil_banner(settings: &HilSettings, address: &str) -> String {
    let origin = settings.vehicle.origin;
    let motors = match settings.mount {
        Mount::X => "front right, back left, front left, back right",
        Mount::Plus => "right, left, front, back",
    };
    format!(
        "lmpc-sitl {}: simulator for an external autopilot, at {:.6}, {:.6}, {:.0} m\n  TCP server on {address}; motors \
         1 to 4: {motors}\n      PX4: make px4_sitl none_iris\n",
        env!("CARGO_PKG_VERSION"),
        origin.latitude_deg,
        origin.longitude_deg,
        origin.altitude_m,
    )
}

/// Where a vehicle stands, and where its links are if they are its own.
fn start(member: &Member, settings: &Settings, fleet: &Fleet) -> String {
    let [north, east, _] = member.autopilot().settings().configuration.initial.position_m;
    let mut addresses = String::new();
    if let (Some(links), Some(specifications), true) =
        (fleet.hubs().get(member.hub()), settings.hubs.get(member.hub()), fleet.hubs().len() > 1)
    {
        for (link, address) in specifications.iter().zip(links.addresses()) {
            // A client listens where a link sends to.
            addresses.push_str(&match &link.endpoint {
                Endpoint::UdpOut { host, port, .. } => format!("  to {host}:{port}"),
                _ => format!("  at {address}"),
            });
        }
    }
    format!(
        "  system {:3} at north {north:6.1} east {east:6.1} m{addresses}\n",
        member.autopilot().system_id()
    )
}

/// Where links are, and what clients are told to connect to them.
fn ways(links: &Links, specifications: &[LinkSpecification]) -> String {
    let mut text = String::new();
    for ((link, description), address) in
        specifications.iter().zip(links.descriptions()).zip(links.addresses())
    {
        let profile = if link.profile == LinkProfile::Onboard { "onboard" } else { "ground" };
        text.push_str(&format!("  {description} ({profile})\n"));
        text.push_str(&match &link.endpoint {
            Endpoint::UdpOut { host, port: 14_550, .. } => {
                format!("      QGroundControl: start it; MAVProxy: --master=udpin:{}:14550\n", listening(host))
            }
            Endpoint::UdpOut { host, port, .. } => format!(
                "      MAVSDK: udpin://0.0.0.0:{port}; pymavlink: mavlink_connection('udpin:{}:{port}')\n",
                listening(host)
            ),
            Endpoint::UdpIn { .. } => format!(
                "      pymavlink: mavlink_connection('udpout:{address}'); MAVSDK: udpout://{address}; MAVProxy: --master=udpout:{address}\n"
            ),
            Endpoint::TcpIn { .. } => format!(
                "      pymavlink: mavlink_connection('tcp:{address}'); MAVSDK: tcpout://{address}; MAVProxy: --master=tcp:{address}\n"
            ),
            Endpoint::Serial { .. } => String::new(),
        });
    }
    text
}

/// Where a client listens that a link sends to: on this machine, or on another one to whoever sends.
fn listening(host: &str) -> &str {
    if matches!(host, "127.0.0.1" | "localhost") { "127.0.0.1" } else { "0.0.0.0" }
}
