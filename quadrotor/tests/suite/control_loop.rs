//! The control loop by itself, without a simulation around it.

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use quadrotor::{
    AirframePreset, AttitudeTarget, Configuration, ConfigurationError, ControlError, ControlInputs,
    ControlLaw, ControlLoop, ControlState, ControllerKind, InitialState, Inputs, Measurement, Plant,
    PlantInputs, PlantState, PositionReference, Simulation, Target,
};

use crate::common::{KINDS, exact, fly_plant, unshaped, unshaped_by};

/// A vehicle that sways, whatever it is commanded.
fn swaying(time_us: u64) -> Measurement {
    let t = time_us as f64 * 1e-6;
    let configuration = Configuration::default();
    let mut state = PlantState::hovering(&InitialState::default(), &configuration.airframe);
    state.body.position_m = Vector3::new(0.3 * t.sin(), -0.2 * t, 0.1 * (2.0 * t).cos());
    state.body.velocity_m_s = Vector3::new(0.3 * t.cos(), -0.2, -0.2 * (2.0 * t).sin());
    state.body.attitude =
        UnitQuaternion::from_euler_angles(0.05 * (3.0 * t).sin(), 0.03, 0.1 * t).into_inner();
    state.rotor_speed_rad_s[1] += 5.0 * t.sin();
    exact(&state)
}

/// Every law in turn, armed late and disarmed once.
fn asked(time_us: u64) -> ControlInputs {
    let reference = PositionReference::goal([1.0, 0.0, -2.0], 0.3);
    let attitude = AttitudeTarget {
        attitude: UnitQuaternion::from_euler_angles(0.1, 0.0, 0.0),
        body_rate_rad_s: Vector3::zeros(),
        thrust_n: 7.0,
    };
    let target = match time_us {
        400_000..700_000 => Target::Attitude(attitude),
        1_000_000..1_300_000 => Target::WithoutRotor { lost: 2, reference },
        _ => Target::Reference(reference),
    };
    let armed = time_us >= 3_500 && !(1_500_000..1_600_000).contains(&time_us);
    ControlInputs { armed, ..ControlInputs::armed(target) }
}

fn new_loop(configuration: &Configuration, time_us: u64) -> ControlLoop {
    ControlLoop::new(configuration, &asked(time_us), &mut swaying, time_us).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]

    /// It samples at instants of its own, however far the caller steps, and however often he asks.
    #[test]
    fn it_is_the_same_whatever_the_callers_step(
        mut times in prop::collection::vec(0u64..2_000_000, 0..300), kind in 0..3_usize,
    ) {
        let configuration = unshaped_by(KINDS[kind], true);
        times.sort_unstable();
        times.push(2_000_000);
        let (mut split, mut whole) = (new_loop(&configuration, 0), new_loop(&configuration, 0));
        let mut command = [0.0; 4];
        for time_us in times {
            command = split.advance_to(time_us, &asked, &mut swaying).unwrap();
            prop_assert!(split.next_sample_us() > time_us);
        }
        prop_assert_eq!(command, whole.advance_to(2_000_000, &asked, &mut swaying).unwrap());
        prop_assert_eq!(split.state(), whole.state());
    }

    #[test]
    fn saved_and_restored_it_goes_on_bit_for_bit(middle in 0u64..2_000_000, kind in 0..3_usize) {
        let configuration = unshaped_by(KINDS[kind], true);
        let mut straight = new_loop(&configuration, 0);
        straight.advance_to(middle, &asked, &mut swaying).unwrap();
        let bytes = postcard::to_allocvec(straight.state()).unwrap();
        straight.advance_to(2_000_000, &asked, &mut swaying).unwrap();
        let state: ControlState = postcard::from_bytes(&bytes).unwrap();
        let mut resumed = ControlLoop::from_state(&configuration, state).unwrap();
        resumed.advance_to(2_000_000, &asked, &mut swaying).unwrap();
        prop_assert_eq!(&straight, &resumed);
        // And back again.
        straight.restore(state).unwrap();
        straight.advance_to(2_000_000, &asked, &mut swaying).unwrap();
        prop_assert_eq!(straight.state(), resumed.state());
    }
}

#[test]
fn no_law_allocates_in_a_step() {
    for kind in KINDS {
        let mut control = new_loop(&unshaped_by(kind, true), 0);
        let allocations = allocation_counter::measure(|| {
            control.advance_to(2_000_000, &asked, &mut swaying).unwrap();
        });
        assert_eq!(allocations.count_total, 0, "{kind:?}");
    }
}

#[test]
fn it_may_begin_at_any_time() {
    let mut control = new_loop(&unshaped(), 1_234_567);
    assert_eq!(control.next_sample_us(), 1_235_000);
    control.advance_to(1_240_000, &asked, &mut swaying).unwrap();
    assert_eq!((control.next_sample_us(), control.state().law()), (1_241_000, ControlLaw::RotorLoss));
}

#[test]
fn what_cannot_be_flown_is_refused_and_forgotten() {
    let mut control = new_loop(&unshaped(), 5_000);
    let before = control.clone();
    let goal = PositionReference::goal([0.0; 3], 0.0);
    let nowhere = PositionReference { yaw_rad: f64::NAN, ..goal };
    for (target, error) in [
        (Target::Reference(nowhere), ControlError::InputNotFinite { name: "reference.yaw", time_us: 5_000 }),
        (Target::WithoutRotor { lost: 7, reference: goal }, ControlError::NoSuchRotor { rotor: 7 }),
    ] {
        let refused = control.advance_to(20_000, &ControlInputs::armed(target), &mut swaying);
        assert_eq!(refused, Err(error));
        assert_eq!(control, before);
    }
}

/// A sensor that fails must not become a rotor command.
#[test]
fn a_measurement_that_is_none_is_refused_and_forgotten() {
    let configuration = unshaped();
    let spoil: [fn(&mut Measurement); 4] = [
        |measured| measured.motion.position_m.x = f64::NAN,
        |measured| measured.motion.attitude.coords.fill(0.0),
        |measured| measured.motion.body_rate_rad_s.z = f64::INFINITY,
        |measured| measured.rotor_speed_rad_s[3] = f64::NAN,
    ];
    for spoil in spoil {
        let mut broken = |time_us: u64| {
            let mut measured = swaying(time_us);
            spoil(&mut measured);
            measured
        };
        let refused = ControlLoop::new(&configuration, &asked(0), &mut broken, 0);
        assert_eq!(refused, Err(ConfigurationError::Measurement));
        // Where it takes the vehicle over, and at a sample of the attitude controller.
        for (from_us, at_us) in [(3_000, 4_000), (4_000, 10_000)] {
            let mut control = new_loop(&configuration, 0);
            control.advance_to(from_us, &asked, &mut swaying).unwrap();
            let refused = control.advance_to(20_000, &asked, &mut broken);
            assert_eq!(refused, Err(ControlError::Measurement { time_us: at_us }));
            control.advance_to(20_000, &asked, &mut swaying).unwrap();
            let mut sound = new_loop(&configuration, 0);
            sound.advance_to(20_000, &asked, &mut swaying).unwrap();
            assert_eq!(control, sound);
        }
    }
}

/// The commanded wrench is what the lag of the rotors answers to: over each sample of the attitude controller the plant's thrust and
/// torques go towards it as a first-order lag does.
#[test]
fn the_plant_answers_to_the_commanded_wrench_with_a_first_order_lag() {
    const SAMPLE_US: u64 = 10_000;
    let configuration = Configuration::default();
    let kept = (-0.01 / configuration.airframe.rotor_time_constant_s).exp();
    let inputs = Inputs::default();
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    let (mut moved, mut turned) = (0.0_f64, 0.0_f64);
    for sample in 1..400 {
        let before = flight.outputs();
        flight.advance_to(sample * SAMPLE_US, &inputs).unwrap();
        let (after, wanted) = (flight.outputs(), flight.control().state().commanded_wrench());
        let thrust_n = wanted.thrust_n + (before.thrust_n - wanted.thrust_n) * kept;
        let torque_n_m = wanted.torque_n_m + (before.torque_n_m - wanted.torque_n_m) * kept;
        assert!((after.thrust_n - thrust_n).abs() < 1e-6, "{sample}: {} {thrust_n}", after.thrust_n);
        assert!((after.torque_n_m - torque_n_m).norm() < 1e-6, "{sample}: {} {torque_n_m}", after.torque_n_m);
        moved = moved.max((wanted.thrust_n - before.thrust_n).abs());
        turned = turned.max((wanted.torque_n_m - before.torque_n_m).norm());
    }
    assert!(moved > 0.1 && turned > 0.01, "{moved} {turned}");
    let disarmed = Inputs { armed: false, ..inputs };
    flight.advance_to(4_100_000, &disarmed).unwrap();
    assert_eq!(flight.control().state().commanded_wrench().thrust_n, 0.0);
}

#[test]
fn a_vehicle_is_taken_over_anew_as_by_a_new_loop() {
    let configuration = unshaped_by(ControllerKind::Lmpc, true);
    let mut control = new_loop(&configuration, 0);
    control.advance_to(2_000_000, &asked, &mut swaying).unwrap();
    control.take_over(&asked(7_001_000), &mut swaying, 7_001_000).unwrap();
    assert_eq!(control, new_loop(&configuration, 7_001_000));
    let mut broken = swaying(0);
    broken.motion.position_m.x = f64::NAN;
    let refused = control.take_over(&asked(8_000_000), &mut broken, 8_000_000);
    assert_eq!(refused, Err(ConfigurationError::Measurement));
    assert_eq!(control, new_loop(&configuration, 7_001_000));
}

/// How far a vehicle that is to hover is off after a minute whose velocity and body rates are read with a bias, m.
fn hover_with_biased_rates_m(preset: AirframePreset, kind: ControllerKind) -> f64 {
    let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
    configuration.reference.shaping = false;
    configuration.controllers.kind = kind;
    let plant = Plant::new(&configuration.airframe, &configuration.environment);
    let state = PlantState::hovering(&configuration.initial, &configuration.airframe);
    let measured = |state: &PlantState| {
        let mut measured = exact(state);
        measured.motion.velocity_m_s += Vector3::new(0.1, -0.05, 0.1);
        measured.motion.body_rate_rad_s += Vector3::new(0.05, -0.05, 0.02);
        measured
    };
    let inputs = ControlInputs::armed(Target::Reference(PositionReference::goal([0.0; 3], 0.0)));
    let (state, _) =
        fly_plant(&configuration, (state, &inputs), measured, 60.0, |_, state, command_rad_s| {
            plant.step(state, &PlantInputs::rotor_speeds(command_rad_s), 1e-3)
        });
    state.body.position_m.norm()
}

/// A gyroscope and a velocity that are off lead nobody astray: what place and attitude show tells by how much. Laws that foresee the
/// motion integrate the rates, and were held 6 to 15 cm beside their place.
#[test]
fn rates_that_are_off_leave_no_offset() {
    for preset in AirframePreset::ALL {
        for kind in KINDS {
            let off_m = hover_with_biased_rates_m(preset, kind);
            assert!(off_m < 1e-3, "{preset:?} {kind:?}: {off_m} m");
        }
    }
}
