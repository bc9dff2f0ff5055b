//! Where the nose points in Guided.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use super::flier::*;
use crate::common::requests::local_target;
use mavlink::Message as _;
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

/// The only message of a kind that a request for it brings.
macro_rules! requested {
    ($flier:expr, $kind:ident, $data:ident) => {{
        $flier.bench.heard.clear();
        let wanted = MavMessage::$kind($data::DEFAULT).message_id() as f32;
        let asked = [wanted, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!($flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, asked), ACCEPTED);
        $flier.fly(0.05);
        let told = $flier.latest(|message| match message {
            MavMessage::$kind(data) => Some(data.clone()),
            _ => None,
        });
        told.expect(stringify!($kind))
    }};
}

/// Programs wait for NAV_CONTROLLER_OUTPUT.wp_dist: it is the distance to the place that was asked for, not that to the reference on the
/// way there. POSITION_TARGET_GLOBAL_INT is that place, and nothing else of it counts.
#[test]
fn the_distance_to_the_place_that_was_asked_for_is_told() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    flier.wait("10 m", 30.0, |flier| flier.height_m() > 9.8);
    ask(&mut flier, PLACE, [0.0, 40.0, -12.0], [0.0; 3]);
    flier.wait("on the way", 30.0, |flier| flier.distance_m() > 5.0);
    let told = requested!(flier, NAV_CONTROLLER_OUTPUT, NAV_CONTROLLER_OUTPUT_DATA);
    assert!((f64::from(told.wp_dist) - (40.0 - flier.distance_m())).abs() < 1.5, "{}", told.wp_dist);
    assert_eq!(told.target_bearing, 90);
    let target = requested!(flier, POSITION_TARGET_GLOBAL_INT, POSITION_TARGET_GLOBAL_INT_DATA);
    let there = flier.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(0.0, 40.0, -12.0));
    assert!((f64::from(target.lat_int) - there.latitude_deg * 1e7).abs() < 2.0);
    assert!((f64::from(target.lon_int) - there.longitude_deg * 1e7).abs() < 2.0);
    assert!((f64::from(target.alt) - there.altitude_m).abs() < 0.01);
    assert_eq!((target.type_mask.bits(), target.vy), (0b1111_1111_1000, 0.0));
    flier.change_mode(RTL);
    flier.wait("on the way home", 60.0, |flier| flier.height_m() > 14.8);
    flier.fly(2.0);
    let told = requested!(flier, NAV_CONTROLLER_OUTPUT, NAV_CONTROLLER_OUTPUT_DATA);
    assert!((f64::from(told.wp_dist) - flier.distance_m()).abs() < 1.5, "{}", told.wp_dist);
    assert!(flier.distance_m() > 3.0, "{} m", flier.distance_m());
}

/// ArduCopter has NAV_GUIDED_ENABLE only in missions: as a command it is unknown, and leaves the mode as it is.
#[test]
fn guided_is_not_enabled_by_a_command() {
    let mut flier = Flier::new();
    flier.take_off(5.0, GUIDED);
    assert_eq!(
        flier.command(MavCmd::MAV_CMD_NAV_GUIDED_ENABLE, [0.0; 7]),
        MavResult::MAV_RESULT_UNSUPPORTED as u8
    );
    assert_eq!(flier.mode(), GUIDED);
}

/// GCS_MAVLINK_Copter::handle_command_int_do_reposition: outside of Guided it is denied without the flag that changes the mode.
#[test]
fn a_reposition_leaves_other_modes_alone_unless_it_may_change_them() {
    let mut flier = Flier::new();
    flier.take_off(10.0, LOITER);
    let there = flier.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(20.0, 0.0, -10.0));
    let place = [there.latitude_deg as f32, there.longitude_deg as f32, there.altitude_m as f32];
    let with = |flag: f32| [-1.0, flag, 0.0, f32::NAN, place[0], place[1], place[2]];
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_REPOSITION, with(0.0)), MavResult::MAV_RESULT_DENIED as u8);
    assert_eq!(flier.mode(), LOITER);
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_REPOSITION, with(1.0)), ACCEPTED);
    assert_eq!(flier.mode(), GUIDED);
    // There it is a target like another.
    assert_eq!(flier.command(MavCmd::MAV_CMD_DO_REPOSITION, with(0.0)), ACCEPTED);
}

/// Suite: GuidedRejectOutsideFence.
#[test]
fn a_place_beyond_the_fence_fails() {
    let mut flier = Flier::new();
    flier.set_all(&[
        ("FENCE_TYPE", 2.0),
        ("FENCE_RADIUS", 50.0),
        ("FENCE_ACTION", 0.0),
        ("FENCE_ENABLE", 1.0),
    ]);
    flier.take_off(10.0, GUIDED);
    let home = crate::common::settings(vehicle::identity::Identity::ArduPilot).origin;
    for (north_m, result) in [(10.0, ACCEPTED), (200.0, FAILED)] {
        flier.bench.heard.clear();
        flier.bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            target_system: 1,
            target_component: 1,
            command: MavCmd::MAV_CMD_DO_REPOSITION,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            x: ((home.latitude_deg + north_m / 111_194.9) * 1e7) as i32,
            y: (home.longitude_deg * 1e7) as i32,
            z: 10.0,
            ..COMMAND_INT_DATA::default()
        }));
        let acks = flier.bench.acks();
        assert_eq!(acks.last().map(|ack| ack.result), Some(result), "{north_m} m: {:?}", flier.bench.texts());
    }
}

/// A turn keeps to the rate that it is asked for, from rest to rest.
#[test]
fn a_turn_keeps_to_its_rate() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    flier.fly(5.0);
    let turn = [180.0, 30.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_CONDITION_YAW, turn), ACCEPTED);
    let mut fastest_deg_s = 0.0_f64;
    for _ in 0..110 {
        flier.fly(0.1);
        fastest_deg_s = fastest_deg_s.max(flier.vehicle().outputs().body_rate_rad_s.z.to_degrees());
    }
    assert!((29.0..32.5).contains(&fastest_deg_s), "{fastest_deg_s}");
    assert!(flier.heads(180.0, 2.0), "{}", flier.heading_deg());
}
