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

#[cfg(test)]
mod tests {
    use lmpc::{Augmented, ControllerState, Discretization, Dlqr, Sample};
    use nalgebra::{DMatrix, SVector, Vector1, Vector3};

    use super::printed_design;
    use crate::control::tracking_law::TrackingLaw;
    use crate::design::capacities::{ALTITUDE_FEW, ALTITUDE_MANY};
    use crate::design::linear_models::altitude_model;
    use crate::design::loop_weights::loop_weights;
    use crate::{Configuration, ControllerKind};

    type Law = TrackingLaw<3, 1, ALTITUDE_FEW, ALTITUDE_MANY>;

    const BANDWIDTH_RAD_S: f64 = 2.7;

    /// The law of a kind on the altitude model as printed, ż = v, v̇ = G, whose third state is idle, and the regulator's gain of the same
    /// weights on that model alone.
    fn designed(kind: ControllerKind) -> (Law, DMatrix<f64>) {
        let settings = Configuration::default().controllers.altitude;
        let plant = altitude_model(settings.sample_time_s(), Discretization::ZeroOrderHold).expect("a model");
        let bandwidth = Vector1::new(BANDWIDTH_RAD_S);
        let (_, law) = printed_design(kind, &settings, &bandwidth, &plant).expect("a design");
        let model = Augmented::new(&plant);
        let weights = loop_weights(&model, &settings, &bandwidth).expect("weights");
        let regulator = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0).expect("a regulator");
        (law, regulator.gain().clone())
    }

    /// The first move from rest, per unit of one thing that the law is told.
    fn answer(law: &Law, sample: Sample<'_, 3, 1, 1>) -> f64 {
        law.step(&mut ControllerState::at_rest().keeping(), &sample).input.x
    }

    #[test]
    fn gains_are_the_regulators_on_the_states_that_there_are() {
        for (kind, share) in [(ControllerKind::Dlqr, 1e-9), (ControllerKind::Lmpc, 0.02)] {
            let (law, regulator) = designed(kind);
            let unit = |state: usize| SVector::from_fn(|row, _| if row == state { 1.0 } else { 0.0 });
            let found = [
                answer(&law, Sample { increment: unit(0), ..Sample::default() }),
                answer(&law, Sample { increment: unit(1), ..Sample::default() }),
                answer(&law, Sample { error: Vector1::new(1.0), ..Sample::default() }),
            ];
            for (found, expected) in found.iter().zip(regulator.iter()) {
                assert!((found / expected + 1.0).abs() < share, "{kind:?}: {found} {expected}");
            }
            assert_eq!(answer(&law, Sample { increment: unit(2), ..Sample::default() }), 0.0, "{kind:?}");
        }
    }

    /// Two metres off, on the exact solution of ż = v, v̇ = G over a sample: there within 8 s, whatever the idle state is told to be.
    #[test]
    fn every_kind_closes_the_printed_loop() {
        for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr] {
            let (law, _) = designed(kind);
            let sample_time_s = Configuration::default().controllers.altitude.sample_time_s();
            let mut state =
                ControllerState::new(Vector3::new(2.0, 0.0, 0.0), Vector1::zeros(), Vector1::zeros())
                    .keeping();
            let (mut z, mut v, mut input) = (2.0, 0.0, 0.0);
            for _ in 0..(8.0 / sample_time_s) as usize {
                let measured = Vector3::new(z, v, input);
                let sample = Sample {
                    measured,
                    increment: measured - state.measured(),
                    deviation: measured,
                    error: Vector1::new(z),
                    ..Sample::default()
                };
                input = law.step(&mut state, &sample).input.x;
                z += v * sample_time_s + input * sample_time_s * sample_time_s / 2.0;
                v += input * sample_time_s;
            }
            assert!(z.abs() < 0.01 && v.abs() < 0.01, "{kind:?}: {z} {v}");
        }
    }
}
