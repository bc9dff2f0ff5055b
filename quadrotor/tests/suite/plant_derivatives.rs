//! Exact derivatives of the plant against differences, and against derivatives by hand.

use nalgebra::Vector3;
use proptest::prelude::*;
use quadrotor::{
    Actuation, Airframe, Disturbance, Environment, GRAVITY_M_S2, InitialState, Plant, PlantInputs,
    PlantOutputs, PlantState, RotorFault, Switch, Wrench,
};

use crate::common::physics::all_physics;

/// How many numbers inputs have: what drives, force, torque and wind.
const INPUTS: usize = 13;
/// State and inputs.
const ALL: usize = PlantState::LEN + INPUTS;

/// Where a derivative is taken: a state and inputs, or a change of both.
#[derive(Clone, Copy, Debug)]
struct Point {
    state: PlantState,
    inputs: PlantInputs,
}

impl Point {
    fn new(numbers: &[f64; ALL], by_rotors: bool, fault: Option<RotorFault>) -> Self {
        let (state, inputs) = numbers.split_at(PlantState::LEN);
        let vector = |from: usize| Vector3::from_column_slice(&inputs[from..from + 3]);
        let actuation = if by_rotors {
            Actuation::RotorSpeeds(std::array::from_fn(|rotor| inputs[rotor]))
        } else {
            // In the range of rotor speeds, so brought to that of a wrench.
            Actuation::Wrench(Wrench { thrust_n: inputs[0] / 30.0, torque_n_m: vector(1) / 1e3 })
        };
        Self {
            state: PlantState::from_array(std::array::from_fn(|index| state[index])),
            inputs: PlantInputs {
                actuation,
                disturbance: Disturbance { force_n: vector(4), torque_n_m: vector(7), wind_m_s: vector(10) },
                rotor_faults: [None, fault, None, None],
                ground_z_m: 0.0,
            },
        }
    }
}

/// Slope of g at zero, by central differences whose errors are extrapolated twice (Richardson): of sixth order.
fn slope(g: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        g(h).iter().zip(g(-h)).map(|(ahead, behind)| (ahead - behind) / (2.0 * h)).collect()
    };
    let extrapolated = |coarse: &[f64], fine: &[f64], order: f64| -> Vec<f64> {
        coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) / (order - 1.0)).collect()
    };
    let [one, two, three] = [2e-3, 1e-3, 5e-4].map(central);
    extrapolated(&extrapolated(&one, &two, 4.0), &extrapolated(&two, &three, 4.0), 16.0)
}

fn flat(outputs: &PlantOutputs) -> Vec<f64> {
    let vectors = [
        outputs.position_m,
        outputs.velocity_m_s,
        outputs.acceleration_m_s2,
        outputs.body_velocity_m_s,
        outputs.attitude_rad,
        outputs.body_rate_rad_s,
        outputs.wrench.torque_n_m,
    ];
    let battery = outputs.battery;
    let rest = [outputs.wrench.thrust_n, battery.voltage_v, battery.current_a, battery.remaining];
    let vectors = vectors.iter().flatten().copied();
    vectors.chain(outputs.quaternion).chain(outputs.rotor_speed_rad_s).chain(rest).collect()
}

/// Ranges of states and inputs, in flight and on the ground.
fn numbers() -> impl Strategy<Value = [f64; ALL]> {
    let centre = |index: usize| match index {
        2 => -0.4,
        6 => 1.0,
        13..=16 | 18..=21 => 250.0,
        17 => 0.5,
        _ => 0.0,
    };
    let half = |index: usize| match index {
        0 | 1 => 5.0,
        2 => 0.7,
        3..=5 => 4.0,
        6 => 0.05,
        7..=9 => 0.7,
        10..=12 => 3.0,
        13..=21 => {
            if index == 17 {
                0.7
            } else {
                180.0
            }
        }
        22..=24 => 1.0,
        25..=27 => 0.1,
        _ => 5.0,
    };
    // Every other one stands on the ground.
    let standing = move |index: usize| match index {
        2 => (0.005, 0.003),
        3..=5 | 10..=12 => (0.0, 0.03),
        7 | 8 => (0.0, 0.003),
        _ => (centre(index), half(index)),
    };
    (prop::array::uniform31(-1.0..1.0_f64), any::<bool>()).prop_map(move |(unit, stands)| {
        std::array::from_fn(|index| {
            let (centre, half) = if stands { standing(index) } else { (centre(index), half(index)) };
            centre + half * unit[index]
        })
    })
}

/// A direction in which each number changes in proportion to what it usually is.
fn directions() -> impl Strategy<Value = [f64; ALL]> {
    let usual = |index: usize| match index {
        3..=5 => 0.1,
        6..=9 => 0.01,
        13..=16 | 18..=21 => 10.0,
        17 => 0.01,
        25..=27 => 0.1,
        2 => 1e-3,
        _ => 1.0,
    };
    prop::array::uniform31(-1.0..1.0_f64)
        .prop_map(move |unit| std::array::from_fn(|index| usual(index) * unit[index]))
}

fn airframes() -> impl Strategy<Value = Airframe> {
    prop::sample::select(vec![
        Airframe::default(),
        all_physics(),
        Airframe { centre_of_gravity_m: [0.0; 3], ..all_physics() },
        Airframe { products_of_inertia_kg_m2: [0.0; 3], ..all_physics() },
    ])
}

fn faults() -> impl Strategy<Value = Option<RotorFault>> {
    prop::sample::select(vec![
        None,
        Some(RotorFault::Off),
        Some(RotorFault::Stuck),
        Some(RotorFault::Weak { share: 0.4 }),
    ])
}

fn assert_close(found: &[f64], expected: &[f64], what: &str) -> Result<(), TestCaseError> {
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs();
        prop_assert!(error < 2e-7 * (1.0 + expected.abs()), "{what} {index}: {found}, {expected}");
    }
    Ok(())
}

/// Whether a kink that a mode does not freeze, or the singularity of Euler's angles, is near.
fn is_rough(plant: &Plant, point: &Point) -> bool {
    let mode = plant.mode(&point.state, &point.inputs);
    let indicators = plant.event_indicators(mode, &point.state, &point.inputs);
    let close = |switch: Switch| indicators[switch.index()].abs() < 0.05;
    let rotors = (0..4).any(|rotor| close(Switch::NearGround(rotor)) || close(Switch::NoThrust(rotor)));
    let lag = match point.inputs.actuation {
        Actuation::RotorSpeeds(command) => {
            let share = plant.airframe().battery.speed_share(plant.battery(&point.state).voltage_v);
            let faults = point.inputs.rotor_faults;
            (0..4).any(|rotor| {
                let weak =
                    if let Some(RotorFault::Weak { share }) = faults[rotor] { share.sqrt() } else { 1.0 };
                (command[rotor] * share * weak - point.state.rotor_speed_rad_s[rotor]).abs() < 1.0
            })
        }
        Actuation::Wrench(_) => false,
    };
    let outputs = plant.outputs(&point.state, &point.inputs);
    let [phi, theta, psi]: [f64; 3] = outputs.attitude_rad.into();
    let turned_over = phi.abs() > 3.1 || psi.abs() > 3.1 || theta.abs() > 1.4;
    rotors || lag || turned_over || close(Switch::Upright) || close(Switch::Overloaded)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_global_rejects: 20_000, ..ProptestConfig::default() })]

    /// Of the state's derivative and of the outputs, along any direction of states and inputs.
    #[test]
    fn derivatives_are_those_of_differences(
        airframe in airframes(), ground_plane in any::<bool>(), by_rotors in any::<bool>(), fault in faults(),
        at in numbers(), along in directions(),
    ) {
        let plant = Plant::new(&airframe, &Environment { ground_plane });
        let (point, seed) = (Point::new(&at, by_rotors, fault), Point::new(&along, by_rotors, fault));
        prop_assume!(!is_rough(&plant, &point));
        let mode = plant.mode(&point.state, &point.inputs);
        let (state, inputs) = (point.state.with_seed(&seed.state), point.inputs.with_seed(&seed.inputs));
        let moved = |h: f64| {
            let numbers = std::array::from_fn(|index| at[index] + h * along[index]);
            Point::new(&numbers, by_rotors, fault)
        };

        let found = plant.derivative_in(mode, &state, &inputs);
        prop_assert_eq!(found.value(), plant.derivative_in(mode, &point.state, &point.inputs));
        let expected = slope(|h| {
            let Point { state, inputs } = moved(h);
            plant.derivative_in(mode, &state, &inputs).to_array().to_vec()
        });
        assert_close(&found.tangent().to_array(), &expected, "derivative")?;

        let found = plant.outputs_in(mode, &state, &inputs);
        prop_assert_eq!(found.value(), plant.outputs_in(mode, &point.state, &point.inputs));
        let expected = slope(|h| flat(&plant.outputs_in(mode, &moved(h).state, &moved(h).inputs)));
        assert_close(&flat(&found.tangent()), &expected, "output")?;

        // The same without a mode, but for static friction.
        if !mode.is_on(Switch::Held) {
            prop_assert_eq!(plant.derivative(&state, &inputs), plant.derivative_in(mode, &state, &inputs));
            prop_assert_eq!(plant.outputs(&state, &inputs), plant.outputs_in(mode, &state, &inputs));
        }
    }

    /// Of a step over a millisecond, which is what co-simulation is made of.
    #[test]
    fn derivatives_of_a_step_are_those_of_differences(
        airframe in airframes(), ground_plane in any::<bool>(), by_rotors in any::<bool>(), fault in faults(),
        at in numbers(), along in directions(),
    ) {
        let plant = Plant::new(&airframe, &Environment { ground_plane });
        let (point, seed) = (Point::new(&at, by_rotors, fault), Point::new(&along, by_rotors, fault));
        prop_assume!(!is_rough(&plant, &point));
        let stepped = |h: f64| {
            let numbers = std::array::from_fn(|index| at[index] + h * along[index]);
            let Point { state, inputs } = Point::new(&numbers, by_rotors, fault);
            let next = plant.step(&state, &inputs, 1e-3);
            ([plant.mode(&state, &inputs), plant.mode(&next, &inputs)], next)
        };
        // No foot comes down and no bound is met on the way.
        let [start, end] = stepped(0.0).0;
        prop_assume!(start == end && [-2e-3, 2e-3].into_iter().all(|h| stepped(h).0 == [start; 2]));

        let (state, inputs) = (point.state.with_seed(&seed.state), point.inputs.with_seed(&seed.inputs));
        let found = plant.step(&state, &inputs, 1e-3);
        prop_assert_eq!(found.value(), stepped(0.0).1);
        let expected = slope(|h| stepped(h).1.to_array().to_vec());
        assert_close(&found.tangent().to_array(), &expected, "state")?;
    }
}

/// In hover, level: the entries of the linear models (8), (14), (22) and the rotors' own.
#[test]
fn hover_has_the_derivatives_that_are_found_by_hand() {
    let airframe = Airframe { inertia_kg_m2: [0.08, 0.11, 0.15], ..Airframe::default() };
    let plant = Plant::new(&airframe, &Environment::default());
    let mut hover = PlantState::hovering(&InitialState::default(), &airframe);
    hover.body.body_rate_rad_s.z = 0.7;
    let inputs = PlantInputs::rotor_speeds(hover.rotor_speed_rad_s);
    let zero = PlantState::from_array([0.0; PlantState::LEN]);
    let along = |seed: &PlantState| plant.derivative(&hover.with_seed(seed), &inputs.constant()).tangent();
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, {expected}");

    // Rolled to the right by φ = 2 q₁ it accelerates to the right with g φ; pitched up by θ = 2 q₂ backwards.
    let mut roll = zero;
    roll.body.attitude.i = 0.5;
    close(along(&roll).body.velocity_m_s.y, GRAVITY_M_S2);
    let mut pitch = zero;
    pitch.body.attitude.j = 0.5;
    close(along(&pitch).body.velocity_m_s.x, -GRAVITY_M_S2);
    // The quaternion's length does not matter to the acceleration.
    let mut longer = zero;
    longer.body.attitude.w = 1.0;
    assert!(along(&longer).body.velocity_m_s.norm() < 1e-12);

    // ṗ = (J_y − J_z)/J_x q r, q̇ = (J_z − J_x)/J_y p r
    let mut rates = zero;
    (rates.body.body_rate_rad_s.x, rates.body.body_rate_rad_s.y) = (1.0, 10.0);
    close(along(&rates).body.body_rate_rad_s.x, (0.11 - 0.15) / 0.08 * 7.0);
    close(along(&rates).body.body_rate_rad_s.y, (0.15 - 0.08) / 0.11 * 0.7);

    // The front rotor: −2 k₁ ω/m upwards, l 2 k₁ ω/J_y nose up, −2 k₂ ω/J_z to the left, and −1/τ of itself.
    let mut front = zero;
    front.rotor_speed_rad_s[0] = 1.0;
    let (slope, speed) = (along(&front), hover.rotor_speed_rad_s[0]);
    close(slope.body.velocity_m_s.z, -2.0 * 2.7e-5 * speed / 0.7);
    close(slope.body.body_rate_rad_s.y, 0.275 * 2.0 * 2.7e-5 * speed / 0.11);
    close(slope.body.body_rate_rad_s.z, -2.0 * 6.0e-7 * speed / 0.15);
    close(slope.rotor_speed_rad_s[0], -1.0 / 0.03);
}

/// A step of the rotors' lag is 1 − e^(−h/τ), as the Runge–Kutta polynomial has it; of a force, h/m and h²/2m.
#[test]
fn a_step_has_the_derivatives_that_are_found_by_hand() {
    let airframe = Airframe::default();
    let plant = Plant::new(&airframe, &Environment::default());
    let hover = PlantState::hovering(&InitialState::default(), &airframe);
    let inputs = PlantInputs::rotor_speeds(hover.rotor_speed_rad_s);
    let mut seed = PlantInputs::rotor_speeds([0.0, 1.0, 0.0, 0.0]);
    seed.disturbance.force_n.x = 2.0;
    let after = |h_s: f64| plant.step(&hover.constant(), &inputs.with_seed(&seed), h_s).tangent();
    for h_s in [1e-3, 0.01, 0.03] {
        let x: f64 = h_s / 0.03;
        let polynomial = 1.0 - x + x * x / 2.0 - x.powi(3) / 6.0 + x.powi(4) / 24.0;
        let [front, right, ..] = after(h_s).rotor_speed_rad_s;
        assert!(front == 0.0 && (right - (1.0 - polynomial)).abs() < 1e-15);
        assert!((after(h_s).body.velocity_m_s.x - 2.0 * h_s / 0.7).abs() < 1e-15);
        assert!((after(h_s).body.position_m.x - h_s * h_s / 0.7).abs() < 1e-15);
    }
    // A seed of a wrench does not drive rotors.
    let wrench = PlantInputs::wrench(Wrench { thrust_n: 1.0, torque_n_m: Vector3::repeat(1.0) });
    let still = plant.step(&hover.constant(), &inputs.with_seed(&wrench), 1e-3).tangent();
    assert_eq!(still, PlantState::from_array([0.0; PlantState::LEN]));
}
