//! The pilot of a vehicle that flies by itself: the yaw stick turns the nose, and on the way down the others move the place of the landing.

use super::flier::*;
use vehicle::plan::command;

const TAKEOFF: u16 = command::NAV_TAKEOFF;
const WAYPOINT: u16 = command::NAV_WAYPOINT;
const LANDING: u16 = command::NAV_LAND;
/// Of the options of the modes.
const IGNORE_YAW: f64 = 4.0;

/// Turns for 2 s and lets go; returns by how many degrees the nose has turned once it rests.
fn turn_by_hand(flier: &mut Flier) -> f64 {
    let before_deg = flier.heading_deg();
    flier.rc(4, 1600);
    flier.fly(2.0);
    flier.rc(4, 1500);
    flier.fly(4.0);
    let turned_deg = (flier.heading_deg() - before_deg + 180.0).rem_euclid(360.0) - 180.0;
    let rests_deg = flier.heading_deg();
    flier.fly(1.0);
    assert!(flier.heads(rests_deg, 2.0), "it turns on: {} after {rests_deg}", flier.heading_deg());
    turned_deg
}

/// Suite: IgnorePilotYaw. Without the option the stick turns, and the nose stays where it leaves it.
#[test]
fn the_yaw_stick_turns_in_guided_unless_an_option_says_no() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    flier.rc(3, 1500);
    assert!(turn_by_hand(&mut flier) > 15.0, "{}", flier.heading_deg());
    flier.set("GUID_OPTIONS", IGNORE_YAW);
    assert!(turn_by_hand(&mut flier).abs() < 2.0, "{}", flier.heading_deg());
}

/// ArduCopter's Auto keeps the pilot's heading to the end of the leg; the next one points ahead again.
#[test]
fn the_yaw_stick_turns_in_auto_until_the_next_leg() {
    let rows = [(TAKEOFF, 0.0, 0.0, 10.0), (WAYPOINT, 150.0, 0.0, 10.0), (WAYPOINT, 150.0, 150.0, 10.0)];
    let mut flier = with_mission(&rows);
    flier.take_off(10.0, GUIDED);
    flier.rc(3, 1500);
    flier.change_mode(AUTO);
    flier.wait("its leg", 30.0, |flier| {
        flier.vehicle().mission_status().current == 2 && flier.speed_m_s() > 4.0
    });
    assert!(turn_by_hand(&mut flier) > 15.0, "{}", flier.heading_deg());
    flier.wait("the next leg", 60.0, |flier| flier.vehicle().mission_status().current == 3);
    flier.wait("east", 30.0, |flier| flier.heads(90.0, 0.2));
    flier.set("AUTO_OPTIONS", IGNORE_YAW);
    assert!(turn_by_hand(&mut flier).abs() < 2.0, "{}", flier.heading_deg());
}

/// ArduCopter's RTL_OPTIONS say the same of a return, but for its landing, where LAND_REPOSITION decides.
#[test]
fn the_yaw_stick_turns_on_a_return_and_its_landing() {
    let mut flier = Flier::new();
    flier.set_all(&[("RTL_OPTIONS", IGNORE_YAW), ("RTL_LOIT_TIME", 8000.0)]);
    flier.take_off(20.0, GUIDED);
    flier.rc(3, 1500);
    flier.change_mode(RTL);
    assert!(turn_by_hand(&mut flier).abs() < 2.0, "{}", flier.heading_deg());
    flier.wait("the descent", 30.0, |flier| flier.climb_m_s() < -0.3);
    assert!(turn_by_hand(&mut flier) > 15.0, "{}", flier.heading_deg());
    flier.wait_home();
}

/// Comes down for a second by Land from a height, m, under a parameter.
fn landing_with(name: &str, value: f64, height_m: f64) -> Flier {
    let mut flier = Flier::new();
    flier.set(name, value);
    flier.take_off(height_m, GUIDED);
    flier.rc(3, 1500);
    flier.change_mode(LAND);
    flier.fly(1.0);
    flier
}

/// A full stick moves the place by half a second of the acceleration of missions (WP_ACC), in the frame of the nose; a centred one leaves it.
#[test]
fn sticks_move_the_place_of_a_landing() {
    for (moves, least_m, most_m) in [(1.0, 1.0, 8.0), (0.0, 0.0, 0.1)] {
        let mut flier = landing_with("LAND_REPOSITION", moves, 12.0);
        flier.rc(2, 1000);
        flier.fly(3.0);
        let fastest_m_s = 0.5 * flier.vehicle().kept_configuration().limits.acceleration_horizontal_m_s2;
        assert!(flier.speed_m_s() <= 1.1 * fastest_m_s, "{} of {fastest_m_s}", flier.speed_m_s());
        flier.rc(2, 1500);
        flier.wait_disarmed(60.0);
        let moved_m = flier.vehicle().outputs().position_m.x;
        assert!((least_m..=most_m).contains(&moved_m.abs()), "{moves}: {moved_m}");
        assert!(moves == 0.0 || moved_m > 0.0, "forward is north: {moved_m}");
    }
}

/// The same in the landing of a mission, whose place is no longer flown to then.
#[test]
fn sticks_move_the_landing_of_a_mission() {
    let rows = [(TAKEOFF, 0.0, 0.0, 8.0), (LANDING, 20.0, 0.0, 0.0)];
    let mut flier = with_mission(&rows);
    flier.take_off(8.0, GUIDED);
    flier.rc(3, 1500);
    flier.change_mode(AUTO);
    flier.wait("the descent", 60.0, |flier| flier.height_m() < 7.0 && flier.distance_m() > 19.0);
    flier.rc(1, 2000);
    flier.fly(2.0);
    flier.rc(1, 1500);
    flier.wait_disarmed(60.0);
    let place_m = flier.vehicle().outputs().position_m;
    assert!(place_m.y.abs() + (place_m.x - 20.0).abs() > 0.5, "{place_m}");
}

/// Of PILOT_THR_BHV: a throttle above 70 % breaks off a landing, for Loiter.
#[test]
fn a_high_throttle_breaks_off_a_landing_if_it_is_to() {
    for (behaviour, mode) in [(0.0, LAND), (2.0, LOITER)] {
        let mut flier = landing_with("PILOT_THR_BHV", behaviour, 15.0);
        flier.rc(3, 1750);
        flier.fly(1.0);
        assert_eq!(flier.mode(), mode, "{:?}", flier.bench.texts());
    }
}
