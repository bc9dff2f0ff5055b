//! The plant from event to event: an integrator of its own against the plant's steps, and the rules of the events.

use nalgebra::{Quaternion, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use quadrotor::{
    Airframe, BatteryPack, Disturbance, Environment, InitialState, Plant, PlantInputs, PlantMode, PlantState,
    Switch,
};

use crate::common::dormand_prince::Flight;
use crate::common::physics::all_physics;

/// Durations, s, and the inputs meanwhile.
type Phases = Vec<(f64, PlantInputs)>;

fn over_ground(airframe: &Airframe) -> Plant {
    Plant::new(airframe, &Environment { ground_plane: true })
}

fn pushed(inputs: PlantInputs, force_n: [f64; 3]) -> PlantInputs {
    PlantInputs { disturbance: Disturbance { force_n: force_n.into(), ..inputs.disturbance }, ..inputs }
}

/// Steps of the plant's own.
fn stepped(plant: &Plant, start: &PlantState, phases: &Phases, h_s: f64) -> PlantState {
    phases.iter().fold(*start, |state, (duration_s, inputs)| {
        let steps = (duration_s / h_s).round() as usize;
        (0..steps).fold(state, |state, _| plant.step(&state, inputs, h_s))
    })
}

/// From event to event.
fn flown<'a>(plant: &'a Plant, start: &PlantState, phases: &Phases, tolerance: f64) -> Flight<'a> {
    let mut flight = Flight::new(plant, start, &phases[0].1, tolerance);
    let mut end_s = 0.0;
    for (duration_s, inputs) in phases {
        flight.set_inputs(inputs);
        end_s += duration_s;
        flight.fly_to(end_s);
    }
    flight
}

/// Rotors at rest, stood for a second.
fn standing(plant: &Plant) -> PlantState {
    let start = PlantState::at_rest(&InitialState::default());
    stepped(plant, &start, &vec![(1.0, PlantInputs::default())], 1e-3)
}

/// Largest difference of two states, each number relative to its nominal.
fn difference(plant: &Plant, one: &PlantState, other: &PlantState) -> f64 {
    let [one, other] = [one, other].map(|state| state.normalized().to_array());
    let nominal = PlantState::nominal(plant.airframe()).to_array();
    (0..PlantState::LEN).map(|i| (one[i] - other[i]).abs() / nominal[i]).fold(0.0, f64::max)
}

fn all_feet(mode: PlantMode, switch: fn(usize) -> Switch) -> bool {
    (0..4).all(|foot| mode.is_on(switch(foot)))
}

/// Integrated from event to event the error is that of the tolerance. Steps find events up to a step late, so that theirs is in
/// proportion to the step.
fn assert_agreement(plant: &Plant, start: &PlantState, phases: &Phases) -> PlantMode {
    let fine = flown(plant, start, phases, 1e-11);
    for tolerance in [1e-4, 1e-6, 1e-8] {
        // A step whose own error is just within the tolerance may end anywhere: one of three flights may be off.
        let mut errors = [1.0, 0.9, 0.8].map(|share| {
            let coarse = flown(plant, start, phases, share * tolerance);
            assert_eq!((coarse.events, coarse.mode), (fine.events, fine.mode), "at {tolerance}");
            difference(plant, &coarse.state, &fine.state)
        });
        errors.sort_unstable_by(f64::total_cmp);
        assert!(errors[1] < tolerance, "{errors:?} at {tolerance}");
    }
    for h_s in [1e-3, 1e-4, 1e-5] {
        let error = difference(plant, &stepped(plant, start, phases, h_s), &fine.state);
        assert!(error < 0.5 * h_s, "{error} with steps of {h_s} s");
    }
    assert!(fine.events > 0);
    fine.mode
}

fn airframes() -> [Airframe; 3] {
    [Airframe::default(), Airframe { drag_n_s_m: [0.3; 3], ..Airframe::default() }, all_physics()]
}

/// Dropped aslant and turning, it lands on one foot after the other, slides, and is held.
#[test]
fn a_landing_with_slip_is_that_of_small_steps() {
    for airframe in airframes() {
        let start = PlantState::at_rest(&InitialState {
            position_m: [0.0, 0.0, -0.3],
            velocity_m_s: [0.8, -0.3, 0.0],
            attitude_rad: [0.05, -0.03, 0.4],
            body_rate_rad_s: [0.0, 0.0, 1.0],
            ..InitialState::default()
        });
        let mode = assert_agreement(&over_ground(&airframe), &start, &vec![(1.5, PlantInputs::default())]);
        assert!(mode.is_on(Switch::Held) && all_feet(mode, Switch::Bears));
    }
}

/// Held at first, pushed aside as soon as the rotors have taken the load, then in the air.
#[test]
fn a_lift_off_in_a_push_is_that_of_small_steps() {
    for airframe in airframes() {
        let plant = over_ground(&airframe);
        let phases = vec![
            (0.1, PlantInputs::default()),
            (0.5, pushed(PlantInputs::rotor_speeds([300.0; 4]), [2.0, 1.0, 0.0])),
        ];
        let mode = assert_agreement(&plant, &standing(&plant), &phases);
        assert!(!mode.is_on(Switch::Held) && (0..4).all(|foot| !mode.is_on(Switch::Bears(foot))));
    }
}

/// Pulled by more than friction holds, then left alone.
#[test]
fn a_slide_is_that_of_small_steps() {
    for airframe in airframes() {
        let plant = over_ground(&airframe);
        let rest = PlantInputs::default();
        let pull = vec![(0.1, rest), (0.5, pushed(rest, [0.0, 6.0, 0.0]))];
        let sliding = assert_agreement(&plant, &standing(&plant), &pull);
        assert!(!sliding.is_on(Switch::Held) && all_feet(sliding, Switch::Slides));
        let mode = assert_agreement(&plant, &standing(&plant), &[pull, vec![(1.0, rest)]].concat());
        assert!(mode.is_on(Switch::Held) && !mode.is_on(Switch::Slides(0)));
    }
}

/// The knee of the battery's voltage, its end, and the bounds of the thrust.
#[test]
fn kinks_in_flight_are_events() {
    let battery = BatteryPack { capacity_a_s: 40.0, ..all_physics().battery };
    let airframe = Airframe { battery, centre_of_gravity_m: [0.0; 3], ..all_physics() };
    let plant = Plant::new(&airframe, &Environment::default());
    let discharge = 0.8;
    let start = PlantState::hovering(&InitialState { discharge, ..InitialState::default() }, &airframe);
    let inputs = PlantInputs::rotor_speeds([220.0; 4]);
    let draining = assert_agreement(&plant, &start, &vec![(2.0, inputs)]);
    assert!(!draining.is_on(Switch::AboveKnee) && !draining.is_on(Switch::Empty));
    let emptied = assert_agreement(&plant, &start, &vec![(8.0, inputs)]);
    assert!(emptied.is_on(Switch::Empty));
    // A climb that leaves no thrust, and a fall.
    let start = PlantState { rotor_speed_rad_s: [100.0; 4], ..start };
    let thrown = vec![(4.0, PlantInputs::rotor_speeds([100.0; 4]))];
    let climbing = PlantState::from_array({
        let mut numbers = start.to_array();
        numbers[5] = -20.0;
        numbers
    });
    assert!(all_feet(plant.mode(&climbing, &thrown[0].1), Switch::NoThrust));
    let falling = assert_agreement(&plant, &climbing, &thrown);
    assert!(all_feet(falling, Switch::MostThrust) && !falling.is_on(Switch::NoThrust(0)));
}

/// At rest nothing happens, exactly; in a hover with all physics nothing happens either, however coarse the integrator is.
#[test]
fn events_do_not_chatter() {
    let plant = over_ground(&Airframe { drag_n_s_m: [0.3; 3], ..Airframe::default() });
    let mut wind = PlantInputs::default();
    wind.disturbance.wind_m_s = Vector3::new(3.0, -4.0, 0.0);
    let start = standing(&plant);
    for tolerance in [1e-2, 1e-4, 1e-8] {
        let stood = flown(&plant, &start, &vec![(60.0, wind)], tolerance);
        assert_eq!((stood.events, stood.mode.is_on(Switch::Held)), (0, true));
        let body = stood.state.body;
        assert_eq!(body.position_m.xy(), start.body.position_m.xy());
        assert_eq!((body.velocity_m_s.xy().norm(), body.body_rate_rad_s.z), (0.0, 0.0));
        assert_eq!(plant.outputs_in(stood.mode, &stood.state, &wind).acceleration_m_s2.xy().norm(), 0.0);
    }
    let airframe =
        Airframe { centre_of_gravity_m: [0.0; 3], products_of_inertia_kg_m2: [0.0; 3], ..all_physics() };
    let plant = over_ground(&airframe);
    let initial = InitialState { position_m: [0.0, 0.0, -50.0], ..InitialState::default() };
    for tolerance in [1e-2, 1e-4, 1e-8] {
        let start = PlantState::hovering(&initial, &airframe);
        let hovered = flown(&plant, &start, &vec![(3.0, PlantInputs::rotor_speeds([270.0; 4]))], tolerance);
        assert_eq!(hovered.events, 0);
    }
}

/// The mode is plain data.
#[test]
fn a_mode_is_saved_and_restored() {
    let plant = over_ground(&Airframe::default());
    let mode = plant.mode(&standing(&plant), &PlantInputs::default());
    assert!(mode.is_on(Switch::Held) && mode != PlantMode::default());
    let bytes = postcard::to_allocvec(&mode).unwrap();
    assert_eq!(postcard::from_bytes::<PlantMode>(&bytes).unwrap(), mode);
}

/// Each switch has a place of its own.
#[test]
fn switches_have_their_own_indicators() {
    let many: [fn(usize) -> Switch; 6] = [
        Switch::Bears,
        Switch::Slides,
        Switch::Hardest,
        Switch::MostThrust,
        Switch::NoThrust,
        Switch::NearGround,
    ];
    let single = [Switch::Upright, Switch::AboveKnee, Switch::Empty, Switch::Overloaded, Switch::Held];
    let switches = many.iter().flat_map(|of| (0..4).map(of)).chain(single);
    let places: Vec<usize> = switches.map(Switch::index).collect();
    assert_eq!(places, (0..Switch::COUNT).collect::<Vec<_>>());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// After an event the mode fits the state: the signs of all indicators, and there is no second event. In the mode that a
    /// state is in by itself the derivative is that of everywhere, unless the vehicle is held.
    #[test]
    fn an_event_ends_in_a_mode_that_fits(
        place in prop::array::uniform3(-1.0..1.0), lean in prop::array::uniform3(-1.0..1.0),
        velocity in prop::array::uniform3(-1.0..1.0), rate in prop::array::uniform3(-1.0..1.0),
        speeds in prop::array::uniform4(0.0..450.0), discharge in 0.0..1.2, force in prop::array::uniform3(-3.0..3.0),
        [slow, low, ground_plane, plain] in prop::array::uniform4(any::<bool>()), stale in prop::collection::vec(any::<f64>(), 18),
    ) {
        let airframe = if plain { Airframe::default() } else { all_physics() };
        let plant = Plant::new(&airframe, &Environment { ground_plane });
        let mut state = PlantState::at_rest(&InitialState { discharge, ..InitialState::default() });
        let (tilt, fast) = if low { (0.01, if slow { 0.03 } else { 0.5 }) } else { (0.5, 8.0) };
        state.body.position_m.z = if low { 0.005 * place[2] + 0.004 } else { place[2] - 1.2 };
        let [i, j, k] = lean;
        state.body.attitude = Quaternion::new(1.0, tilt * i, tilt * j, k);
        state.body.velocity_m_s = Vector3::from(velocity) * fast;
        state.body.body_rate_rad_s = Vector3::from(rate) * fast;
        state.rotor_speed_rad_s = speeds;
        let inputs = pushed(PlantInputs::rotor_speeds([200.0; 4]), force);

        let natural = plant.mode(&state, &inputs);
        if !natural.is_on(Switch::Held) {
            prop_assert_eq!(plant.derivative_in(natural, &state, &inputs), plant.derivative(&state, &inputs));
            prop_assert_eq!(plant.event(natural, &state, &inputs), (natural, state));
        }
        // From any mode: here that of another state.
        let other = PlantState::from_array(std::array::from_fn(|n| stale[n].clamp(-300.0, 300.0)));
        for before in [natural, plant.mode(&other, &inputs)] {
            let (mode, after) = plant.event(before, &state, &inputs);
            let signs = plant.event_indicators(mode, &after, &inputs).map(|indicator| indicator > 0.0);
            let again = plant.event(mode, &after, &inputs);
            prop_assert_eq!(again, (mode, after));
            for switch in [Switch::Bears(0), Switch::Slides(3), Switch::NearGround(1), Switch::Empty, Switch::Held] {
                prop_assert_eq!(signs[switch.index()], mode.is_on(switch), "{:?}", switch);
            }
            if mode.is_on(Switch::Held) {
                let body = after.body;
                prop_assert_eq!((body.velocity_m_s.xy().norm(), body.body_rate_rad_s.z), (0.0, 0.0));
                let slope = plant.derivative_in(mode, &after, &inputs).body;
                prop_assert_eq!((slope.position_m.xy().norm(), slope.velocity_m_s.xy().norm()), (0.0, 0.0));
                prop_assert_eq!(slope.body_rate_rad_s.z, 0.0);
            } else {
                prop_assert_eq!(after, state);
            }
        }
    }
}

proptest! {
    // The same landings each time: of 4000 others, 8 spread further than the bound.
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// However it comes down, and however it is pushed there, events are few, and a coarse solver ends where a fine one does.
    #[test]
    fn any_landing_ends(
        lean in prop::array::uniform3(-1.0..1.0), velocity in prop::array::uniform3(-2.0..2.0),
        rate in prop::array::uniform3(-3.0..3.0), force in prop::array::uniform3(-3.0..3.0),
        speed in 0.0..200.0, plain in any::<bool>(),
    ) {
        let airframe = if plain { Airframe::default() } else { all_physics() };
        let plant = over_ground(&airframe);
        let start = PlantState {
            rotor_speed_rad_s: [speed; 4],
            ..PlantState::at_rest(&InitialState {
                position_m: [0.0, 0.0, -0.4],
                velocity_m_s: velocity,
                attitude_rad: [0.6 * lean[0], 0.6 * lean[1], 3.0 * lean[2]],
                body_rate_rad_s: rate,
                ..InitialState::default()
            })
        };
        let phases = vec![(1.5, pushed(PlantInputs::rotor_speeds([speed; 4]), force))];
        let coarse = flown(&plant, &start, &phases, 1e-4);
        let fine = flown(&plant, &start, &phases, 1e-8);
        prop_assert!(coarse.events < 200 && fine.events < 200, "{} events, {}", coarse.events, fine.events);
        // A landing on feet spreads what a solver leaves open.
        let spread = difference(&plant, &coarse.state, &fine.state);
        prop_assert!(spread < 0.05, "{}", spread);
    }
}
