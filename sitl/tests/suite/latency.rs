//! How long a set-point takes to the motors, in simulated time.
//!
//! Two vehicles fly the same flight until one of them gets another set-point: their motors are commanded alike until it acts.

use crate::common::requests::local_target;
use mavlink::dialects::ardupilotmega::{AttitudeTargetTypemask, MavMessage, SET_ATTITUDE_TARGET_DATA};
use vehicle::identity::Identity;
use vehicle::{Mode, TICK_US};

use super::common::Bench;

/// Set-points per second.
const RATES_HZ: [u64; 4] = [50, 100, 250, 1000];

/// Level, with a share of the thrust.
fn thrust(changed: bool) -> MavMessage {
    MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
        target_system: 1,
        target_component: 1,
        type_mask: AttitudeTargetTypemask::from_bits_retain(0b111),
        q: [1.0, 0.0, 0.0, 0.0],
        thrust: if changed { 0.2 } else { 0.1 },
        ..SET_ATTITUDE_TARGET_DATA::default()
    })
}

/// A velocity down, with a heading.
fn velocity(changed: bool) -> MavMessage {
    local_target(0b100111000111, [0.0; 3], [0.0, 0.0, if changed { -1.0 } else { 0.0 }])
}

/// On the ground, armed, with too little thrust to lift off.
fn standing() -> Bench {
    let mut bench = Bench::new(Identity::Px4);
    bench.send(thrust(false));
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.arm();
    bench
}

fn hovering() -> Bench {
    let mut bench = Bench::hovering(Identity::Px4);
    bench.send(velocity(false));
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench
}

fn motors(bench: &Bench) -> [f64; 4] {
    bench.autopilot.vehicle().simulation().rotor_command_rad_s()
}

/// Ticks from another set-point to other motors, in a stream with a set-point each `period` ticks that changes after `phase` ticks.
fn latency(start: fn() -> Bench, set_point: fn(bool) -> MavMessage, period: u64, phase: u64) -> u64 {
    let mut twins = [start(), start()];
    let mut changed = None;
    for tick in 0.. {
        if tick % period == phase % period {
            if changed.is_none() && tick >= 200 + phase {
                changed = Some(tick);
            }
            twins[0].send(set_point(false));
            twins[1].send(set_point(changed.is_some()));
        }
        twins.iter_mut().for_each(|bench| bench.fly(0.001));
        let alike = motors(&twins[0]) == motors(&twins[1]);
        match changed {
            Some(changed) if !alike => return tick + 1 - changed,
            Some(changed) => assert!(tick - changed < 1_000, "no effect"),
            None => assert!(alike, "the same flight"),
        }
    }
    unreachable!("the loop has no end")
}

/// Prints the mean and the longest latency over some phases between set-points and samples of a controller, ms, and checks the latter.
fn check(what: &str, start: fn() -> Bench, set_point: fn(bool) -> MavMessage, most_ms: u64, phases: &[u64]) {
    assert_eq!(TICK_US, 1_000);
    for rate_hz in RATES_HZ {
        let latencies: Vec<u64> =
            phases.iter().map(|phase| latency(start, set_point, 1_000 / rate_hz, *phase)).collect();
        let longest = latencies.iter().copied().max().expect("phases");
        let mean = latencies.iter().sum::<u64>() as f64 / latencies.len() as f64;
        println!("{what} at {rate_hz} Hz: mean {mean:.1} ms, longest {longest} ms");
        assert!(longest <= most_ms, "{what} at {rate_hz} Hz: {latencies:?} ms");
    }
}

#[test]
fn a_thrust_reaches_the_motors_within_a_sample_of_the_attitude_controller() {
    check("thrust", standing, thrust, 10, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
}

#[test]
fn a_velocity_reaches_the_motors_within_a_sample_of_the_altitude_controller() {
    // A reference begins where the vehicle is: of one that begins with a sample, the next sample sees the first difference.
    check("velocity", hovering, velocity, 50 + 1, &[0, 10, 20, 30, 40]);
}
