//! MAV_CMD_PREFLIGHT_CALIBRATION: the vehicle has to stand still for a while. It takes time, so it is answered "in progress" until it
//! is over, and can be cancelled. ArduPilot's clients expect one answer, when it is over: there it is over at once.

use mavlink::dialects::ardupilotmega::{MavCmd, MavResult};
use vehicle::{Refusal, Severity, Vehicle};

use super::command::{acknowledge, acknowledge_outcome};
use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, CommandKind, Frame, id};
use crate::context::Context;
use crate::envelope::Origin;

const NUMBER: u16 = MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION as u16;

/// It takes this long, µs.
const DURATION_US: u64 = 2_000_000;
/// Parts of it that are told.
const STEPS: u64 = 5;
/// Turning faster than this, rad/s, or moving faster than this, m/s, it does not stand still.
const STILL_RAD_S: f64 = 0.1;
const STILL_M_S: f64 = 0.1;

/// The radio: a ground station watches its pulses and sets parameters, and the vehicle heeds neither sticks nor switches until a command
/// with nothing to calibrate ends that, or until it is armed.
const RADIO: &str = "radio";
/// Its trims, which are taken at once.
const TRIM: &str = "radio trim";
/// Parameters of the command, and what they calibrate.
const UNITS: [(usize, f64, &str); 8] = [
    (1, 1.0, "gyro"),
    (2, 1.0, "mag"),
    (3, 1.0, "baro"),
    (4, 1.0, RADIO),
    (4, 2.0, TRIM),
    (5, 1.0, "accel"),
    (5, 2.0, "level"),
    // ArduPilot's simple calibration, on level ground.
    (5, 4.0, "accel"),
];

/// A calibration that is under way.
#[derive(Clone, Copy, Debug)]
struct Calibration {
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

/// Calibrates, calibrate one sensor at a time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Calibrations {
    running: Option<Calibration>,
}

impl Service for Calibrations {
    fn summary(&self) -> &'static str {
        "Calibrations of sensors"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::COMMAND_CANCEL]
    }

    /// A question: a second one asks how far it is, and refusals are told in the words of calibrations.
    fn commands(&self) -> &'static [CommandEntry] {
        const COMMANDS: &[CommandEntry] = &[CommandEntry::question(NUMBER)];
        COMMANDS
    }

    /// COMMAND_CANCEL: ends what is under way. What is over already is left alone.
    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        if frame.payload().u16(0) == NUMBER {
            self.end(context);
        }
    }

    /// Begins a calibration, or answers how far it is. With nothing to calibrate it ends what is under way.
    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        let unit = match unit(command) {
            Ok(None) => {
                self.end(context);
                if context.vehicle.calibrate_radio(false) {
                    say(context, Severity::Info, "calibration done: radio");
                }
                return Ok(Progress::Done);
            }
            Ok(Some(unit)) => Ok(unit),
            Err(refusal) => Err(refusal),
        };
        if let Some(running) = self.running {
            let sender = |origin: &Origin| (origin.system, origin.component);
            if unit == Ok(running.unit) && sender(&running.origin) == sender(origin) {
                return Ok(Progress::Percent(running.percent()));
            }
            return Err(Refusal::later("another calibration is running"));
        }
        match unit.and_then(|unit| may_begin(&context.vehicle).map(|()| unit)) {
            Ok(RADIO) => {
                context.vehicle.calibrate_radio(true);
                say(context, Severity::Info, "calibration started: radio; sticks and switches are ignored");
                Ok(Progress::Done)
            }
            Ok(unit) => {
                if context.identity().is_ardupilot() {
                    say(context, Severity::Info, &format!("calibration done: {unit}"));
                    return Ok(Progress::Done);
                }
                let begun_us = context.vehicle.time_us();
                self.running = Some(Calibration { origin: *origin, unit, begun_us, told: 0 });
                say(context, Severity::Info, &format!("calibration started: 2 {unit}"));
                Ok(Progress::Percent(0))
            }
            Err(refusal) => {
                say(context, Severity::Warning, &format!("calibration failed: {refusal}"));
                Err(refusal)
            }
        }
    }

    fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Goes on with the one that is under way.
    fn tick(&mut self, context: &mut Context) {
        let Some(mut running) = self.running else { return };
        let origin = running.origin;
        if let Err(refusal) = may_begin(&context.vehicle) {
            self.running = None;
            acknowledge(&mut context.outbox, &origin, NUMBER, MavResult::MAV_RESULT_FAILED);
            say(context, Severity::Warning, &format!("calibration failed: {refusal}"));
            return;
        }
        let elapsed_us = context.vehicle.time_us() - running.begun_us;
        let steps = elapsed_us * STEPS / DURATION_US;
        if steps == running.told {
            return;
        }
        running.told = steps;
        if steps < STEPS {
            self.running = Some(running);
            let outcome = Ok(Progress::Percent(running.percent()));
            acknowledge_outcome(&mut context.outbox, &origin, NUMBER, Some(&outcome));
            say(context, Severity::Info, &format!("progress <{}>", running.percent()));
        } else {
            self.running = None;
            acknowledge(&mut context.outbox, &origin, NUMBER, MavResult::MAV_RESULT_ACCEPTED);
            say(context, Severity::Info, &format!("calibration done: {}", running.unit));
        }
    }
}

impl Calibrations {
    fn end(&mut self, context: &mut Context) {
        if let Some(running) = self.running.take() {
            acknowledge(&mut context.outbox, &running.origin, NUMBER, MavResult::MAV_RESULT_CANCELLED);
            say(context, Severity::Info, "calibration cancelled");
        }
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
        return Err(Refusal::denied("calibrate one sensor at a time"));
    }
    let unit = UNITS.iter().find(|(known, kind, _)| *known == number && *kind == libm::round(value));
    unit.map(|(_, _, unit)| Some(*unit))
        .ok_or_else(|| Refusal::Unsupported(format!("parameter {number} = {value} is not supported")))
}

fn may_begin(vehicle: &Vehicle) -> Result<(), Refusal> {
    if vehicle.is_armed() {
        return Err(Refusal::later("vehicle is armed"));
    }
    // The truth: an estimate may still be on its way to it.
    let motion = vehicle.truth();
    if motion.body_rate_rad_s.norm() > STILL_RAD_S || motion.velocity_m_s.norm() > STILL_M_S {
        return Err(Refusal::later("vehicle is moving"));
    }
    Ok(())
}

/// In the words that clients look for.
fn say(context: &mut Context, severity: Severity, text: &str) {
    context.say(severity, &format!("[cal] {text}"));
}
