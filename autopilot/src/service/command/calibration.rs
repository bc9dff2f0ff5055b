//! MAV_CMD_PREFLIGHT_CALIBRATION: the vehicle has to stand still for a while. It takes time, so it is answered "in progress" until it
//! is over, and can be cancelled.

use vehicle::{Refusal, Severity, Vehicle};

use super::{acknowledge, acknowledge_progress, result};
use crate::autopilot::Autopilot;
use crate::codec::{Command, CommandKind, Frame};
use crate::service::{Origin, status_text};

/// MAV_CMD_PREFLIGHT_CALIBRATION.
pub const NUMBER: u16 = 241;

/// It takes this long, µs.
const DURATION_US: u64 = 2_000_000;
/// Parts of it that are told.
const STEPS: u64 = 5;
/// Turning faster than this, rad/s, or moving faster than this, m/s, it does not stand still.
const STILL_RAD_S: f64 = 0.1;
const STILL_M_S: f64 = 0.1;

/// Parameters of the command, and what they calibrate.
const UNITS: [(usize, f64, &str); 5] =
    [(1, 1.0, "gyro"), (2, 1.0, "mag"), (3, 1.0, "baro"), (5, 1.0, "accel"), (5, 2.0, "level")];

/// A calibration that is under way.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    origin: Origin,
    unit: &'static str,
    begun_us: u64,
    told: u64,
}

impl Calibration {
    fn percent(&self) -> u8 {
        (self.told * 100 / STEPS) as u8
    }
}

/// Begins a calibration, or answers how far it is. With nothing to calibrate it ends what is under way.
pub fn handle(autopilot: &mut Autopilot, origin: &Origin, command: &Command) {
    let unit = match unit(command) {
        Ok(None) => {
            acknowledge(autopilot, origin, NUMBER, result::ACCEPTED);
            end(autopilot);
            return;
        }
        Ok(Some(unit)) => Ok(unit),
        Err(refusal) => Err(refusal),
    };
    if let Some(running) = autopilot.calibration {
        let sender = |origin: &Origin| (origin.system, origin.component);
        if unit == Ok(running.unit) && sender(&running.origin) == sender(origin) {
            acknowledge_progress(autopilot, origin, NUMBER, running.percent());
        } else {
            acknowledge(autopilot, origin, NUMBER, result::TEMPORARILY_REJECTED);
        }
        return;
    }
    match unit.and_then(|unit| may_begin(&autopilot.vehicle).map(|()| unit)) {
        Ok(unit) => {
            let begun_us = autopilot.vehicle.time_us();
            autopilot.calibration = Some(Calibration { origin: *origin, unit, begun_us, told: 0 });
            acknowledge_progress(autopilot, origin, NUMBER, 0);
            say(autopilot, Severity::Info, &format!("calibration started: 2 {unit}"));
        }
        Err(refusal) => {
            let reason = refusal.to_string();
            acknowledge(autopilot, origin, NUMBER, super::code(&Some(Err(refusal))));
            say(autopilot, Severity::Warning, &format!("calibration failed: {reason}"));
        }
    }
}

/// COMMAND_CANCEL: ends what is under way. What is over already is left alone.
pub fn cancel(autopilot: &mut Autopilot, frame: &Frame) {
    let command = frame.payload().u16(0);
    if command == NUMBER && autopilot.calibration.is_some() {
        end(autopilot);
    }
}

fn end(autopilot: &mut Autopilot) {
    if let Some(running) = autopilot.calibration.take() {
        acknowledge(autopilot, &running.origin, NUMBER, result::CANCELLED);
        say(autopilot, Severity::Info, "calibration cancelled");
    }
}

/// Goes on with the one that is under way.
pub fn step(autopilot: &mut Autopilot) {
    let Some(mut running) = autopilot.calibration else { return };
    let origin = running.origin;
    if let Err(refusal) = may_begin(&autopilot.vehicle) {
        autopilot.calibration = None;
        acknowledge(autopilot, &origin, NUMBER, result::FAILED);
        say(autopilot, Severity::Warning, &format!("calibration failed: {refusal}"));
        return;
    }
    let elapsed_us = autopilot.vehicle.time_us() - running.begun_us;
    let steps = elapsed_us * STEPS / DURATION_US;
    if steps == running.told {
        return;
    }
    running.told = steps;
    if steps < STEPS {
        autopilot.calibration = Some(running);
        acknowledge_progress(autopilot, &origin, NUMBER, running.percent());
        say(autopilot, Severity::Info, &format!("progress <{}>", running.percent()));
    } else {
        autopilot.calibration = None;
        acknowledge(autopilot, &origin, NUMBER, result::ACCEPTED);
        say(autopilot, Severity::Info, &format!("calibration done: {}", running.unit));
    }
}

/// The one unit that a command is for; `None` for none at all.
fn unit(command: &Command) -> Result<Option<&'static str>, Refusal> {
    // An integer stands for itself here, not for degrees.
    let scale = if matches!(command.kind, CommandKind::Int { .. }) { 1e7 } else { 1.0 };
    let [a, b, c, d] = command.parameters;
    let values = [a, b, c, d, command.x * scale, command.y * scale, command.z];
    // What was not given asks for nothing.
    let mut asked = (1..).zip(values).filter(|(_, value)| !value.is_nan() && *value != 0.0);
    let Some((number, value)) = asked.next() else { return Ok(None) };
    if asked.next().is_some() {
        return Err(Refusal::denied("one unit at a time"));
    }
    let unit = UNITS.iter().find(|(known, kind, _)| *known == number && *kind == libm::round(value));
    unit.map(|(_, _, unit)| Some(*unit))
        .ok_or_else(|| Refusal::Unsupported(format!("parameter {number} = {value} is not supported")))
}

fn may_begin(vehicle: &Vehicle) -> Result<(), Refusal> {
    if vehicle.is_armed() {
        return Err(Refusal::later("armed"));
    }
    // The truth: an estimate may still be on its way to it.
    let motion = vehicle.truth();
    if motion.body_rate_rad_s.norm() > STILL_RAD_S || motion.velocity_m_s.norm() > STILL_M_S {
        return Err(Refusal::later("not standing still"));
    }
    Ok(())
}

/// In the words that clients look for.
fn say(autopilot: &mut Autopilot, severity: Severity, text: &str) {
    status_text::send(autopilot, severity, &format!("[cal] {text}"));
}
