//! Limits that are lowered in flight hold as far as the motion can keep them: no goal is overshot for their sake. And goals farther
//! away than any flight.

use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use quadrotor::{
    Access, Configuration, Inputs, Limits, PARAMETERS, Parameter, PositionReference, Simulation,
};

use crate::common::goal;

const START_M: [f64; 3] = [0.0, 0.0, -10.0];
/// Between two observations, µs.
const LOOK_US: u64 = 50_000;

/// How far flights of the table may leave their way beyond what the unchanged ones do: what controllers make of a reference that
/// does not leave it, m and rad.
const MARGIN_M: f64 = 0.12;
const MARGIN_RAD: f64 = 0.02;

/// Climb, descent, cruise and a turn in all axes: goal, m, and heading, rad.
const FLIGHTS: [([f64; 3], f64); 4] = [
    ([0.0, 0.0, -20.0], 0.0),
    ([0.0, 0.0, -3.0], 0.0),
    ([40.0, 0.0, -10.0], 0.0),
    ([10.0, 10.0, -14.0], 2.5),
];

fn base(shaping: bool) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.initial.position_m = START_M;
    configuration.reference.shaping = shaping;
    configuration
}

/// How far a flight leaves the way between its start and its goal.
#[derive(Clone, Copy, Debug, Default)]
struct Excursion {
    beyond_m: f64,
    heading_rad: f64,
    /// Height above the ground, if there were one at z = 0, m.
    lowest_m: f64,
}

fn beyond(value: f64, from: f64, to: f64) -> f64 {
    (from.min(to) - value).max(value - from.max(to)).max(0.0)
}

/// Flies for a while and observes.
fn fly_on(flight: &mut Simulation, inputs: &Inputs, seconds: f64) -> Excursion {
    let goal = &inputs.reference;
    let mut excursion = Excursion { lowest_m: f64::INFINITY, ..Excursion::default() };
    let begin_us = flight.time_us();
    for look in 1..=(seconds * 1e6) as u64 / LOOK_US {
        flight.advance_to(begin_us + look * LOOK_US, inputs).expect("the flight goes on");
        let now = flight.outputs();
        for (axis, start_m) in START_M.into_iter().enumerate() {
            let beyond_m = beyond(now.position_m[axis], start_m, goal.position_m[axis]);
            excursion.beyond_m = excursion.beyond_m.max(beyond_m);
        }
        excursion.heading_rad = excursion.heading_rad.max(beyond(now.setpoint.yaw_rad, 0.0, goal.yaw_rad));
        excursion.lowest_m = excursion.lowest_m.min(-now.position_m.z);
    }
    excursion
}

fn lowered(parameter: &Parameter, base: &Configuration, to_minimum: bool) -> Configuration {
    let Access::Real { minimum, get, set, .. } = parameter.access else { panic!("a limit is a real number") };
    let mut low = *base;
    set(&mut low, if to_minimum { minimum } else { (get(base) / 10.0).max(minimum) });
    if parameter.name == "limits.tilt" {
        // More than the tilt can make is refused.
        low.limits.acceleration_horizontal_m_s2 = 0.12;
    }
    low
}

fn check_table(shaping: bool, changes_us: &[u64]) {
    let base = base(shaping);
    for (goal_m, yaw_rad) in FLIGHTS {
        let inputs = goal(goal_m, yaw_rad);
        let unchanged = fly_on(&mut Simulation::new(&base, &inputs).unwrap(), &inputs, 30.0);
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.name.starts_with("limits.")) {
            for (change_us, to_minimum) in changes_us.iter().flat_map(|time| [(time, true), (time, false)]) {
                let mut flight = Simulation::new(&base, &inputs).unwrap();
                flight.advance_to(*change_us, &inputs).unwrap();
                flight.reconfigure(&lowered(parameter, &base, to_minimum)).unwrap();
                let excursion = fly_on(&mut flight, &inputs, 30.0);
                let told =
                    || format!("{} {to_minimum} at {change_us} to {goal_m:?}: {excursion:?}", parameter.name);
                assert!(excursion.beyond_m < unchanged.beyond_m + MARGIN_M, "{}", told());
                assert!(excursion.heading_rad < unchanged.heading_rad + MARGIN_RAD, "{}", told());
            }
        }
    }
}

#[test]
fn no_lowered_limit_leads_a_shaped_flight_off_its_way() {
    check_table(true, &[1_000_000, 3_500_000]);
}

#[test]
fn no_lowered_limit_leads_an_unshaped_flight_off_its_way() {
    check_table(false, &[2_500_000]);
}

/// A descent whose jerk is lowered arrives without going back up on its way: what it has begun is ended with the jerk that this needs.
#[test]
fn a_descent_does_not_turn_back_on_its_way() {
    let inputs = goal([0.0, 0.0, -3.0], 0.0);
    for change_us in [600_000, 1_000_000, 1_500_000, 2_500_000] {
        for jerk_m_s3 in [1.0, 0.4] {
            let mut flight = Simulation::new(&base(true), &inputs).unwrap();
            flight.advance_to(change_us, &inputs).unwrap();
            let mut low = base(true);
            low.limits.jerk_vertical_m_s3 = jerk_m_s3;
            flight.reconfigure(&low).unwrap();
            let (mut lowest_m, mut back_m): (f64, f64) = (f64::NEG_INFINITY, 0.0);
            for look in 1..=400 {
                flight.advance_to(change_us + look * LOOK_US, &inputs).unwrap();
                let z_m = flight.outputs().position_m.z;
                lowest_m = lowest_m.max(z_m);
                back_m = back_m.max(lowest_m - z_m);
            }
            assert!(back_m < 0.02, "{jerk_m_s3} m/s³ at {change_us} us: {back_m} m back up");
            assert!((flight.outputs().position_m.z + 3.0).abs() < 0.01);
        }
    }
}

/// With less jerk an acceleration is taken out too late: both ended far away, one of them in the ground.
#[test]
fn less_jerk_on_the_way_up_and_down_ends_at_the_goal() {
    for (goal_z_m, jerk_m_s3) in [(-3.0, 1.0), (-20.0, 0.4)] {
        let inputs = goal([0.0, 0.0, goal_z_m], 0.0);
        let mut flight = Simulation::new(&base(true), &inputs).unwrap();
        flight.advance_to(1_000_000, &inputs).unwrap();
        let mut low = base(true);
        low.limits.jerk_vertical_m_s3 = jerk_m_s3;
        flight.reconfigure(&low).unwrap();
        let excursion = fly_on(&mut flight, &inputs, 60.0);
        assert!(excursion.beyond_m < 0.02 && excursion.lowest_m > 2.9, "{goal_z_m}: {excursion:?}");
        let end = flight.outputs();
        assert!((end.position_m.z - goal_z_m).abs() < 0.01 && end.velocity_m_s.norm() < 0.01, "{end:?}");
    }
}

/// Where nothing speaks against it a lower limit holds at once: far from the goal, at an even speed.
#[test]
fn a_lower_speed_is_braked_to_at_once_with_the_lower_acceleration() {
    let inputs = goal([200.0, 0.0, -10.0], 0.0);
    let mut flight = Simulation::new(&base(true), &inputs).unwrap();
    flight.advance_to(8_000_000, &inputs).unwrap();
    assert!(flight.outputs().setpoint.velocity_m_s.x > 7.8);
    let mut low = base(true);
    low.limits = Limits {
        speed_horizontal_m_s: 2.0,
        acceleration_horizontal_m_s2: 1.0,
        jerk_horizontal_m_s3: 1.0,
        ..low.limits
    };
    flight.reconfigure(&low).unwrap();
    let mut before = flight.outputs().setpoint;
    for look in 1..=240 {
        flight.advance_to(8_000_000 + look * LOOK_US, &inputs).unwrap();
        let now = flight.outputs().setpoint;
        assert!(now.acceleration_m_s2.norm() < 1.0, "{now:?}");
        let jump_m_s2 = (now.acceleration_m_s2 - before.acceleration_m_s2).norm();
        assert!(jump_m_s2 < 0.06, "{jump_m_s2} m/s² in 50 ms");
        before = now;
    }
    assert!((before.velocity_m_s.x - 1.96).abs() < 1e-6, "{before:?}");
}

/// While a motion needs the old limits they are state, to be saved and restored.
#[test]
fn a_saved_flight_goes_on_with_the_limits_that_it_needs() {
    let inputs = goal([0.0, 0.0, -3.0], 0.0);
    let mut flight = Simulation::new(&base(true), &inputs).unwrap();
    flight.advance_to(1_500_000, &inputs).unwrap();
    let mut low = base(true);
    low.limits.jerk_vertical_m_s3 = 0.2;
    low.limits.tilt_rate_rad_s = 0.5;
    flight.reconfigure(&low).unwrap();
    flight.advance_to(1_700_000, &inputs).unwrap();
    let mut other = Simulation::new(&low, &inputs).unwrap();
    other.restore(flight.state()).unwrap();
    for time_us in [2_000_000, 3_000_000, 20_000_000] {
        flight.advance_to(time_us, &inputs).unwrap();
        other.advance_to(time_us, &inputs).unwrap();
        assert_eq!(flight.outputs(), other.outputs());
    }
    assert!((flight.outputs().position_m.z + 3.0).abs() < 0.01, "{:?}", flight.outputs().position_m);
}

fn factors() -> impl Strategy<Value = [f64; 7]> {
    prop::array::uniform7(prop_oneof![1 => Just(1.0), 2 => 0.03..1.0_f64])
}

fn scaled(limits: &Limits, by: [f64; 7]) -> Limits {
    let [speed, climb, sink, horizontal, vertical, jerk_horizontal, jerk_vertical] = by;
    Limits {
        speed_horizontal_m_s: (limits.speed_horizontal_m_s * speed).max(0.5),
        speed_up_m_s: (limits.speed_up_m_s * climb).max(0.5),
        speed_down_m_s: (limits.speed_down_m_s * sink).max(0.5),
        acceleration_horizontal_m_s2: (limits.acceleration_horizontal_m_s2 * horizontal).max(0.1),
        acceleration_vertical_m_s2: (limits.acceleration_vertical_m_s2 * vertical).max(0.1),
        jerk_horizontal_m_s3: (limits.jerk_horizontal_m_s3 * jerk_horizontal).max(0.1),
        jerk_vertical_m_s3: (limits.jerk_vertical_m_s3 * jerk_vertical).max(0.1),
        ..*limits
    }
}

fn place() -> impl Strategy<Value = [f64; 3]> {
    (-30.0..30.0_f64, -30.0..30.0_f64, -40.0..-2.0_f64).prop_map(|(x, y, z)| [x, y, z])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    /// Any of them lowered together at any time, with another goal at that moment or without: the reference goes no farther past
    /// its goal, axis by axis, than with the limits that it began with, keeps those throughout, comes to rest at the goal, and the
    /// next flight keeps the new ones.
    #[test]
    fn a_reference_under_lowered_limits_goes_no_farther(
        first in place(), second in prop::option::of(place()), change_us in 100_000_u64..8_000_000, by in factors(),
    ) {
        let base = base(true);
        let before = goal(first, 0.0);
        let mut unchanged = Simulation::new(&base, &before).unwrap();
        unchanged.advance_to(change_us, &before).unwrap();
        let mut changed = unchanged.clone();
        let low = Configuration { limits: scaled(&base.limits, by), ..base };
        changed.reconfigure(&low).unwrap();
        let after = goal(second.unwrap_or(first), 0.0);
        let from_m = unchanged.outputs().setpoint.position_m;
        // Along the way to the goal and across it, as the plans are made.
        let way_m = after.reference.position_m - from_m;
        let bearing = Rotation3::from_euler_angles(0.0, 0.0, way_m.y.atan2(way_m.x)).inverse();
        let to_m = bearing * way_m;
        let observe = |flight: &mut Simulation| {
            let (mut past_m, mut worst) = (Vector3::<f64>::zeros(), None);
            for look in 1..=2_400 {
                flight.advance_to(change_us + look * LOOK_US, &after).unwrap();
                let now = flight.outputs().setpoint;
                let at_m = bearing * (now.position_m - from_m);
                for axis in 0..3 {
                    past_m[axis] = beyond(at_m[axis], 0.0, to_m[axis]).max(past_m[axis]);
                }
                let (v, a) = (now.velocity_m_s, now.acceleration_m_s2);
                let limits = &base.limits;
                let fits = v.xy().norm() < limits.speed_horizontal_m_s + 0.01
                    && v.z < limits.speed_down_m_s + 0.01 && v.z > -limits.speed_up_m_s - 0.01
                    && a.xy().norm() < limits.acceleration_horizontal_m_s2 + 0.01
                    && a.z.abs() < limits.acceleration_vertical_m_s2 + 0.01;
                if !fits { worst = Some(now); }
            }
            (past_m, worst)
        };
        let (free_m, _) = observe(&mut unchanged);
        let (past_m, worst) = observe(&mut changed);
        prop_assert_eq!(worst, None);
        for axis in 0..3 {
            // The plan's axes may be turned by one sample's motion relative to these, and share the limits otherwise than without lower ones:
            // a flight to (−18.8, 12.2) m that is sent to (−6.4, 13.5) m after 3.35 s, at 0.14 of the speed limit, goes 2.4 % farther across.
            prop_assert!(past_m[axis] <= 1.03 * free_m[axis] + 0.02, "{past_m} {free_m}");
        }
        let end = changed.outputs().setpoint;
        prop_assert!((end.position_m - after.reference.position_m).norm() < 1e-3, "{end:?}");
        prop_assert!(end.velocity_m_s.norm() < 1e-3, "{end:?}");
        // The next flight.
        let next = goal([0.0, 0.0, -20.0], 0.0);
        let begin_us = changed.time_us();
        for look in 1..=200 {
            changed.advance_to(begin_us + look * LOOK_US, &next).unwrap();
            let (v, a) = (changed.outputs().setpoint.velocity_m_s, changed.outputs().setpoint.acceleration_m_s2);
            let limits = &low.limits;
            prop_assert!(v.xy().norm() < limits.speed_horizontal_m_s + 0.01, "{v}");
            prop_assert!(a.xy().norm() < limits.acceleration_horizontal_m_s2 + 0.01, "{a}");
            prop_assert!(a.z.abs() < limits.acceleration_vertical_m_s2 + 0.01, "{a}");
        }
    }
}

/// However far the goal is the vehicle sets out towards it, and keeps its speed.
#[test]
fn goals_beyond_every_flight_are_flown_towards() {
    for distance_m in [1e4, 2.1e4, 1e5, 1e6, 1e9, 1e12, 1e100, 1e300] {
        for shaping in [true, false] {
            let reference = PositionReference::goal([distance_m, -distance_m / 3.0, -distance_m], distance_m);
            let inputs = Inputs { reference, ..Inputs::default() };
            let mut flight = Simulation::new(&base(shaping), &inputs).unwrap();
            flight.advance_to(20_000_000, &inputs).unwrap();
            let now = flight.outputs();
            let speed_m_s = now.velocity_m_s;
            let told = format!("{distance_m:e}, shaping {shaping}: {speed_m_s}");
            assert!(speed_m_s.iter().chain(&now.position_m).all(|value| value.is_finite()), "{told}");
            assert!(
                speed_m_s.x > 3.9 && speed_m_s.x < 8.2 && speed_m_s.z < -3.6 && speed_m_s.z > -4.1,
                "{told}"
            );
            assert!((speed_m_s.y + speed_m_s.x / 3.0).abs() < 0.2, "{told}");
        }
    }
}

/// Plans reach 20 km: a longer way is planned in parts, without slowing down between them.
#[test]
fn a_way_longer_than_a_plan_is_flown_through() {
    let mut configuration = base(true);
    configuration.limits.speed_horizontal_m_s = 50.0;
    let inputs = goal([45_000.0, 0.0, -10.0], 0.0);
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    for second in 30..880 {
        flight.advance_to(second * 1_000_000, &inputs).unwrap();
        assert!((flight.outputs().setpoint.velocity_m_s.x - 49.0).abs() < 1e-6, "after {second} s");
    }
    flight.advance_to(1_000_000_000, &inputs).unwrap();
    assert!((flight.outputs().position_m.x - 45_000.0).abs() < 0.01, "{:?}", flight.outputs().position_m);
}
