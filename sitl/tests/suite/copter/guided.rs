//! Where the nose points in Guided.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use super::flier::*;
use crate::common::requests::local_target;
use mavlink::dialects::ardupilotmega::*;

/// Only the place counts.
const PLACE: u16 = 0b1101_1111_1000;
/// Only the velocity counts.
const VELOCITY: u16 = 0b1101_1100_0111;

fn ask(flier: &mut Flier, mask: u16, place: [f32; 3], velocity: [f32; 3]) {
    flier.bench.send(local_target(mask, place, velocity));
}

fn look(flier: &mut Flier, [north_m, east_m]: [f64; 2]) {
    let home = flier.vehicle().home().position_m;
    let there = flier.vehicle().frame().to_geodetic(&(home + nalgebra::Vector3::new(north_m, east_m, 0.0)));
    let place = [there.latitude_deg as f32, there.longitude_deg as f32];
    let parameters = [0.0, 0.0, 0.0, 0.0, place[0], place[1], 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_SET_ROI, parameters), ACCEPTED);
}

fn turn(flier: &mut Flier, heading_deg: f32) {
    let parameters = [heading_deg, 20.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_CONDITION_YAW, parameters), ACCEPTED);
    flier.wait_heading(f64::from(heading_deg));
}

/// Suite: MountYawVehicleForMountROI. The nose points to what is looked at; a first place to fly to ends that, and the nose points ahead;
/// what is looked at then stays in view from place to place.
#[test]
fn the_nose_points_ahead_unless_something_is_looked_at() {
    let mut flier = Flier::new();
    flier.take_off(20.0, GUIDED);
    flier.wait("20 m", 30.0, |flier| flier.height_m() > 19.8);
    turn(&mut flier, 0.0);
    look(&mut flier, [-100.0, -100.0]);
    flier.wait_heading(225.0);
    ask(&mut flier, PLACE, [3000.0, -9000.0, -20.0], [0.0; 3]);
    flier.wait_heading(288.4);
    look(&mut flier, [-100.0, -100.0]);
    flier.wait_heading(170.0);
    ask(&mut flier, PLACE, [3500.0, -9000.0, -20.0], [0.0; 3]);
    flier.fly(3.0);
    assert!(!flier.heads(288.0, 60.0), "{} deg", flier.heading_deg());
    // Velocities lead in another way.
    for _ in 0..20 {
        ask(&mut flier, VELOCITY, [0.0; 3], [0.0, 5.0, 0.0]);
        flier.fly(1.0);
    }
    assert!(flier.heads(90.0, 2.0), "{} deg", flier.heading_deg());
}

/// Suite: GuidedSubModeChange, WPYawBehaviour1RTL. WP_YAW_BEHAVIOR says whether the nose points ahead; a heading that was asked for stays
/// as long as places lead.
#[test]
fn the_nose_stays_where_it_is_if_that_is_asked_for() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    flier.wait("10 m", 30.0, |flier| flier.height_m() > 9.8);
    ask(&mut flier, PLACE, [0.0, 30.0, -10.0], [0.0; 3]);
    flier.wait_heading(90.0);
    turn(&mut flier, 45.0);
    ask(&mut flier, PLACE, [0.0, 0.0, -10.0], [0.0; 3]);
    flier.fly(6.0);
    assert!(flier.heads(45.0, 2.0), "{} deg", flier.heading_deg());
    flier.set("WP_YAW_BEHAVIOR", 0.0);
    ask(&mut flier, VELOCITY, [0.0; 3], [-3.0, 0.0, 0.0]);
    flier.fly(2.0);
    assert!(flier.heads(45.0, 2.0) && flier.speed_m_s() > 2.0, "{} deg", flier.heading_deg());
}

/// Suite: GuidedSubModeChange. A place beyond what can be flown here, off Africa, is flown towards.
#[test]
fn a_place_beyond_reach_is_flown_towards() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    flier.bench.send(MavMessage::SET_POSITION_TARGET_GLOBAL_INT(SET_POSITION_TARGET_GLOBAL_INT_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
        type_mask: PositionTargetTypemask::from_bits_retain(PLACE),
        lat_int: 5,
        lon_int: 5,
        alt: 10.0,
        ..SET_POSITION_TARGET_GLOBAL_INT_DATA::default()
    }));
    flier.wait("on the way", 30.0, |flier| flier.distance_m() > 50.0);
    let flown_m = flier.vehicle().outputs().position_m - flier.vehicle().home().position_m;
    // From 47.4 degrees north and 8.5 degrees east straight over a plane map: atan2(-8.5 cos 23.7 deg, -47.4).
    let course_deg = flown_m.y.atan2(flown_m.x).to_degrees().rem_euclid(360.0);
    assert!((course_deg - 189.3).abs() < 2.0 && (flier.height_m() - 10.0).abs() < 1.0, "{course_deg} deg");
}
