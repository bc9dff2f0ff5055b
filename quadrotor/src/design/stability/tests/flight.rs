//! Nonlinear flights with any configuration whose controllers can be designed.

use alloc::sync::Arc;

use crate::design::loop_design::LoopDesign;
use crate::design::rotor_loss_design::RotorLossDesign;
use crate::design::stability::stability_report::StabilityReport;
use crate::{
    CascadeDesign, Configuration, ConfigurationError, Inputs, Outputs, PositionReference, PreparedDesign,
    Simulation,
};

/// Loses sight of the vehicle, m.
const FAR_M: f64 = 100.0;
/// Cosine of a tilt of 80°.
const TIPPED: f64 = 0.173_648;

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Flown,
    Lost,
}

/// Controllers and report of a configuration, whatever the report says.
pub(super) fn designed(configuration: &Configuration) -> Result<LoopDesign, ConfigurationError> {
    let cascade = CascadeDesign::new(configuration)?;
    let stability = StabilityReport::of(configuration, &cascade)
        .map_err(|source| ConfigurationError::Design { part: "closed loop", source })?;
    let rotor_loss = RotorLossDesign::new(configuration);
    Ok(LoopDesign { configuration: *configuration, cascade: cascade.into(), rotor_loss, stability })
}

/// Armed at the origin, with a goal and a heading.
pub(super) fn towards(goal_m: [f64; 3], yaw_rad: f64) -> Inputs {
    Inputs { reference: PositionReference::goal(goal_m, yaw_rad), ..Inputs::default() }
}

/// Flies for `duration_s` and shows the outputs every `step_us`, until the flight cannot go on.
pub(super) fn fly(
    design: LoopDesign,
    inputs: &Inputs,
    duration_s: f64,
    step_us: u64,
    mut see: impl FnMut(&Outputs),
) -> End {
    let design = PreparedDesign { design: Arc::new(design) };
    let Ok(mut flight) = Simulation::prepared(&design, inputs) else { return End::Lost };
    for step in 1..=(duration_s * 1e6) as u64 / step_us {
        if flight.advance_to(step * step_us, inputs).is_err() {
            return End::Lost;
        }
        let outputs = flight.outputs();
        let [_, x, y, _] = outputs.quaternion;
        let upright = 1.0 - 2.0 * (x * x + y * y);
        let distance_m = outputs.position_m.norm();
        if upright.is_nan() || upright < TIPPED || distance_m.is_nan() || distance_m > FAR_M {
            return End::Lost;
        }
        see(&outputs);
    }
    End::Flown
}

/// A metre in each direction and half a radian of heading.
pub(super) fn fly_a_metre(design: LoopDesign, duration_s: f64) -> End {
    fly(design, &towards([1.0, 1.0, -1.0], 0.5), duration_s, 20_000, |_| {})
}
