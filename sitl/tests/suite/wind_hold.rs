//! The wind that the vehicle holds its position in: the derived limit against flights, the warning at the start and the
//! announcement in flight.

use crate::common::requests::set_parameter;
use crate::common::{Bench, settings};
use clap::Parser;
use mavlink::dialects::ardupilotmega::MavCmd;
use quadrotor::{Configuration, ControllerKind, side_force_limit_n};
use sitl::configuration::{Arguments, Settings};
use sitl::hil::HilSettings;
use vehicle::identity::Identity;
use vehicle::{Severity, VehicleSettings};

const DRAG_N_S_M: f64 = 0.15;

/// Share of the derived limit in which all controllers hold their place.
const HELD: f64 = 0.98;

/// A vehicle with drag in a wind, m/s, from a direction, rad.
fn in_wind(configuration: &Configuration, speed_m_s: f64, from_rad: f64) -> VehicleSettings {
    let mut settings = settings(Identity::Px4);
    settings.configuration = *configuration;
    settings.configuration.airframe.drag_n_s_m = [DRAG_N_S_M; 3];
    (settings.wind.speed_m_s, settings.wind.from_rad) = (speed_m_s, from_rad);
    settings
}

fn limit_m_s(configuration: &Configuration) -> f64 {
    side_force_limit_n(configuration) / DRAG_N_S_M
}

/// Arms, takes off to 10 m and flies on, whether it gets there or not.
fn take_off(settings: &VehicleSettings, seconds: f64) -> Bench {
    let mut bench = Bench::of(settings);
    bench.arm();
    let [nan, altitude] = [f32::NAN, 498.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, nan, nan, nan, altitude]), 0);
    bench.fly(seconds);
    bench
}

/// The largest distance from the reference, m, in the next seconds.
fn farthest_m(bench: &mut Bench, seconds: f64) -> f64 {
    let mut farthest: f64 = 0.0;
    for _ in 0..(seconds * 10.0) as usize {
        bench.fly(0.1);
        let now = bench.autopilot.vehicle().outputs();
        farthest = farthest.max((now.position_m - now.setpoint.position_m).norm());
    }
    farthest
}

/// Lines about holding the position.
fn said(bench: &Bench) -> Vec<String> {
    let about = |text: &String| text.contains("old position") || text.contains("Holding");
    bench.texts().into_iter().filter(about).collect()
}

#[test]
fn it_holds_just_below_the_limit_and_not_above() {
    let of_kind = |kind| {
        let mut configuration = Configuration::default();
        configuration.controllers.kind = kind;
        configuration
    };
    let mut loaded = Configuration::default();
    loaded.airframe.mass_kg = 1.4;
    let mut weak = Configuration::default();
    // Here the thrust ends before the tilt does: it sinks.
    weak.limits.thrust_max = 1.05;
    for (name, configuration, [below, above]) in [
        ("lmpc", of_kind(ControllerKind::Lmpc), [HELD, 1.02]),
        ("ssmpc", of_kind(ControllerKind::StateSpaceMpc), [HELD, 1.02]),
        ("dlqr", of_kind(ControllerKind::Dlqr), [HELD, 1.02]),
        ("loaded", loaded, [HELD, 1.02]),
        ("weak", weak, [0.9, 1.04]),
    ] {
        let limit_m_s = limit_m_s(&configuration);
        let mut within = take_off(&in_wind(&configuration, below * limit_m_s, 0.0), 60.0);
        let mut beyond = take_off(&in_wind(&configuration, above * limit_m_s, 0.0), 60.0);
        let (near_m, far_m) = (farthest_m(&mut within, 10.0), farthest_m(&mut beyond, 10.0));
        println!("{name}: {limit_m_s:.1} m/s: {near_m:.3} m below, {far_m:.1} m beyond");
        assert!(near_m < 0.3 && far_m > 5.0, "{name}: {near_m} m below, {far_m} m beyond {limit_m_s} m/s");
    }
}

#[test]
fn the_page_names_the_limit() {
    let page = include_str!("../../../book/src/vehicle/wind-and-sensors.md");
    let limit_m_s = limit_m_s(&Configuration::default());
    let named = format!("{limit_m_s:.1} m/s with the default limits and a drag of {DRAG_N_S_M} N·s/m");
    assert!(page.contains(&named), "{named}");
}

#[test]
fn gusts_are_held_with_three_standard_deviations_of_room_and_not_with_one_and_a_half() {
    let configuration = Configuration::default();
    let worst_m = |deviations: f64| {
        let mut worst: f64 = 0.0;
        for (sigma_m_s, seed) in [(1.0, 1), (2.0, 2), (2.0, 3), (3.0, 3)] {
            let mut settings =
                in_wind(&configuration, HELD * limit_m_s(&configuration) - deviations * sigma_m_s, 0.5);
            (settings.wind.gusts_m_s, settings.wind.seed) = (sigma_m_s, seed);
            worst = worst.max(farthest_m(&mut take_off(&settings, 20.0), 120.0));
        }
        worst
    };
    let (roomy_m, tight_m) = (worst_m(3.0), worst_m(1.5));
    println!("{roomy_m:.2} m with three, {tight_m:.2} m with one and a half");
    assert!(roomy_m < 1.0 && tight_m > 1.5, "{roomy_m} m, {tight_m} m");
}

#[test]
fn it_says_once_that_it_cannot_hold_and_when_it_can_again() {
    let mut bench = take_off(&in_wind(&Configuration::default(), 30.0, 1.0), 20.0);
    assert_eq!(said(&bench), ["Cannot hold position in 30 m/s wind"]);
    assert!(farthest_m(&mut bench, 5.0) > 5.0);
    // It may lean farther now, and comes back.
    bench.send(set_parameter("LIM_TILT", 0.9));
    bench.fly(60.0);
    assert_eq!(said(&bench), ["Cannot hold position in 30 m/s wind", "Holding position again"]);
    assert!(farthest_m(&mut bench, 1.0) < 0.3);
    // A wind within the limit is no cause.
    let bench = take_off(&in_wind(&Configuration::default(), 25.0, 1.0), 40.0);
    assert!(said(&bench).is_empty(), "{:?}", said(&bench));
}

#[test]
fn a_wind_beyond_the_limit_is_warned_of_at_the_start() {
    let arguments = |line: &str| {
        Arguments::try_parse_from(std::iter::once("lmpc-sitl").chain(line.split_whitespace())).expect(line)
    };
    let warnings = |line: &str| {
        let notes = Settings::resolve(&arguments(line)).expect(line).notes;
        notes
            .into_iter()
            .filter(|note| note.severity == Severity::Warning)
            .map(|note| note.text)
            .collect::<Vec<_>>()
    };
    for calm in [
        "--seed 1",
        "--wind 27",
        "--wind 21 --gusts 2",
        "--gusts 9",
        "--wind 30 --set FRAME_DRAG_X=0.05 --set FRAME_DRAG_Y=0.05",
        // From the east there is nothing to push.
        "--wind 30,90 --set FRAME_DRAG_Y=0",
        "--wind 30 --set LIM_TILT=0.8",
    ] {
        assert!(warnings(calm).is_empty(), "{calm}: {:?}", warnings(calm));
    }
    for (line, expected) in [
        (
            "--wind 30",
            "a wind of 30.0 m/s pushes with 4.5 N, but the vehicle holds its position only up to 4.2 N (27.8 m/s)",
        ),
        ("--wind 16 --set FRAME_DRAG_X=0.3", "a wind of 16.0 m/s pushes with 4.8 N"),
        (
            "--wind 30,90 --vehicles 3",
            "it will be blown away; reduce the wind or the drag, or raise limits.tilt",
        ),
        ("--wind 24 --gusts 2", "gusts reach 30.0 m/s (wind of 24.0 m/s and 3 standard deviations)"),
        ("--gusts 10", "up to 27.8 m/s: it will be pushed off for seconds"),
    ] {
        let warnings = warnings(line);
        assert!(warnings.len() == 1 && warnings[0].contains(expected), "{line}: {warnings:?}");
    }
    // What holds the position of an external autopilot is not ours.
    let hil = HilSettings::resolve(&arguments("--wind 30"), "0").expect("settings");
    assert!(hil.notes.iter().all(|note| note.severity == Severity::Info));
}
