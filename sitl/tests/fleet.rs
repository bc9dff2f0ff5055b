//! Several vehicles in one run: their settings, and that none notices the others.

mod common;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Parser;
use sitl::configuration::{Arguments, Settings};
use sitl::record::Digest;
use sitl::{Autopilot, Session};

fn settings(line: &str) -> Result<Settings, sitl::Failure> {
    let words = ["lmpc-sitl"].into_iter().chain(line.split_whitespace());
    Settings::resolve(&Arguments::try_parse_from(words).expect(line))
}

#[test]
fn vehicles_have_ids_ports_starts_seeds_and_files_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    let own = settings(&format!(
        "--vehicles 3 --system-id 20 --instance 4 --formation line,2.5 --seed 9 --parameters {}",
        file("b.c").display()
    ))
    .expect("settings");
    let ids: Vec<u8> = own.vehicles.iter().map(|vehicle| vehicle.system_id).collect();
    assert_eq!(ids, [20, 21, 22]);
    let links: Vec<String> = own.hubs.iter().map(|links| links[1].to_string()).collect();
    assert_eq!(
        links,
        [
            "udpout:127.0.0.1:14544@14584,onboard",
            "udpout:127.0.0.1:14545@14585,onboard",
            "udpout:127.0.0.1:14546@14586,onboard"
        ]
    );
    for (number, vehicle) in own.vehicles.iter().enumerate() {
        assert_eq!(vehicle.vehicle.configuration.initial.position_m, [0.0, 2.5 * number as f64, 0.0]);
        assert_eq!(vehicle.vehicle.wind.seed, 9 + number as u64);
        assert_eq!(vehicle.hub, number);
        assert_eq!(vehicle.parameters, Some(file(&format!("b-{}.c", 20 + number))));
        assert_eq!(vehicle.vehicle.origin, own.vehicles[0].vehicle.origin);
    }
    assert_eq!(own.clocks().len(), 1);

    let shared = settings("--vehicles 2 --ports shared --clocks separate --link tcpin:0").expect("settings");
    assert_eq!((shared.hubs.len(), shared.clocks().len()), (1, 2));
    let one = settings(&format!("--parameters {}", file("b.c").display())).expect("settings");
    assert_eq!(one.vehicles[0].parameters, Some(file("b.c")));
}

#[test]
fn what_does_not_fit_is_refused_by_its_name() {
    for (line, words) in [
        ("--vehicles 200 --instance 60", "system 61 on need system 260"),
        ("--vehicles 2 --system-id 250", "the last is 250"),
        ("--vehicles 2 --link serial:/dev/null", "leaves no port to vehicle 2"),
        ("--vehicles 2 --link tcpin:65535", "leaves no port to vehicle 2"),
    ] {
        let error = settings(line).expect_err(line).to_string();
        assert!(error.contains(words), "{error}");
    }
    for wrong in ["--vehicles 0", "--vehicles 251", "--ports mine", "--clocks none", "--formation star"] {
        let words = ["lmpc-sitl"].into_iter().chain(wrong.split_whitespace());
        assert!(Arguments::try_parse_from(words).is_err(), "{wrong}");
    }
}

/// Each vehicle of a run flies as it flies alone, whoever else shares its ports and its clock.
#[test]
fn a_flight_among_others_is_the_flight_alone() {
    const LINE: &str =
        "--vehicles 4 --formation grid,3 --wind 5,40 --gusts 1.5 --link udpin:0 --speed max --duration 3";
    let mut digests = Vec::new();
    for sharing in ["--ports own", "--ports shared", "--clocks separate"] {
        let settings = settings(&format!("{LINE} {sharing}")).expect("settings");
        let vehicles = settings.vehicles.clone();
        let session = Session::new(settings).expect("free ports");
        let summary = session.run(&Arc::new(AtomicBool::new(false))).expect("a flight");
        assert_eq!(summary.flights.len(), 4);
        for (flight, own) in summary.flights.iter().zip(vehicles) {
            let mut alone = Autopilot::new(&own.vehicle, own.system_id, sitl::parameters::Speed::Max, &[], 5)
                .expect("valid");
            let mut digest = Digest::default();
            while alone.vehicle().time_us() < 3_000_000 {
                alone.tick().expect("a flight");
                digest.update(alone.vehicle());
            }
            let expected =
                sitl::Flight { system_id: own.system_id, time_us: 3_000_000, digest: digest.value() };
            assert_eq!(*flight, expected, "{sharing}");
            digests.push(flight.digest);
        }
    }
    digests.sort_unstable();
    digests.dedup();
    assert_eq!(digests.len(), 4, "four starts and four winds are four flights");
}
