//! A flight depends on its messages and their simulation times, and is the one of the library.

use crate::common;
use crate::common::recording::{Record, Recording};
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, MavCmd, MavFrame, MavMessage, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use quadrotor::{Inputs, PositionReference, Simulation};
use sitl::Failure;
use sitl::record::RecordEnd;
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
    let mut vehicle = settings(Identity::Px4);
    // The library knows no slow takeoffs.
    vehicle.conduct.speeds.takeoff_m_s = vehicle.configuration.limits.speed_up_m_s;
    let mut bench = Bench::of(&vehicle);
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
    // What is not an entry is refused by its line.
    let reason = record.changed("frame ", "fame ").expect_err("no record").to_string();
    assert!(reason.contains("line 2 is not an entry"), "{reason}");
}

/// A record of a flight on the ground: a heartbeat every 0.1 s, and the state every second, as the program writes it.
fn short_record(seconds: u32) -> Record {
    let mut recording = Recording::of(&settings(Identity::Px4));
    for millisecond in 0..seconds * 1000 {
        if millisecond % 100 == 50 {
            recording.send(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        }
        if millisecond % 1000 == 0 {
            recording.note_state();
        }
        recording.step();
    }
    recording.finish()
}

/// Cut anywhere behind its header, by kill -9 or a full disk, a record replays up to its last whole line.
#[test]
fn a_cut_record_replays_up_to_its_last_whole_line() {
    let record = short_record(3);
    let text = record.text();
    let header = text.lines().next().expect("a header").len() + 1;
    for at in (header..text.len()).step_by(97).chain([header, text.len() - 1]) {
        let replayed = record.replay_text(&text[..at]).unwrap_or_else(|failure| panic!("{at}: {failure}"));
        let whole: Vec<&str> =
            text[..at].split_inclusive('\n').filter(|line| line.ends_with('\n')).skip(1).collect();
        let time_us = |line: &&str| line.split(' ').nth(1).expect("a time").parse::<u64>().expect("a time");
        let states = whole.iter().filter(|line| line.starts_with("state"));
        assert_eq!(replayed[0].end, RecordEnd::Cut, "{at}");
        assert_eq!(replayed[0].flight.time_us, whole.last().map_or(0, time_us), "{at}");
        assert_eq!(replayed[0].verified_us, states.map(time_us).max().unwrap_or(0), "{at}");
    }
    let headless = record.replay_text(&text[..header - 1]).expect_err("half a header").to_string();
    assert!(headless.contains("line 1, the header"), "{headless}");
}

/// No change of a single character goes unnoticed, wherever it is; and the place and time are named.
#[test]
fn damage_is_refused_by_line_and_time() {
    let record = short_record(3);
    let text = record.text();
    let header = text.find('\n').expect("a header");
    // Without its last line feed a record counts as cut.
    for at in (header / 2..text.len() - 1).step_by(53) {
        let mut bytes = text.clone().into_bytes();
        bytes[at] = if bytes[at] == b'7' { b'8' } else { b'7' };
        let damaged = String::from_utf8(bytes).expect("text");
        let result = record.replay_text(&damaged);
        let failure = result.expect_err("damaged").to_string();
        let line = text[..=at].lines().count();
        assert!(
            failure.contains(&format!("line {line}, ")) && failure.contains("is damaged"),
            "{at}: {failure}"
        );
    }
    // The end is moved hours away.
    let moved = text.replace("end 3000000", "end 30000000000");
    let failure = record.replay_text(&moved).expect_err("damaged").to_string();
    assert!(failure.contains("the entry after 2.950000 s of simulation time, is damaged"), "{failure}");
    // A line that is lost, moved or doubled.
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    for lines in [
        [&lines[..5], &lines[6..]].concat(),
        [&lines[..5], &[lines[6], lines[5]], &lines[7..]].concat(),
        [&lines[..6], &lines[5..]].concat(),
    ] {
        let failure = record.replay_text(&lines.concat()).expect_err("damaged").to_string();
        assert!(failure.contains("line "), "{failure}");
    }
    // Of an older release.
    let older = text.replace("record 3", "record 2");
    assert!(record.replay_text(&older).expect_err("older").to_string().contains("format 2"));
}

/// With right checksums, another state is noticed when it is recorded, not at the end.
#[test]
fn a_flight_that_differs_is_noticed_at_the_first_state() {
    let record = short_record(3);
    let text = record.text();
    let state = text.lines().find(|line| line.starts_with("state 2000000")).expect("a state");
    let digest = state.split(' ').nth(3).expect("a digest");
    let failure = record.changed(digest, "0123456789abcdef").expect_err("another flight");
    assert!(matches!(failure, Failure::Differs { time_us: 2_000_000, system_id: 1, .. }), "{failure}");
}

/// A record that reaches its limit stops with the state of every flight, and replays up to there.
#[test]
fn a_full_record_replays_up_to_its_limit() {
    let vehicle = settings(Identity::Px4);
    let mut recording = Recording::limited(&vehicle, 20_000);
    let mut stopped_us = None;
    for millisecond in 0..20_000_u32 {
        if millisecond % 20 == 0 {
            recording.send(place(0.0, 0.0, -1.0, 0.0));
        }
        if recording.stop_if_full() {
            stopped_us = Some(u64::from(millisecond) * 1000);
        }
        recording.step();
    }
    let stopped_us = stopped_us.expect("it was full");
    let record = recording.finish();
    let size = record.text().len();
    assert!((20_000..20_400).contains(&size), "{size}");
    let replayed = record.replay_text(&record.text()).expect("the same flight");
    let [only] = replayed[..] else { panic!("{replayed:?}") };
    assert_eq!((only.end, only.flight.time_us, only.verified_us), (RecordEnd::Limit, stopped_us, stopped_us));
}
