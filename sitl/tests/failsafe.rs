//! Failsafes: every transition of the table is flown, and the documentation draws the table.

mod common;

use common::{Bench, settings};
use mavlink::dialects::common::*;
use sitl::codec::Message;
use sitl::estimation::SensorModel;
use sitl::identity::Identity;
use sitl::parameters::{ARDUPILOT_PARAMETERS, CONDUCT_PARAMETERS};
use sitl::plan::{MissionItem, Plan, PlanKind, command, frame};
use sitl::vehicle::{Action, Cause, Conduct, Mode};

const TEMPORARILY_REJECTED: u8 = 1;

fn set(bench: &mut Bench, id: &str, value: f64) {
    let mut param_id = [0; 16];
    param_id[..id.len()].copy_from_slice(id.as_bytes());
    let integer = CONDUCT_PARAMETERS.iter().any(|known| known.id == id && known.integer);
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

/// The parameter of a cause.
fn parameter(identity: Identity, cause: Cause) -> &'static str {
    match cause {
        Cause::GroundStationLost if identity.is_ardupilot() => "FS_GCS_ENABLE",
        Cause::Fence if identity.is_ardupilot() => "FENCE_ACTION",
        Cause::BatteryLow if identity.is_ardupilot() => "BATT_FS_LOW_ACT",
        Cause::BatteryCritical | Cause::BatteryEmergency if identity.is_ardupilot() => "BATT_FS_CRT_ACT",
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
    hovering_as(Identity::Px4, cause)
}

fn hovering_as(identity: Identity, cause: Cause) -> Bench {
    let mut start = settings(identity);
    if cause == Cause::HighWind {
        start.wind = sitl::world::WindSettings { speed_m_s: 6.0, ..start.wind };
    }
    Bench::hovering_with(&start)
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
    let capacity = if bench.autopilot.identity().is_ardupilot() { "BATT_CAPACITY" } else { "BAT1_CAPACITY" };
    set(bench, capacity, (drawn_mah / (1.0 - share)).max(10.0));
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
        Cause::Fence if bench.autopilot.identity().is_ardupilot() => set(bench, "FENCE_ALT_MAX", 8.0),
        Cause::Fence => set(bench, "GF_MAX_VER_DIST", 8.0),
        Cause::RotorFailure => inject(bench, FailureUnit::FAILURE_UNIT_SYSTEM_MOTOR),
    }
}

/// Of all units of a kind, the first one.
fn inject(bench: &mut Bench, unit: FailureUnit) {
    break_unit(bench, unit, FailureType::FAILURE_TYPE_OFF);
}

fn break_unit(bench: &mut Bench, unit: FailureUnit, kind: FailureType) {
    let parameters = [unit as u32 as f32, kind as u32 as f32, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, parameters), 0);
}

fn lose_ground_station(bench: &mut Bench) {
    bench.autopilot.hear_ground_station(true);
    bench.autopilot.hear_ground_station(false);
}

/// The numbers that a cause's parameter takes, and what it does then.
fn choices(identity: Identity, cause: Cause) -> Vec<(u8, Action)> {
    let name = parameter(identity, cause);
    let mut known = CONDUCT_PARAMETERS.iter().chain(ARDUPILOT_PARAMETERS);
    let parameter = known.find(|known| known.id == name).expect("there is one");
    let choice = |number: u8| {
        let mut conduct = Conduct::new(identity.is_ardupilot());
        (parameter.set)(&mut conduct, f64::from(number)).then(|| (number, conduct.failsafe.action(cause)))
    };
    (0..=10).filter_map(choice).collect()
}

/// The state that the latest HEARTBEAT tells.
fn state(bench: &Bench) -> MavState {
    let told = bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(MavMessage::HEARTBEAT(beat)) => Some(beat.system_status),
        _ => None,
    });
    told.expect("a heartbeat")
}

/// What HEARTBEAT tells while something is done about a cause.
fn expected_state(cause: Cause, action: Action) -> MavState {
    match action {
        Action::None | Action::Warn => MavState::MAV_STATE_ACTIVE,
        Action::Terminate => MavState::MAV_STATE_FLIGHT_TERMINATION,
        _ if matches!(cause, Cause::RotorFailure | Cause::BatteryEmergency) => MavState::MAV_STATE_EMERGENCY,
        _ => MavState::MAV_STATE_CRITICAL,
    }
}

/// Every action that a parameter can choose for a cause is taken and told.
fn every_action_of(cause: Cause) {
    every_action_as(Identity::Px4, cause);
}

fn every_action_as(identity: Identity, cause: Cause) {
    for (number, action) in choices(identity, cause) {
        let mut bench = hovering_as(identity, cause);
        set(&mut bench, parameter(identity, cause), f64::from(number));
        let before = bench.mode();
        bench.heard.clear();
        spoil(&mut bench, cause);
        // Until the next heartbeat that comes by itself.
        bench.fly(1.1);
        let (vehicle, texts) = (bench.autopilot.vehicle(), bench.texts());
        let told = format!("Failsafe: {}", cause.name());
        let announced = texts.iter().any(|text| text.starts_with(&told));
        assert_eq!(announced, action != Action::None, "{cause:?} {action:?}: {texts:?}");
        match action {
            Action::None | Action::Warn => assert_eq!(vehicle.mode(), before, "{cause:?} {action:?}"),
            Action::Terminate => assert!(!vehicle.is_armed(), "{cause:?} {action:?}"),
            _ => assert_eq!(Some(vehicle.mode()), action.mode(), "{cause:?} {action:?}: {texts:?}"),
        }
        assert_eq!(state(&bench), expected_state(cause, action), "{cause:?} {action:?}");
    }
}

/// ArduPilot's names and numbers choose among the same actions.
#[test]
fn ardupilots_parameters() {
    for cause in [
        Cause::GroundStationLost,
        Cause::Fence,
        Cause::BatteryLow,
        Cause::BatteryCritical,
        Cause::BatteryEmergency,
    ] {
        assert!(choices(Identity::ArduPilot, cause).len() >= 4, "{cause:?}");
        every_action_as(Identity::ArduPilot, cause);
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
fn breached_fence() {
    every_action_of(Cause::Fence);
}

#[test]
fn failed_rotor() {
    every_action_of(Cause::RotorFailure);
}

fn count(bench: &Bench, text: &str) -> usize {
    bench.texts().iter().filter(|told| *told == text).count()
}

/// A cause that comes and goes several times per second acts once, and is over once.
#[test]
fn what_flickers_acts_once() {
    let mut bench = hovering(Cause::GroundStationLost);
    set(&mut bench, "NAV_DLL_ACT", 1.0);
    bench.heard.clear();
    for _ in 0..20 {
        lose_ground_station(&mut bench);
        bench.fly(0.4);
        bench.autopilot.hear_ground_station(true);
        bench.fly(0.4);
        assert_eq!(state(&bench), MavState::MAV_STATE_CRITICAL);
    }
    assert_eq!(count(&bench, "Failsafe: Ground station lost: hold"), 1, "{:?}", bench.texts());
    assert_eq!(count(&bench, "Failsafe: ground station lost is over"), 0);
    bench.fly(0.7);
    assert_eq!(count(&bench, "Failsafe: ground station lost is over"), 1);
    assert_eq!(state(&bench), MavState::MAV_STATE_ACTIVE);
    // A user who flies on is not spared the next time, however soon it comes.
    lose_ground_station(&mut bench);
    bench.fly(0.1);
    bench.autopilot.hear_ground_station(true);
    bench.fly(0.1);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    bench.autopilot.hear_ground_station(false);
    bench.fly(0.1);
    assert_eq!(bench.mode(), Mode::Hold, "{:?}", bench.texts());
}

/// On its way home the battery runs empty: it lands where it is.
#[test]
fn a_return_on_a_critical_battery_becomes_a_landing_when_it_is_empty() {
    let mut bench = hovering(Cause::BatteryCritical);
    bench.fly(60.0);
    drain_to(&mut bench, 0.053);
    bench.fly(0.1);
    assert_eq!((bench.mode(), state(&bench)), (Mode::Return, MavState::MAV_STATE_CRITICAL));
    bench.fly_until("empty", 60.0, |bench| bench.mode() == Mode::Land);
    let share = bench.autopilot.vehicle().battery_remaining();
    assert!((share - 0.05).abs() < 1e-4, "{share}");
    assert_eq!(count(&bench, "Failsafe: Battery empty (5 %): land"), 1, "{:?}", bench.texts());
    bench.fly(0.1);
    assert_eq!(state(&bench), MavState::MAV_STATE_EMERGENCY);
    bench.fly_until("landed", 90.0, |bench| !bench.autopilot.vehicle().is_armed());
    assert!(bench.position()[2].abs() < 0.05, "{:?}", bench.position());
}

/// From a hold in the wind to a return to a landing, and never back.
#[test]
fn a_worse_cause_goes_before_a_milder_one() {
    let mut bench = hovering(Cause::HighWind);
    for (id, value) in [("COM_WIND_MAX_ACT", 2.0), ("NAV_DLL_ACT", 2.0), ("GF_ACTION", 5.0)] {
        set(&mut bench, id, value);
    }
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut modes = Vec::new();
    for cause in [Cause::HighWind, Cause::GroundStationLost, Cause::Fence] {
        spoil(&mut bench, cause);
        bench.fly(0.1);
        modes.push(bench.mode());
    }
    assert_eq!(modes, [Mode::Hold, Mode::Return, Mode::Land]);
    lose_ground_station(&mut bench);
    bench.fly(3.0);
    assert_eq!(bench.mode(), Mode::Land);
}

/// Only landing is left: a mission is neither begun nor gone on with.
#[test]
fn no_mission_is_begun_without_a_position_or_a_rotor() {
    for cause in [Cause::PositionLost, Cause::RotorFailure] {
        let mut start = settings(Identity::Px4);
        let waypoint = MissionItem {
            frame: frame::GLOBAL_RELATIVE_INT,
            command: command::NAV_WAYPOINT,
            parameters: [0.0; 4],
            position: [start.origin.latitude_deg, start.origin.longitude_deg, 15.0],
            autocontinue: true,
        };
        start.plans.set(PlanKind::Mission, Plan::new(vec![waypoint]));
        let mut bench = Bench::hovering_with(&start);
        spoil(&mut bench, cause);
        bench.fly(0.2);
        for command in [MavCmd::MAV_CMD_MISSION_START, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH] {
            assert_eq!(bench.command(command, [0.0; 7]), TEMPORARILY_REJECTED, "{cause:?} {command:?}");
        }
        let go_on = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_ne!(bench.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, go_on), 0, "{cause:?}");
        assert_eq!(bench.mode(), Mode::Land, "{cause:?}");
    }
}

/// A user who starts the mission, or pauses where it is, has decided: the next cause acts again.
#[test]
fn whoever_flies_on_has_decided() {
    let mut bench = hovering(Cause::HighWind);
    set(&mut bench, "COM_WIND_MAX_ACT", 3.0);
    set(&mut bench, "RTL_MIN_DIST", 0.5);
    spoil(&mut bench, Cause::HighWind);
    bench.fly(0.1);
    assert_eq!((bench.mode(), state(&bench)), (Mode::Return, MavState::MAV_STATE_CRITICAL));
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPOSITION, [f32::NAN; 7]), 0);
    bench.fly(0.1);
    assert_eq!((bench.mode(), state(&bench)), (Mode::Hold, MavState::MAV_STATE_ACTIVE));
    set(&mut bench, "NAV_DLL_ACT", 2.0);
    lose_ground_station(&mut bench);
    bench.fly(0.1);
    assert_eq!((bench.mode(), state(&bench)), (Mode::Return, MavState::MAV_STATE_CRITICAL));
}

/// Terminated by command it says so until it is armed again.
#[test]
fn a_terminated_flight_is_told() {
    let mut bench = hovering(Cause::Fence);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_FLIGHTTERMINATION, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 0);
    bench.fly(0.1);
    assert!(!bench.autopilot.vehicle().is_armed());
    assert_eq!(state(&bench), MavState::MAV_STATE_FLIGHT_TERMINATION);
    bench.fly(10.0);
    assert_eq!(state(&bench), MavState::MAV_STATE_FLIGHT_TERMINATION);
    assert_eq!(
        bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        0
    );
    bench.fly(0.1);
    assert_eq!(state(&bench), MavState::MAV_STATE_ACTIVE);
}

#[test]
fn a_meaningless_choice_is_refused_with_those_that_there_are() {
    let mut bench = Bench::new(Identity::Px4);
    let mut param_id = [0; 16];
    param_id[..16].copy_from_slice(b"COM_ACT_FAIL_ACT");
    bench.send(MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: f32::from_bits(1),
        target_system: 1,
        target_component: 1,
        param_id: param_id.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_INT32,
    }));
    let told = bench.texts().pop().expect("a reason");
    let reason = "Parameter refused: COM_ACT_FAIL_ACT = 1 has no meaning here: 2 Land, 4 Terminate";
    assert_eq!(told, reason);
}

/// Without a barometer and a receiver nothing corrects the height; without an accelerometer nothing is known between fixes.
/// Measured: touched down at 0.3 to 0.9 m/s.
#[test]
fn without_a_height_it_lands_at_once_and_softly() {
    use FailureType::{FAILURE_TYPE_OFF as OFF, FAILURE_TYPE_STUCK as STUCK};
    use FailureUnit::{
        FAILURE_UNIT_SENSOR_ACCEL as ACCELEROMETER, FAILURE_UNIT_SENSOR_BARO as BAROMETER,
        FAILURE_UNIT_SENSOR_GPS as GPS,
    };
    for (broken, failed) in [
        (vec![(BAROMETER, OFF), (GPS, OFF)], "barometer, gps failed"),
        (vec![(ACCELEROMETER, STUCK)], "accelerometer failed"),
    ] {
        let mut start = settings(Identity::Px4);
        start.sensors.model = SensorModel::Realistic;
        let mut bench = Bench::of(&start);
        bench.fly(4.0);
        bench.arm();
        let altitude = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 498.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, altitude), 0);
        bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
        for (unit, kind) in broken {
            break_unit(&mut bench, unit, kind);
        }
        bench.fly(1.5);
        assert_eq!((bench.mode(), state(&bench)), (Mode::Land, MavState::MAV_STATE_CRITICAL), "{failed}");
        let told = format!("Failsafe: Position lost ({failed}): land");
        assert_eq!(count(&bench, &told), 1, "{:?}", bench.texts());
        let mut fastest: f64 = 0.0;
        while bench.autopilot.vehicle().is_armed() {
            bench.fly(0.05);
            fastest = fastest.max(bench.autopilot.vehicle().truth().velocity_m_s.z);
            assert!(bench.autopilot.vehicle().time_us() < 90_000_000, "still up: {:?}", bench.position());
        }
        println!("{failed}: {fastest}");
        assert!(fastest < 1.6, "{failed}: {fastest} m/s");
    }
}

#[test]
fn without_a_gyroscope_it_falls_and_says_so() {
    let mut start = settings(Identity::Px4);
    start.sensors.model = SensorModel::Realistic;
    let mut bench = Bench::of(&start);
    bench.fly(4.0);
    bench.arm();
    let altitude = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 498.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, altitude), 0);
    bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
    break_unit(&mut bench, FailureUnit::FAILURE_UNIT_SENSOR_GYRO, FailureType::FAILURE_TYPE_OFF);
    let mut fastest: f64 = 0.0;
    while bench.autopilot.vehicle().is_armed() {
        bench.fly(0.05);
        fastest = fastest.max(bench.autopilot.vehicle().truth().velocity_m_s.z);
        assert!(bench.autopilot.vehicle().time_us() < 60_000_000, "still up: {:?}", bench.position());
    }
    let told = "Failsafe: Position lost (gyroscope failed: no attitude can be held): land";
    assert_eq!(count(&bench, told), 1, "{:?}", bench.texts());
    assert!(fastest > 8.0, "{fastest} m/s");
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
        let identities = [Identity::Px4, Identity::ArduPilot];
        let all = |cause: Cause| identities.into_iter().flat_map(move |identity| choices(identity, cause));
        let by = |cause: &Cause| all(*cause).any(|(_, choice)| choice == action);
        let causes: Vec<String> =
            Cause::ALL.into_iter().filter(by).map(|cause| cause.name().to_lowercase()).collect();
        let to = action.mode().map_or("Terminated".to_owned(), |mode| format!("{mode:?}"));
        meant.push(format!("Flying --> {to} : {}", causes.join(", ")));
    }
    meant.sort_unstable();
    assert_eq!(drawn, meant, "the diagram should be:\n{}", meant.join("\n"));
}
