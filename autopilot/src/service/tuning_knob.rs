//! Knobs of ArduPilot's radio that change a value in flight: TUNE says what.

use vehicle::Severity;
use vehicle::plan::ChangeSpeed;

use super::Service;
use crate::context::Context;

/// ArduPilot looks at the knobs 3.3 times per second: every so often, µs.
const PERIOD_US: u64 = 300_000;

/// What a knob changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    /// The speed of the way that is flown: so many of its units are a metre per second.
    WaySpeed(f64),
    /// A parameter.
    Parameter(&'static str),
}

/// Numbers of TUNE that change something here.
const TARGETS: &[(u32, Target)] = &[
    (10, Target::WaySpeed(100.0)),
    (25, Target::Parameter("ACRO_RP_RATE")),
    (28, Target::Parameter("PSC_NE_VEL_I")),
    (39, Target::Parameter("CIRCLE_RATE")),
    (40, Target::Parameter("ACRO_Y_RATE")),
    (60, Target::Parameter("LOIT_SPEED_MS")),
    (61, Target::WaySpeed(1.0)),
];

/// Follows the knobs.
#[derive(Clone, Copy, Debug, Default)]
pub struct TuningKnobs {
    due_us: u64,
    /// What was set last for each knob: what, and to which value.
    set: [Option<(u32, f64)>; 2],
}

impl Service for TuningKnobs {
    fn tick(&mut self, context: &mut Context) {
        let time_us = context.vehicle.time_us();
        if time_us < self.due_us || !context.identity().is_ardupilot() {
            return;
        }
        self.due_us = time_us + PERIOD_US;
        let pilot = context.vehicle.pilot();
        let Some(pulses) = pilot.pulses.filter(|_| !pilot.lost) else { return };
        for (index, set) in self.set.iter_mut().enumerate() {
            let turned = context.vehicle.conduct().radio.turned(index, &pulses);
            let target = turned.and_then(|(number, _)| TARGETS.iter().find(|(known, _)| *known == number));
            let (Some((number, value)), Some((_, target))) = (turned, target) else {
                *set = None;
                continue;
            };
            if matches!(target, Target::WaySpeed(_)) && !context.vehicle.is_armed() {
                // A flight begins with the speeds of the parameters.
                *set = None;
                continue;
            }
            // A knob that rests leaves what others set.
            if set.replace((number, value)) != Some((number, value))
                && let Err(reason) = apply(context, *target, value)
            {
                context.say(Severity::Warning, &format!("Tuning knob: {reason}"));
            }
        }
    }
}

/// Sets the value that a knob asks for.
fn apply(context: &mut Context, target: Target, value: f64) -> Result<(), String> {
    const OVER_GROUND: f64 = 1.0;
    let vehicle = &mut context.vehicle;
    match target {
        Target::WaySpeed(units) => match ChangeSpeed::of(OVER_GROUND, value / units) {
            Some(change) => vehicle.change_speed(&change).map_err(|refusal| refusal.to_string()),
            None => Err(format!("{value} is no speed")),
        },
        Target::Parameter(name) => {
            context.parameters.set(name, value, vehicle).map_err(|error| error.to_string())
        }
    }
}
