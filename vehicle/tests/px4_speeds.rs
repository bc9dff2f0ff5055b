//! The speeds that PX4's parameters set beside those of automatic flight, as they are flown.

use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::{AxisTarget, Mode, PositionSetPoint, SetPoint, Vehicle, VehicleSettings, YawTarget};

/// What a speed may be beyond its limit, m/s: the vehicle swings into it.
const SWING_M_S: f64 = 0.1;

fn vehicle(identity: Identity, most_m_s: [Option<f64>; 3]) -> Vehicle {
    let mut settings = VehicleSettings::new(identity);
    settings.conduct.speeds.most_m_s = most_m_s;
    if identity.is_ardupilot() {
        settings.conduct.initial_mode = 4;
    }
    Vehicle::new(&settings).expect("valid settings")
}

/// Flies until something holds. Returns the largest climb and sink rates, m/s, below and above a height, m, and the time, s.
fn fly(
    vehicle: &mut Vehicle,
    most_s: f64,
    height_m: f64,
    ends: impl Fn(&Vehicle) -> bool,
) -> ([[f64; 2]; 2], f64) {
    let mut rates_m_s = [[0.0_f64; 2]; 2];
    for tick in 0..(most_s * 1e3) as usize {
        if ends(vehicle) {
            return (rates_m_s, tick as f64 / 1e3);
        }
        vehicle.tick().expect("the flight goes on");
        let truth = vehicle.truth();
        let [climb, sink] = &mut rates_m_s[usize::from(-truth.position_m.z > height_m)];
        *climb = climb.max(-truth.velocity_m_s.z);
        *sink = sink.max(truth.velocity_m_s.z);
    }
    panic!("not within {most_s} s: {:?}", vehicle.truth().position_m)
}

fn item(command: u16, position: [f64; 3]) -> MissionItem {
    let parameters = [0.0, 2.0, 0.0, f64::NAN];
    MissionItem { frame: frame::LOCAL_NED, command, parameters, position, autocontinue: true }
}

/// PX4 climbs with MPC_TKO_SPEED below MPC_LAND_ALT1 (1.5 m/s, 10 m), then as always; ArduPilot climbs as always.
#[test]
fn a_takeoff_climbs_slowly_at_first() {
    for (identity, slow) in [(Identity::Px4, true), (Identity::ArduPilot, false)] {
        let mut vehicle = vehicle(identity, [None; 3]);
        vehicle.arm(false).expect("armed");
        vehicle.take_off(Some(30.0)).expect("a takeoff");
        let ([[low, _], [high, _]], seconds) =
            fly(&mut vehicle, 60.0, 10.0, |vehicle| vehicle.mode() != Mode::Takeoff);
        eprintln!("{identity:?}: takeoff to 30 m in {seconds:.1} s, {low:.2} then {high:.2} m/s");
        assert_eq!(low < 1.5 + SWING_M_S, slow, "{identity:?}: {low} m/s below 10 m");
        assert!(high > 3.5, "{identity:?}: {high} m/s above");
    }
}

/// So does a mission that takes off.
#[test]
fn a_mission_takes_off_slowly_at_first() {
    let mut vehicle = vehicle(Identity::Px4, [None; 3]);
    let items =
        vec![item(command::NAV_TAKEOFF, [0.0, 0.0, -25.0]), item(command::NAV_WAYPOINT, [20.0, 0.0, -25.0])];
    vehicle.set_plan(PlanKind::Mission, items).expect("a mission");
    vehicle.set_mode(Mode::Mission).expect("its mode");
    vehicle.arm(false).expect("armed");
    let ([[low, _], [high, _]], _) = fly(&mut vehicle, 90.0, 10.0, |vehicle| vehicle.mode() == Mode::Hold);
    assert!(low < 1.5 + SWING_M_S && high > 3.0, "{low} m/s below 10 m, {high} m/s above");
}

/// Velocities that a program asks for are cut to the largest speeds, which may be above those of automatic flight.
#[test]
fn set_points_are_cut_to_the_largest_speeds() {
    for (most_m_s, expected) in [(None, 8.0), (Some(5.0), 5.0), (Some(10.0), 10.0)] {
        let mut vehicle = vehicle(Identity::Px4, [most_m_s, Some(2.0), Some(1.0)]);
        vehicle.arm(false).expect("armed");
        vehicle.take_off(Some(10.0)).expect("a takeoff");
        fly(&mut vehicle, 60.0, 0.0, |vehicle| vehicle.mode() == Mode::Hold);
        let ask = |vehicle: &mut Vehicle, down_m_s| {
            let axes = [15.0, 0.0, down_m_s].map(AxisTarget::Velocity);
            let set_point = PositionSetPoint { axes, yaw: YawTarget::Hold };
            vehicle.set_point(SetPoint::Position(set_point)).expect("a set-point");
        };
        ask(&mut vehicle, -6.0);
        vehicle.set_mode(Mode::Offboard).expect("set-points come");
        for (down_m_s, flown_m_s) in [(-6.0, -2.0), (6.0, 1.0)] {
            for _ in 0..100 {
                ask(&mut vehicle, down_m_s);
                let until_us = vehicle.time_us() + 100_000;
                fly(&mut vehicle, 0.2, 0.0, |vehicle| vehicle.time_us() >= until_us);
            }
            let velocity_m_s = vehicle.truth().velocity_m_s;
            assert!((velocity_m_s.x - expected).abs() < SWING_M_S, "{most_m_s:?}: {velocity_m_s:?}");
            assert!((velocity_m_s.z - flown_m_s).abs() < SWING_M_S, "{most_m_s:?}: {velocity_m_s:?}");
        }
    }
}

/// A landing sinks more slowly the nearer it comes: below MPC_LAND_ALT1 (10 m) in proportion, down to MPC_LAND_SPEED at MPC_LAND_ALT2.
/// ArduPilot has its LAND_SPD_MS from LAND_ALT_LOW_M (10 m) on.
#[test]
fn a_landing_slows_down_between_two_heights() {
    for (identity, most_m_s) in [(Identity::Px4, 0.7 + 2.3 * (6.0 - 2.0) / 8.0), (Identity::ArduPilot, 0.5)] {
        let mut vehicle = vehicle(identity, [None; 3]);
        vehicle.arm(false).expect("armed");
        vehicle.take_off(Some(30.0)).expect("a takeoff");
        fly(&mut vehicle, 60.0, 0.0, |vehicle| vehicle.mode() != Mode::Takeoff);
        vehicle.set_mode(Mode::Land).expect("a landing");
        let ([_, [_, high]], _) = fly(&mut vehicle, 60.0, 6.0, |vehicle| height_m(vehicle) < 6.0);
        assert!((high - 3.0).abs() < SWING_M_S, "{identity:?}: {high} m/s above 6 m");
        let ([[_, low], _], seconds) = fly(&mut vehicle, 60.0, 6.0, |vehicle| !vehicle.is_armed());
        eprintln!("{identity:?}: from 6 m in {seconds:.1} s, at most {low:.2} m/s");
        assert!(low < most_m_s + SWING_M_S && low > most_m_s / 2.0, "{identity:?}: {low} m/s below 6 m");
    }
}

fn height_m(vehicle: &Vehicle) -> f64 {
    -vehicle.truth().position_m.z
}
