//! A flight depends on its messages and their simulation times, and is the one of the library.

mod common;

use common::recording::Recording;
use common::{Bench, settings};
use mavlink::dialects::common::{
    MavCmd, MavFrame, MavMessage, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use quadrotor::{Inputs, PositionReference, Simulation};
use vehicle::Mode;
use vehicle::identity::Identity;

fn place(x: f32, y: f32, z: f32, yaw: f32) -> MavMessage {
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(0b1001_1111_1000),
        x,
        y,
        z,
        yaw,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}

/// Goals of the flight: when, µs, and where.
const GOALS: [(u64, [f32; 4]); 3] = [
    (6_000_000, [5.0, 5.0, -10.0, 0.0]),
    (14_000_000, [5.0, 5.0, -10.0, 0.5]),
    (20_000_000, [-2.5, 1.0, -4.0, -1.0]),
];
const END_US: u64 = 30_000_000;

/// Armed and told to take off at the same instant, then sent from place to place; bit for bit the flight of the library
/// with the same goals at the same times.
#[test]
fn the_flight_through_messages_is_that_of_the_library() {
    let mut bench = Bench::new(Identity::Px4);
    bench.fly(1.0);
    let takeoff_us = bench.autopilot.vehicle().time_us();
    let start = bench.autopilot.vehicle().outputs().position_m;
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
    // Above home, which is where it was armed.
    let height = start.z - 2.5;
    let takeoff = PositionReference::goal([start.x, start.y, height], 0.0);

    let mut configuration = quadrotor::Configuration::default();
    configuration.environment.ground_plane = true;
    let goals = GOALS.map(|(time_us, goal)| {
        let [x, y, z, yaw] = goal.map(f64::from);
        (time_us, PositionReference::goal([x, y, z], yaw))
    });
    let inputs = |time_us: u64| Inputs {
        armed: time_us >= takeoff_us,
        reference: goals
            .iter()
            .rev()
            .find(|(from_us, _)| *from_us <= time_us)
            .map_or(takeoff, |(_, goal)| *goal),
        ..Inputs::default()
    };
    let mut library =
        Simulation::new(&configuration, &Inputs { armed: false, ..Inputs::default() }).expect("defaults");

    while bench.autopilot.vehicle().time_us() < END_US {
        let time_us = bench.autopilot.vehicle().time_us();
        let goal = GOALS.iter().rev().find(|(from_us, _)| *from_us <= time_us);
        if let Some((from_us, [x, y, z, yaw])) = goal {
            if time_us.is_multiple_of(50_000) {
                bench.send(place(*x, *y, *z, *yaw));
            }
            if time_us == *from_us && bench.mode() != Mode::Offboard {
                assert_eq!(bench.set_mode(Mode::Offboard), 0);
            }
        }
        bench.fly(0.001);
        let time_us = bench.autopilot.vehicle().time_us();
        library.advance_to(time_us, &inputs).expect("flight");
        let flown = bench.autopilot.vehicle().outputs();
        assert_eq!(*flown, library.outputs(), "at {time_us} µs");
    }
    assert!((library.outputs().position_m - nalgebra::Vector3::new(-2.5, 1.0, -4.0)).norm() < 0.05);
}

/// A record, replayed, is the same flight; a changed one is found out.
#[test]
fn a_record_replays_bit_for_bit() {
    let mut vehicle = settings(Identity::Px4);
    vehicle.wind = vehicle::world::WindSettings { speed_m_s: 4.0, from_rad: 1.0, gusts_m_s: 1.5, seed: 5 };
    vehicle.configuration.airframe.drag_n_s_m = [0.15; 3];
    let mut recording = Recording::of(&vehicle);
    let arm =
        common::command_long(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0);
    let offboard = common::command_long(MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0);
    for millisecond in 0..20_000_u32 {
        if millisecond >= 1_000 && millisecond % 37 == 0 {
            recording.send(place(millisecond as f32 / 2000.0, 3.0, -6.0, 0.3));
        }
        match millisecond {
            1_500 => recording.send(arm.clone()),
            1_600 => recording.send(offboard.clone()),
            _ => {}
        }
        recording.step();
    }
    assert!(recording.bench.position()[2] < -5.0);
    let record = recording.finish();
    assert_eq!(record.flight.time_us, 20_000_000);
    record.assert_same();

    // One set-point comes twenty milliseconds later.
    let text = record.text();
    let line = text.lines().find(|line| line.starts_with("frame 50")).expect("a frame at 5 s");
    let time = line.split(' ').nth(1).expect("a time");
    let later = line.replacen(time, &(time.parse::<u64>().expect("a time") + 20_000).to_string(), 1);
    record.assert_depends_on(line, &later);
    // What is no record is refused by its line.
    assert!(record.changed("frame ", "fame ").expect_err("no record").to_string().contains("line 2"));
}
