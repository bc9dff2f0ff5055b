//! Failsafes that follow one another, flicker, or leave a choice.

use crate::common::failsafe_bench::*;
use crate::common::requests::set_parameter_as;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::*;
use vehicle::estimation::SensorModel;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, command, frame};
use vehicle::{Cause, Mode, VehicleSettings};

fn count(bench: &Bench, text: &str) -> usize {
    bench.texts().iter().filter(|told| *told == text).count()
}

/// A mission of a single item, 15 m above where the vehicle starts.
fn give_mission(start: &mut VehicleSettings, command: u16) {
    let item = MissionItem {
        frame: frame::GLOBAL_RELATIVE_INT,
        command,
        parameters: [0.0; 4],
        position: [start.origin.latitude_deg, start.origin.longitude_deg, 15.0],
        autocontinue: true,
    };
    start.plans.set(PlanKind::Mission, Plan::new(vec![item]));
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
    assert_eq!(count(&bench, "Ground station lost: holding"), 1, "{:?}", bench.texts());
    assert_eq!(count(&bench, "Failsafe cleared: ground station connected"), 0);
    bench.fly(0.7);
    assert_eq!(count(&bench, "Failsafe cleared: ground station connected"), 1);
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
    assert_eq!(count(&bench, "Battery empty (5 %): landing"), 1, "{:?}", bench.texts());
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
        give_mission(&mut start, command::NAV_WAYPOINT);
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
    bench.send(set_parameter_as("COM_ACT_FAIL_ACT", f32::from_bits(5), MavParamType::MAV_PARAM_TYPE_INT32));
    let told = bench.texts().pop().expect("a reason");
    let reason = "COM_ACT_FAIL_ACT = 5; allowed 0 (Warn), 1 (Hold), 2 (Land), 3 (Return), 4 (Terminate)";
    assert_eq!(told, reason);
}

/// COM_ACT_FAIL_ACT = 1 stays up on three rotors, until Land is asked for; 3 comes back to home and descends there.
#[test]
fn a_lost_rotor_may_hold_or_return() {
    for (number, mode) in [(1.0, Mode::Hold), (3.0, Mode::Return)] {
        let mut bench = hovering(Cause::RotorFailure);
        set(&mut bench, "COM_ACT_FAIL_ACT", number);
        spoil(&mut bench, Cause::RotorFailure);
        bench.fly(20.0);
        assert_eq!(bench.mode(), mode, "{:?}", bench.texts());
        let height_m = -bench.position()[2];
        assert!(height_m > 5.0, "{mode:?}: {height_m} m");
        if mode == Mode::Hold {
            let before = bench.position();
            bench.fly(20.0);
            let now = bench.position();
            let moved_m = (0..3).map(|axis| (now[axis] - before[axis]).abs()).fold(0.0, f64::max);
            assert!(moved_m < 1.5, "{before:?} {now:?}");
            assert_eq!(bench.set_mode(Mode::Land), 0);
        }
        bench.fly_until("a landing", 90.0, |bench| !bench.autopilot.vehicle().is_armed());
        let [x, y, z] = bench.position();
        assert!(z.abs() < 0.5, "{mode:?}: {z}");
        assert!(mode == Mode::Hold || x.hypot(y) < 3.0, "home: {x} {y}");
    }
}

/// Nothing is flown for it: its mode stays, and under the control for four three rotors tip it over. Measured: 11 m/s at the ground.
#[test]
fn who_is_only_warned_of_a_lost_rotor_goes_on_in_its_mode_and_falls() {
    let mut bench = hovering(Cause::RotorFailure);
    set(&mut bench, "COM_ACT_FAIL_ACT", 0.0);
    let mode = bench.mode();
    bench.heard.clear();
    spoil(&mut bench, Cause::RotorFailure);
    bench.fly(0.6);
    assert_eq!((bench.mode(), count(&bench, "Rotor 1 lost")), (mode, 1), "{:?}", bench.texts());
    assert_eq!(bench.autopilot.vehicle().lost_rotor(), Some(0));
    // Other modes are not refused, either.
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let mut fastest = 0.0_f64;
    for _ in 0..300 {
        bench.fly(0.01);
        fastest = fastest.max(bench.velocity()[2]);
    }
    assert!(fastest > 5.0 && bench.mode() == Mode::Position, "a fall, not a descent: {fastest} m/s");
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
        let told = format!("Position lost ({failed}): landing");
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
    // How it tumbles on the ground with rotors that turn is chance.
    while bench.autopilot.vehicle().truth().position_m.z < -0.5 {
        bench.fly(0.05);
        fastest = fastest.max(bench.autopilot.vehicle().truth().velocity_m_s.z);
        assert!(bench.autopilot.vehicle().time_us() < 60_000_000, "still up: {:?}", bench.position());
    }
    let told = "Position lost (gyroscope failed: cannot hold attitude): landing";
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

/// A vehicle without a receiver, armed by force, in a mode unless it starts in the one.
fn armed_without_a_position(mut start: VehicleSettings, mode: Option<Mode>) -> Bench {
    start.sensors.model = SensorModel::Realistic;
    start.faults = vec!["0:gps=off".parse().expect("a fault")];
    let mut bench = Bench::of(&start);
    bench.fly(3.0);
    if let Some(mode) = mode {
        assert_eq!(bench.set_mode(mode), 0);
    }
    let by_force = [1.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, by_force), 0, "{:?}", bench.texts());
    bench.fly(0.1);
    bench
}

#[test]
fn no_takeoff_is_begun_without_a_position() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        // Of ArduPilot, a mode that needs no place can be armed in.
        let mode = identity.is_ardupilot().then_some(Mode::Offboard);
        let mut bench = armed_without_a_position(settings(identity), mode);
        let height = if identity.is_ardupilot() { 10.0 } else { f32::NAN };
        let parameters = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, height];
        assert_ne!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, parameters), 0, "{identity:?}");
        let told = "Takeoff rejected: position lost, only landing is possible";
        assert_eq!(count(&bench, told), 1, "{identity:?} {:?}", bench.texts());
        bench.heard.clear();
        bench.fly(20.0);
        assert!(bench.position()[2].abs() < 1.0 && bench.autopilot.vehicle().truth().position_m.z > -0.1);
        // It disarms by itself, and the position is as lost as before.
        assert!(!bench.autopilot.vehicle().is_armed(), "{:?}", bench.texts());
        assert!(bench.texts().iter().all(|text| !text.contains("leared")), "{:?}", bench.texts());
    }
}

/// Who arms in the mode of missions has asked for no takeoff that could be refused.
#[test]
fn a_mission_that_takes_off_without_a_position_lands() {
    let mut start = settings(Identity::Px4);
    give_mission(&mut start, command::NAV_TAKEOFF);
    start.autostart = false;
    let mut bench = armed_without_a_position(start, Some(Mode::Mission));
    bench.fly(30.0);
    assert!(!bench.autopilot.vehicle().is_armed(), "{:?}", bench.texts());
    assert!(
        bench.texts().iter().any(|text| text.starts_with("Position lost") && text.ends_with(": landing"))
    );
    assert!(bench.texts().iter().all(|text| !text.contains("position known")), "{:?}", bench.texts());
}
