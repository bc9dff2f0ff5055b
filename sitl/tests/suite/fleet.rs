//! Several vehicles in one run: their settings, and that none notices the others.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use autopilot::Autopilot;
use clap::Parser;
use sitl::Session;
use sitl::configuration::{self, Arguments, MemberSettings, Settings};
use sitl::record::Digest;
use vehicle::VehicleSettings;
use vehicle::plan::PlanKind;

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

/// A plan or a fault with an id in front is of that vehicle; a plan of its own goes before that of all.
#[test]
fn plans_and_faults_are_of_all_or_of_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, count: usize| {
        let path = folder.path().join(name);
        let line = |number: usize| format!("{number} 0 3 16 0 0 0 0 47.3978 8.5456 10 1\n");
        let lines: String = (0..count).map(line).collect();
        std::fs::write(&path, format!("QGC WPL 110\n{lines}")).expect("written");
        path.display().to_string()
    };
    let (all, own) = (file("all.waypoints", 2), file("own.waypoints", 3));
    let line = format!(
        "--vehicles 3 --system-id 4 --mission {all} --mission 5:{own} --fault 5:9:rotor1=weak:0.5 --fault 7:rotor2=off"
    );
    let counts = |settings: &Settings| {
        let plan = |vehicle: &VehicleSettings| vehicle.plans.get(PlanKind::Mission).items().len();
        let of = |member: &MemberSettings| (plan(&member.vehicle), member.vehicle.faults.len());
        settings.vehicles.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(counts(&settings(&line).expect("settings")), [(2, 1), (3, 2), (2, 1)]);
    // A configuration file names one or several.
    let path = folder.path().join("fleet.toml");
    for (text, expected) in [
        (format!("vehicles = 2\nmission = {all:?}"), [(2, 0), (2, 0)]),
        (format!("vehicles = 2\nmission = [{:?}]", format!("2:{own}")), [(0, 0), (3, 0)]),
    ] {
        std::fs::write(&path, text).expect("written");
        let arguments = configuration::file::read(&path).expect("a file");
        assert_eq!(counts(&Settings::resolve(&arguments).expect("settings")), expected);
    }
    for (line, words) in [
        (
            format!("--vehicles 2 --mission 3:{own}"),
            "there is no system 3; the systems of this run are 1 to 2",
        ),
        (format!("--mission 3:{own}"), "there is no system 3; the systems of this run are 1"),
        (format!("--mission {all} --mission {own}"), "is a second plan for all"),
        ("--vehicles 2 --fault 3:1:rotor1=off".to_owned(), "--fault: `3:1:rotor1=off`: there is no system 3"),
    ] {
        let error = settings(&line).expect_err(&line).to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn what_does_not_fit_is_refused_by_its_name() {
    for (line, words) in [
        ("--vehicles 200 --instance 60", "system 61 on need system ids up to 260"),
        ("--vehicles 2 --system-id 250", "the largest is 250"),
        ("--vehicles 2 --link serial:/dev/null", "leaves no port for vehicle 2"),
        ("--vehicles 2 --link tcpin:65535", "leaves no port for vehicle 2"),
        ("--lockstep-period 0.05", "--lockstep-period: needs --lockstep"),
        ("--lockstep-timeout 9", "--lockstep-timeout: needs --lockstep"),
    ] {
        let error = settings(line).expect_err(line).to_string();
        assert!(error.contains(words), "{error}");
    }
    for wrong in [
        "--lockstep never",
        "--lockstep --lockstep-period 2",
        "--vehicles 0",
        "--vehicles 251",
        "--ports mine",
        "--clocks none",
        "--formation star",
    ] {
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
        let summary = session.run(&Arc::new(AtomicBool::new(false)));
        assert_eq!(summary.flights.len(), 4);
        for (flight, own) in summary.flights.iter().zip(vehicles) {
            let mut alone =
                Autopilot::new(&own.vehicle, own.system_id, vehicle::parameters::Speed::Max, &[], 5)
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
