//! MAV_CMD_DO_MOTOR_TEST and MAV_CMD_ACTUATOR_TEST: single rotors turn on the ground.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::{MotorTest, Refusal};

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;

const MOTOR_TEST: u16 = MavCmd::MAV_CMD_DO_MOTOR_TEST as u16;
const ACTUATOR_TEST: u16 = MavCmd::MAV_CMD_ACTUATOR_TEST as u16;
const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MOTOR_TEST), CommandEntry::action(ACTUATOR_TEST)];

/// MOTOR_TEST_THROTTLE_TYPE.
const PERCENT: f64 = 0.0;
const PULSE: f64 = 1.0;
/// Pulses of a motor that rests and of one that turns as fast as it can, µs; and those that are taken at all.
const LEAST_PULSE_US: f64 = 1000.0;
const MOST_PULSE_US: f64 = 2000.0;
const PULSES_US: core::ops::RangeInclusive<f64> = 800.0..=2200.0;

/// Turns rotors.
#[derive(Clone, Copy, Debug)]
pub struct MotorTests;

impl Service for MotorTests {
    fn summary(&self) -> &'static str {
        "Tests of single motors on the ground"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let test = if command.number == ACTUATOR_TEST { test_actuator } else { test_motor };
        test(context, command).map(|()| Progress::Done)
    }
}

/// Motor, kind of throttle, throttle, seconds, number of motors, order: ours is clockwise from the front, which is ArduPilot's order of
/// tests.
fn test_motor(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let rotor = command.whole(1).and_then(|number| number.checked_sub(1));
    let rotor = rotor.ok_or_else(|| Refusal::denied("Motor Test: motors are numbered from 1"))?;
    let throttle = command.parameter(3);
    let speed_share = match command.parameter(2) {
        PERCENT if (0.0..=100.0).contains(&throttle) => throttle / 100.0,
        PULSE if PULSES_US.contains(&throttle) => {
            ((throttle - LEAST_PULSE_US) / (MOST_PULSE_US - LEAST_PULSE_US)).clamp(0.0, 1.0)
        }
        PERCENT => return Err(Refusal::denied("Motor Test: throttle out of range; allowed 0–100 %")),
        PULSE => return Err(Refusal::denied("Motor Test: throttle out of range; allowed 800–2200 us")),
        kind => {
            let reason =
                format!("Motor Test: throttle type {kind} is not supported; 0 is percent, 1 a pulse");
            return Err(Refusal::Unsupported(reason));
        }
    };
    let each_s = Some(command.parameter(4)).filter(|seconds| seconds.is_finite()).unwrap_or(0.0);
    let count = Some(command.integer(5)).filter(|count| *count >= 1.0).map_or(1, |count| count as usize);
    context.vehicle.test_motors(&MotorTest { rotor: rotor as usize, count, speed_share, each_s })
}

/// Value from -1 to 1 (NaN: at rest), seconds (0 ends the test), and the function of the output: motors are 1 to 12.
fn test_actuator(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let function = command.integer(5);
    if function.fract() != 0.0 || !(1.0..=12.0).contains(&function) {
        return Err(Refusal::denied("Actuator test: only motors can be tested, output functions 1–4"));
    }
    if context.vehicle.is_armed() {
        return Err(Refusal::later("Actuator test rejected: disarm first"));
    }
    let (value, each_s) = (command.parameter(1), command.parameter(2));
    if value.is_nan() || each_s.is_nan() || each_s <= 0.0 {
        context.vehicle.end_motor_test();
        return Ok(());
    }
    let test = MotorTest { rotor: function as usize - 1, count: 1, speed_share: value.max(0.0), each_s };
    context.vehicle.test_motors(&test)
}
