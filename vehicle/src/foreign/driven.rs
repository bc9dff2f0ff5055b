//! A plant from elsewhere under rotor commands, with what it does not show made up for.

use nalgebra::Vector3;
use quadrotor::{Actuation, Plant, PlantInputs, PlantState, PositionReference, Wrench};

use super::{Demand, ForeignModel, ForeignMotion};
use crate::FlightError;

/// A plant from elsewhere after a part of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driven {
    /// Its state. Rotors that it does not show follow their commands with the airframe's lag; its battery is always ours.
    pub state: PlantState,
    /// Its acceleration in NED, m/s²: as shown, or the change of its velocity.
    pub acceleration_m_s2: Vector3<f64>,
    /// As it has shown itself.
    pub motion: ForeignMotion,
}

/// Drives a plant from elsewhere from a state on, for `duration_us` from `time_us`.
///
/// # Errors
/// [`FlightError`] of the model.
pub fn drive(
    model: &mut dyn ForeignModel,
    plant: &Plant,
    state: &PlantState,
    inputs: &PlantInputs,
    (time_us, duration_us): (u64, u64),
) -> Result<Driven, FlightError> {
    let h_s = duration_us as f64 / 1e6;
    let ours = plant.step(state, inputs, h_s);
    // A motor without power is one that is told to stop; the lag to there is the model's.
    let rotor_command_rad_s = inputs.rotor_goals_rad_s(&state.rotor_speed_rad_s);
    let (_, _, yaw_rad) = state.body.rotation().euler_angles();
    let motion = model.advance(&Demand {
        time_us,
        duration_us,
        reference: PositionReference::goal(state.body.position_m.into(), yaw_rad),
        armed: turns(inputs),
        rotor_command_rad_s,
        wrench: mean_wrench(plant, state, &ours, inputs),
        wind_m_s: inputs.disturbance.wind_m_s,
        ground_z_m: inputs.ground_z_m,
    })?;
    let change = || (motion.body.velocity_m_s - state.body.velocity_m_s) / h_s;
    let rotor_speed_rad_s = motion.rotor_speed_rad_s.unwrap_or(ours.rotor_speed_rad_s);
    Ok(Driven {
        state: PlantState { body: motion.body, rotor_speed_rad_s, discharge: ours.discharge },
        acceleration_m_s2: motion.acceleration_m_s2.unwrap_or_else(change),
        motion,
    })
}

/// Whether a rotor is commanded to turn.
fn turns(inputs: &PlantInputs) -> bool {
    matches!(inputs.actuation, Actuation::RotorSpeeds(command_rad_s) if command_rad_s.iter().any(|speed| *speed > 0.0))
}

/// The mean of thrust and torques at the beginning and the end of a step in which the rotors follow their commands.
fn mean_wrench(plant: &Plant, before: &PlantState, after: &PlantState, inputs: &PlantInputs) -> Wrench {
    let end = PlantState { body: before.body, ..*after };
    let (begin, end) = (plant.wrench(before, inputs), plant.wrench(&end, inputs));
    Wrench {
        thrust_n: (begin.thrust_n + end.thrust_n) / 2.0,
        torque_n_m: (begin.torque_n_m + end.torque_n_m) / 2.0,
    }
}
