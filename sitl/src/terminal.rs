//! What a person sees: the banner, and one live line.

use std::io::{IsTerminal, Write, stderr};
use std::time::{Duration, Instant};

use crate::autopilot::Autopilot;
use crate::configuration::Settings;
use crate::link::{Endpoint, Links};
use crate::service::LinkProfile;

/// How often the line changes.
const PERIOD: Duration = Duration::from_millis(500);

/// What is running, where, and how to connect to it.
pub fn banner(settings: &Settings, links: &Links) -> String {
    let origin = settings.vehicle.origin;
    let mut text = format!(
        "lmpc-sitl {}: simulated quadrotor, system {}, as {:?}, at {:.6}, {:.6}, {:.0} m\n",
        env!("CARGO_PKG_VERSION"),
        settings.system_id,
        settings.vehicle.identity,
        origin.latitude_deg,
        origin.longitude_deg,
        origin.altitude_m,
    );
    for ((link, description), address) in
        settings.links.iter().zip(links.descriptions()).zip(links.addresses())
    {
        let profile = if link.profile == LinkProfile::Onboard { "onboard" } else { "ground" };
        text.push_str(&format!("  {description} ({profile})\n"));
        text.push_str(&match &link.endpoint {
            Endpoint::UdpOut { port: 14_550, .. } => {
                "      QGroundControl: start it; MAVProxy: --master=udpin:127.0.0.1:14550\n".to_owned()
            }
            Endpoint::UdpOut { port, .. } => format!(
                "      MAVSDK: udpin://0.0.0.0:{port}; pymavlink: mavlink_connection('udpin:127.0.0.1:{port}')\n"
            ),
            Endpoint::UdpIn { .. } => format!("      pymavlink: mavlink_connection('udpout:{address}')\n"),
            Endpoint::TcpIn { .. } => {
                format!("      pymavlink: mavlink_connection('tcp:{address}'); MAVSDK: tcpout://{address}\n")
            }
            Endpoint::Serial { .. } => String::new(),
        });
    }
    text
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
    pub fn update(&mut self, now: Instant, autopilot: &Autopilot, peers: usize) {
        if !self.terminal || now.saturating_duration_since(self.last) < PERIOD {
            return;
        }
        let vehicle = autopilot.vehicle();
        let time_us = vehicle.time_us();
        let factor = (time_us - self.last_us) as f64 / 1e6 / now.duration_since(self.last).as_secs_f64();
        (self.last, self.last_us, self.shown) = (now, time_us, true);
        let [x, y, z] = vehicle.outputs().position_m.data.0[0];
        let armed = if vehicle.is_armed() { "armed" } else { "disarmed" };
        let mode = vehicle.identity().mode_name(vehicle.mode());
        let battery = 100.0 * vehicle.battery_remaining();
        let text = format!(
            "{:8.1} s x{factor:<5.1} {armed} {mode}  N {x:7.1} E {y:7.1} up {:6.1} m  battery {battery:3.0} %  {peers} peers",
            time_us as f64 / 1e6,
            -z,
        );
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

/// A writer of log lines that does not mix them with the live line.
#[derive(Clone, Copy, Debug, Default)]
pub struct LogLines;

impl Write for LogLines {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if stderr().is_terminal() {
            stderr().write_all(b"\r\x1b[K")?;
        }
        stderr().write_all(bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        stderr().flush()
    }
}
