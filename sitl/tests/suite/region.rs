//! The region of interest: the nose follows it.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common::mission_flight::{Flight, at, takeoff};
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{COMMAND_INT_DATA, MavCmd, MavFrame, MavMessage};
use nalgebra::Vector3;
use vehicle::Mode;
use vehicle::identity::Identity;
use vehicle::plan::command;
use vehicle::world::LocalFrame;

const DENIED: u8 = 2;
const UNSUPPORTED_FRAME: u8 = 9;

/// COMMAND_INT at a place 10 m up.
fn command_at(bench: &mut Bench, command: MavCmd, [north, east]: [f64; 2], yaw: f32) -> u8 {
    let frame = LocalFrame::new(settings(Identity::Px4).origin);
    let place = frame.to_geodetic(&Vector3::new(north, east, -10.0));
    bench.heard.clear();
    bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        param4: yaw,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: 498.0,
        ..COMMAND_INT_DATA::default()
    }));
    bench.acks().last().expect("an answer").result
}

fn look(bench: &mut Bench, place: [f64; 2]) -> u8 {
    command_at(bench, MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, place, 0.0)
}

fn go(bench: &mut Bench, place: [f64; 2]) {
    assert_eq!(command_at(bench, MavCmd::MAV_CMD_DO_REPOSITION, place, f32::NAN), 0, "{:?}", bench.texts());
}

/// Angle between the nose and the direction to a place, degrees.
fn off_deg(bench: &Bench, [north, east]: [f64; 2]) -> f64 {
    let [x, y, _] = bench.position();
    let off_rad = yaw_rad(bench) - (east - y).atan2(north - x);
    off_rad.sin().atan2(off_rad.cos()).to_degrees().abs()
}

fn yaw_rad(bench: &Bench) -> f64 {
    bench.autopilot.vehicle().outputs().attitude_rad.z
}

fn turns_rad_s(bench: &Bench) -> f64 {
    bench.autopilot.vehicle().outputs().body_rate_rad_s.z.abs()
}

const TREE: [f64; 2] = [15.0, 10.0];

#[test]
fn it_is_followed_on_the_way_past_it() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::hovering(identity);
        // In ArduPilot a first target turns the nose away from what is looked at.
        go(&mut bench, [0.0, 0.0]);
        assert_eq!(look(&mut bench, TREE), 0, "{:?}", bench.texts());
        bench.fly(6.0);
        assert!(off_deg(&bench, TREE) < 1.0, "{identity:?}: {}", off_deg(&bench, TREE));
        go(&mut bench, [0.0, 30.0]);
        for _ in 0..100 {
            bench.fly(0.1);
            assert!(off_deg(&bench, TREE) < 5.0, "{identity:?}: {}", off_deg(&bench, TREE));
        }
        // It is left on the way back.
        go(&mut bench, [0.0, 0.0]);
        bench.fly(2.5);
        assert!(turns_rad_s(&bench) > 0.1, "{}", turns_rad_s(&bench));
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI_NONE, [0.0; 7]), 0);
        // ArduPilot's nose then turns ahead.
        bench.fly(8.0);
        let before_rad = yaw_rad(&bench);
        bench.fly(4.0);
        let turned_rad = (yaw_rad(&bench) - before_rad).abs();
        assert!(turned_rad < 0.02 && turns_rad_s(&bench) < 0.01, "{identity:?}: {turned_rad}, {before_rad}");
    }
}

/// The older command; ArduPilot's clients leave its kind zero.
#[test]
fn it_is_followed_while_braking_until_a_heading_is_asked_for() {
    for (identity, kind) in [(Identity::Px4, 3.0), (Identity::ArduPilot, 0.0)] {
        let mut bench = Bench::hovering(identity);
        go(&mut bench, [0.0, 40.0]);
        bench.fly(4.0);
        let place = LocalFrame::new(settings(identity).origin).to_geodetic(&Vector3::new(0.0, -20.0, 0.0));
        let [latitude, longitude] = [place.latitude_deg as f32, place.longitude_deg as f32];
        let parameters = [kind, 0.0, 0.0, 0.0, latitude, longitude, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_ROI, parameters), 0);
        assert_eq!(bench.set_mode(Mode::Hold), 0);
        bench.fly(12.0);
        assert!(off_deg(&bench, [0.0, -20.0]) < 2.0, "{identity:?}: {}", off_deg(&bench, [0.0, -20.0]));
        if identity == Identity::Px4 {
            assert_eq!(command_at(&mut bench, MavCmd::MAV_CMD_DO_REPOSITION, [0.0, 0.0], 0.0), 0);
            bench.fly(12.0);
            assert!(yaw_rad(&bench).abs() < 0.02, "{}", yaw_rad(&bench));
        }
    }
}

#[test]
fn what_is_none_is_refused_with_the_reason() {
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(look(&mut bench, TREE), 0);
    bench.fly(6.0);
    let (location, older) = (MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, MavCmd::MAV_CMD_DO_SET_ROI);
    for (command, parameters, reason) in [
        (location, [0.0, 0.0, 0.0, 0.0, 95.0, 8.0, 0.0], "latitude = 95; allowed -90 to 90 degrees"),
        (older, [2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0], "no item has sequence number 3; the plan has 0 items"),
        (older, [4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "kind = 4; allowed 0 to 3"),
    ] {
        assert_eq!(bench.command(command, parameters), DENIED);
        assert!(bench.texts().iter().any(|text| text.contains(reason)), "{:?}", bench.texts());
    }
    let unknown = COMMAND_INT_DATA {
        command: location,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_BODY_FRD,
        ..COMMAND_INT_DATA::default()
    };
    bench.send(MavMessage::COMMAND_INT(unknown));
    assert_eq!(bench.acks().last().expect("an answer").result, UNSUPPORTED_FRAME);
    bench.fly(3.0);
    assert!(off_deg(&bench, TREE) < 1.0, "the old one stays: {}", off_deg(&bench, TREE));
}

/// It goes before the centre of a circle.
#[test]
fn it_is_followed_around_a_circle() {
    let items = [
        takeoff(),
        at(command::DO_SET_ROI_LOCATION, [0.0; 4], [40.0, 0.0, 0.0]),
        at(command::NAV_LOITER_TURNS, [1.0, 0.0, 10.0, 0.0], [10.0, 0.0, -10.0]),
    ];
    let flight = Flight::new(&items).complete(90.0);
    let end_s = flight.time_of(2);
    let worst = flight
        .between(end_s - 10.0, end_s)
        .map(|(_, at, yaw)| (yaw - (-at.y).atan2(40.0 - at.x)).sin().abs().to_degrees())
        .fold(0.0, f64::max);
    assert!(worst < 3.0, "{worst}");
}
