//! The server that an autopilot connects to.

use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use autopilot::codec::{Command, CommandAck, Frame, Message, id};
use vehicle::parameters::Speed;

use super::actuator_controls::ActuatorControls;
use super::client::{Client, Gone};
use super::messages;
use super::rig::{Rig, STEP_US};
use super::settings::HilSettings;
use crate::failure::Failure;
use crate::fmu::FlownFmu;
use crate::link::{LinkError, resolve};
use crate::pace::Pace;
use crate::summary::{Flight, Summary};
use crate::terminal::{Panel, of_autopilot, set_simulation_time, waiting};

/// Between two looks for a connection, and longest rest of the pace.
const REST: Duration = Duration::from_millis(1);
/// Between two looks whether to stop while controls are awaited.
const LOOK: Duration = Duration::from_millis(20);
/// After this long without controls, the simulation continues by one step: the autopilot may have missed a message.
const PATIENCE: Duration = Duration::from_secs(1);

/// A listening simulator.
#[derive(Debug)]
pub struct Simulator {
    settings: HilSettings,
    listener: TcpListener,
}

/// One autopilot's flight.
struct Flown<'a> {
    settings: &'a HilSettings,
    panel: &'a mut Panel,
    rig: Rig,
    client: Client,
    /// Time of the last controls that were taken.
    answered_us: Option<u64>,
    lockstep: bool,
    armed: bool,
    /// Controls that were late or came twice.
    stale: u64,
    /// Steps without controls that should have come.
    missed: u64,
}

impl Simulator {
    /// Listens.
    ///
    /// # Errors
    /// [`Failure::Link`]
    pub fn open(settings: HilSettings) -> Result<Self, Failure> {
        // A vehicle that cannot fly is found before anybody connects.
        rig(&settings)?;
        let link = format!("--hil {}:{}", settings.host, settings.port);
        let failed = |source| LinkError::Socket {
            what: format!("TCP port {}:{}", settings.host, settings.port),
            link: link.clone(),
            source,
        };
        let listener = TcpListener::bind(resolve(&settings.host, settings.port, &link)?).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        Ok(Self { settings, listener })
    }

    /// Where it listens.
    pub fn address(&self) -> String {
        self.listener.local_addr().map_or_else(|_| "?".to_owned(), |address| address.to_string())
    }

    /// Serves one autopilot after the other, each from the start, until it is told to stop or the asked time is over.
    ///
    /// # Errors
    /// [`Failure`] of the simulation.
    pub fn run(self, stop: &Arc<AtomicBool>) -> Result<Summary, Failure> {
        let start = Instant::now();
        let mut panel = Panel::new(start, self.settings.no_panel);
        let mut flights = Vec::new();
        while !stop.load(Ordering::Relaxed) {
            let Ok((stream, address)) = self.listener.accept() else {
                panel.update(Instant::now(), 0, |_| waiting());
                std::thread::sleep(REST);
                continue;
            };
            tracing::info!("autopilot connected from {address}");
            let flight = self.serve(stream, stop, &mut panel)?;
            flights.push(flight);
            if self.settings.end_us.is_some_and(|end_us| flight.time_us >= end_us) {
                break;
            }
        }
        panel.clear();
        Ok(Summary { wall: start.elapsed(), flights, losses: Vec::new(), incomplete: Vec::new() })
    }

    fn serve(&self, stream: TcpStream, stop: &Arc<AtomicBool>, panel: &mut Panel) -> Result<Flight, Failure> {
        let rig = rig(&self.settings)?;
        let system_id = self.settings.system_id;
        let Ok(client) = Client::new(stream, system_id) else {
            return Ok(Flight { system_id, time_us: 0, digest: rig.digest().value() });
        };
        let mut flown = Flown {
            settings: &self.settings,
            panel,
            rig,
            client,
            answered_us: None,
            lockstep: false,
            armed: false,
            stale: 0,
            missed: 0,
        };
        let ended = flown.fly(stop)?;
        let time_us = flown.rig.time_us();
        tracing::info!(
            stale_controls = flown.stale,
            missed_controls = flown.missed,
            rejected_bytes = flown.client.rejected_bytes(),
            "{} after {:.3} s",
            if ended.is_err() { "autopilot disconnected" } else { "simulation ended" },
            time_us as f64 / 1e6,
        );
        Ok(Flight { system_id, time_us, digest: flown.rig.digest().value() })
    }
}

/// A vehicle on the ground: ours, or that of an FMU.
fn rig(settings: &HilSettings) -> Result<Rig, Failure> {
    let rig = Rig::new(&settings.vehicle, settings.mount)?;
    let Some(choice) = &settings.fmu else { return Ok(rig) };
    let placed = Rig::placed(&settings.vehicle, settings.mount)?;
    let mount_rad = settings.vehicle.heading_rad - placed.heading_rad;
    Ok(rig.flown_by(Box::new(FlownFmu::start(choice, "plant", &placed, mount_rad)?)))
}

impl Flown<'_> {
    /// Steps until it is told to stop, the time is over, or the autopilot is gone.
    fn fly(&mut self, stop: &Arc<AtomicBool>) -> Result<Result<(), Gone>, Failure> {
        let mut pace = Pace::new(self.settings.speed, Instant::now(), 0);
        if self.client.send([messages::heartbeat()]).is_err() {
            return Ok(Err(Gone));
        }
        let end_us = self.settings.end_us.unwrap_or(u64::MAX);
        while !stop.load(Ordering::Relaxed) && self.rig.time_us() < end_us {
            let now = Instant::now();
            let goal_us = pace.goal_us(self.speed(), now, self.rig.time_us());
            let ahead = goal_us.is_some_and(|goal_us| self.rig.time_us() + STEP_US > goal_us);
            set_simulation_time(self.rig.time_us());
            self.show(now);
            if ahead {
                std::thread::sleep(REST);
            } else {
                let told = self.rig.step()?;
                if self.client.send(told).is_err() {
                    return Ok(Err(Gone));
                }
            }
            let went_on = if self.lockstep {
                if ahead { Ok(()) } else { self.await_controls(stop) }
            } else {
                self.take(None).map(|_| ())
            };
            if went_on.is_err() {
                return Ok(Err(Gone));
            }
        }
        Ok(Ok(()))
    }

    /// Shows the state on the terminal, if it is time to.
    fn show(&mut self, now: Instant) {
        let state = match (self.answered_us, self.armed) {
            (None, _) => "autopilot starting",
            (Some(_), false) => "disarmed",
            (Some(_), true) => "armed",
        };
        let body = self.rig.plant().body;
        let said = |form| of_autopilot(state, &body.position_m, &body.velocity_m_s, form);
        self.panel.update(now, self.rig.time_us(), said);
    }

    /// An autopilot that has not answered yet is starting, by the wall clock as much as by ours.
    fn speed(&self) -> Speed {
        match self.settings.speed {
            Speed::Factor(factor) if self.answered_us.is_none() => Speed::Factor(factor.min(1.0)),
            Speed::Max if !self.lockstep => Speed::Factor(1.0),
            speed => speed,
        }
    }

    /// Waits for controls that answer the last sensors.
    fn await_controls(&mut self, stop: &Arc<AtomicBool>) -> Result<(), Gone> {
        let start = Instant::now();
        while !self.take(Some(LOOK))? && !stop.load(Ordering::Relaxed) {
            if start.elapsed() > PATIENCE {
                if self.missed == 0 {
                    tracing::warn!(
                        "no HIL_ACTUATOR_CONTROLS for {PATIENCE:?} after {:.3} s: continuing without",
                        self.rig.time_us() as f64 / 1e6
                    );
                }
                self.missed += 1;
                break;
            }
        }
        Ok(())
    }

    /// Handles received messages; returns whether new controls were among them.
    fn take(&mut self, wait: Option<Duration>) -> Result<bool, Gone> {
        let mut answered = false;
        for frame in self.client.receive(wait)? {
            match frame.message_id() {
                ActuatorControls::ID => answered |= self.control(&ActuatorControls::read(&frame)),
                id::COMMAND_LONG => self.command(&frame)?,
                _ => {}
            }
        }
        Ok(answered)
    }

    fn control(&mut self, controls: &ActuatorControls) -> bool {
        let newest_us = self.answered_us.unwrap_or(0);
        if controls.time_us != 0 && controls.time_us <= newest_us {
            self.stale += 1;
            return false;
        }
        if self.answered_us.is_none() {
            let how = if controls.lockstep { "in lock-step" } else { "at its own pace" };
            tracing::info!(
                "first HIL_ACTUATOR_CONTROLS after {:.3} s, {how}",
                self.rig.time_us() as f64 / 1e6
            );
        }
        self.answered_us = Some(controls.time_us.max(newest_us));
        (self.lockstep, self.armed) = (controls.lockstep, controls.armed);
        self.rig.control(controls);
        true
    }

    /// SET_MESSAGE_INTERVAL of HIL_STATE_QUATERNION is understood, as PX4 sends it.
    fn command(&mut self, frame: &Frame) -> Result<(), Gone> {
        const SET_MESSAGE_INTERVAL: u16 = 511;
        const HIL_STATE_QUATERNION: u32 = 115;
        const ACCEPTED: u8 = 0;
        const UNSUPPORTED: u8 = 3;
        let Some(command) = Command::read(frame) else { return Ok(()) };
        let understood =
            command.number == SET_MESSAGE_INTERVAL && command.whole(1) == Some(HIL_STATE_QUATERNION);
        if understood {
            self.rig.set_truth_interval(command.whole(2).map(u64::from));
        }
        let ack = CommandAck {
            command: command.number,
            result: if understood { ACCEPTED } else { UNSUPPORTED },
            progress: 0,
            target_system: frame.system(),
            target_component: frame.component(),
        };
        self.client.send([Message::CommandAck(ack)])
    }
}
