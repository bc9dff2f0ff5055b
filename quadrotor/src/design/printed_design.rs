//! A controller on a model that the paper prints, (9) or (15), whose inputs act at once.

use lmpc::{Augmented, DesignError, LmpcDesign, StateSpace};
use nalgebra::{DMatrix, SVector};

use crate::control::tracking_law::TrackingLaw;
use crate::design::cascade_design::weighted_design;
use crate::design::loop_weights::loop_weights;
use crate::{ControllerKind, ControllerSettings};

/// Pole of the states that the printed models do not have.
const IDLE: f64 = 0.5;

/// The design of a chain of double integrators and its law for a plant of N states: Laguerre MPC without limits, as in the paper, or the
/// regulator, or state-space MPC without limits. What exceeds the limits is cut off.
pub(crate) fn printed_design<const N: usize, const P: usize, const S: usize, const L: usize>(
    kind: ControllerKind,
    settings: &ControllerSettings<P>,
    bandwidth_rad_s: &SVector<f64, P>,
    plant: &StateSpace,
) -> Result<(LmpcDesign, TrackingLaw<N, P, S, L>), DesignError> {
    let with_idle_states = with_idle_states(plant, N, P)?;
    let augmented = Augmented::new(plant);
    let design =
        weighted_design(settings, &augmented, &loop_weights(&augmented, settings, bandwidth_rad_s)?)?;
    let law = match kind {
        ControllerKind::Lmpc => TrackingLaw::of_gain(&widened(design.gain(), N, P))?,
        ControllerKind::Dlqr => TrackingLaw::of_gain(&widened(design.dlqr().gain(), N, P))?,
        ControllerKind::StateSpaceMpc => {
            let augmented = Augmented::new(&with_idle_states);
            let weights = loop_weights(&augmented, settings, bandwidth_rad_s)?;
            let design = weighted_design(settings, &augmented, &weights)?;
            TrackingLaw::new(kind, settings, &design, &weights)?
        }
    };
    Ok((design, law))
}

/// The same plant with further states behind those of each channel, which nothing moves.
fn with_idle_states(plant: &StateSpace, states: usize, channels: usize) -> Result<StateSpace, DesignError> {
    let (of_plant, of_all) = (plant.states() / channels, states / channels);
    let place = |state: usize| state / of_plant * of_all + state % of_plant;
    let mut a = DMatrix::identity(states, states) * IDLE;
    let mut b = DMatrix::zeros(states, channels);
    let mut c = DMatrix::zeros(channels, states);
    for row in 0..plant.states() {
        a[(place(row), place(row))] = 0.0;
        for column in 0..plant.states() {
            a[(place(row), place(column))] = plant.a()[(row, column)];
        }
        for input in 0..channels {
            b[(place(row), input)] = plant.b()[(row, input)];
            c[(input, place(row))] = plant.c()[(input, row)];
        }
    }
    StateSpace::new(a, b, c)
}

/// The same gain on \[Δx; y − r\] of a plant with such further states.
fn widened(gain: &DMatrix<f64>, states: usize, channels: usize) -> DMatrix<f64> {
    let given = gain.ncols() - channels;
    let (of_plant, of_all) = (given / channels, states / channels);
    let mut widened = DMatrix::zeros(channels, states + channels);
    for state in 0..given {
        widened.set_column(state / of_plant * of_all + state % of_plant, &gain.column(state));
    }
    for output in 0..channels {
        widened.set_column(states + output, &gain.column(given + output));
    }
    widened
}
