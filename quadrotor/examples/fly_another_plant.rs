//! Flies the control loop against a plant that is not ours: the paper's twelve states with Euler angles (2)–(3) and
//! rotors with a lag, integrated by Heun's method at a step that fits none of the loop's sample times.
//!
//! ```text
//! cargo run -p quadrotor --example fly_another_plant
//! ```

use std::error::Error;

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{
    Configuration, ControlInputs, ControlLoop, Measurement, PositionReference, RigidBody, Target,
};

/// Step of the plant, µs.
const STEP_US: u64 = 1_300;
/// Length of the flight, µs.
const FLIGHT_US: u64 = 15_000_000;
/// The paper's goal: 5 m north, 5 m east, 10 m up.
const GOAL_M: [f64; 3] = [5.0, 5.0, -10.0];

// Table 1, and the rotors that our default airframe has.
const MASS_KG: f64 = 0.7;
const ARM_M: f64 = 0.275;
const INERTIA_KG_M2: [f64; 3] = [0.1063, 0.1063, 0.2122];
const THRUST_N_S2: f64 = 2.7e-5;
const TORQUE_N_M_S2: f64 = 6.0e-7;
const LAG_S: f64 = 0.03;
const GRAVITY_M_S2: f64 = 9.806_65;

/// x y z u v w φ θ ψ p q r, and the speeds of the front, right, back and left rotor.
type State = [f64; 16];

fn main() -> Result<(), Box<dyn Error>> {
    let end = fly()?;
    println!("{end:?} m from the start after {} s", FLIGHT_US / 1_000_000);
    Ok(())
}

/// Flies from hover at the origin to the goal; north, east and down at the end, m.
fn fly() -> Result<[f64; 3], Box<dyn Error>> {
    let hover_rad_s = (MASS_KG * GRAVITY_M_S2 / (4.0 * THRUST_N_S2)).sqrt();
    let mut state: State = [0.0; 16];
    state[12..].fill(hover_rad_s);

    let inputs = ControlInputs::armed(Target::Reference(PositionReference::goal(GOAL_M, 0.5)));
    let mut control = ControlLoop::new(&Configuration::default(), &inputs, &mut measured(&state), 0)?;
    let mut time_us = 0;
    while time_us < FLIGHT_US {
        // The loop samples at its own instants: between two of this plant's steps it is given what the vehicle does there.
        let before = state;
        let command = control.state().rotor_command_rad_s();
        let mut sensors =
            |at_us: u64| measured(&stepped(&before, &command, at_us.saturating_sub(time_us) as f64 * 1e-6));
        state = stepped(&before, &command, STEP_US as f64 * 1e-6);
        control.advance_to(time_us + STEP_US, &inputs, &mut sensors)?;
        time_us += STEP_US;
    }
    Ok([state[0], state[1], state[2]])
}

/// (2)–(3) and the rotor map (1).
fn derivative(state: &State, command_rad_s: &[f64; 4]) -> State {
    let [_, _, _, u, v, w, phi, theta, psi, p, q, r, front, right, back, left] = *state;
    let ((sp, cp), (st, ct), (ss, cs)) = (phi.sin_cos(), theta.sin_cos(), psi.sin_cos());
    let squared = [front, right, back, left].map(|speed| speed * speed);
    let thrust = THRUST_N_S2 * squared.iter().sum::<f64>();
    let roll = ARM_M * THRUST_N_S2 * (squared[3] - squared[1]);
    let pitch = ARM_M * THRUST_N_S2 * (squared[0] - squared[2]);
    let yaw = TORQUE_N_M_S2 * (squared[1] + squared[3] - squared[0] - squared[2]);
    let [jx, jy, jz] = INERTIA_KG_M2;
    let lag = |rotor: usize| (command_rad_s[rotor] - state[12 + rotor]) / LAG_S;
    [
        cs * ct * u + (cs * st * sp - ss * cp) * v + (cs * st * cp + ss * sp) * w,
        ss * ct * u + (ss * st * sp + cs * cp) * v + (ss * st * cp - cs * sp) * w,
        -st * u + ct * sp * v + ct * cp * w,
        r * v - q * w - GRAVITY_M_S2 * st,
        p * w - r * u + GRAVITY_M_S2 * ct * sp,
        q * u - p * v + GRAVITY_M_S2 * ct * cp - thrust / MASS_KG,
        p + sp * theta.tan() * q + cp * theta.tan() * r,
        cp * q - sp * r,
        sp / ct * q + cp / ct * r,
        (jy - jz) / jx * q * r + roll / jx,
        (jz - jx) / jy * p * r + pitch / jy,
        (jx - jy) / jz * p * q + yaw / jz,
        lag(0),
        lag(1),
        lag(2),
        lag(3),
    ]
}

/// Heun's method.
fn stepped(state: &State, command_rad_s: &[f64; 4], h_s: f64) -> State {
    let moved = |by: &dyn Fn(usize) -> f64| -> State { std::array::from_fn(|i| state[i] + h_s * by(i)) };
    let first = derivative(state, command_rad_s);
    let second = derivative(&moved(&|i| first[i]), command_rad_s);
    moved(&|i| (first[i] + second[i]) / 2.0)
}

/// What the loop sees: NED, FRD and a quaternion.
fn measured(state: &State) -> Measurement {
    let [x, y, z, u, v, w, phi, theta, psi, p, q, r, front, right, back, left] = *state;
    let attitude = UnitQuaternion::from_euler_angles(phi, theta, psi);
    Measurement {
        motion: RigidBody {
            position_m: Vector3::new(x, y, z),
            velocity_m_s: attitude * Vector3::new(u, v, w),
            attitude: attitude.into_inner(),
            body_rate_rad_s: Vector3::new(p, q, r),
        },
        rotor_speed_rad_s: [front, right, back, left],
    }
}

#[cfg(test)]
mod tests {
    use super::{GOAL_M, fly};

    #[test]
    fn it_arrives() {
        let end = fly().expect("a flight");
        for (axis, goal) in end.iter().zip(GOAL_M) {
            assert!((axis - goal).abs() < 0.005, "{end:?}");
        }
    }
}
