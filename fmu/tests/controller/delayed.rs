//! Controllers and plant under a master that steps both at once: each command acts a step later.
//!
//! A plant that is driven by u(t − h) in place of u(t) is driven by u and a disturbance w(t) = u(t − h) − u(t). To first order the closed
//! loop answers with δ = g ∗ w, where g is its answer to an impulse at the plant's input. The integral of w is −h times the mean of u over
//! the last step, so that integration by parts leaves δ = −h ġ ∗ ū and
//!
//! ```text
//! |δ| ≤ h ∫|ġ| dt · max|u − u_trim|
//! ```
//!
//! An impulse of the thrust kicks the velocity, one of a torque the body rate. K = ∫|ġ| dt is therefore the way that the vehicle goes until
//! it has recovered from a kick of one unit, back and forth; the rotors' lag only smooths it. With a the commanded acceleration without
//! gravity's part, and ω̇ the commanded angular acceleration:
//!
//! ```text
//! |δ_z| ≤ h K_v max|a|
//! |δ_x|, |δ_y| ≤ h (K_ω max|ω̇| + K_v tan(tilt) max|a|)
//! ```

use crate::master::{Order, Pair, exact};
use fmi::Model;
use nalgebra::Vector3;
use quadrotor::{Configuration, GRAVITY_M_S2, Inputs, PlantState, PositionReference, Simulation};

/// A kick, small enough for a linear answer: m/s or rad/s.
const KICK: f64 = 1e-3;
/// In hover, before the kick, µs.
const SETTLING_US: u64 = 1_000_000;
/// After which nothing of a kick is left, µs.
const RECOVERED_US: u64 = 6_000_000;

fn pair(inputs: &Inputs) -> Pair {
    let configuration = Configuration::default();
    let parameters = exact(configuration);
    Pair::new(&parameters, inputs, Order::Jacobi)
}

/// What a loop with this step does about a kick of one unit.
struct Recovery {
    /// Way along an axis, back and forth, m.
    way_m: f64,
    /// Farthest from where it was, m.
    farthest_m: f64,
}

/// The worst over the instants of a kick between two samples of the outer controllers.
fn recovery(step_us: u64, axis: usize, kick: fn(&mut PlantState)) -> Recovery {
    let inputs = Inputs { reference: PositionReference::goal([0.0; 3], 0.0), ..Inputs::default() };
    let mut worst = Recovery { way_m: 0.0, farthest_m: 0.0 };
    for phase_us in [0, 10_000, 20_000, 30_000, 40_000] {
        let mut pair = pair(&inputs);
        while pair.controller.time_us() < SETTLING_US + phase_us {
            pair.step(step_us, &inputs);
        }
        let start_m = pair.state.body.position_m[axis];
        kick(&mut pair.state);
        let (mut way_m, mut farthest_m, mut last_m) = (0.0, 0.0_f64, start_m);
        while pair.controller.time_us() < SETTLING_US + phase_us + RECOVERED_US {
            pair.step(step_us, &inputs);
            let now_m = pair.state.body.position_m[axis];
            way_m += (now_m - last_m).abs() / KICK;
            farthest_m = farthest_m.max((now_m - start_m).abs() / KICK);
            last_m = now_m;
        }
        assert!((last_m - start_m).abs() < 1e-2 * KICK, "it has not recovered: {} m", last_m - start_m);
        worst = Recovery { way_m: worst.way_m.max(way_m), farthest_m: worst.farthest_m.max(farthest_m) };
    }
    worst
}

/// How far the default flight of a pair is from the closed loop's at most, m, and the extremes of its commands.
struct Deviation {
    horizontal_m: f64,
    vertical_m: f64,
    acceleration_m_s2: f64,
    angular_rad_s2: f64,
    tilt_rad: f64,
}

/// `idle`: the plant has no command in the first step, as from an importer that begins with zeros.
fn deviation(step_us: u64, idle: bool) -> Deviation {
    let inputs = Inputs::default();
    let configuration = Configuration::default();
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    let mut pair = pair(&inputs);
    let mut found = Deviation {
        horizontal_m: 0.0,
        vertical_m: 0.0,
        acceleration_m_s2: 0.0,
        angular_rad_s2: 0.0,
        tilt_rad: 0.0,
    };
    for time_us in (step_us..=20_000_000).step_by(usize::try_from(step_us).unwrap()) {
        if idle && time_us == step_us {
            pair.step_without_command(step_us, &inputs);
        } else {
            pair.step(step_us, &inputs);
        }
        flight.advance_to(time_us, &inputs).unwrap();
        let apart = flight.outputs().position_m - pair.state.body.position_m;
        found.horizontal_m = found.horizontal_m.max(apart.x.abs()).max(apart.y.abs());
        found.vertical_m = found.vertical_m.max(apart.z.abs());
        let wrench = pair.controller.outputs().wrench;
        let acceleration_m_s2 = wrench.thrust_n / configuration.airframe.mass_kg - GRAVITY_M_S2;
        found.acceleration_m_s2 = found.acceleration_m_s2.max(acceleration_m_s2.abs());
        let angular = wrench.torque_n_m.component_div(&Vector3::from(configuration.airframe.inertia_kg_m2));
        found.angular_rad_s2 = found.angular_rad_s2.max(angular.x.abs()).max(angular.y.abs());
        let upright = (pair.state.body.rotation() * Vector3::z()).z;
        found.tilt_rad = found.tilt_rad.max(upright.clamp(-1.0, 1.0).acos());
    }
    found
}

#[test]
fn a_delayed_command_moves_the_flight_no_farther_than_the_bound() {
    for step_us in [1_000, 2_000, 5_000] {
        let h_s = step_us as f64 / 1e6;
        let kicked = recovery(step_us, 2, |state| state.body.velocity_m_s.z += KICK);
        let aside = recovery(step_us, 0, |state| state.body.velocity_m_s.x += KICK);
        let turned = recovery(step_us, 0, |state| state.body.body_rate_rad_s.y += KICK);
        let found = deviation(step_us, false);
        let a = found.acceleration_m_s2;
        let vertical_m = h_s * kicked.way_m * a;
        let horizontal_m =
            h_s * (turned.way_m * found.angular_rad_s2 + aside.way_m * found.tilt_rad.tan() * a);
        assert!(found.vertical_m <= vertical_m && found.horizontal_m <= horizontal_m);
        // What the documentation says: 2 m per second of the step.
        assert!(vertical_m <= 2.0 * h_s && horizontal_m <= 2.0 * h_s);
        // Without the delay there would be nothing to bound.
        assert!(found.vertical_m > 0.02 * vertical_m && found.horizontal_m > 0.02 * horizontal_m);

        // Rotors that lose their commands for a step lose 2 h/τ of their thrust, and regain it within τ: a kick of 2 g h.
        let idle = deviation(step_us, true);
        let begun_m = vertical_m + 2.0 * GRAVITY_M_S2 * h_s * kicked.farthest_m;
        assert!(idle.vertical_m <= begun_m && idle.vertical_m > found.vertical_m);
    }
}
