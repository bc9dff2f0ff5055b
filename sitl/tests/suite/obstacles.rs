//! Obstacles of a world: measured, kept away from, and touched. The oracles are the sources' semantics and plane geometry.

use crate::common;
use crate::common::Bench;
use crate::common::failsafe_bench::set;
use crate::common::requests::local_target;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::Mode;
use vehicle::identity::Identity;
use vehicle::surroundings::{Obstacle, Shape};

/// 20 m north of the start, ten wide and twenty high; its near side is at 19 m.
fn house() -> Obstacle {
    let shape = Shape::Box { centre_m: [20.0, 0.0], size_m: [2.0, 10.0], heading_rad: 0.0 };
    Obstacle { name: "house".to_owned(), shape, bottom_m: 0.0, top_m: 20.0 }
}

fn pole() -> Obstacle {
    let shape = Shape::Cylinder { centre_m: [0.0, -8.0], radius_m: 0.5 };
    Obstacle { name: "pole".to_owned(), shape, bottom_m: 0.0, top_m: 30.0 }
}

/// Hovering 10 m above the start.
fn hovering(identity: Identity, obstacles: Vec<Obstacle>) -> Bench {
    let mut settings = common::settings(identity);
    settings.surroundings.obstacles = obstacles;
    Bench::hovering_with(&settings)
}

/// The stick forward, as MANUAL_CONTROL.
fn push_forward(bench: &mut Bench) {
    bench.send(MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
        target: 1,
        x: 1000,
        z: 500,
        ..MANUAL_CONTROL_DATA::default()
    }));
}

fn velocity_north(bench: &mut Bench, speed: f32) {
    bench.send(local_target(0x0DC7, [0.0; 3], [speed, 0.0, 0.0]));
}

/// OBSTACLE_DISTANCE of a companion computer: something in the middle sector of the nose.
fn companion_sees(bench: &mut Bench, distance_cm: u16) {
    let mut distances = [3001; 72];
    distances[0] = distance_cm;
    bench.send(MavMessage::OBSTACLE_DISTANCE(OBSTACLE_DISTANCE_DATA {
        distances,
        min_distance: 20,
        max_distance: 3000,
        increment: 5,
        frame: MavFrame::MAV_FRAME_BODY_FRD,
        ..OBSTACLE_DISTANCE_DATA::default()
    }));
}

#[test]
fn the_lidar_and_the_rangefinder_tell_what_is_there() {
    let mut bench = hovering(Identity::Px4, vec![house(), pole()]);
    bench.heard.clear();
    bench.fly(1.1);
    let scan = bench.heard.iter().find_map(|message| match message {
        Message::Typed(MavMessage::OBSTACLE_DISTANCE(scan)) => Some(scan.clone()),
        _ => None,
    });
    let scan = scan.expect("once a second");
    assert_eq!((scan.frame, scan.increment, scan.max_distance), (MavFrame::MAV_FRAME_BODY_FRD, 5, 4000));
    assert!(scan.distances[0].abs_diff(1900) < 10, "the house ahead: {}", scan.distances[0]);
    assert!(scan.distances[54].abs_diff(750) < 10, "the pole to the left: {}", scan.distances[54]);
    assert_eq!(scan.distances[36], 4001, "nothing behind");
    let below = bench.heard.iter().find_map(|message| match message {
        Message::Typed(MavMessage::DISTANCE_SENSOR(range)) => Some(range.clone()),
        _ => None,
    });
    let below = below.expect("once a second");
    assert_eq!(below.orientation, MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270);
    assert!(below.current_distance.abs_diff(1000) < 10, "{}", below.current_distance);
    let bits = bench.heard.iter().find_map(|message| match message {
        Message::Typed(MavMessage::SYS_STATUS(status)) => Some(status.onboard_control_sensors_present),
        _ => None,
    });
    let both = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_PROXIMITY
        | MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_LASER_POSITION;
    assert!(bits.expect("once a second").contains(both));
}

/// PX4's CP_DIST in Position mode, ArduPilot's AVOID_MARGIN in Loiter: the stick stays forward and the vehicle stops.
#[test]
fn sticks_stop_before_an_obstacle() {
    for (identity, parameters) in [
        (Identity::Px4, &[("CP_DIST", 5.0)][..]),
        (Identity::ArduPilot, &[("AVOID_MARGIN", 5.0), ("PRX1_TYPE", 4.0)]),
    ] {
        let mut bench = hovering(identity, vec![house()]);
        parameters.iter().for_each(|(name, value)| set(&mut bench, name, *value));
        assert_eq!(bench.set_mode(Mode::Position), 0);
        bench.heard.clear();
        bench.stream(20.0, push_forward);
        let [north, ..] = bench.position();
        assert!((12.9..=14.05).contains(&north), "{identity:?}: {north}: 5 m before 19 m");
        assert!(bench.velocity()[0].abs() < 0.1, "{identity:?}: it stands");
        let told = bench.texts().iter().any(|text| text == "Obstacle ahead: stopping");
        assert_eq!(told, identity == Identity::Px4, "{:?}", bench.texts());
        // Away from it goes as ever.
        bench.stream(3.0, |bench| {
            bench.send(MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
                target: 1,
                x: -1000,
                z: 500,
                ..MANUAL_CONTROL_DATA::default()
            }));
        });
        assert!(bench.position()[0] < north - 5.0, "{identity:?}");
    }
}

/// Off by default, as in both originals; the flight ends at the wall then.
#[test]
fn without_the_parameter_it_collides_and_the_flight_ends() {
    let mut bench = hovering(Identity::Px4, vec![house()]);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    bench.heard.clear();
    bench.stream(8.0, push_forward);
    assert!(bench.texts().iter().any(|text| text == "Collision with house"), "{:?}", bench.texts());
    assert!(!bench.autopilot.vehicle().is_armed());
    assert!(bench.autopilot.vehicle().is_terminated());
}

#[test]
fn guided_velocities_stop_before_an_obstacle_with_ardupilots_avoidance() {
    let mut bench = hovering(Identity::ArduPilot, vec![house()]);
    set(&mut bench, "AVOID_MARGIN", 4.0);
    set(&mut bench, "PRX1_TYPE", 4.0);
    bench.stream(15.0, |bench| velocity_north(bench, 4.0));
    let [north, ..] = bench.position();
    assert!((13.9..=15.05).contains(&north), "{north}: 4 m before 19 m");
    // Bit 2 is what looks at the proximity sensor.
    set(&mut bench, "AVOID_ENABLE", 1.0);
    bench.stream(2.0, |bench| velocity_north(bench, 1.0));
    assert!(bench.position()[0] > north + 0.5);
}

#[test]
fn what_a_companion_computer_sees_stops_it_too_and_without_data_px4_stays() {
    let mut bench = hovering(Identity::Px4, Vec::new());
    set(&mut bench, "CP_DIST", 3.0);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    bench.heard.clear();
    bench.stream(2.0, push_forward);
    assert!(bench.position()[0].abs() < 0.1, "{:?}", bench.position());
    assert!(bench.texts().iter().any(|text| text == "No range data: not moving"), "{:?}", bench.texts());
    // A wall 12 m north of the start, as a companion computer measures it.
    bench.stream(10.0, |bench| {
        let away = (12.0 - bench.position()[0]) * 100.0;
        companion_sees(bench, away.max(20.0) as u16);
        push_forward(bench);
    });
    let [north, ..] = bench.position();
    assert!((7.9..=9.05).contains(&north), "{north}: 3 m before 12 m");
}

/// A step that no scan can have makes it no data, and an offset counts modulo a turn.
#[test]
fn scans_that_make_no_sense_are_passed_over() {
    let mut bench = hovering(Identity::Px4, Vec::new());
    set(&mut bench, "CP_DIST", 3.0);
    assert_eq!(bench.set_mode(Mode::Position), 0);
    let scan = |increment_f, angle_offset, distances| OBSTACLE_DISTANCE_DATA {
        distances,
        max_distance: 3000,
        increment_f,
        angle_offset,
        frame: MavFrame::MAV_FRAME_BODY_FRD,
        ..OBSTACLE_DISTANCE_DATA::default()
    };
    bench.stream(2.0, |bench| {
        for increment_f in [f32::MAX, -1e9, 361.0, f32::NAN, f32::INFINITY] {
            bench.send(MavMessage::OBSTACLE_DISTANCE(scan(increment_f, 0.0, [3001; 72])));
        }
        push_forward(bench);
    });
    assert!(bench.position()[0].abs() < 0.1, "no data: {:?}", bench.position());
    bench.stream(10.0, |bench| {
        let mut distances = [3001; 72];
        distances[36] = ((12.0 - bench.position()[0]) * 100.0).max(20.0) as u16;
        bench.send(MavMessage::OBSTACLE_DISTANCE(scan(5.0, 180.0 - 360.0 * 1000.0, distances)));
        push_forward(bench);
    });
    let [north, ..] = bench.position();
    assert!((7.9..=9.05).contains(&north), "{north}: 3 m before 12 m");
}

/// ArduPilot's rangefinder, without a world.
#[test]
fn a_rangefinder_is_there_if_its_parameter_says_so() {
    let mut bench = hovering(Identity::ArduPilot, Vec::new());
    let ask = |bench: &mut Bench| {
        bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [173.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    assert_eq!(ask(&mut bench), 3, "none by default");
    set(&mut bench, "RNGFND1_TYPE", 1.0);
    bench.fly(0.2);
    assert_eq!(ask(&mut bench), 0);
    let told = bench.heard.iter().find_map(|message| match message {
        Message::Typed(MavMessage::RANGEFINDER(range)) => Some(range.distance),
        _ => None,
    });
    assert!((told.expect("a range") - 10.0).abs() < 0.1);
}
