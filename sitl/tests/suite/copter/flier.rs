//! A pilot and a ground station of ArduCopter at once, as the programs that test it fly it: sticks as pulses, modes by number, and
//! waiting for what is told.

use crate::common::{Bench, failsafe_bench, settings};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, frame};
use vehicle::radio::CHANNELS;
use vehicle::{Vehicle, VehicleSettings};

/// Custom modes.
pub const STABILIZE: u32 = 0;
pub const ALT_HOLD: u32 = 2;
pub const AUTO: u32 = 3;
pub const GUIDED: u32 = 4;
pub const LOITER: u32 = 5;
pub const RTL: u32 = 6;
pub const LAND: u32 = 9;

/// Results of commands.
pub const ACCEPTED: u8 = 0;
pub const FAILED: u8 = 4;

/// Metres in a degree of latitude.
const DEGREE_M: f64 = 111_194.9;

pub struct Flier {
    pub bench: Bench,
    pulses: [u16; CHANNELS],
}

impl Flier {
    /// On the ground with the throttle low and the mode switch at Stabilize.
    pub fn new() -> Self {
        Self::with(&settings(Identity::ArduPilot))
    }

    pub fn with(settings: &VehicleSettings) -> Self {
        let mut pulses = [1000; CHANNELS];
        pulses[..5].copy_from_slice(&[1500, 1500, 1000, 1500, 1800]);
        let mut flier = Self { bench: Bench::of(settings), pulses };
        flier.bench.autopilot.receive_radio(pulses);
        flier.bench.fly(0.5);
        flier
    }

    pub fn vehicle(&self) -> &Vehicle {
        self.bench.autopilot.vehicle()
    }

    /// Sets a parameter, and sees that it is kept.
    pub fn set(&mut self, name: &str, value: f64) {
        failsafe_bench::set(&mut self.bench, name, value);
    }

    pub fn set_all(&mut self, parameters: &[(&str, f64)]) {
        for (name, value) in parameters {
            self.set(name, *value);
        }
    }

    /// Moves a channel of the radio, from 1.
    pub fn rc(&mut self, channel: usize, pulse_us: u16) {
        self.pulses[channel - 1] = pulse_us;
        self.bench.autopilot.receive_radio(self.pulses);
    }

    /// Moves channels of the radio at once.
    pub fn rc_all(&mut self, pulses: &[(usize, u16)]) {
        for (channel, pulse_us) in pulses {
            self.pulses[channel - 1] = *pulse_us;
        }
        self.bench.autopilot.receive_radio(self.pulses);
    }

    pub fn command(&mut self, command: MavCmd, parameters: [f32; 7]) -> u8 {
        self.bench.command(command, parameters)
    }

    /// Asks for a mode; what is answered.
    pub fn ask_mode(&mut self, custom: u32) -> u8 {
        self.command(MavCmd::MAV_CMD_DO_SET_MODE, [1.0, custom as f32, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    pub fn change_mode(&mut self, custom: u32) {
        assert_eq!(self.ask_mode(custom), ACCEPTED, "mode {custom}: {:?}", self.bench.texts());
        assert_eq!(self.mode(), custom);
    }

    /// The mode that HEARTBEAT shows.
    pub fn mode(&self) -> u32 {
        self.vehicle().identity().custom_mode(self.vehicle().mode())
    }

    pub fn arm(&mut self) {
        self.bench.arm();
    }

    pub fn is_armed(&self) -> bool {
        self.vehicle().is_armed()
    }

    /// Above home, m.
    pub fn height_m(&self) -> f64 {
        self.vehicle().home().position_m.z - self.vehicle().outputs().position_m.z
    }

    /// From home over the ground, m.
    pub fn distance_m(&self) -> f64 {
        (self.vehicle().outputs().position_m - self.vehicle().home().position_m).xy().norm()
    }

    pub fn speed_m_s(&self) -> f64 {
        self.vehicle().outputs().velocity_m_s.xy().norm()
    }

    pub fn climb_m_s(&self) -> f64 {
        -self.vehicle().outputs().velocity_m_s.z
    }

    /// Degrees from north through east, 0 to 360.
    pub fn heading_deg(&self) -> f64 {
        self.vehicle().outputs().attitude_rad.z.to_degrees().rem_euclid(360.0)
    }

    /// Whether the nose is within some degrees of a heading.
    pub fn heads(&self, heading_deg: f64, within_deg: f64) -> bool {
        let off_deg = (self.heading_deg() - heading_deg + 180.0).rem_euclid(360.0) - 180.0;
        off_deg.abs() <= within_deg
    }

    /// Turns until the nose is within 5 degrees of a heading: it has 20 s.
    pub fn wait_heading(&mut self, heading_deg: f64) {
        self.wait(&format!("{heading_deg} deg"), 20.0, |flier| flier.heads(heading_deg, 5.0));
    }

    /// Flies until it is so far, m, from where it is now, give or take 2 m: it has 30 s.
    pub fn wait_moved(&mut self, metres: f64) {
        let from_m = self.vehicle().outputs().position_m.xy();
        self.wait(&format!("{metres} m"), 30.0, |flier| {
            ((flier.vehicle().outputs().position_m.xy() - from_m).norm() - metres).abs() <= 2.0
        });
    }

    pub fn fly(&mut self, seconds: f64) {
        self.bench.fly(seconds);
    }

    /// Flies until a condition holds.
    pub fn wait(&mut self, what: &str, seconds: f64, condition: impl Fn(&Self) -> bool) {
        for _ in 0..(seconds * 50.0) as usize {
            if condition(self) {
                return;
            }
            self.bench.fly(0.02);
        }
        panic!(
            "not within {seconds} s: {what}; mode {}, {:.1} m up, {:.1} m away, {:.1} m/s, {:?}",
            self.mode(),
            self.height_m(),
            self.distance_m(),
            self.speed_m_s(),
            self.bench.texts()
        );
    }

    pub fn wait_mode(&mut self, custom: u32, seconds: f64) {
        self.wait(&format!("mode {custom}"), seconds, |flier| flier.mode() == custom);
    }

    pub fn wait_disarmed(&mut self, seconds: f64) {
        self.wait("disarmed", seconds, |flier| !flier.is_armed());
    }

    /// Whether a text has been told since the last command.
    pub fn has_said(&self, text: &str) -> bool {
        self.bench.texts().iter().any(|said| said.contains(text))
    }

    pub fn wait_text(&mut self, text: &str, seconds: f64) {
        self.wait(text, seconds, |flier| flier.has_said(text));
    }

    /// Arms and takes off to a height above home, m, and hovers there in a mode.
    pub fn take_off(&mut self, height_m: f64, mode: u32) {
        self.change_mode(mode);
        self.arm();
        if mode == GUIDED {
            let parameters = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m as f32];
            assert_eq!(self.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), ACCEPTED);
            self.wait("takeoff", 120.0, |flier| flier.height_m() > height_m - 1.0);
            return;
        }
        self.rc(3, 1700);
        self.wait("takeoff", 120.0, |flier| flier.height_m() > height_m - 1.0);
        self.rc(3, 1500);
    }

    /// Returns, and is disarmed at home.
    pub fn return_home(&mut self) {
        self.change_mode(RTL);
        self.rc(3, 1500);
        self.wait_home();
    }

    pub fn wait_home(&mut self) {
        self.wait_disarmed(300.0);
        assert!(self.height_m() <= 1.0 && self.distance_m() < 10.0, "{:?}", self.bench.position());
    }

    pub fn land(&mut self) {
        self.change_mode(LAND);
        self.wait_disarmed(120.0);
    }

    /// What speaks against arming, as RUN_PREARM_CHECKS tells it.
    pub fn obstacles(&mut self) -> Vec<String> {
        self.command(MavCmd::MAV_CMD_RUN_PREARM_CHECKS, [0.0; 7]);
        self.bench.texts().into_iter().filter(|text| text.starts_with("PreArm: ")).collect()
    }

    pub fn reboot(&mut self) {
        let parameters = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(self.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, parameters), ACCEPTED);
        let boots = self.bench.autopilot.boots();
        self.wait("the boot", 3.0, |flier| flier.bench.autopilot.boots() > boots);
        self.bench.autopilot.receive_radio(self.pulses);
        self.fly(3.0);
    }

    /// The latest message that a choice takes something of.
    pub fn latest<T>(&self, choose: impl Fn(&MavMessage) -> Option<T>) -> Option<T> {
        self.all(choose).pop()
    }

    /// What a choice takes of all messages, the latest last.
    pub fn all<T>(&self, choose: impl Fn(&MavMessage) -> Option<T>) -> Vec<T> {
        let typed = |message: &Message| match message {
            Message::Typed(message) => choose(message),
            _ => None,
        };
        self.bench.heard.iter().filter_map(typed).collect()
    }
}

/// A mission of commands at places north and east of home, m, at heights above it, m; its item 0 is home.
pub fn mission(settings: &VehicleSettings, rows: &[(u16, f64, f64, f64)]) -> Plan {
    let origin = settings.origin;
    let item = |command: u16, north_m: f64, east_m: f64, height_m: f64| MissionItem {
        frame: frame::GLOBAL_RELATIVE_INT,
        command,
        parameters: [0.0; 4],
        position: [
            origin.latitude_deg + north_m / DEGREE_M,
            origin.longitude_deg + east_m / (DEGREE_M * origin.latitude_deg.to_radians().cos()),
            height_m,
        ],
        autocontinue: true,
    };
    let home = item(16, 0.0, 0.0, 0.0);
    let items =
        rows.iter().map(|(command, north_m, east_m, height_m)| item(*command, *north_m, *east_m, *height_m));
    Plan::new(std::iter::once(home).chain(items).collect())
}

/// A vehicle with a mission.
pub fn with_mission(rows: &[(u16, f64, f64, f64)]) -> Flier {
    let mut start = settings(Identity::ArduPilot);
    start.plans.set(PlanKind::Mission, mission(&start, rows));
    Flier::with(&start)
}
