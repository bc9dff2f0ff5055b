//! Failsafes, fence, the mission's landing and simple mode with ArduPilot's parameters, as its documentation has them.

use crate::common::failsafe_bench::{lose_ground_station, set};
use crate::common::requests::local_target;
use crate::common::{Bench, settings};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::fence::Breach;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, command, frame};
use vehicle::radio::CHANNELS;
use vehicle::{Mode, VehicleSettings};

const FAILED: u8 = 4;
/// AUTO_RTL in HEARTBEAT.
const AUTO_RTL: u32 = 27;

fn ardupilot() -> VehicleSettings {
    settings(Identity::ArduPilot)
}

fn said(bench: &Bench, text: &str) -> bool {
    bench.texts().iter().any(|said| said.contains(text))
}

fn set_all(bench: &mut Bench, parameters: &[(&str, f64)]) {
    for (name, value) in parameters {
        set(bench, name, *value);
    }
}

/// The custom mode of the latest HEARTBEAT.
fn told_mode(bench: &mut Bench) -> u32 {
    bench.heard.clear();
    bench.fly(1.1);
    let told = bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(MavMessage::HEARTBEAT(beat)) => Some(beat.custom_mode),
        _ => None,
    });
    told.expect("a heartbeat")
}

fn item(start: &VehicleSettings, command: u16, north_m: f64, height_m: f64) -> MissionItem {
    MissionItem {
        frame: frame::GLOBAL_RELATIVE_INT,
        command,
        parameters: [0.0; 4],
        position: [start.origin.latitude_deg + north_m / 111_200.0, start.origin.longitude_deg, height_m],
        autocontinue: true,
    }
}

/// Takes off, flies 40 m north, and lands 15 m north of home.
fn with_landing() -> VehicleSettings {
    let mut start = ardupilot();
    let rows = [
        (command::NAV_WAYPOINT, 0.0, 0.0),
        (command::NAV_TAKEOFF, 0.0, 10.0),
        (command::NAV_WAYPOINT, 40.0, 10.0),
        (command::DO_LAND_START, 0.0, 0.0),
        (command::NAV_WAYPOINT, 15.0, 8.0),
        (command::NAV_LAND, 15.0, 0.0),
    ];
    let items = rows.map(|(number, north_m, height_m)| item(&start, number, north_m, height_m));
    start.plans.set(PlanKind::Mission, Plan::new(items.to_vec()));
    start
}

/// FS_GCS_ENABLE and FS_OPTIONS with what clients wait for: the mode, and the words.
#[test]
fn the_ground_station_is_lost_as_its_parameters_say() {
    for (enabled, options, from, to, words) in [
        (1.0, 0.0, Mode::Position, Mode::Return, "GCS Failsafe: returning"),
        (99.0, 0.0, Mode::Position, Mode::Return, "GCS Failsafe: returning"),
        (5.0, 0.0, Mode::Altitude, Mode::Land, "GCS Failsafe: landing"),
        (3.0, 0.0, Mode::Altitude, Mode::SmartReturn, "GCS Failsafe: returning along its path"),
        (1.0, 16.0, Mode::Altitude, Mode::Altitude, "GCS Failsafe - Continuing Pilot Control"),
        (1.0, 8.0, Mode::Land, Mode::Land, "GCS Failsafe - Continuing Landing"),
    ] {
        let mut bench = Bench::hovering_with(&ardupilot());
        set_all(&mut bench, &[("FS_GCS_ENABLE", enabled), ("FS_OPTIONS", options)]);
        assert_eq!(bench.set_mode(from), 0, "{:?}", bench.texts());
        bench.heard.clear();
        lose_ground_station(&mut bench);
        bench.fly(0.2);
        assert_eq!(bench.mode(), to, "{enabled} {options}: {:?}", bench.texts());
        assert!(said(&bench, words), "{enabled} {options}: {:?}", bench.texts());
        bench.autopilot.hear_ground_station(true);
        bench.fly(1.2);
        assert!(said(&bench, "GCS Failsafe Cleared"), "{:?}", bench.texts());
    }
}

/// Low, then critical: both fly back along the path, whoever has taken over between.
#[test]
fn a_weak_battery_returns_twice() {
    let mut bench = Bench::hovering_with(&ardupilot());
    set_all(
        &mut bench,
        &[
            ("BATT_LOW_VOLT", 11.5),
            ("BATT_CRT_VOLT", 10.1),
            ("BATT_LOW_TIMER", 1.0),
            ("BATT_FS_LOW_ACT", 3.0),
            ("BATT_FS_CRT_ACT", 4.0),
            ("SIM_BATT_VOLTAGE", 12.5),
        ],
    );
    bench.fly(3.0);
    assert_eq!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
    for (volts, words, state) in [
        (11.4, "Battery 1 is low", MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_LOW),
        (10.0, "Battery 1 is critical", MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_CRITICAL),
    ] {
        assert_eq!(bench.set_mode(Mode::Position), 0, "{:?}", bench.texts());
        set(&mut bench, "SIM_BATT_VOLTAGE", volts);
        bench.fly_until(words, 5.0, |bench| bench.mode() == Mode::SmartReturn && said(bench, words));
        bench.fly(2.1);
        let told = bench.heard.iter().rev().find_map(|message| match message {
            Message::Typed(MavMessage::BATTERY_STATUS(status)) => Some(status.charge_state),
            _ => None,
        });
        assert_eq!(told, Some(state));
    }
    let reset = [1.0, 100.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_BATTERY_RESET, reset), 0);
    assert!((bench.autopilot.vehicle().battery_remaining() - 1.0).abs() < 1e-3);
}

/// Leads a vehicle in the guided mode to a height above home, m.
fn lead_to_height(bench: &mut Bench, height_m: f32) {
    bench.send(local_target(0b1101_1111_1000, [0.0, 0.0, -height_m], [0.0; 3]));
}

/// FENCE_ALT_MIN: below it after it has been above, the vehicle returns, and lands through it. DO_FENCE_ENABLE 2 switches it off, 1 on.
#[test]
fn the_floor_of_the_fence_is_kept_to() {
    let mut bench = Bench::hovering_with(&ardupilot());
    set_all(&mut bench, &[("FENCE_ALT_MIN", 6.0), ("FENCE_TYPE", 8.0), ("FENCE_ENABLE", 1.0)]);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    for (switch, height_m) in [(2.0, 3.0), (1.0, 10.0)] {
        let parameters = [switch, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_FENCE_ENABLE, parameters), 0);
        lead_to_height(&mut bench, height_m);
        bench.fly_until("there", 20.0, |bench| (bench.position()[2] + f64::from(height_m)).abs() < 0.1);
        assert_eq!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
    }
    lead_to_height(&mut bench, 3.0);
    bench.fly_until("below the floor", 20.0, |bench| bench.mode() == Mode::Return);
    assert!((-bench.position()[2] - 6.0).abs() < 0.3, "{:?}", bench.position());
    assert!(said(&bench, "Min Alt fence breached"), "{:?}", bench.texts());
    let latest = bench.autopilot.vehicle().fence_record().latest.map(|(breach, _)| breach);
    assert_eq!(latest, Some(Breach::Floor(6.0)));
    bench.fly_until("landed", 90.0, |bench| !bench.autopilot.vehicle().is_armed());
}

#[test]
fn the_fence_switches_itself_on_with_arming() {
    let mut bench = Bench::new(Identity::ArduPilot);
    set_all(&mut bench, &[("FENCE_TYPE", 1.0), ("FENCE_AUTOENABLE", 3.0)]);
    let is_on = |bench: &mut Bench| {
        bench.fly(0.1);
        bench.autopilot.vehicle().fence().is_some()
    };
    assert!(!is_on(&mut bench));
    bench.arm();
    assert!(is_on(&mut bench));
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [0.0; 7]), 0);
    assert!(!is_on(&mut bench));
}

/// The words that clients wait for before arming.
#[test]
fn what_speaks_against_arming_is_told_in_ardupilots_words() {
    let mut bench = Bench::new(Identity::ArduPilot);
    set(&mut bench, "FENCE_ENABLE", 1.0);
    for (name, value, back, words) in [
        ("FENCE_RADIUS", -1.0, 300.0, "PreArm: Invalid Circle FENCE_RADIUS value"),
        ("FENCE_ALT_MAX", -1.0, 100.0, "PreArm: Invalid FENCE_ALT_MAX value"),
        ("BATT_ARM_VOLT", 50.0, 0.0, "PreArm: Battery 1 below minimum arming voltage"),
        ("BATT_ARM_MAH", 50_000.0, 0.0, "PreArm: Battery 1 below minimum arming capacity"),
        ("ARMING_MIS_ITEMS", 8.0, 0.0, "PreArm: Missing mission item: takeoff"),
    ] {
        set(&mut bench, name, value);
        bench.command(MavCmd::MAV_CMD_RUN_PREARM_CHECKS, [0.0; 7]);
        assert!(said(&bench, words), "{:?}", bench.texts());
        assert_ne!(
            bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            0
        );
        set(&mut bench, name, back);
    }
    set_all(&mut bench, &[("FENCE_RADIUS", -1.0), ("ARMING_CHECK", 0.0)]);
    bench.arm();
}

/// Mode 27 joins the landing, and is shown; without a landing it is refused.
#[test]
fn auto_rtl_flies_the_landing_of_the_mission() {
    let mut bench = Bench::hovering_with(&with_landing());
    assert_eq!(bench.set_mode(Mode::MissionLanding), 0, "{:?}", bench.texts());
    assert_eq!(told_mode(&mut bench), AUTO_RTL);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    assert_ne!(told_mode(&mut bench), AUTO_RTL);
    // The failsafe joins it, too.
    set_all(&mut bench, &[("FS_GCS_ENABLE", 6.0), ("FS_OPTIONS", 0.0)]);
    lose_ground_station(&mut bench);
    bench.fly(0.1);
    assert_eq!(told_mode(&mut bench), AUTO_RTL, "{:?}", bench.texts());
    bench.fly_until("landed", 90.0, |bench| !bench.autopilot.vehicle().is_armed());
    let [north, ..] = bench.position();
    assert!((north - 15.0).abs() < 0.5, "{north}");
    let mut bench = Bench::hovering_with(&ardupilot());
    assert_eq!(bench.set_mode(Mode::MissionLanding), FAILED);
    let reason = "the mission has neither DO_RETURN_PATH_START nor DO_LAND_START";
    assert!(said(&bench, reason), "{:?}", bench.texts());
}

/// Each step is told when it begins, and waypoints when they are reached.
#[test]
fn a_mission_tells_its_steps() {
    let mut bench = Bench::of(&with_landing());
    assert_eq!(bench.set_mode(Mode::Mission), 0, "{:?}", bench.texts());
    bench.arm();
    bench.fly_until("the second waypoint", 60.0, |bench| said(bench, "Reached command #4"));
    let told =
        ["Mission: 1 Takeoff", "Mission: 2 WP", "Reached command #2", "Mission: 4 WP", "Reached command #4"];
    let texts = bench.texts();
    let places = told.iter().map(|text| texts.iter().position(|said| said == text));
    assert!(places.clone().all(|place| place.is_some()) && places.is_sorted(), "{texts:?}");
}

/// AVOID_ENABLE: a stick pushed against the fence ends at its margin, and a ceiling that comes down is backed away from.
#[test]
fn sticks_stop_at_the_margin_of_the_fence() {
    let mut bench = Bench::hovering_with(&ardupilot());
    set_all(
        &mut bench,
        &[("FENCE_TYPE", 3.0), ("FENCE_RADIUS", 15.0), ("FENCE_MARGIN", 3.0), ("FENCE_ENABLE", 1.0)],
    );
    let mut pulses = [1500; CHANNELS];
    pulses[4] = 1685;
    bench.autopilot.receive_radio(pulses);
    bench.fly(0.3);
    assert_eq!(bench.mode(), Mode::Position, "{:?}", bench.texts());
    pulses[1] = 1100;
    bench.autopilot.receive_radio(pulses);
    let away = |bench: &Bench| bench.position()[0].hypot(bench.position()[1]);
    bench.fly(15.0);
    for _ in 0..20 {
        bench.fly(0.5);
        assert!((away(&bench) - 12.0).abs() < 1.0, "{}", away(&bench));
    }
    assert_eq!(bench.mode(), Mode::Position, "{:?}", bench.texts());
    set_all(&mut bench, &[("FENCE_ACTION", 0.0), ("FENCE_ALT_MAX", 9.0)]);
    let mut fastest: f64 = 0.0;
    for _ in 0..80 {
        bench.fly(0.1);
        fastest = fastest.max(bench.velocity()[2]);
    }
    assert!(
        (-bench.position()[2] - 6.0).abs() < 0.5 && fastest < 0.75 * 1.1,
        "{fastest} {:?}",
        bench.position()
    );
}

/// SIMPLE: the stick forward is north, where the nose was when it was armed, though it points elsewhere now.
#[test]
fn simple_mode_keeps_the_heading_of_arming() {
    let mut pulses = [1000; CHANNELS];
    pulses[..5].copy_from_slice(&[1500, 1500, 1000, 1500, 1800]);
    let mut bench = Bench::new(Identity::ArduPilot);
    bench.autopilot.receive_radio(pulses);
    bench.fly(0.3);
    // The sixth position of the mode switch.
    set(&mut bench, "SIMPLE", 32.0);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    bench.arm();
    let mut radio = |bench: &mut Bench, channel: usize, pulse: u16| {
        pulses[channel - 1] = pulse;
        bench.autopilot.receive_radio(pulses);
    };
    radio(&mut bench, 3, 1700);
    bench.fly_until("8 m", 30.0, |bench| bench.position()[2] < -8.0);
    radio(&mut bench, 3, 1500);
    let start_rad = bench.autopilot.vehicle().outputs().attitude_rad.z;
    radio(&mut bench, 4, 1700);
    bench.fly_until("turned", 20.0, |bench| {
        (bench.autopilot.vehicle().outputs().attitude_rad.z - start_rad).abs() > 1.3
    });
    radio(&mut bench, 4, 1500);
    bench.fly(1.0);
    radio(&mut bench, 2, 1200);
    bench.fly(3.0);
    let [north, east, _] = bench.velocity();
    let along = north * start_rad.cos() + east * start_rad.sin();
    assert!(along > 1.0 && north.hypot(east) - along < 0.2, "{north} {east} {start_rad}");
}
