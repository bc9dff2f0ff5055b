//! The linear loops decay, and grow, as small deviations of nonlinear flights do.

extern crate std;
use std::vec::Vec;

use super::flight::{designed, fly, towards};
use crate::{Configuration, ControllerKind, Outputs};

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

/// Altitude and heading have one slowest oscillation, which stands alone after some seconds, whatever flies.
#[test]
fn small_deviations_decay_as_the_report_says() {
    for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr] {
        for output_feedback in [false, true] {
            for mass_factor in [0.8, 1.0] {
                let mut configuration = unshaped(kind, output_feedback);
                configuration.controllers.mass_factor = mass_factor;
                let report = designed(&configuration).expect("a design").stability;
                let [_, _, yaw, _, _, altitude] = report.loops();
                let cases: [(_, Seen, _); 2] = [
                    (yaw, |outputs| outputs.yaw_error_rad, (3.0, 8.0)),
                    (altitude, |outputs| outputs.tracking_error_m.z, (4.0, 10.0)),
                ];
                for (judged, error, window) in cases {
                    let rate = measured_decay_1_s(&configuration, error, judged.frequency_rad_s, window);
                    let difference = rate / judged.decay_rate_1_s - 1.0;
                    assert!(
                        difference.abs() < 0.05,
                        "{kind:?} {output_feedback} {mass_factor}: {rate} {judged:?}"
                    );
                }
            }
        }
    }
}

/// Unstable loops grow at the predicted rate, whichever of them it is and whatever the reason.
#[test]
fn small_deviations_grow_as_the_report_says() {
    let changes: [(&str, Change, usize, Seen); 5] = [
        ("rotor lag", |c| c.airframe.rotor_time_constant_s = 0.3, 4, |outputs| outputs.attitude_rad.x),
        (
            "position weight",
            |c| c.controllers.position.output_weight.fill(1e4),
            3,
            |outputs| outputs.position_m.x,
        ),
        (
            "altitude lag",
            |c| c.controllers.altitude.increment_weight.fill(1e-4),
            5,
            |outputs| outputs.velocity_m_s.z,
        ),
        (
            "yaw weight",
            |c| c.controllers.attitude.increment_weight[2] = 1e-4,
            2,
            |outputs| outputs.attitude_rad.z,
        ),
        (
            "rotor inertia",
            |c| c.airframe.rotor_spin.inertia_kg_m2 = 4e-4,
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
