//! The linear loops decay, and grow, as small deviations of nonlinear flights do.

extern crate std;
use std::vec::Vec;

use nalgebra::{Matrix2, SVector, Vector2, Vector3};

use super::flight::{designed, fly, towards};
use crate::design::stability::linear_law::LinearLaw;
use crate::design::stability::small_signal::{Reading, SmallSignal};
use crate::design::stability::turning_axis::{Turning, TurningAxis};
use crate::design::stability::turning_loop::TurningLoop;
use crate::{Configuration, ControllerKind, Outputs, PredictionModel};

/// One number of the outputs.
type Seen = fn(&Outputs) -> f64;
type Change = fn(&mut Configuration);

/// Greatest magnitude of an error within a part of a flight.
fn greatest(errors: &[(f64, f64)], from_s: f64, to_s: f64) -> f64 {
    let within = errors.iter().filter(|(time_s, _)| (from_s..to_s).contains(time_s));
    within.map(|(_, error)| error.abs()).fold(0.0, f64::max)
}

/// Decay rate of one error of a flight to a goal a hundredth of a micrometre away, over whole oscillations.
fn measured_decay_1_s(
    configuration: &Configuration,
    error: impl Fn(&Outputs) -> f64,
    frequency_rad_s: f64,
    (from_s, to_s): (f64, f64),
) -> f64 {
    let mut errors = Vec::new();
    let design = designed(configuration).expect("a design");
    fly(design, &towards([1e-8, 1e-8, -1e-8], 1e-8), to_s, 1_000, |outputs| {
        errors.push((outputs.time_us as f64 / 1e6, error(outputs)));
    });
    let cycle_s = if frequency_rad_s > 0.0 { core::f64::consts::PI / frequency_rad_s } else { 0.5 };
    // Whole half oscillations between two windows of one each.
    let count = ((to_s - from_s) / cycle_s).floor() - 1.0;
    assert!(count >= 1.0, "{count}");
    let (early, late) = (
        greatest(&errors, from_s, from_s + cycle_s),
        greatest(&errors, from_s + count * cycle_s, from_s + (count + 1.0) * cycle_s),
    );
    (early / late).ln() / (count * cycle_s)
}

fn unshaped(kind: ControllerKind, output_feedback: bool) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.reference.shaping = false;
    configuration.controllers.kind = kind;
    configuration.sensors.output_feedback = output_feedback;
    configuration
}

/// Decay rate of an error in a part of a flight in which its two slowest modes are left: the larger root of z² = c₁ z + c₂, with the
/// c that fit e(t + 2h) = c₁ e(t + h) + c₂ e(t) best, all times alike.
fn fitted_decay_1_s(errors: &[f64], (from_s, to_s): (f64, f64)) -> f64 {
    /// h, ms: an error is seen every millisecond.
    const STEP: usize = 200;
    let (mut squares, mut products) = (Matrix2::zeros(), Vector2::zeros());
    for first in (from_s * 1e3) as usize..(to_s * 1e3) as usize - 2 * STEP {
        let seen = Vector3::new(errors[first], errors[first + STEP], errors[first + 2 * STEP]).normalize();
        let before = Vector2::new(seen.y, seen.x);
        squares += before * before.transpose();
        products += before * seen.z;
    }
    let fitted = squares.try_inverse().expect("two modes") * products;
    let discriminant = fitted.x * fitted.x / 4.0 + fitted.y;
    let largest =
        if discriminant < 0.0 { (-fitted.y).sqrt() } else { fitted.x.abs() / 2.0 + discriminant.sqrt() };
    -largest.ln() / (STEP as f64 / 1e3)
}

/// The altitude has one slowest oscillation, which stands alone after some seconds, whatever flies.
#[test]
fn small_deviations_decay_as_the_report_says() {
    for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr] {
        for output_feedback in [false, true] {
            for mass_factor in [0.8, 1.0] {
                let mut configuration = unshaped(kind, output_feedback);
                configuration.controllers.mass_factor = mass_factor;
                configuration.controllers.learning = false;
                let design = designed(&configuration).expect("a design");
                let [_, _, _, _, _, judged] = *design.stability.loops();
                let mut heights = Vec::new();
                fly(design, &towards([1e-4, 1e-4, -1e-4], 1e-4), 10.0, 1_000, |outputs| {
                    heights.push(outputs.tracking_error_m.z);
                });
                let rate = fitted_decay_1_s(&heights, (3.0, 8.0));
                let difference = rate / judged.decay_rate_1_s - 1.0;
                assert!(
                    difference.abs() < 0.05,
                    "{kind:?} {output_feedback} {mass_factor}: {rate} {judged:?}"
                );
            }
        }
    }
}

/// The heading comes back by modes that are too near to one another to be told apart: its whole way off and back, when a torque begins to turn
/// the vehicle, is that of the linear loop.
#[test]
fn a_heading_comes_back_as_its_linear_loop_does() {
    const PUSH_RAD_S2: f64 = 1e-4;
    for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr] {
        for (output_feedback, mass_factor) in [(false, 1.0), (false, 0.8), (true, 1.0), (true, 0.8)] {
            let mut configuration = unshaped(kind, output_feedback);
            configuration.controllers.mass_factor = mass_factor;
            configuration.controllers.learning = false;
            let design = designed(&configuration).expect("a design");
            let [law] = LinearLaw::of(&design.cascade.attitude.turn);
            let axis = TurningAxis::new(&configuration, &design.cascade, (2, law));
            let linear = TurningLoop::new(&configuration, axis, 0.0).expect("a loop");
            let sample_time_s = linear.period_s();
            let mut inputs = towards([0.0; 3], 0.0);
            inputs.disturbance.torque_n_m.z = PUSH_RAD_S2 * configuration.airframe.inertia_kg_m2[2];
            let mut state = SVector::zeros();
            let (mut largest_rad, mut worst_rad) = (0.0_f64, 0.0_f64);
            fly(design, &inputs, 6.0, 10_000, |outputs| {
                state = linear.after(&state, 0, &Reading::default());
                state[Turning::ANGLE] += PUSH_RAD_S2 * sample_time_s * sample_time_s / 2.0;
                state[Turning::ANGLE + 1] += PUSH_RAD_S2 * sample_time_s;
                largest_rad = largest_rad.max(outputs.attitude_rad.z.abs());
                worst_rad = worst_rad.max((outputs.attitude_rad.z - state[Turning::ANGLE]).abs());
            });
            assert!(worst_rad < 1e-3 * largest_rad, "{kind:?} {output_feedback}: {worst_rad} {largest_rad}");
            assert!(state[Turning::ANGLE].abs() < 0.02 * largest_rad, "{kind:?} {output_feedback}: {state}");
        }
    }
}

/// Unstable loops grow at the predicted rate, whichever of them it is and whatever the reason.
#[test]
fn small_deviations_grow_as_the_report_says() {
    let changes: [(&str, Change, usize, Seen); 4] = [
        (
            "rotor lag",
            |c| {
                // The printed model of the position does not know the attitude that answers late.
                c.controllers.model = PredictionModel::Paper;
                c.airframe.rotor_time_constant_s = 0.06;
            },
            4,
            |outputs| outputs.attitude_rad.x,
        ),
        (
            "position weight",
            |c| {
                c.controllers.model = PredictionModel::Paper;
                c.controllers.position.output_weight.fill(1e4);
            },
            3,
            |outputs| outputs.position_m.x,
        ),
        (
            "altitude lag",
            |c| {
                c.controllers.model = PredictionModel::Paper;
                c.controllers.altitude.increment_weight.fill(1e-4);
                c.airframe.rotor_time_constant_s = 0.15;
            },
            5,
            |outputs| outputs.velocity_m_s.z,
        ),
        (
            "rotor inertia",
            |c| {
                c.controllers.model = PredictionModel::Paper;
                c.airframe.rotor_spin.inertia_kg_m2 = 1e-3;
            },
            2,
            |outputs| outputs.attitude_rad.z,
        ),
    ];
    for (name, change, index, error) in changes {
        let mut configuration = unshaped(ControllerKind::Dlqr, false);
        change(&mut configuration);
        let judged = designed(&configuration).expect("a design").stability.loops()[index];
        assert!(!judged.is_stable(), "{name}: {judged:?}");
        // To three thousand times a hundredth of a micrometre: limits are still far away.
        let window = (-4.0 / judged.decay_rate_1_s, -8.0 / judged.decay_rate_1_s);
        let measured = measured_decay_1_s(&configuration, error, judged.frequency_rad_s, window);
        assert!((measured / judged.decay_rate_1_s - 1.0).abs() < 0.1, "{name}: {measured} {judged:?}");
    }
}
