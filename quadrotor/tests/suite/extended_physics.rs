//! Optional physics of the plant against closed forms and conservation laws.

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use quadrotor::{
    Airframe, AirframePreset, BatteryPack, Direction, Disturbance, Environment, GRAVITY_M_S2, InitialState,
    Plant, PlantInputs, PlantState, Rotor, RotorAerodynamics, RotorLayout, RotorSpin, Wrench,
};

/// Integration step, s.
const STEP_S: f64 = 1e-3;

fn free_space(airframe: &Airframe) -> Plant {
    Plant::new(airframe, &Environment::default())
}

fn flown(plant: &Plant, start: PlantState, inputs: &PlantInputs, steps: u32) -> PlantState {
    (0..steps).fold(start, |state, _| plant.step(&state, inputs, STEP_S))
}

/// Rotors that turn and lift nothing, and no drag torque either.
fn without_air() -> Airframe {
    Airframe { thrust_coefficient_n_s2: 0.0, torque_coefficient_n_m_s2: 0.0, ..Airframe::default() }
}

fn with_rotor_inertia(inertia_kg_m2: f64) -> Airframe {
    let rotor_spin = RotorSpin { inertia_kg_m2, ..RotorSpin::default() };
    Airframe { rotor_spin, ..without_air() }
}

/// Level, it falls no faster than with m g/(c_z + d_z), and drifts with the wind in the end.
#[test]
fn terminal_velocity_is_weight_over_drag() {
    let airframe =
        Airframe { drag_n_s_m: [0.1; 3], body_drag_n_s_m: [0.05, 0.1, 0.4], ..Airframe::default() };
    let wind_m_s = Vector3::new(3.0, -2.0, 0.0);
    let inputs = PlantInputs {
        disturbance: Disturbance { wind_m_s, ..Disturbance::default() },
        ..PlantInputs::default()
    };
    let fallen =
        flown(&free_space(&airframe), PlantState::at_rest(&InitialState::default()), &inputs, 100_000);
    let expected = wind_m_s + Vector3::z() * (airframe.weight_n() / 0.5);
    assert!((fallen.body.velocity_m_s - expected).norm() < 1e-6, "{}", fallen.body.velocity_m_s);
}

/// Under a force along its forward axis a body that heads north-east moves along that axis, as v = F/d (1 − e^(−d t/m)).
#[test]
fn drag_along_the_body_axes_slows_down_exponentially() {
    let airframe = Airframe { body_drag_n_s_m: [0.2, 0.7, 0.4], ..Airframe::default() };
    let yaw = 0.8;
    let initial = InitialState { attitude_rad: [0.0, 0.0, yaw], ..InitialState::default() };
    let forward = Vector3::new(yaw.cos(), yaw.sin(), 0.0);
    let inputs = PlantInputs {
        disturbance: Disturbance { force_n: forward * 1.5, ..Disturbance::default() },
        ..PlantInputs::wrench(Wrench { thrust_n: airframe.weight_n(), torque_n_m: Vector3::zeros() })
    };
    let moved = flown(&free_space(&airframe), PlantState::at_rest(&initial), &inputs, 2_000);
    let speed = 1.5 / 0.2 * (1.0 - (-0.2 * 2.0 / airframe.mass_kg).exp());
    assert!((moved.body.velocity_m_s - forward * speed).norm() < 1e-9, "{}", moved.body.velocity_m_s);
}

/// With all rotors at one speed Ω their drag is that of a body with 4 k_d Ω along its forward and right axes.
#[test]
fn rotor_drag_is_body_drag_by_the_sum_of_the_speeds() {
    let speed = 260.0;
    let of_rotors = RotorAerodynamics { drag_coefficient_n_s2_m: 2e-4, ..RotorAerodynamics::default() };
    let induced = Airframe { rotor_aerodynamics: of_rotors, ..Airframe::default() };
    let lumped =
        Airframe { body_drag_n_s_m: [4.0 * 2e-4 * speed, 4.0 * 2e-4 * speed, 0.0], ..Airframe::default() };
    let initial = InitialState {
        velocity_m_s: [6.0, -3.0, 2.0],
        attitude_rad: [0.3, -0.4, 1.0],
        ..InitialState::default()
    };
    let start = PlantState { rotor_speed_rad_s: [speed; 4], ..PlantState::at_rest(&initial) };
    let end = |airframe: &Airframe| {
        flown(&free_space(airframe), start, &PlantInputs::rotor_speeds([speed; 4]), 1_000)
    };
    let (one, other) = (end(&induced).body, end(&lumped).body);
    assert!((one.velocity_m_s - other.velocity_m_s).norm() < 1e-10);
    assert!(
        (one.velocity_m_s - end(&Airframe::default()).body.velocity_m_s).norm() > 1.0,
        "it does something"
    );
}

/// In free space the angular momentum Jω + h does not change, whatever the rotors are commanded, and however it tumbles.
#[test]
fn angular_momentum_is_conserved_in_spin_up() {
    for products in [[0.0; 3], [0.01, -0.015, 0.02]] {
        let inertia_kg_m2 = [0.08, 0.11, 0.15];
        let airframe =
            Airframe { inertia_kg_m2, products_of_inertia_kg_m2: products, ..with_rotor_inertia(2e-4) };
        let momentum = |state: &PlantState| {
            let signs = [1.0, -1.0, 1.0, -1.0]; // "+": front and back turn to the right
            let spin: f64 =
                state.rotor_speed_rad_s.iter().zip(signs).map(|(speed, sign)| sign * speed * 2e-4).sum();
            let body = &state.body;
            body.rotation() * (airframe.inertia_tensor_kg_m2() * body.body_rate_rad_s + Vector3::z() * spin)
        };
        let initial = InitialState { body_rate_rad_s: [2.0, -1.0, 0.5], ..InitialState::default() };
        let start =
            PlantState { rotor_speed_rad_s: [100.0, 300.0, 50.0, 0.0], ..PlantState::at_rest(&initial) };
        let commands = PlantInputs::rotor_speeds([400.0, 50.0, 350.0, 120.0]);
        let end = flown(&free_space(&airframe), start, &commands, 2_000);
        let drift = momentum(&end) - momentum(&start);
        assert!(drift.norm() < 1e-8, "{products:?}: {drift}");
        assert!((end.body.body_rate_rad_s - start.body.body_rate_rad_s).norm() > 0.5, "it does something");
    }
}

/// From rest, the clockwise pair at Ω turns the body to the left with 2 J_r Ω/J_z, and to rest again when it stops.
#[test]
fn spin_up_turns_the_body_by_the_ratio_of_the_inertias() {
    let airframe = with_rotor_inertia(3e-4);
    let plant = free_space(&airframe);
    let spun = flown(
        &plant,
        PlantState::at_rest(&InitialState::default()),
        &PlantInputs::rotor_speeds([400.0, 0.0, 400.0, 0.0]),
        1_000,
    );
    let expected = -2.0 * 3e-4 * 400.0 / airframe.inertia_kg_m2[2];
    assert!(
        (spun.body.body_rate_rad_s - Vector3::z() * expected).norm() < 1e-9,
        "{}",
        spun.body.body_rate_rad_s
    );
    let stopped = flown(&plant, spun, &PlantInputs::default(), 1_000);
    assert!(stopped.body.body_rate_rad_s.norm() < 1e-9);
}

/// A gyroscope: with the momentum h of the clockwise pair and J_x = J_y, roll and pitch rates turn into one another with
/// λ = ((J_z − J_x) r + h)/J_x: p = p₀ cos λt, q = p₀ sin λt.
#[test]
fn roll_precesses_with_the_momentum_of_the_rotors() {
    let airframe = with_rotor_inertia(5e-4);
    let speeds = [350.0, 0.0, 350.0, 0.0];
    let [jx, _, jz] = airframe.inertia_kg_m2;
    for yaw_rate in [0.0, 1.5] {
        let initial = InitialState { body_rate_rad_s: [0.8, 0.0, yaw_rate], ..InitialState::default() };
        let start = PlantState { rotor_speed_rad_s: speeds, ..PlantState::at_rest(&initial) };
        let end = flown(&free_space(&airframe), start, &PlantInputs::rotor_speeds(speeds), 700);
        let rate = ((jz - jx) * yaw_rate + 2.0 * 5e-4 * 350.0) / jx;
        let expected =
            Vector3::new((rate * 0.7).cos(), (rate * 0.7).sin(), 0.0) * 0.8 + Vector3::z() * yaw_rate;
        assert!((end.body.body_rate_rad_s - expected).norm() < 1e-9, "{}", end.body.body_rate_rad_s);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    /// Torque-free, a body described in turned axes tumbles as the same body in its principal axes does.
    #[test]
    fn products_of_inertia_are_principal_axes_seen_askew(
        angles in prop::array::uniform3(-3.0..3.0), rate in prop::array::uniform3(-6.0..6.0),
    ) {
        let moments = [0.08, 0.11, 0.17];
        // Body axes = askew · principal axes.
        let askew = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let tensor = askew * nalgebra::Matrix3::from_diagonal(&Vector3::from(moments)) * askew.inverse();
        let principal = Airframe { inertia_kg_m2: moments, ..without_air() };
        let seen = Airframe {
            inertia_kg_m2: [tensor.m11, tensor.m22, tensor.m33],
            products_of_inertia_kg_m2: [tensor.m12, tensor.m13, tensor.m23],
            ..without_air()
        };
        let rate = Vector3::from(rate);
        let start = |rate: Vector3<f64>| {
            PlantState::at_rest(&InitialState { body_rate_rad_s: rate.into(), ..InitialState::default() })
        };
        let one = flown(&free_space(&principal), start(rate), &PlantInputs::default(), 1_000).body;
        let other = flown(&free_space(&seen), start(askew * rate), &PlantInputs::default(), 1_000).body;
        prop_assert!((askew * one.body_rate_rad_s - other.body_rate_rad_s).norm() < 1e-7);
        let turned = askew * one.rotation() * askew.inverse();
        prop_assert!(turned.angle_to(&other.rotation()) < 1e-7);
    }
}

/// A thrust beside the centre of mass turns the body as any other force there: θ̈ = −F c_x/J_y.
#[test]
fn an_offset_centre_of_gravity_turns_the_body() {
    let airframe = Airframe { centre_of_gravity_m: [0.01, -0.02, 0.03], ..Airframe::default() };
    let hover = PlantState {
        rotor_speed_rad_s: [airframe.hover_rotor_speed_rad_s(); 4],
        ..PlantState::at_rest(&InitialState::default())
    };
    let derivative =
        free_space(&airframe).derivative(&hover, &PlantInputs::rotor_speeds(hover.rotor_speed_rad_s));
    let [jx, jy, _] = airframe.inertia_kg_m2;
    let weight = airframe.weight_n();
    let expected = Vector3::new(-0.02 * weight / jx, -0.01 * weight / jy, 0.0);
    assert!((derivative.body.body_rate_rad_s - expected).norm() < 1e-12);
    assert!(derivative.body.velocity_m_s.norm() < 1e-14, "the centre of mass does not accelerate");
}

/// The rotors near the centre of mass make the more thrust by which a hover does not turn.
#[test]
fn a_hover_balances_an_offset_centre_of_gravity() {
    for preset in AirframePreset::ALL {
        let airframe = preset.airframe();
        let centre_of_gravity_m = [0.05, -0.03, 0.02].map(|part| part * airframe.arm_length_m);
        let airframe = Airframe { centre_of_gravity_m, ..airframe };
        let hover = PlantState::hovering(&InitialState::default(), &airframe);
        let inputs = PlantInputs::rotor_speeds(hover.rotor_speed_rad_s);
        let derivative = free_space(&airframe).derivative(&hover, &inputs);
        let [turns, accelerates] =
            [derivative.body.body_rate_rad_s, derivative.body.velocity_m_s].map(|rate| rate.norm());
        assert!(turns < 1e-10 && accelerates < 1e-13, "{preset:?}: {turns} {accelerates}");
    }
}

/// On the ground it stands at z = 0 but for the compliance, which the front feet bear more of.
#[test]
fn an_offset_centre_of_gravity_stands_on_the_ground() {
    let airframe = Airframe { centre_of_gravity_m: [0.05, 0.0, 0.1], ..Airframe::default() };
    let plant = Plant::new(&airframe, &Environment { ground_plane: true });
    let standing =
        flown(&plant, PlantState::at_rest(&InitialState::default()), &PlantInputs::default(), 3_000);
    let (_, pitch, _) = standing.body.rotation().euler_angles();
    assert!(standing.body.position_m.z > 0.0 && standing.body.position_m.z < 0.006);
    assert!(pitch < -1e-3 && pitch > -0.02, "{pitch}");
    assert!(standing.body.velocity_m_s.norm() < 1e-9 && standing.body.position_m.xy().norm() < 1e-3);
}

/// ω(t) = ω∞ + (ω₀ − ω∞) e^(−t/τ), with τ up and 2.5 τ down, also when one rises while another falls.
#[test]
fn rotors_rise_and_fall_with_time_constants_of_their_own() {
    let rotor_spin = RotorSpin { fall_time_ratio: 2.5, ..RotorSpin::default() };
    let airframe = Airframe { rotor_time_constant_s: 0.04, rotor_spin, ..Airframe::default() };
    let start = PlantState {
        rotor_speed_rad_s: [200.0, 300.0, 250.0, 0.0],
        ..PlantState::at_rest(&InitialState::default())
    };
    let goals = [300.0, 200.0, 250.0, 100.0];
    let end = flown(&free_space(&airframe), start, &PlantInputs::rotor_speeds(goals), 60);
    for (rotor, lag) in [0.04, 0.1, 0.04, 0.04].into_iter().enumerate() {
        let (from, to) = (start.rotor_speed_rad_s[rotor], goals[rotor]);
        let expected = to + (from - to) * f64::exp(-0.06 / lag);
        assert!(
            (end.rotor_speed_rad_s[rotor] - expected).abs() < 1e-4,
            "{rotor}: {:?}",
            end.rotor_speed_rad_s
        );
    }
}

/// m v̇ = 4 (k₁Ω² − k_z Ω v) − m g: it climbs as v∞ (1 − e^(−t/T)), v∞ = (4k₁Ω² − m g)/(4k_zΩ) and T = m/(4k_zΩ).
#[test]
fn a_climb_at_constant_rotor_speed_ends_where_the_inflow_takes_the_excess_thrust() {
    let rotor_aerodynamics =
        RotorAerodynamics { inflow_coefficient_n_s2_m: 3e-4, ..RotorAerodynamics::default() };
    let airframe = Airframe { rotor_aerodynamics, ..Airframe::default() };
    let speed = 280.0;
    let start = PlantState { rotor_speed_rad_s: [speed; 4], ..PlantState::at_rest(&InitialState::default()) };
    let inflow = 4.0 * 3e-4 * speed;
    let fastest = (4.0 * airframe.thrust_coefficient_n_s2 * speed * speed - airframe.weight_n()) / inflow;
    for seconds in [0.5, 2.0, 20.0] {
        let end = flown(
            &free_space(&airframe),
            start,
            &PlantInputs::rotor_speeds([speed; 4]),
            (seconds * 1e3) as u32,
        );
        let climb = fastest * (1.0 - f64::exp(-seconds * inflow / airframe.mass_kg));
        assert!((end.body.velocity_m_s + Vector3::z() * climb).norm() < 1e-9, "{}", end.body.velocity_m_s);
    }
}

/// Level in a wind of 8 m/s, a hover needs less speed: 4 (k₁Ω² + k_h V²) = m g.
#[test]
fn translational_lift_carries_part_of_the_weight() {
    let rotor_aerodynamics =
        RotorAerodynamics { translational_lift_coefficient_n_s2_m2: 4e-3, ..RotorAerodynamics::default() };
    let airframe = Airframe { rotor_aerodynamics, ..Airframe::default() };
    let lift = 4e-3 * 64.0;
    let speed = ((airframe.weight_n() / 4.0 - lift) / airframe.thrust_coefficient_n_s2).sqrt();
    let state = PlantState { rotor_speed_rad_s: [speed; 4], ..PlantState::at_rest(&InitialState::default()) };
    let mut inputs = PlantInputs::rotor_speeds([speed; 4]);
    inputs.disturbance.wind_m_s = Vector3::new(4.8, -6.4, 0.0);
    assert!(speed < 0.95 * airframe.hover_rotor_speed_rad_s());
    let acceleration = free_space(&airframe).acceleration_m_s2(&state, &inputs);
    assert!(acceleration.norm() < 1e-12, "{acceleration}");
}

/// At heights of one and two radii a hover needs Ω²/(Ω∞²) = 15/16 and 63/64; without a ground plane nothing changes.
#[test]
fn the_ground_carries_part_of_the_weight() {
    let radius_m = 0.15;
    let rotor_aerodynamics =
        RotorAerodynamics { ground_effect: true, radius_m, ..RotorAerodynamics::default() };
    let airframe = Airframe { rotor_aerodynamics, ..Airframe::default() };
    let hover = airframe.hover_rotor_speed_rad_s();
    for (radii, share, ground_plane) in
        [(1.0, 15.0 / 16.0, true), (2.0, 63.0 / 64.0, true), (1.0, 1.0, false), (1e4, 1.0, true)]
    {
        let plant = Plant::new(&airframe, &Environment { ground_plane });
        let initial = InitialState { position_m: [0.0, 0.0, -radii * radius_m], ..InitialState::default() };
        let speeds = [hover * f64::sqrt(share); 4];
        let mut state = PlantState { rotor_speed_rad_s: speeds, ..PlantState::at_rest(&initial) };
        // Out of reach of the feet.
        state.body.attitude = UnitQuaternion::identity().into_inner();
        let acceleration = plant.acceleration_m_s2(&state, &PlantInputs::rotor_speeds(speeds));
        assert!(acceleration.norm() < 1e-6, "{radii}: {acceleration}");
    }
}

/// A constant load P drains the pack as an independent integration of I = P/U has it, and the rotors follow the voltage.
#[test]
fn rotors_follow_the_voltage_of_the_battery() {
    let battery = BatteryPack { sag: true, voltage_v: 12.6, resistance_ohm: 0.05, capacity_a_s: 400.0 };
    let airframe = Airframe { battery, ..Airframe::default() };
    let plant = free_space(&airframe);
    let command = 300.0;
    let mut state =
        PlantState { rotor_speed_rad_s: [command; 4], ..PlantState::at_rest(&InitialState::default()) };
    // Fixed point of Ω = Ω_c U/U₀ with U = U_oc − R P(Ω)/U; and the charge by Euler's method on it, 10 ms at a time.
    let (mut drawn, mut speed) = (0.0, command);
    for _ in 0..4_000 {
        let remaining: f64 = 1.0 - drawn / 400.0;
        let open =
            3.0 * if remaining > 0.1 { 3.7 + 0.5 * (remaining - 0.1) / 0.9 } else { 3.3 + 4.0 * remaining };
        let (mut voltage, mut current) = (open, 0.0);
        for _ in 0..30 {
            current = 4.0 * 6e-7 * f64::powi(speed, 3) / 0.75 / voltage;
            voltage = open - 0.05 * current;
            speed = command * voltage / 12.6;
        }
        drawn += current * 0.01;
        state = flown(&plant, state, &PlantInputs::rotor_speeds([command; 4]), 10);
    }
    let output = plant.battery(&state);
    assert!((state.discharge - drawn / 400.0).abs() < 1e-3, "{} {}", state.discharge, drawn / 400.0);
    assert!((output.remaining - (1.0 - state.discharge)).abs() < 1e-15 && output.remaining < 0.6);
    assert!((state.rotor_speed_rad_s[2] - speed).abs() < 0.1, "{:?} {speed}", state.rotor_speed_rad_s);
    assert!(speed < 0.95 * command);
    // A full pack without resistance changes nothing but the charge.
    let strong = BatteryPack { resistance_ohm: 0.0, capacity_a_s: 1e7, ..battery };
    let plant = free_space(&Airframe { battery: strong, ..Airframe::default() });
    let start =
        PlantState { rotor_speed_rad_s: [command; 4], ..PlantState::at_rest(&InitialState::default()) };
    let end = flown(&plant, start, &PlantInputs::rotor_speeds([command; 4]), 1_000);
    assert!((end.rotor_speed_rad_s[0] - command).abs() < 1e-3 && end.discharge > 0.0);
}

/// Whatever drives the body in place of the rotors, their spin, air and battery do not matter.
#[test]
fn a_wrench_is_in_place_of_the_rotors() {
    let everything = Airframe {
        rotor_spin: RotorSpin { inertia_kg_m2: 1e-3, fall_time_ratio: 3.0 },
        rotor_aerodynamics: RotorAerodynamics {
            drag_coefficient_n_s2_m: 1e-3,
            inflow_coefficient_n_s2_m: 1e-3,
            translational_lift_coefficient_n_s2_m2: 1e-2,
            radius_m: 0.3,
            ground_effect: true,
        },
        battery: BatteryPack { sag: true, ..BatteryPack::default() },
        ..Airframe::default()
    };
    let initial = InitialState {
        position_m: [0.0, 0.0, -0.4],
        velocity_m_s: [3.0, 2.0, -1.0],
        body_rate_rad_s: [1.0, 2.0, 3.0],
        ..InitialState::default()
    };
    let state = PlantState { rotor_speed_rad_s: [300.0, 200.0, 100.0, 0.0], ..PlantState::at_rest(&initial) };
    let inputs = PlantInputs::wrench(Wrench { thrust_n: 5.0, torque_n_m: Vector3::new(0.1, -0.2, 0.05) });
    let derivative = |airframe: &Airframe| {
        Plant::new(airframe, &Environment { ground_plane: true }).derivative(&state, &inputs)
    };
    assert_eq!(derivative(&everything), derivative(&Airframe::default()));
}

/// All options at once on a layout of four different arms: energy only leaves, while the rotors stand still.
#[test]
fn drag_only_takes_energy() {
    let rotors = [(1.2, 0.1), (-0.1, 0.8), (-0.9, 0.2), (-0.2, -1.1)].map(|(x, y)| {
        let direction = if x * y > 0.0 { Direction::Clockwise } else { Direction::Counterclockwise };
        Rotor { x, y, direction }
    });
    let airframe = Airframe {
        layout: RotorLayout { rotors },
        products_of_inertia_kg_m2: [0.01, -0.02, 0.005],
        centre_of_gravity_m: [0.03, -0.05, 0.2],
        drag_n_s_m: [0.1, 0.2, 0.3],
        body_drag_n_s_m: [0.3, 0.1, 0.2],
        ..Airframe::default()
    };
    let energy = |state: &PlantState| {
        let (body, rate) = (&state.body, state.body.body_rate_rad_s);
        airframe.mass_kg * (body.velocity_m_s.norm_squared() / 2.0 - GRAVITY_M_S2 * body.position_m.z)
            + rate.dot(&(airframe.inertia_tensor_kg_m2() * rate)) / 2.0
    };
    let initial = InitialState {
        velocity_m_s: [5.0, -3.0, -4.0],
        body_rate_rad_s: [4.0, -3.0, 5.0],
        ..InitialState::default()
    };
    let plant = free_space(&airframe);
    let mut state = PlantState::at_rest(&initial);
    let mut before = energy(&state);
    let start = before;
    for _ in 0..5_000 {
        state = plant.step(&state, &PlantInputs::default(), STEP_S);
        let now = energy(&state);
        assert!(now <= before + 1e-9, "{before} to {now}");
        before = now;
    }
    assert!(before < start - 10.0);
}
