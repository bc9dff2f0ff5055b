//! ArduPilot's calibration of the magnetometer: MAV_CMD_DO_START_MAG_CAL, DO_ACCEPT_MAG_CAL, DO_CANCEL_MAG_CAL, MAG_CAL_PROGRESS and
//! MAG_CAL_REPORT; and MAV_CMD_FIXED_MAG_CAL_YAW.
//!
//! Nobody can turn a simulated vehicle by hand: the calibration goes on as if somebody did, and finds the offsets that the magnetometer
//! has, which are none.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    MAG_CAL_PROGRESS_DATA, MAG_CAL_REPORT_DATA, MagCalStatus, MavCmd, MavMessage, MavSensorOrientation,
};
use vehicle::{Refusal, Severity};

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::{Destination, Origin};

const START: u16 = MavCmd::MAV_CMD_DO_START_MAG_CAL as u16;
const ACCEPT: u16 = MavCmd::MAV_CMD_DO_ACCEPT_MAG_CAL as u16;
const CANCEL: u16 = MavCmd::MAV_CMD_DO_CANCEL_MAG_CAL as u16;
const FIXED_YAW: u16 = MavCmd::MAV_CMD_FIXED_MAG_CAL_YAW as u16;
const COMMANDS: &[CommandEntry] = &[
    CommandEntry::action(START),
    CommandEntry::action(ACCEPT),
    CommandEntry::action(CANCEL),
    CommandEntry::action(FIXED_YAW),
];

/// The mask of the only compass.
const MASK: u8 = 1;
/// Turning it takes this long, µs; half of it finds a sphere, the other half an ellipsoid.
const DURATION_US: u64 = 10_000_000;
/// How often the progress and the result are told, µs.
const TOLD_US: u64 = 100_000;
const REPORTED_US: u64 = 1_000_000;
/// Sections of the sphere that have been seen are bits.
const SECTIONS: u32 = 80;
/// Fitness of a calibration without an error, mGauss: what the noise leaves.
const FITNESS: f32 = 1.0;
/// A reboot that was asked for follows this long after success, µs.
const REBOOT_US: u64 = 1_000_000;

/// A calibration.
#[derive(Clone, Copy, Debug)]
struct Calibration {
    begins_us: u64,
    told_us: u64,
    saves: bool,
    reboots: bool,
    /// Whether it has succeeded.
    over: bool,
}

/// Calibrates the magnetometer.
#[derive(Clone, Copy, Debug, Default)]
pub struct MagnetometerCalibrations {
    running: Option<Calibration>,
}

impl Service for MagnetometerCalibrations {
    fn summary(&self) -> &'static str {
        "Calibration of the magnetometer, as if somebody turned the vehicle"
    }

    fn answers(&self) -> &'static [u32] {
        &[MAG_CAL_PROGRESS_DATA::ID, MAG_CAL_REPORT_DATA::ID]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        if command.number == FIXED_YAW {
            return fix_by_yaw(context, command).map(|()| Progress::Done);
        }
        if !(0.0..=255.0).contains(&command.parameter(1)) {
            return Err(Refusal::Failed("Compass mask out of range; allowed 0–255".to_owned()));
        }
        match command.number {
            START => self.start(context, command)?,
            ACCEPT => self.accept()?,
            _ => self.running = None,
        }
        Ok(Progress::Done)
    }

    fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    fn tick(&mut self, context: &mut Context) {
        let Some(calibration) = &mut self.running else { return };
        let time_us = context.vehicle.time_us();
        if context.vehicle.is_armed() {
            self.running = None;
            return;
        }
        let period_us = if calibration.over { REPORTED_US } else { TOLD_US };
        if time_us < calibration.told_us + period_us {
            return;
        }
        calibration.told_us = time_us;
        let done_us = time_us.saturating_sub(calibration.begins_us);
        if done_us >= DURATION_US && !calibration.over {
            calibration.over = true;
            if calibration.saves && calibration.reboots {
                context.reboot_us.get_or_insert(time_us + REBOOT_US);
            }
        }
        let message = if calibration.over {
            report(calibration)
        } else {
            progress(done_us, time_us >= calibration.begins_us)
        };
        context.outbox.send(Destination::Everyone, message);
    }
}

impl MagnetometerCalibrations {
    /// Mask, retry, save by itself, delay in s, reboot then.
    fn start(&mut self, context: &mut Context, command: &Command) -> Result<(), Refusal> {
        if context.vehicle.is_armed() {
            return Err(Refusal::Failed("Disarm to allow compass calibration".to_owned()));
        }
        let mask = command.parameter(1) as u8;
        if mask & !MASK != 0 {
            return Err(Refusal::Failed(format!(
                "Compass mask {mask}: there is only compass 1, mask {MASK}"
            )));
        }
        if !context.vehicle.instrument_health().magnetometer {
            return Err(Refusal::Failed("Compass calibration: compass not healthy".to_owned()));
        }
        let given = |value: f64| !value.is_nan() && value != 0.0;
        let delay_s = Some(command.parameter(4)).filter(|delay| *delay > 0.0).unwrap_or(0.0);
        let time_us = context.vehicle.time_us();
        self.running = Some(Calibration {
            begins_us: time_us.saturating_add((delay_s * 1e6) as u64),
            told_us: time_us,
            saves: given(command.parameter(3)),
            reboots: given(command.integer(5)),
            over: false,
        });
        Ok(())
    }

    /// What is accepted is told no longer.
    fn accept(&mut self) -> Result<(), Refusal> {
        if self.running.is_some_and(|calibration| !calibration.over) {
            return Err(Refusal::Failed("Compass calibration is not over yet".to_owned()));
        }
        self.running = None;
        Ok(())
    }
}

/// Heading in degrees, mask, latitude and longitude: the offsets that agree with it are those of a compass without errors.
fn fix_by_yaw(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    if context.vehicle.is_armed() {
        return Err(Refusal::Failed("Disarm to allow compass calibration".to_owned()));
    }
    if !command.parameter(1).is_finite() {
        return Err(Refusal::Failed("Compass calibration requires a heading".to_owned()));
    }
    if !context.vehicle.validity().horizontal_position {
        return Err(Refusal::Failed("Mag: no position available".to_owned()));
    }
    context.say(Severity::Info, "Mag: calibrated by heading");
    Ok(())
}

fn progress(done_us: u64, begun: bool) -> MavMessage {
    let share = done_us.min(DURATION_US) as f64 / DURATION_US as f64;
    let seen = (share * f64::from(SECTIONS)) as u32;
    let mut completion_mask = [0; 10];
    for (index, byte) in (0..).zip(&mut completion_mask) {
        let bits = seen.saturating_sub(8 * index).min(8);
        *byte = ((1_u16 << bits) - 1) as u8;
    }
    let cal_status = match (begun, share < 0.5) {
        (false, _) => MagCalStatus::MAG_CAL_WAITING_TO_START,
        (true, true) => MagCalStatus::MAG_CAL_RUNNING_STEP_ONE,
        (true, false) => MagCalStatus::MAG_CAL_RUNNING_STEP_TWO,
    };
    MavMessage::MAG_CAL_PROGRESS(MAG_CAL_PROGRESS_DATA {
        cal_mask: MASK,
        cal_status,
        attempt: 1,
        completion_pct: (100.0 * share) as u8,
        completion_mask,
        ..MAG_CAL_PROGRESS_DATA::default()
    })
}

fn report(calibration: &Calibration) -> MavMessage {
    MavMessage::MAG_CAL_REPORT(MAG_CAL_REPORT_DATA {
        cal_mask: MASK,
        cal_status: MagCalStatus::MAG_CAL_SUCCESS,
        autosaved: u8::from(calibration.saves),
        fitness: FITNESS,
        diag_x: 1.0,
        diag_y: 1.0,
        diag_z: 1.0,
        orientation_confidence: 1.0,
        old_orientation: MavSensorOrientation::MAV_SENSOR_ROTATION_NONE,
        new_orientation: MavSensorOrientation::MAV_SENSOR_ROTATION_NONE,
        scale_factor: 1.0,
        ..MAG_CAL_REPORT_DATA::default()
    })
}
