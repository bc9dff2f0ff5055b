//! Mass and drag learned in flight: what the controllers make of a wrong mass, a load, a force and drag.

use crate::common::trajectory::Trajectory;
use crate::common::{Extremes, KINDS, distance, fly, goal, noisy, overshoot, unshaped_by};
use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{
    Airframe, AirframePreset, AttitudeTarget, Configuration, ControlInputs, ControlLoop, ControllerKind,
    Disturbance, Inputs, Measurement, Plant, PlantInputs, PlantState, PositionReference, Sensors, Simulation,
    Target,
};

const GOAL_M: [f64; 3] = [0.0, 0.0, -5.0];

/// Root mean square distance from the goal between two times, s.
fn distance_m(simulation: &mut Simulation, inputs: &Inputs, goal_m: [f64; 3], window_s: [f64; 2]) -> f64 {
    let [from_us, to_us] = window_s.map(|time_s| (time_s * 1e6) as u64);
    simulation.advance_to(from_us, inputs).unwrap();
    let (mut sum, mut count) = (0.0, 0.0);
    for time_us in (from_us..to_us).step_by(20_000) {
        simulation.advance_to(time_us, inputs).unwrap();
        sum += (simulation.outputs().position_m - Vector3::from(goal_m)).norm_squared();
        count += 1.0;
    }
    f64::sqrt(sum / count)
}

/// A raw step under a mass that is believed to be half, or half as much again, the true one. Without learning Laguerre MPC bobs by
/// decimetres for a minute under half of it.
#[test]
fn a_wrong_mass_does_not_bob() {
    for kind in KINDS {
        for output_feedback in [false, true] {
            for mass_factor in [0.5, 0.75, 1.25, 1.5] {
                let mut configuration = unshaped_by(kind, output_feedback);
                configuration.controllers.mass_factor = mass_factor;
                let inputs = Inputs { reference: PositionReference::goal(GOAL_M, 0.0), ..Inputs::default() };
                let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
                let bob_m = distance_m(&mut simulation, &inputs, GOAL_M, [12.0, 20.0]);
                let factor = simulation.control().belief().mass_kg / configuration.airframe.mass_kg;
                let told = format!("{kind:?} {output_feedback} {mass_factor}: {bob_m} m, {factor}");
                assert!(bob_m < 0.002, "{told}");
                // The less it bobs, the less there is to learn from.
                assert!((factor - 1.0).abs() < 0.05, "{told}");
            }
        }
    }
}

/// Level circles, entered with their speed, of 1.4 m/s² inwards: the thrust turns and hardly changes. The mass had not been learned there, and
/// the vehicle had flown 2 to 5 cm beside them for ever.
#[test]
fn a_wrong_mass_is_found_on_a_level_circle() {
    const RATE_RAD_S: f64 = 0.85;
    const RADIUS_M: f64 = 2.0;
    let at = |time_us: u64| {
        let (sine, cosine) = (RATE_RAD_S * time_us as f64 * 1e-6).sin_cos();
        let (way_m, speed_m_s) = (RADIUS_M, RADIUS_M * RATE_RAD_S);
        PositionReference {
            position_m: Vector3::new(way_m * cosine, way_m * sine, -5.0),
            velocity_m_s: Vector3::new(-speed_m_s * sine, speed_m_s * cosine, 0.0),
            acceleration_m_s2: -Vector3::new(cosine, sine, 0.0) * (speed_m_s * RATE_RAD_S),
            ..PositionReference::goal([0.0; 3], 0.0)
        }
    };
    let inputs = |time_us: u64| Inputs { reference: at(time_us), ..Inputs::default() };
    for preset in [AirframePreset::Paper, AirframePreset::Crazyflie] {
        for kind in KINDS {
            for mass_factor in [0.8, 0.9, 1.2] {
                let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
                configuration.reference.shaping = false;
                configuration.controllers.kind = kind;
                configuration.controllers.mass_factor = mass_factor;
                let start = at(0);
                configuration.initial.position_m = start.position_m.into();
                configuration.initial.velocity_m_s = start.velocity_m_s.into();
                let mut simulation = Simulation::new(&configuration, &inputs(0)).unwrap();
                let mut furthest_m = 0.0_f64;
                for time_us in (0..30_000_000).step_by(20_000) {
                    simulation.advance_to(time_us, &inputs).unwrap();
                    if time_us > 20_000_000 {
                        let off_m = simulation.outputs().position_m - at(time_us).position_m;
                        furthest_m = furthest_m.max(off_m.norm());
                    }
                }
                let factor = simulation.control().belief().mass_kg / configuration.airframe.mass_kg;
                let told = format!("{preset:?} {kind:?} {mass_factor}: {furthest_m} m, {factor}");
                assert!(furthest_m < 0.01 && (factor - 1.0).abs() < 0.05, "{told}");
            }
        }
    }
}

/// A Crazyflie that is believed to be half as heavy again, and as hard to turn, on noisy attitudes and positions alone. What it believes of its
/// moments of inertia goes back with the mass; its attitude loops had stayed unstable, and it had fallen for ever.
#[test]
fn too_large_a_belief_does_not_last() {
    for position_noise_m in [0.0, 0.02] {
        let mut configuration = Configuration::for_airframe(&AirframePreset::Crazyflie.airframe()).unwrap();
        configuration.reference.shaping = false;
        configuration.controllers.mass_factor = 1.5;
        configuration.sensors = Sensors {
            output_feedback: true,
            attitude_noise_rad: 0.005,
            position_noise_m,
            ..configuration.sensors
        };
        let inputs = Inputs { reference: PositionReference::goal(GOAL_M, 0.0), ..Inputs::default() };
        let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
        let off_m = distance_m(&mut simulation, &inputs, GOAL_M, [40.0, 60.0]);
        assert!(off_m < 0.05, "{position_noise_m}: {off_m} m");
    }
}

/// Raw goals beyond and below, on any airframe: half of the mass is believed only until the thrust has changed for the first time. Limits
/// were broken by up to 16 % while it was learned, and goals overshot by 7 % and reached after 17 s.
#[test]
fn a_wrong_mass_is_found_before_limits_are_reached() {
    for (preset, goal_m, most_share) in [
        (AirframePreset::Paper, [20.0, 20.0, 10.0], 1.01),
        (AirframePreset::Paper, [12.0, -4.0, 6.0], 1.01),
        (AirframePreset::Paper, [0.0, 0.0, 7.0], 1.01),
        (AirframePreset::Crazyflie, [12.0, -4.0, 6.0], 1.01),
        (AirframePreset::Hummingbird, [-9.0, 14.0, 12.0], 1.01),
        (AirframePreset::Heavy, [20.0, 20.0, 10.0], 1.01),
        (AirframePreset::Heavy, [12.0, -4.0, 6.0], 1.02),
    ] {
        for mass_factor in [0.5, 0.65] {
            let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
            configuration.reference.shaping = false;
            configuration.controllers.mass_factor = mass_factor;
            let limits = configuration.limits;
            let (mut extremes, mut beyond) = (Extremes::new(), 0.0_f64);
            let end = fly(&configuration, &goal(goal_m, 0.0), 9.0, |outputs| {
                extremes.see(outputs);
                beyond = beyond.max(overshoot(outputs, goal_m));
            });
            let share = (extremes.tilt_rad / limits.tilt_rad)
                .max(extremes.horizontal_speed_m_s / limits.speed_horizontal_m_s)
                .max(extremes.sink_m_s / limits.speed_down_m_s);
            let away_m = distance(&end.outputs(), goal_m);
            let told = format!("{preset:?} {goal_m:?} {mass_factor}: {share}, {beyond}, {away_m} m");
            assert!(share < most_share && beyond < 0.04 && away_m < 0.02, "{told}");
        }
    }
}

/// On noisy outputs alone, the mass is found and stays found; such a configuration is refused without learning, because
/// its loop is unstable.
#[test]
fn a_wrong_mass_is_found_under_noise() {
    for mass_factor in [0.5, 1.5] {
        let mut configuration = unshaped_by(ControllerKind::Lmpc, true);
        configuration.sensors.position_noise_m = 0.02;
        configuration.sensors.attitude_noise_rad = 0.005;
        configuration.controllers.mass_factor = mass_factor;
        let inputs = Inputs { reference: PositionReference::goal(GOAL_M, 0.0), ..Inputs::default() };
        let mut unlearned = configuration;
        unlearned.controllers.learning = false;
        assert!(Simulation::new(&unlearned, &inputs).is_err());
        let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
        for window_s in [[15.0, 25.0], [40.0, 50.0]] {
            let error_m = distance_m(&mut simulation, &inputs, GOAL_M, window_s);
            let factor = simulation.control().belief().mass_kg / configuration.airframe.mass_kg;
            assert!((factor - 1.0).abs() < 0.1, "{mass_factor}: {factor}");
            // Measured: 0.117 m with a mass factor of 1.5.
            assert!(error_m < 0.15, "{mass_factor}: {error_m} m");
        }
    }
}

/// A vehicle that is taken over in motion while positions alone are measured. The predictor begins with one at rest: until it has found the
/// velocity, what is missing of it passes for a force. 2.5 times the mass was learned from that, and the vehicle ended metres from its goal.
#[test]
fn an_unknown_velocity_is_no_mass() {
    for preset in AirframePreset::ALL {
        for kind in KINDS {
            for velocity_m_s in [[3.0, 0.0, 0.0], [0.0, -5.0, 0.0], [0.0, 0.0, -1.5]] {
                let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
                configuration.controllers.kind = kind;
                configuration.reference.shaping = false;
                configuration.sensors.output_feedback = true;
                configuration.initial.velocity_m_s = velocity_m_s;
                let inputs = goal([0.0; 3], 0.0);
                let simulation = fly(&configuration, &inputs, 20.0, |_| {});
                let factor = simulation.control().belief().mass_kg / configuration.airframe.mass_kg;
                let off_m = simulation.outputs().position_m.norm();
                let told = format!("{preset:?} {kind:?} {velocity_m_s:?}: {off_m} m, {factor}");
                assert!((factor - 1.0).abs() < 0.05 && off_m < 0.02, "{told}");
            }
        }
    }
}

/// A flight that begins at speed on a circle: the first differences of noisy velocities say nothing yet. A mass 8 % too large was learned from
/// them, and kept as long as the thrust did not change.
#[test]
fn a_noisy_start_at_speed_teaches_no_wrong_mass() {
    let circle = Trajectory::circle(1.2);
    for seed in 0..8 {
        let mut configuration = unshaped_by(ControllerKind::Lmpc, false);
        circle.begin(&mut configuration);
        configuration.limits.tilt_rad = 1.2;
        configuration.sensors = Sensors { seed, ..noisy() };
        let inputs =
            |time_us: u64| Inputs { reference: circle.reference(time_us, true), ..Inputs::default() };
        let flight = fly(&configuration, &inputs, 10.0, |_| {});
        let factor = flight.control().belief().mass_kg / configuration.airframe.mass_kg;
        assert!((factor - 1.0).abs() < 0.03, "seed {seed}: {factor}");
    }
}

/// A force that comes and goes obliquely is no mass: one within 35 % of the airframe's own is believed in throughout, and the vehicle
/// holds its place when it is over. Taken for two and a half masses it shook the vehicle for ever.
#[test]
fn gusts_are_no_mass() {
    const OVER_US: u64 = 12_000_000;
    for (preset, share, period_us) in [
        (AirframePreset::Iris, 0.3, 1_500_000),
        (AirframePreset::Heavy, 0.3, 1_500_000),
        (AirframePreset::Crazyflie, 0.3, 600_000),
    ] {
        for kind in KINDS {
            let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
            configuration.controllers.kind = kind;
            configuration.reference.shaping = false;
            let force_n = Vector3::new(0.86, 0.31, 0.4) * (share * configuration.airframe.weight_n());
            let inputs = |time_us: u64| {
                let pushes = time_us < OVER_US && time_us / period_us % 2 == 1;
                let force_n = if pushes { force_n } else { Vector3::zeros() };
                Inputs {
                    reference: PositionReference::goal(GOAL_M, 0.0),
                    disturbance: Disturbance { force_n, ..Disturbance::default() },
                    ..Inputs::default()
                }
            };
            configuration.initial.position_m = GOAL_M;
            let mut flight = Simulation::new(&configuration, &inputs(0)).unwrap();
            for time_us in (0..OVER_US + 6_000_000).step_by(100_000) {
                flight.advance_to(time_us, &inputs).unwrap();
                let factor = flight.control().belief().mass_kg / configuration.airframe.mass_kg;
                assert!((0.65..1.35).contains(&factor), "{preset:?} {kind:?}: {factor} at {time_us} µs");
            }
            let away_m = (flight.outputs().position_m - Vector3::from(GOAL_M)).norm();
            assert!(away_m < 0.01, "{preset:?} {kind:?}: {away_m} m");
        }
    }
}

/// A circle of 4 m in a wind that swings, with drag that is known: what is learned costs hardly more than knowing it. Taken for two and a
/// half masses, the wind left too little of the thrust to lean with, and the vehicle gave the circle up for ever, metres away.
#[test]
fn a_swinging_wind_is_neither_mass_nor_drag() {
    const FROM_US: u64 = 10_000_000;
    const RATE_RAD_S: f64 = 0.8;
    let way = |time_s: f64| {
        let (sine, cosine) = (RATE_RAD_S * time_s).sin_cos();
        let (out, along) = (Vector3::new(cosine, sine, 0.0), Vector3::new(-sine, cosine, 0.0));
        PositionReference {
            velocity_m_s: along * (4.0 * RATE_RAD_S),
            acceleration_m_s2: out * (-4.0 * RATE_RAD_S * RATE_RAD_S),
            ..PositionReference::goal((out * 4.0).into(), 0.0)
        }
    };
    for kind in KINDS {
        for (wind_m_s, swing_rad_s) in
            [([6.0, 0.0, 1.8], 1.5), ([6.0, 0.0, 0.0], 1.5), ([6.0, 0.0, 1.8], 4.0)]
        {
            let inputs = |time_us: u64| {
                let time_s = time_us as f64 * 1e-6;
                let swings = [1.0, 1.0, 1.3].map(|rate| f64::sin(rate * swing_rad_s * time_s));
                let wind_m_s = Vector3::from(wind_m_s).component_mul(&Vector3::from(swings));
                Inputs {
                    reference: way(time_s),
                    disturbance: Disturbance { wind_m_s, ..Disturbance::default() },
                    ..Inputs::default()
                }
            };
            let off_m = |learning: bool| {
                let mut configuration = unshaped_by(kind, false);
                configuration.controllers.learning = learning;
                configuration.airframe.drag_n_s_m = [0.3, 0.3, 0.2];
                configuration.initial.position_m = way(0.0).position_m.into();
                let mut flight = Simulation::new(&configuration, &inputs(0)).unwrap();
                let mut squares = Vec::new();
                for time_us in (FROM_US..30_000_000).step_by(20_000) {
                    flight.advance_to(time_us, &inputs).unwrap();
                    let place_m = way(time_us as f64 * 1e-6).position_m;
                    squares.push((flight.outputs().position_m - place_m).norm_squared());
                }
                f64::sqrt(squares.iter().sum::<f64>() / squares.len() as f64)
            };
            let (learning_m, knowing_m) = (off_m(true), off_m(false));
            let told = format!("{kind:?} {wind_m_s:?} {swing_rad_s}: {learning_m} m, {knowing_m} m");
            assert!(learning_m < 1.25 * knowing_m, "{told}");
        }
    }
}

/// Drag that is known, or learned, is fed forward: the reference is braked with, not against it.
#[test]
fn drag_is_fed_forward() {
    for kind in KINDS {
        let goal_m = [60.0, 0.0, -5.0];
        let inputs = Inputs { reference: PositionReference::goal(goal_m, 0.0), ..Inputs::default() };
        let worst_m = |learning: bool, known: bool| {
            let mut configuration = Configuration::default();
            configuration.controllers.kind = kind;
            configuration.controllers.learning = learning;
            let plant = Airframe { drag_n_s_m: [0.2; 3], ..configuration.airframe };
            if known {
                configuration.airframe = plant;
            }
            let targets = ControlInputs::armed(Target::Reference(inputs.reference));
            let mut state = PlantState::hovering(&configuration.initial, &configuration.airframe);
            let read = |state: &PlantState| Measurement {
                motion: state.body,
                rotor_speed_rad_s: state.rotor_speed_rad_s,
            };
            let mut control = ControlLoop::new(&configuration, &targets, &mut read(&state), 0).unwrap();
            let mut worst_m = 0.0_f64;
            for time_us in (0..14_000_000).step_by(1_000) {
                let command = control.advance_to(time_us, &targets, &mut read(&state)).unwrap();
                state = Plant::new(&plant, &configuration.environment).step(
                    &state,
                    &PlantInputs::rotor_speeds(command),
                    1e-3,
                );
                let reference = control.state().reference(time_us);
                // From the cruise on.
                if time_us > 6_000_000 {
                    worst_m = worst_m.max((state.body.position_m - reference.position_m).norm());
                }
            }
            (worst_m, control.belief().drag_n_s_m.x)
        };
        let (unaided_m, _) = worst_m(false, false);
        let (known_m, _) = worst_m(false, true);
        let (learned_m, drag) = worst_m(true, false);
        let told = format!("{kind:?}: {unaided_m} m, known {known_m} m, learned {learned_m} m, {drag} N·s/m");
        assert!(known_m < 0.5 * unaided_m && learned_m < 0.6 * unaided_m, "{told}");
        assert!((0.12..0.28).contains(&drag), "{told}");
    }
}

/// Under attitude targets it learns, too, and nothing of a flight without a rotor.
#[test]
fn every_law_goes_on_with_what_was_learned() {
    let configuration = unshaped_by(ControllerKind::Lmpc, false);
    let mass_kg = configuration.airframe.mass_kg;
    let wrong = Configuration {
        controllers: quadrotor::Controllers { mass_factor: 1.5, ..configuration.controllers },
        ..configuration
    };
    let weight_n = configuration.airframe.weight_n();
    let inputs = |time_us: u64| {
        let share = 1.0 + 0.25 * f64::sin(2.0 * time_us as f64 * 1e-6);
        let target = AttitudeTarget {
            attitude: UnitQuaternion::identity(),
            body_rate_rad_s: Vector3::zeros(),
            thrust_n: share * weight_n,
        };
        Inputs { attitude_target: Some(target), ..Inputs::default() }
    };
    let mut simulation = Simulation::new(&wrong, &inputs(0)).unwrap();
    simulation.advance_to(10_000_000, &inputs).unwrap();
    let learned_kg = simulation.control().belief().mass_kg;
    assert!((learned_kg / mass_kg - 1.0).abs() < 0.05, "{learned_kg} kg");
    let without = Inputs { lost_rotor: Some(0), ..Inputs::default() };
    simulation.advance_to(12_000_000, &without).unwrap();
    assert_eq!(simulation.control().belief().mass_kg, learned_kg);
}

/// What was learned is part of the saved state: a flight goes on from there bit for bit.
#[test]
fn what_was_learned_is_saved() {
    let mut configuration = unshaped_by(ControllerKind::Lmpc, true);
    configuration.controllers.mass_factor = 0.8;
    let inputs = Inputs { reference: PositionReference::goal(GOAL_M, 0.0), ..Inputs::default() };
    let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
    simulation.advance_to(2_003_000, &inputs).unwrap();
    let bytes = postcard::to_allocvec(&simulation.state()).unwrap();
    let state = postcard::from_bytes(&bytes).unwrap();
    let mut restored = Simulation::from_state(&configuration, state).unwrap();
    for flight in [&mut simulation, &mut restored] {
        flight.advance_to(4_000_000, &inputs).unwrap();
    }
    assert_eq!(simulation.state(), restored.state());
    assert_ne!(simulation.control().belief().mass_kg, 0.8 * configuration.airframe.mass_kg);
}

/// Switched off, the belief is the configured one again; switched on, learning starts from it. Neither moves the vehicle.
#[test]
fn learning_is_switched_in_flight() {
    let mut configuration = unshaped_by(ControllerKind::Lmpc, false);
    configuration.controllers.mass_factor = 0.8;
    let inputs = Inputs { reference: PositionReference::goal(GOAL_M, 0.0), ..Inputs::default() };
    let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
    simulation.advance_to(15_003_000, &inputs).unwrap();
    let mass_kg = configuration.airframe.mass_kg;
    assert!((simulation.control().belief().mass_kg / mass_kg - 1.0).abs() < 0.03);
    for (learning, time_s) in [(false, 20.0), (true, 25.0)] {
        configuration.controllers.learning = learning;
        simulation.reconfigure(&configuration).unwrap();
        assert!((simulation.control().belief().mass_kg / mass_kg - 0.8).abs() < 1e-12);
        let moved_m = distance_m(&mut simulation, &inputs, GOAL_M, [time_s - 4.9, time_s]);
        assert!(moved_m < 0.002, "{learning}: {moved_m} m");
    }
}
