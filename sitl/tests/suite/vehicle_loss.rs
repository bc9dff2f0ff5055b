//! A vehicle whose simulation fails ends alone: its clients are told, its files are complete, the others fly on.

use std::net::UdpSocket;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::common::seal::sealed;
use autopilot::codec::{Frame, id};
use clap::Parser;
use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MavState, STATUSTEXT_DATA};
use quadrotor::SimulationError;
use sitl::configuration::{Arguments, Settings};
use sitl::record::{RecordEnd, replay};
use sitl::{Failure, Session, Summary};
use vehicle::FlightError;

const END_US: u64 = 6_000_000;
/// No range allows this wind, m/s: it carries a vehicle out of the numbers within seconds.
const IMPOSSIBLE_WIND_M_S: f64 = 2e12;

/// A fleet, the second vehicle of which is lost.
fn settings(line: &str, folder: &Path) -> Settings {
    let path = |name: &str| folder.join(name).display().to_string();
    let line = format!(
        "lmpc-sitl --link udpin:0 --speed max --duration 6 --log-dir {} --record {} --tlog {} --parameters {} {line}",
        folder.display(),
        path("a.record"),
        path("a.tlog"),
        path("a.params"),
    );
    let mut settings =
        Settings::resolve(&Arguments::try_parse_from(line.split_whitespace()).expect("a command line"))
            .expect("valid");
    let last = settings.vehicles.len().min(2) - 1;
    let lost = &mut settings.vehicles[last].vehicle;
    lost.configuration.airframe.drag_n_s_m = [0.1; 3];
    lost.wind.speed_m_s = IMPOSSIBLE_WIND_M_S;
    settings
}

fn flown(settings: Settings) -> Summary {
    Session::new(settings).expect("free ports").run(&Arc::new(AtomicBool::new(false)))
}

/// The frames that a system sent, in order.
fn sent_by(system: u8, folder: &Path) -> Vec<Frame> {
    const TIME: usize = 8;
    let bytes = std::fs::read(folder.join("a.tlog")).expect("a log");
    let mut rest = bytes.as_slice();
    let mut frames = Vec::new();
    while rest.len() > TIME + 1 {
        // MAVLink 2 without signature: ten bytes before the payload, two after it.
        let length = 12 + usize::from(rest[TIME + 1]);
        let (frame, next) = rest[TIME..].split_at(length);
        frames.push(Frame::parse(frame).expect("a frame"));
        rest = next;
    }
    frames.retain(|frame| frame.system() == system);
    frames
}

#[test]
fn one_of_a_fleet_is_lost_and_the_others_fly_the_same_flights() {
    for sharing in ["--ports own", "--ports shared", "--ports shared --clocks separate", "--lockstep"] {
        let folder = tempfile::tempdir().expect("a folder");
        let line = format!("--vehicles 3 --formation line,3 {sharing}");
        let summary = flown(settings(&line, folder.path()));
        let [loss] = summary.losses.as_slice() else { panic!("{sharing}: {:?}", summary.losses) };
        let FlightError::Simulation(SimulationError::Diverged { time_us, overload: Some(overload) }) =
            loss.error
        else {
            panic!("{loss}")
        };
        assert_eq!((loss.system_id, overload.name), (2, "wind.velocity.x"));
        let times: Vec<u64> = summary.flights.iter().map(|flight| flight.time_us).collect();
        assert_eq!(times, [END_US, time_us - 1000, END_US], "{sharing}: the last good tick");
        assert!(time_us > 1_000_000, "{sharing}: it flew");
        assert_eq!(summary.incomplete, Vec::<String>::new());

        // The same fleet without a loss.
        let other = tempfile::tempdir().expect("a folder");
        let mut calm = settings(&line, other.path());
        calm.vehicles[1].vehicle.wind.speed_m_s = 0.0;
        let calm = flown(calm);
        assert_eq!(calm.losses, []);
        for survivor in [0, 2] {
            assert_eq!(summary.flights[survivor], calm.flights[survivor], "{sharing}");
        }

        let replayed = replay(&folder.path().join("a.record")).expect("the same flights");
        let ends: Vec<RecordEnd> = replayed.iter().map(|replayed| replayed.end).collect();
        assert_eq!(ends, [RecordEnd::Complete, RecordEnd::Failure, RecordEnd::Complete]);
        for (replayed, flight) in replayed.iter().zip(&summary.flights) {
            assert_eq!((replayed.flight, replayed.verified_us), (*flight, flight.time_us), "{sharing}");
        }
    }
}

#[test]
fn clients_are_told_once_and_hear_no_more() {
    let folder = tempfile::tempdir().expect("a folder");
    let client = UdpSocket::bind("127.0.0.1:0").expect("a free port");
    let address = client.local_addr().expect("it is bound");
    let line = format!("--vehicles 2 --ports shared --link udpout:{address}");
    let summary = flown(settings(&line, folder.path()));
    let lost_us = summary.flights[1].time_us;
    let frames = sent_by(2, folder.path());
    let states: Vec<u8> = frames
        .iter()
        .filter(|frame| frame.message_id() == id::HEARTBEAT)
        .map(|frame| frame.payload().u8(7))
        .collect();
    let (last, before) = states.split_last().expect("heartbeats");
    assert_eq!(*last, MavState::MAV_STATE_FLIGHT_TERMINATION as u8);
    assert!(before.iter().all(|state| *state == MavState::MAV_STATE_STANDBY as u8), "{states:?}");
    assert!(states.len() as u64 <= 4 + lost_us / 1_000_000, "{states:?}");
    assert_eq!(frames.last().map(Frame::message_id), Some(id::HEARTBEAT));
    let texts = frames.iter().filter(|frame| frame.message_id() == STATUSTEXT_DATA::ID);
    let texts: Vec<String> = texts.map(|frame| frame.payload().name(1)).collect();
    assert!(texts.iter().any(|text| text.starts_with("Simulation")), "{texts:?}");
    assert!(sent_by(1, folder.path()).len() > frames.len());
}

#[test]
fn the_run_ends_with_its_last_vehicle() {
    // Without a client, one that waits for set-points does not fly.
    for line in ["", "--lockstep"] {
        let folder = tempfile::tempdir().expect("a folder");
        let summary = flown(settings(line, folder.path()));
        assert_eq!(summary.losses.len(), 1);
        assert!(summary.flights[0].time_us < END_US);
        let failure = Failure::Lost(summary.losses);
        assert_eq!(failure.exit_code(), 1);
        let text = failure.to_string();
        assert!(text.starts_with("the simulation failed: system 1: the motion has diverged at "), "{text}");
        let replayed = replay(&folder.path().join("a.record")).expect("the same flight");
        assert_eq!((replayed[0].end, replayed[0].flight), (RecordEnd::Failure, summary.flights[0]));
    }
}

#[test]
fn a_replay_that_does_not_fail_is_another_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut calm = settings("", folder.path());
    calm.vehicles[0].vehicle.wind.speed_m_s = 0.0;
    assert_eq!(flown(calm).losses, []);
    let path = folder.path().join("a.record");
    let text = std::fs::read_to_string(&path).expect("a record");
    let (before, end) = text.rsplit_once("end ").expect("it is complete");
    std::fs::write(&path, sealed(&format!("{before}failure {end}"))).expect("written");
    let failure = replay(&path).expect_err("it flies on");
    assert!(matches!(failure, Failure::FliesOn { system_id: 1, time_us: END_US }), "{failure}");
    assert_eq!(failure.exit_code(), 5);
}
