//! The plant against independent equations and conservation laws.

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use quadrotor::{
    Airframe, Configuration, External, GRAVITY_M_S2, Inputs, Plant, PlantInputs, PlantState, RigidBody,
    Simulation, Wrench,
};

/// The paper's twelve states and equations (2)–(3), word for word: x y z u v w φ θ ψ p q r.
fn euler_form(airframe: &Airframe, s: &[f64; 12], f: f64, tau: [f64; 3]) -> [f64; 12] {
    let [_, _, _, u, v, w, phi, theta, psi, p, q, r] = *s;
    let [jx, jy, jz] = airframe.inertia_kg_m2;
    let (m, g) = (airframe.mass_kg, GRAVITY_M_S2);
    let ((sp, cp), (st, ct), (ss, cs)) = (phi.sin_cos(), theta.sin_cos(), psi.sin_cos());
    let tt = theta.tan();
    [
        // [ẋ ẏ ż]ᵀ = R(φ, θ, ψ) [u v w]ᵀ, R = R_z(ψ) R_y(θ) R_x(φ)
        cs * ct * u + (cs * st * sp - ss * cp) * v + (cs * st * cp + ss * sp) * w,
        ss * ct * u + (ss * st * sp + cs * cp) * v + (ss * st * cp - cs * sp) * w,
        -st * u + ct * sp * v + ct * cp * w,
        r * v - q * w - g * st,
        p * w - r * u + g * ct * sp,
        q * u - p * v + g * ct * cp - f / m,
        p + sp * tt * q + cp * tt * r,
        cp * q - sp * r,
        sp / ct * q + cp / ct * r,
        (jy - jz) / jx * q * r + tau[0] / jx,
        (jz - jx) / jy * p * r + tau[1] / jy,
        (jx - jy) / jz * p * q + tau[2] / jz,
    ]
}

/// One Runge–Kutta step of the Euler form with rotors that approach `command` from `start` as the
/// exponential that solves their lag exactly.
fn euler_step(
    airframe: &Airframe,
    s: &[f64; 12],
    rotors: impl Fn(f64) -> [f64; 4],
    time: f64,
    h: f64,
) -> [f64; 12] {
    let derivative = |s: &[f64; 12], time: f64| {
        let [f, r, b, l] = rotors(time).map(|speed| speed * speed);
        let (k1, k2, arm) =
            (airframe.thrust_coefficient_n_s2, airframe.torque_coefficient_n_m_s2, airframe.arm_length_m);
        let tau = [arm * k1 * (l - r), arm * k1 * (f - b), k2 * (r + l - f - b)];
        euler_form(airframe, s, k1 * (f + r + b + l), tau)
    };
    let moved = |d: &[f64; 12], h: f64| std::array::from_fn(|i| s[i] + h * d[i]);
    let k1 = derivative(s, time);
    let k2 = derivative(&moved(&k1, h / 2.0), time + h / 2.0);
    let k3 = derivative(&moved(&k2, h / 2.0), time + h / 2.0);
    let k4 = derivative(&moved(&k3, h), time + h);
    std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Open loop, away from θ = ±90°, both forms fly the same path.
    #[test]
    fn the_papers_euler_form_flies_the_same_path(
        phi in -0.8..0.8, theta in -0.8..0.8, psi in -3.0..3.0,
        rates in prop::array::uniform3(-0.5..0.5), velocity in prop::array::uniform3(-3.0..3.0),
        commands in prop::array::uniform4(230.0..270.0),
    ) {
        let mut configuration = Configuration::default();
        // Unequal inertias, so that every gyroscopic term counts.
        configuration.airframe.inertia_kg_m2 = [0.08, 0.11, 0.2];
        configuration.initial.attitude_rad = [phi, theta, psi];
        configuration.initial.body_rate_rad_s = rates;
        let rotation = UnitQuaternion::from_euler_angles(phi, theta, psi);
        configuration.initial.velocity_m_s = (rotation * Vector3::from(velocity)).into();

        let airframe = configuration.airframe;
        let plant = Plant::new(&airframe, &configuration.environment);
        let mut flown = PlantState::hovering(&configuration.initial, &airframe);
        let start = flown.rotor_speed_rad_s;
        let rotors = |time: f64| -> [f64; 4] {
            let share = (-time / airframe.rotor_time_constant_s).exp();
            std::array::from_fn(|i| commands[i] + (start[i] - commands[i]) * share)
        };
        let [u, v, w] = velocity;
        let mut state = [0.0, 0.0, 0.0, u, v, w, phi, theta, psi, rates[0], rates[1], rates[2]];
        for step in 0..500 {
            flown = plant.step(&flown, &PlantInputs::rotor_speeds(commands), 1e-3);
            state = euler_step(&airframe, &state, rotors, f64::from(step) * 1e-3, 1e-3);
            if state[7].abs() > 1.3 {
                break; // The Euler form loses its accuracy here, not the quaternion.
            }
        }
        let position = flown.body.position_m - Vector3::new(state[0], state[1], state[2]);
        prop_assert!(position.norm() < 1e-7, "{position}");
        let (phi, theta, psi) = flown.body.rotation().euler_angles();
        let turned = UnitQuaternion::from_euler_angles(phi, theta, psi)
            .angle_to(&UnitQuaternion::from_euler_angles(state[6], state[7], state[8]));
        prop_assert!(turned < 1e-6, "{turned}");
        prop_assert!((flown.body.body_rate_rad_s - Vector3::new(state[9], state[10], state[11])).norm() < 1e-8);
    }

    /// Without rotors, energy and angular momentum are conserved however it tumbles.
    #[test]
    fn free_fall_conserves_energy_and_angular_momentum(
        rates in prop::array::uniform3(-10.0..10.0), velocity in prop::array::uniform3(-10.0..10.0),
    ) {
        let mut configuration = Configuration::default();
        configuration.airframe.inertia_kg_m2 = [0.08, 0.11, 0.2];
        configuration.initial.body_rate_rad_s = rates;
        configuration.initial.velocity_m_s = velocity;
        let airframe = configuration.airframe;
        let inertia = Vector3::from(airframe.inertia_kg_m2);
        let energy = |body: &RigidBody| {
            let rate = body.body_rate_rad_s;
            airframe.mass_kg * (body.velocity_m_s.norm_squared() / 2.0 - GRAVITY_M_S2 * body.position_m.z)
                + rate.dot(&inertia.component_mul(&rate)) / 2.0
        };
        let momentum = |body: &RigidBody| body.rotation() * inertia.component_mul(&body.body_rate_rad_s);

        let plant = Plant::new(&airframe, &configuration.environment);
        let mut fallen = PlantState::at_rest(&configuration.initial);
        let (energy_before, momentum_before) = (energy(&fallen.body), momentum(&fallen.body));
        for _ in 0..2000 {
            fallen = plant.step(&fallen, &PlantInputs::default(), 1e-3);
        }
        let scale = energy_before.abs() + airframe.mass_kg * 20.0 * 20.0;
        prop_assert!((energy(&fallen.body) - energy_before).abs() < 1e-8 * scale);
        let drift = (momentum(&fallen.body) - momentum_before).norm();
        prop_assert!(drift < 1e-7 * (1.0 + momentum_before.norm()), "{drift}");
    }
}

#[test]
fn hover_is_an_equilibrium() {
    // f(x₀, u₀) = 0
    let configuration = Configuration::default();
    let plant = Plant::new(&configuration.airframe, &configuration.environment);
    let hover = PlantState::hovering(&configuration.initial, &configuration.airframe);
    let derivative = plant.derivative(&hover, &PlantInputs::rotor_speeds(hover.rotor_speed_rad_s));
    assert!(derivative.body.velocity_m_s.norm() < 1e-14);
    assert!(derivative.body.body_rate_rad_s.norm() < 1e-14);
    assert_eq!(derivative.rotor_speed_rad_s, [0.0; 4]);
}

/// ẍ = −g θ, ÿ = g φ, z̈ = g − F/m, J ω̇ = τ (4): the linear models are the derivative of the rigid body.
#[test]
fn linearisation_is_the_papers() {
    let airframe = Airframe::default();
    let derivative = |phi: f64, theta: f64, thrust_n: f64, torque: [f64; 3]| {
        let body = RigidBody {
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            attitude: UnitQuaternion::from_euler_angles(phi, theta, 0.0).into_inner(),
            body_rate_rad_s: Vector3::zeros(),
        };
        body.derivative(&airframe, &Wrench { thrust_n, torque_n_m: torque.into() }, &External::default())
    };
    let (small, weight) = (1e-6, airframe.weight_n());
    let by_theta = derivative(0.0, small, weight, [0.0; 3]).velocity_m_s / small;
    let by_phi = derivative(small, 0.0, weight, [0.0; 3]).velocity_m_s / small;
    let by_thrust = derivative(0.0, 0.0, weight + small, [0.0; 3]).velocity_m_s / small;
    assert!((by_theta - Vector3::new(-GRAVITY_M_S2, 0.0, 0.0)).norm() < 1e-4);
    assert!((by_phi - Vector3::new(0.0, GRAVITY_M_S2, 0.0)).norm() < 1e-4);
    assert!((by_thrust - Vector3::new(0.0, 0.0, -1.0 / airframe.mass_kg)).norm() < 1e-4);
    let spun = derivative(0.0, 0.0, weight, [0.3, -0.2, 0.1]).body_rate_rad_s;
    assert!((spun - Vector3::new(0.3 / 0.1063, -0.2 / 0.1063, 0.1 / 0.2122)).norm() < 1e-12);
}

#[test]
fn disarmed_on_the_ground_it_comes_to_rest_and_armed_it_takes_off() {
    let mut configuration = Configuration::default();
    configuration.environment.ground_plane = true;
    configuration.initial.position_m = [0.0, 0.0, -1.0];
    configuration.initial.attitude_rad = [0.1, -0.1, 0.3];
    configuration.initial.velocity_m_s = [0.5, 0.0, 0.0];
    let mut inputs = Inputs { armed: false, ..Inputs::default() };
    inputs.reference.position_m = Vector3::new(1.0, 2.0, -3.0);
    let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
    simulation.advance_to(5_000_000, &inputs).unwrap();
    let rest = simulation.outputs();
    // It rests 4 mm deep in the compliant ground: g/ω² with ω = 50 rad/s.
    assert!((rest.position_m.z - GRAVITY_M_S2 / 2500.0).abs() < 1e-4, "{rest:?}");
    assert!(rest.velocity_m_s.norm() < 1e-4 && rest.attitude_rad.xy().norm() < 1e-3, "{rest:?}");

    inputs.armed = true;
    simulation.advance_to(25_000_000, &inputs).unwrap();
    assert!((simulation.outputs().position_m - Vector3::new(1.0, 2.0, -3.0)).norm() < 0.001);
    inputs.armed = false;
    simulation.advance_to(25_500_000, &inputs).unwrap();
    // Without rotors it falls, but for what they give while they run down.
    assert!(simulation.outputs().velocity_m_s.z > 4.5);
}
