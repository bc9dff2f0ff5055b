//! Failsafes: every transition of the table is flown, and the documentation draws the table.

mod common;

use common::{Bench, settings};
use mavlink::dialects::common::*;
use sitl::identity::Identity;
use sitl::parameters::CONDUCT_PARAMETERS;
use sitl::vehicle::{Action, Cause, Conduct, Mode};

const TEMPORARILY_REJECTED: u8 = 1;

fn set(bench: &mut Bench, id: &str, value: f64) {
    let mut param_id = [0; 16];
    param_id[..id.len()].copy_from_slice(id.as_bytes());
    let integer =
        id.ends_with("_ACT") || id.ends_with("_ACTION") || id.ends_with("NAVL") || id.ends_with("ENABLE");
    let ardupilot = bench.autopilot.identity().is_ardupilot();
    // PX4's integers travel bytewise.
    let (param_value, param_type) = if integer && !ardupilot {
        (f32::from_bits(value as i32 as u32), MavParamType::MAV_PARAM_TYPE_INT32)
    } else {
        (value as f32, MavParamType::MAV_PARAM_TYPE_REAL32)
    };
    let (target_system, target_component) = (1, 1);
    bench.heard.clear();
    bench.send(MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value,
        target_system,
        target_component,
        param_id: param_id.into(),
        param_type,
    }));
    let now = bench.parameters().pop().expect("an answer").param_value;
    assert_eq!(now.to_bits(), param_value.to_bits(), "{id}: {:?}", bench.texts());
}

/// The parameter of a cause in PX4's names.
fn parameter(cause: Cause) -> &'static str {
    match cause {
        Cause::SetPointsLost => "COM_OBL_RC_ACT",
        Cause::GroundStationLost => "NAV_DLL_ACT",
        Cause::HighWind => "COM_WIND_MAX_ACT",
        Cause::Fence => "GF_ACTION",
        Cause::BatteryLow | Cause::BatteryCritical | Cause::BatteryEmergency => "COM_LOW_BAT_ACT",
        Cause::PositionLost => "COM_POSCTL_NAVL",
        Cause::RotorFailure => "COM_ACT_FAIL_ACT",
    }
}

/// A vehicle that hovers 10 m up, in a wind if that is what is wrong.
fn hovering(cause: Cause) -> Bench {
    let mut start = settings(Identity::Px4);
    if cause == Cause::HighWind {
        start.wind = sitl::world::WindSettings { speed_m_s: 6.0, ..start.wind };
    }
    let mut bench = Bench::of(&start);
    bench.arm();
    let altitude = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 498.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, altitude), 0);
    bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
    bench
}

fn stand_still() -> MavMessage {
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_truncate(0b1101_1111_1000),
        z: -10.0,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}

/// Drains the battery down to a share by making it smaller.
fn drain_to(bench: &mut Bench, share: f64) {
    // So much that the rest lasts for a while.
    bench
        .fly_until("some charge drawn", 300.0, |bench| bench.autopilot.vehicle().battery().drawn_ah() > 0.15);
    let drawn_mah = 1000.0 * bench.autopilot.vehicle().battery().drawn_ah();
    set(bench, "BAT1_CAPACITY", (drawn_mah / (1.0 - share)).max(10.0));
}

/// Makes something go wrong.
fn spoil(bench: &mut Bench, cause: Cause) {
    match cause {
        Cause::SetPointsLost => {
            bench.send(stand_still());
            assert_eq!(bench.set_mode(Mode::Offboard), 0);
            bench.fly(1.1);
        }
        Cause::GroundStationLost => lose_ground_station(bench),
        Cause::HighWind => set(bench, "COM_WIND_MAX", 3.0),
        Cause::BatteryLow => drain_to(bench, 0.12),
        Cause::BatteryCritical => drain_to(bench, 0.065),
        Cause::BatteryEmergency => drain_to(bench, 0.03),
        Cause::PositionLost => {
            inject(bench, FailureUnit::FAILURE_UNIT_SENSOR_GPS);
            // As long as its last position is believed.
            bench.fly(5.5);
        }
        Cause::Fence | Cause::RotorFailure => unreachable!("has its own test"),
    }
}

fn inject(bench: &mut Bench, unit: FailureUnit) {
    let off = FailureType::FAILURE_TYPE_OFF as u32 as f32;
    let parameters = [unit as u32 as f32, off, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, parameters), 0);
}

fn lose_ground_station(bench: &mut Bench) {
    bench.autopilot.hear_ground_station(true);
    bench.autopilot.hear_ground_station(false);
}

/// The numbers that a cause's parameter takes, and what it does then.
fn choices(cause: Cause) -> Vec<(u8, Action)> {
    let parameter =
        CONDUCT_PARAMETERS.iter().find(|known| known.id == parameter(cause)).expect("there is one");
    let choice = |number: u8| {
        let mut conduct = Conduct::new(false);
        (parameter.set)(&mut conduct, f64::from(number)).then(|| (number, conduct.failsafe.action(cause)))
    };
    (0..=10).filter_map(choice).collect()
}

/// Every action that a parameter can choose for a cause is taken and told.
fn every_action_of(cause: Cause) {
    for (number, action) in choices(cause) {
        let mut bench = hovering(cause);
        set(&mut bench, parameter(cause), f64::from(number));
        let before = bench.mode();
        bench.heard.clear();
        spoil(&mut bench, cause);
        bench.fly(0.5);
        let (vehicle, texts) = (bench.autopilot.vehicle(), bench.texts());
        let told = format!("Failsafe: {}", cause.name());
        let announced = texts.iter().any(|text| text.starts_with(&told));
        assert_eq!(announced, action != Action::None, "{cause:?} {action:?}: {texts:?}");
        match action {
            Action::None | Action::Warn => assert_eq!(vehicle.mode(), before, "{cause:?} {action:?}"),
            Action::Terminate => assert!(!vehicle.is_armed(), "{cause:?} {action:?}"),
            _ => assert_eq!(Some(vehicle.mode()), action.mode(), "{cause:?} {action:?}: {texts:?}"),
        }
    }
}

#[test]
fn lost_set_points() {
    every_action_of(Cause::SetPointsLost);
}

#[test]
fn lost_ground_station() {
    every_action_of(Cause::GroundStationLost);
}

#[test]
fn high_wind() {
    every_action_of(Cause::HighWind);
}

#[test]
fn low_battery() {
    every_action_of(Cause::BatteryLow);
}

#[test]
fn critical_battery() {
    every_action_of(Cause::BatteryCritical);
}

#[test]
fn empty_battery() {
    every_action_of(Cause::BatteryEmergency);
}

#[test]
fn lost_position() {
    every_action_of(Cause::PositionLost);
}

#[test]
fn a_script_without_a_ground_station_is_left_alone() {
    let mut bench = hovering(Cause::GroundStationLost);
    bench.fly(60.0);
    assert_eq!(bench.mode(), Mode::Hold);
    bench.heard.clear();
    lose_ground_station(&mut bench);
    bench.fly(5.0);
    assert_eq!(bench.mode(), Mode::Hold);
}

#[test]
fn who_lands_is_not_called_back() {
    let mut bench = hovering(Cause::GroundStationLost);
    set(&mut bench, "NAV_DLL_ACT", 2.0);
    assert_eq!(bench.set_mode(Mode::Land), 0);
    lose_ground_station(&mut bench);
    bench.fly(1.0);
    assert_eq!(bench.mode(), Mode::Land);
}

#[test]
fn without_a_position_it_comes_down_level_and_softly() {
    let mut bench = hovering(Cause::PositionLost);
    spoil(&mut bench, Cause::PositionLost);
    bench.fly(0.5);
    assert_eq!(bench.mode(), Mode::Land);
    assert_eq!(bench.set_mode(Mode::Hold), TEMPORARILY_REJECTED);
    let mut fastest: f64 = 0.0;
    while bench.autopilot.vehicle().is_armed() {
        bench.fly(0.05);
        fastest = fastest.max(bench.autopilot.vehicle().truth().velocity_m_s.z);
        assert!(bench.autopilot.vehicle().time_us() < 90_000_000, "still up: {:?}", bench.position());
    }
    assert!(fastest < 3.0, "{fastest} m/s");
    assert!(bench.position()[2].abs() < 0.05);
}

/// Ends of modes, which are no failures.
const ENDS: [(&str, &str); 5] = [
    ("Takeoff --> Hold", "height reached"),
    ("Mission --> Hold", "mission complete"),
    ("Mission --> Return", "item returns"),
    ("Return --> Disarmed", "landed"),
    ("Land --> Disarmed", "landed"),
];

#[test]
fn the_documentation_draws_what_the_parameters_can_choose() {
    let page = include_str!("../docs/failsafes.md");
    let (_, rest) = page.split_once("```mermaid").expect("a diagram");
    let (diagram, _) = rest.split_once("```").expect("its end");
    let mut drawn: Vec<&str> =
        diagram.lines().map(str::trim).filter(|line| line.contains("-->") && !line.contains("[*]")).collect();
    drawn.sort_unstable();
    let mut meant: Vec<String> = ENDS.iter().map(|(edge, why)| format!("{edge} : {why}")).collect();
    for action in Action::ALL.into_iter().filter(|action| *action > Action::Warn) {
        let by = |cause: &Cause| choices(*cause).iter().any(|(_, choice)| *choice == action);
        let causes: Vec<String> =
            Cause::ALL.into_iter().filter(by).map(|cause| cause.name().to_lowercase()).collect();
        let to = action.mode().map_or("Terminated".to_owned(), |mode| format!("{mode:?}"));
        meant.push(format!("Flying --> {to} : {}", causes.join(", ")));
    }
    meant.sort_unstable();
    assert_eq!(drawn, meant, "the diagram should be:\n{}", meant.join("\n"));
}
