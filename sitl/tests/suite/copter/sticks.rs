//! What a pilot's sticks do, as fast as ArduCopter does it.

use super::flier::*;
use crate::common::settings;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind, command, frame};

const FLIP: u32 = 14;
const ZIGZAG: u32 = 24;
const POSHOLD: u32 = 16;

/// Suite: ModeLoiter. At 1580 µs it turns by 25 degrees per second.
#[test]
fn loiter_turns_flies_and_holds() {
    let mut flier = Flier::new();
    flier.take_off(10.0, LOITER);
    let to_deg = flier.heading_deg() - 100.0;
    flier.rc(4, 1580);
    flier.wait_heading(to_deg.rem_euclid(360.0));
    flier.rc(4, 1500);
    flier.rc(2, 1100);
    flier.wait_moved(50.0);
    flier.rc(2, 1500);
    flier.wait("a stop", 60.0, |flier| flier.speed_m_s() < 2.0);
    let (height_m, place_m) = (flier.height_m(), flier.vehicle().outputs().position_m.xy());
    flier.fly(10.0);
    assert!((flier.height_m() - height_m).abs() < 5.0);
    assert!((flier.vehicle().outputs().position_m.xy() - place_m).norm() < 5.0);
    flier.return_home();
}

/// The speeds of ArduCopter's pilot are not those of its missions; a return that begins at 12.5 m/s goes on with WP_SPD.
#[test]
fn loiter_has_speeds_of_its_own() {
    let mut flier = Flier::new();
    flier.set_all(&[("WP_SPD", 5.0), ("WP_SPD_UP", 1.5), ("WP_SPD_DN", 1.0), ("PILOT_SPD_UP", 4.0)]);
    flier.take_off(10.0, LOITER);
    flier.rc(3, 2000);
    flier.wait("4 m/s upwards", 10.0, |flier| (flier.climb_m_s() - 4.0).abs() < 0.2);
    flier.fly(5.0);
    flier.rc(3, 1000);
    flier.wait("4 m/s downwards", 10.0, |flier| (flier.climb_m_s() + 4.0).abs() < 0.2);
    flier.rc_all(&[(3, 1500), (2, 1000)]);
    flier.wait("12.5 m/s", 60.0, |flier| (flier.speed_m_s() - 12.5).abs() < 0.2);
    flier.fly(5.0);
    assert!((flier.speed_m_s() - 12.5).abs() < 0.2, "{} m/s", flier.speed_m_s());
    flier.rc(2, 1500);
    flier.change_mode(RTL);
    flier.fly(20.0);
    assert!((flier.speed_m_s() - 5.0).abs() < 0.2, "{} m/s", flier.speed_m_s());
}

/// Suite: takeoffAndMoveAway, with which its failsafe tests begin.
#[test]
fn altitude_hold_turns_and_flies_away() {
    let mut flier = Flier::new();
    flier.take_off(50.0, GUIDED);
    flier.rc(3, 1500);
    flier.change_mode(ALT_HOLD);
    let to_deg = flier.heading_deg() + 180.0;
    flier.rc(4, 1580);
    flier.wait_heading(to_deg.rem_euclid(360.0));
    flier.rc(4, 1500);
    flier.rc(2, 1800);
    flier.fly(10.0);
    flier.rc(2, 1500);
    assert!(flier.distance_m() > 50.0, "{}", flier.distance_m());
    assert!((flier.height_m() - 50.0).abs() < 3.0, "{}", flier.height_m());
}

/// Corners of the suite's narrow fence, and the places that it is to come near to, degrees of latitude and longitude.
const FENCE_DEG: [[f64; 2]; 3] =
    [[-35.362_892, 149.165_054], [-35.363_014, 149.164_886], [-35.363_018, 149.165_207]];
const START_DEG: [f64; 2] = [-35.362_938, 149.165_085];
const WEST_DEG: [f64; 2] = [-35.363_007, 149.164_911];
const NORTH_DEG: [f64; 2] = [-35.362_908, 149.165_051];
const EAST_DEG: [f64; 2] = [-35.363_013, 149.165_194];

/// Turns by hand, with the other sticks as they are.
fn head(flier: &mut Flier, heading_deg: f64) {
    flier.rc(4, 1580);
    flier.wait_heading(heading_deg);
    flier.rc(4, 1500);
}

/// Flies until it is within 6 m of a place.
fn wait_place(flier: &mut Flier, [latitude_deg, longitude_deg]: [f64; 2], seconds: f64) {
    flier.wait(&format!("{latitude_deg} {longitude_deg}"), seconds, |flier| {
        let here = flier.vehicle().frame().to_geodetic(&flier.vehicle().outputs().position_m);
        let off_m = [
            (here.latitude_deg - latitude_deg) * 111_195.0,
            (here.longitude_deg - longitude_deg) * 111_195.0 * latitude_deg.to_radians().cos(),
        ];
        off_m[0].hypot(off_m[1]) < 6.0
    });
}

/// Suite: AC_Avoidance_Fence, AC_Avoidance_Proximity. The stick is held forward all the time, and the vehicle slides along the fence; so
/// does one with a proximity sensor, switched on by the pilot, that sees nothing.
#[test]
fn a_vehicle_slides_along_a_narrow_fence() {
    const SWITCHES_PROXIMITY: f64 = 40.0;
    for proximity_kind in [0.0, 10.0] {
        let mut flier = behind_a_narrow_fence();
        flier.set_all(&[("PRX1_TYPE", proximity_kind), ("RC10_OPTION", SWITCHES_PROXIMITY)]);
        flier.rc(10, 2000);
        slide_along_the_fence(&mut flier);
    }
}

fn behind_a_narrow_fence() -> Flier {
    let mut start = settings(Identity::ArduPilot);
    (start.origin.latitude_deg, start.origin.longitude_deg) = (START_DEG[0], START_DEG[1]);
    start.heading_rad = 270.0_f64.to_radians();
    let corners = FENCE_DEG.map(|[latitude_deg, longitude_deg]| MissionItem {
        frame: frame::GLOBAL_INT,
        command: command::NAV_FENCE_POLYGON_VERTEX_INCLUSION,
        parameters: [3.0, 0.0, 0.0, 0.0],
        position: [latitude_deg, longitude_deg, 0.0],
        autocontinue: true,
    });
    start.plans.set(PlanKind::Fence, Plan::new(corners.to_vec()));
    let mut flier = Flier::with(&start);
    flier.set("FENCE_ENABLE", 1.0);
    flier
}

fn slide_along_the_fence(flier: &mut Flier) {
    flier.take_off(10.0, LOITER);
    flier.rc(2, 1400);
    wait_place(flier, WEST_DEG, 30.0);
    head(flier, 0.0);
    wait_place(flier, NORTH_DEG, 200.0);
    head(flier, 90.0);
    wait_place(flier, EAST_DEG, 30.0);
    head(flier, 225.0);
    wait_place(flier, WEST_DEG, 200.0);
    flier.rc(2, 1500);
    assert_eq!(flier.mode(), LOITER, "{:?}", flier.bench.texts());
    flier.return_home();
}

/// Suite: ModeFlip, by command.
#[test]
fn a_flip_turns_over_and_goes_on() {
    let mut flier = Flier::new();
    assert_eq!(flier.ask_mode(FLIP), FAILED, "on the ground");
    flier.take_off(20.0, STABILIZE);
    for (channel, axis) in [(1, 0), (2, 1)] {
        flier.rc(channel, 1700);
        flier.fly(0.05);
        assert_eq!(flier.ask_mode(FLIP), ACCEPTED, "{:?}", flier.bench.texts());
        for degrees in [45.0, 90.0, -45.0] {
            flier.wait("its attitude", 2.0, |flier| {
                (flier.vehicle().outputs().attitude_rad[axis].to_degrees() - degrees).abs() <= 30.0
            });
        }
        flier.rc(channel, 1500);
        flier.wait("level", 20.0, |flier| {
            flier.vehicle().outputs().attitude_rad.xy().amax().to_degrees() <= 5.0
        });
        flier.wait("the end", 2.0, |flier| flier.mode() != FLIP);
        flier.change_mode(ALT_HOLD);
        flier.wait("its height", 30.0, |flier| (19.0..60.0).contains(&flier.height_m()));
    }
    flier.return_home();
}

/// Flies forward by 10 m, and stops.
fn forward(flier: &mut Flier) {
    flier.rc(2, 1300);
    flier.wait_moved(10.0);
    flier.rc(2, 1500);
    flier.wait("a stop", 60.0, |flier| flier.speed_m_s() < 0.3);
}

/// Flies across to an end, A at 1100 and B at 1900 µs, and sees it go so far, m.
fn across(flier: &mut Flier, pulse_us: u16, metres: f64) {
    flier.rc(8, 1500);
    flier.fly(0.5);
    flier.rc(8, pulse_us);
    flier.wait_moved(metres);
}

/// Suite: ModeZigZag, to one side.
#[test]
fn zigzag_flies_across_between_its_ends() {
    let mut flier = Flier::new();
    flier.set("RC8_OPTION", 61.0);
    flier.take_off(5.0, LOITER);
    flier.rc(8, 1500);
    flier.fly(0.5);
    flier.change_mode(ZIGZAG);
    flier.rc(8, 1100);
    flier.wait_text("ZigZag: point A stored", 2.0);
    flier.rc(1, 1700);
    flier.wait_moved(20.0);
    flier.rc(1, 1500);
    flier.wait("a stop", 60.0, |flier| flier.speed_m_s() < 0.3);
    flier.rc(8, 1500);
    flier.fly(0.5);
    flier.rc(8, 1900);
    flier.wait_text("ZigZag: point B stored", 2.0);
    for (pulse_us, told) in [(1100, "ZigZag: moving to A"), (1900, "ZigZag: moving to B")] {
        forward(&mut flier);
        across(&mut flier, pulse_us, 17.0);
        flier.wait("a stop", 60.0, |flier| flier.speed_m_s() < 0.3);
        assert!(flier.has_said(told), "{:?}", flier.bench.texts());
    }
    // Halfway it is stopped, flown by hand, and sent on.
    forward(&mut flier);
    across(&mut flier, 1100, 8.0);
    flier.rc(8, 1500);
    flier.wait("a stop", 60.0, |flier| flier.speed_m_s() < 0.3);
    forward(&mut flier);
    across(&mut flier, 1100, 8.0);
    flier.wait("a stop", 60.0, |flier| flier.speed_m_s() < 0.3);
    flier.change_mode(LOITER);
    flier.return_home();
}

/// Suite: PosHoldTakeOff. A moment of throttle is enough.
#[test]
fn a_takeoff_by_hand_goes_on_to_its_height() {
    for (name, height) in [("PILOT_TKOFF_ALT", 700.0), ("PILOT_TKO_ALT_M", 7.0)] {
        takes_off_by_hand(name, height);
    }
}

fn takes_off_by_hand(name: &str, height: f64) {
    let mut flier = Flier::new();
    flier.set(name, height);
    flier.change_mode(POSHOLD);
    flier.arm();
    flier.fly(2.0);
    assert!(flier.height_m() < 0.1);
    flier.rc(3, 1710);
    flier.fly(0.5);
    flier.rc(3, 1500);
    flier.fly(0.1);
    assert!(flier.height_m() < 2.0);
    flier.wait("7 m", 30.0, |flier| (6.9..8.0).contains(&flier.height_m()));
    for _ in 0..10 {
        flier.fly(1.0);
        assert!((6.9..8.0).contains(&flier.height_m()), "{}", flier.height_m());
    }
    flier.land();
}

/// Suite: PILOT_THR_BHV.
#[test]
fn a_landing_by_hand_disarms_if_it_is_to() {
    for (options, disarms) in [(0.0, false), (4.0, true)] {
        let mut flier = Flier::new();
        flier.set_all(&[("DISARM_DELAY", 0.0), ("PILOT_THR_BHV", options)]);
        flier.take_off(2.0, GUIDED);
        flier.rc(3, 1500);
        flier.change_mode(LOITER);
        flier.rc(3, 1300);
        flier.wait_text("Landing detected", 30.0);
        flier.fly(20.0);
        assert_eq!(flier.is_armed(), !disarms, "{options}");
    }
}

/// Suite: CircleManualControlEntryLeft and ...Right: sticks change the circle. To the right it gets faster by one degree per second in a
/// second, and forwards smaller.
#[test]
fn sticks_change_a_circle() {
    const CIRCLE: u32 = 7;
    let mut flier = Flier::new();
    flier.set_all(&[("CIRCLE_RADIUS_M", 10.0), ("CIRCLE_RATE", 10.0)]);
    flier.take_off(10.0, GUIDED);
    flier.rc(3, 1500);
    flier.change_mode(CIRCLE);
    flier.wait("its speed", 30.0, |flier| flier.speed_m_s() > 1.7);
    flier.rc(1, 2000);
    flier.fly(5.0);
    flier.rc(1, 1500);
    flier.fly(3.0);
    let faster_m_s = 15_f64.to_radians() * 10.0;
    assert!((flier.speed_m_s() - faster_m_s).abs() < 0.2, "{} of {faster_m_s}", flier.speed_m_s());
    let radius_m = |flier: &Flier| flier.vehicle().orbit_status().map_or(0.0, |orbit| orbit.radius_m);
    flier.rc(2, 1600);
    flier.fly(3.0);
    flier.rc(2, 1500);
    flier.fly(3.0);
    let (wider_m, centre_m) = (radius_m(&flier), flier.vehicle().orbit_status().map(|orbit| orbit.centre_m));
    assert!(wider_m > 11.0, "{wider_m}");
    let off_m =
        centre_m.map_or(0.0, |centre_m| (flier.vehicle().outputs().position_m - centre_m).xy().norm());
    assert!((off_m - wider_m).abs() < 0.5, "{off_m} of {wider_m}");
    flier.set("CIRCLE_RADIUS_M", 12.0);
    flier.wait("the radius of the parameter", 30.0, |flier| (radius_m(flier) - 12.0).abs() < 0.1);
}
