//! Frames other than "+": rotor positions and directions are data.

use nalgebra::Vector3;
use quadrotor::{
    Configuration, ConfigurationError, Direction, Disturbance, Environment, InitialState, Inputs, Plant,
    PlantInputs, PlantState, PositionReference, Rotor, RotorFault, RotorLayout, Simulation,
};

use crate::common::{Extremes, distance, fly, goal};

fn with(layout: RotorLayout) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.airframe.layout = layout;
    configuration
}

/// In hover, over 5 m and through a turn each frame arrives as the "+" does, and follows its reference at least as closely: four rotors
/// at l/√2 make √2 times the torque of two at l, and the bandwidth of the attitude is chosen by what the torque can do.
#[test]
fn x_and_h_frames_fly_as_the_plus_frame_does() {
    for (goal_m, yaw_rad) in [([0.0, 0.0, -2.0], 0.0), ([5.0, 0.0, -2.0], 0.0), ([3.0, -4.0, -2.0], 1.5)] {
        let arrivals =
            [RotorLayout::plus(), RotorLayout::x(), RotorLayout::h(1.4), RotorLayout::h(0.7)].map(|layout| {
                let configuration = with(layout);
                let (mut extremes, mut path, mut off_m) = (Extremes::new(), Vec::new(), 0.0_f64);
                let end = fly(&configuration, &goal(goal_m, yaw_rad), 15.0, |outputs| {
                    extremes.see(outputs);
                    path.push(outputs.position_m);
                    off_m = off_m.max((outputs.position_m - outputs.setpoint.position_m).norm());
                })
                .outputs();
                extremes.assert_within(&configuration);
                assert!(distance(&end, goal_m) < 0.001, "{layout:?}: {end:?}");
                assert!(end.yaw_error_rad.abs() < 0.001, "{layout:?}: {end:?}");
                (path, off_m)
            });
        let (plus, plus_m) = &arrivals[0];
        // Measured: 46 mm of the "+", 29 mm of the "X", which are 19 mm apart then.
        assert!(*plus_m < 0.05, "{plus_m}");
        for (other, off_m) in &arrivals[1..] {
            assert!(*off_m < plus_m + 1e-4, "{off_m} {plus_m}");
            let apart_m = plus.iter().zip(other).map(|(one, other)| (one - other).norm()).fold(0.0, f64::max);
            assert!(apart_m < 0.02, "{apart_m}");
        }
    }
}

/// Each rotor of a turned frame is where it is said to be: without it the vehicle is flown down, spinning.
#[test]
fn an_x_and_an_h_frame_descend_without_a_rotor() {
    for layout in [RotorLayout::x(), RotorLayout::h(1.2)] {
        for lost in 0..4 {
            let mut configuration = with(layout);
            configuration.initial.position_m[2] = -100.0;
            let reference = PositionReference::goal([0.0, 0.0, -100.0], 0.0);
            let mut inputs = Inputs { reference, ..Inputs::default() };
            let mut flight = Simulation::new(&configuration, &inputs).unwrap();
            inputs.rotor_faults[lost] = Some(RotorFault::Off);
            flight.advance_to(60_000, &inputs).unwrap();
            inputs.lost_rotor = Some(lost);
            flight.advance_to(60_000_000, &inputs).unwrap();
            let end = flight.outputs();
            assert!((end.position_m - reference.position_m).norm() < 0.5, "{layout:?}, {lost}: {end:?}");
            assert!(end.body_rate_rad_s.z.abs() > 5.0, "{layout:?}, {lost}: {end:?}");
        }
    }
}

#[test]
fn frames_stand_on_the_feet_below_their_rotors() {
    let mut configuration = with(RotorLayout::x());
    configuration.environment.ground_plane = true;
    configuration.initial.attitude_rad = [0.1, 0.05, 0.0];
    configuration.initial.position_m[2] = -0.2;
    let inputs = Inputs { armed: false, ..Inputs::default() };
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    flight.advance_to(3_000_000, &inputs).unwrap();
    assert!(flight.outputs().attitude_rad.xy().norm() < 1e-3, "{:?}", flight.outputs());
}

/// Pushed over by 85 % of m g l: past the front feet of an "X", which are at l/√2, but not past that of a "+".
#[test]
fn frames_tip_over_the_feet_at_their_rotors() {
    for (layout, tips) in [(RotorLayout::plus(), false), (RotorLayout::x(), true)] {
        let airframe = with(layout).airframe;
        let plant = Plant::new(&airframe, &Environment { ground_plane: true });
        let torque_n_m = Vector3::new(0.0, -0.85 * airframe.weight_n() * airframe.arm_length_m, 0.0);
        let disturbance = Disturbance { torque_n_m, ..Disturbance::default() };
        let push = PlantInputs { disturbance, ..PlantInputs::default() };
        let mut state = PlantState::at_rest(&InitialState::default());
        for _ in 0..1_000 {
            state = plant.step(&state, &push, 1e-3);
        }
        let (_, pitch_rad, _) = state.body.rotation().euler_angles();
        assert_eq!(pitch_rad < -0.2, tips, "{layout:?}: {pitch_rad}");
    }
}

#[test]
fn layouts_that_cannot_fly_are_refused() {
    let turned_wrongly = |rotor: usize| {
        let mut layout = RotorLayout::plus();
        layout.rotors[rotor].direction = Direction::Counterclockwise;
        layout
    };
    let mut off_centre = RotorLayout::plus();
    off_centre.rotors[0].x = 1.5;
    let mut nowhere = RotorLayout::plus();
    nowhere.rotors[2].y = f64::NAN;
    let mut in_a_line = RotorLayout::x();
    in_a_line.rotors = in_a_line.rotors.map(|rotor| Rotor { y: 0.0, ..rotor });
    for (layout, reason) in [
        (turned_wrongly(0), "as many rotors must turn one way as the other"),
        (off_centre, "the rotors' centre is not the centre of mass"),
        (nowhere, "a rotor's place is not finite"),
        (in_a_line, "the rotors cannot make thrust and all three torques"),
    ] {
        let refused = Simulation::new(&with(layout), &Inputs::default()).unwrap_err();
        assert_eq!(refused, ConfigurationError::Layout { reason });
        assert_eq!(refused.to_string(), format!("airframe.layout cannot be flown: {reason}"));
    }
}

/// Flies, but opposite rotors turn opposite ways: there is no law for the loss of one.
#[test]
fn a_layout_without_opposite_pairs_has_no_flight_without_a_rotor() {
    let mut layout = RotorLayout::x();
    let places = [[0.9, 0.7], [-0.8, 0.9], [-1.0, -0.6], [0.9, -1.0]];
    for (rotor, [x, y]) in layout.rotors.iter_mut().zip(places) {
        (rotor.x, rotor.y) = (x, y);
    }
    let end = fly(&with(layout), &goal([1.0, 1.0, -2.0], 0.3), 15.0, |_| {});
    assert!(distance(&end.outputs(), [1.0, 1.0, -2.0]) < 0.001);
    assert!(end.control().check_loss_of(0).is_err());
}

/// A layout is fixed, and an airframe that was saved without one has the paper's.
#[test]
fn a_saved_airframe_without_a_layout_is_a_plus() {
    let mut flight = Simulation::new(&Configuration::default(), &Inputs::default()).unwrap();
    let fixed = ConfigurationError::Fixed { name: "airframe.layout" };
    assert_eq!(flight.reconfigure(&with(RotorLayout::x())), Err(fixed));

    let airframe = with(RotorLayout::h(1.3)).airframe;
    let mut saved = serde_json::to_value(airframe).unwrap();
    assert_eq!(serde_json::from_value::<quadrotor::Airframe>(saved.clone()).unwrap(), airframe);
    saved.as_object_mut().unwrap().remove("layout");
    let read: quadrotor::Airframe = serde_json::from_value(saved).unwrap();
    assert_eq!(read.layout, RotorLayout::plus());
}

#[test]
fn rotors_are_named_by_where_they_are() {
    assert_eq!(RotorLayout::plus().names(), ["front", "right", "back", "left"]);
    assert_eq!(RotorLayout::x().names(), ["front right", "back right", "back left", "front left"]);
    let first = RotorLayout::h(1.5).rotors[0];
    assert!((Vector3::new(first.x, first.y, 0.0).norm() - 1.0).abs() < 1e-12 && first.x > first.y);
}
