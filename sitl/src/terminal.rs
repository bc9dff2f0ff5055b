//! What a person sees: the banner, and one live line.

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write, stderr};
use std::time::{Duration, Instant};

use autopilot::envelope::LinkProfile;

use crate::configuration::Settings;
use crate::fleet::{Fleet, Member};
use crate::hil::{HilSettings, Mount};
use crate::link::{Endpoint, LinkSpecification, Links};

/// How often the line changes.
const PERIOD: Duration = Duration::from_millis(500);

/// What is running, where, and how to connect to it.
pub fn banner(settings: &Settings, fleet: &Fleet) -> String {
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
    // How to connect to one shows how to connect to all.
    for (links, specifications) in fleet.hubs().iter().zip(&settings.hubs).take(1) {
        text.push_str(&ways(links, specifications));
    }
    text
}

/// The same for a plant alone.
pub fn hil_banner(settings: &HilSettings, address: &str) -> String {
    let origin = settings.vehicle.origin;
    let motors = match settings.mount {
        Mount::X => "front right, back left, front left, back right",
        Mount::Plus => "right, left, front, back",
    };
    format!(
        "lmpc-sitl {}: plant for an external autopilot, at {:.6}, {:.6}, {:.0} m\n  TCP server on {address}; motors 1 to \
         4: {motors}\n      PX4: make px4_sitl none_iris\n",
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

/// One live line on a terminal.
#[derive(Debug)]
pub struct StatusLine {
    shown: bool,
    terminal: bool,
    last: Instant,
    last_us: u64,
}

impl StatusLine {
    /// Shows nothing yet, and never anything that is not a terminal.
    pub fn new(now: Instant) -> Self {
        Self { shown: false, terminal: stderr().is_terminal(), last: now, last_us: 0 }
    }

    /// Shows the state of now, if it is time.
    pub fn update(&mut self, now: Instant, fleet: &Fleet) {
        if !self.terminal || now.saturating_duration_since(self.last) < PERIOD {
            return;
        }
        let Some(time_us) = fleet.members().iter().map(Member::time_us).max() else { return };
        let factor = (time_us - self.last_us) as f64 / 1e6 / now.duration_since(self.last).as_secs_f64();
        (self.last, self.last_us, self.shown) = (now, time_us, true);
        let peers: usize = fleet.hubs().iter().map(Links::active_peers).sum();
        let state = match fleet.members() {
            [only] => state_of_one(only),
            many => state_of_many(many),
        };
        let text = format!("{:6.1} s x{factor:<4.1} {state}  {peers} peers", time_us as f64 / 1e6);
        // A line that wraps could not be taken back.
        let text: String = text.chars().take(columns().saturating_sub(1)).collect();
        // Nobody minds if a terminal is gone.
        let _gone = write!(stderr(), "\r\x1b[K{text}").and_then(|()| stderr().flush());
    }

    /// Leaves the line to what follows.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.shown) {
            let _gone = write!(stderr(), "\r\x1b[K");
        }
    }
}

/// Width of the terminal.
fn columns() -> usize {
    #[cfg(unix)]
    if let Ok(size) = rustix::termios::tcgetwinsize(stderr())
        && size.ws_col > 0
    {
        return size.ws_col.into();
    }
    80
}

fn state_of_one(member: &Member) -> String {
    let vehicle = member.autopilot().vehicle();
    // Minus nothing is nothing.
    let [north, east, down] =
        vehicle.outputs().position_m.map(|metres| (metres * 10.0).round() / 10.0).data.0[0];
    let armed = if vehicle.is_armed() { "armed" } else { "disarmed" };
    let mode = vehicle.identity().mode_name(vehicle.mode());
    let battery = 100.0 * vehicle.battery_remaining();
    format!(
        "{armed} {mode}  N {:5.1} E {:5.1} up {:4.1} m  battery {battery:.0} %",
        north + 0.0,
        east + 0.0,
        0.0 - down
    )
}

/// How many are in which state, and the weakest battery.
fn state_of_many(members: &[Member]) -> String {
    let vehicles = || members.iter().map(|member| member.autopilot().vehicle());
    let armed = vehicles().filter(|vehicle| vehicle.is_armed()).count();
    let mut modes = BTreeMap::new();
    for vehicle in vehicles() {
        *modes.entry(vehicle.identity().mode_name(vehicle.mode())).or_insert(0) += 1;
    }
    let modes: Vec<String> = modes.into_iter().map(|(mode, count)| format!("{count} {mode}")).collect();
    let battery = 100.0 * vehicles().map(|vehicle| vehicle.battery_remaining()).fold(1.0, f64::min);
    format!("{armed} of {} armed  {}  battery {battery:3.0} %", members.len(), modes.join(", "))
}

/// A writer of log lines that does not mix them with the live line.
#[derive(Clone, Copy, Debug, Default)]
pub struct LogLines;

impl Write for LogLines {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        // Whoever has closed it does not want it: the flight goes on.
        if stderr().is_terminal() {
            let _gone = stderr().write_all(b"\r\x1b[K");
        }
        let _gone = stderr().write_all(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        let _gone = stderr().flush();
        Ok(())
    }
}
