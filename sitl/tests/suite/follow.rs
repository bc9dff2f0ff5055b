//! Following a target: in a line and in a curve, by PX4's and by ArduPilot's messages and parameters.

use core::f64::consts::{FRAC_PI_2, PI};

use crate::common::{Bench, settings};
use autopilot::codec::{Frame, Version};
use autopilot::envelope::{Origin, PeerId};
use mavlink::dialects::ardupilotmega::{FOLLOW_TARGET_DATA, GLOBAL_POSITION_INT_DATA, MavCmd, MavMessage};
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::{FollowHeading, FollowHeight, Mode, VehicleSettings, wrapped};

/// System id of the target.
const TARGET: u8 = 42;

/// A target that moves: where it is, and how fast.
#[derive(Clone, Copy)]
struct Moving {
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
}

/// North at 5 m/s.
fn in_a_line(time_s: f64) -> Moving {
    Moving {
        position_m: Vector3::new(5.0 * time_s + 10.0, 4.0, 0.0),
        velocity_m_s: Vector3::new(5.0, 0.0, 0.0),
    }
}

/// A circle of 40 m at 5 m/s.
fn in_a_curve(time_s: f64) -> Moving {
    let (sin, cos) = (time_s / 8.0).sin_cos();
    Moving {
        position_m: Vector3::new(40.0 * sin + 10.0, 40.0 * (1.0 - cos), 0.0),
        velocity_m_s: Vector3::new(5.0 * cos, 5.0 * sin, 0.0),
    }
}

fn send_as(bench: &mut Bench, system: u8, message: MavMessage) {
    let frame = Frame::encode(&message.into(), Version::Two, 0, (system, 1)).expect("a frame");
    let origin = Origin { peer: PeerId { link: 0, number: 7 }, system, component: 1 };
    bench.autopilot.receive(&origin, &frame);
    bench.listen();
}

/// FOLLOW_TARGET as MAVSDK sends it: place and velocity.
fn tell(bench: &mut Bench, target: &Moving) {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&target.position_m);
    let message = MavMessage::FOLLOW_TARGET(FOLLOW_TARGET_DATA {
        lat: (place.latitude_deg * 1e7).round() as i32,
        lon: (place.longitude_deg * 1e7).round() as i32,
        alt: place.altitude_m as f32,
        vel: target.velocity_m_s.map(|v| v as f32).into(),
        est_capabilities: 1,
        ..FOLLOW_TARGET_DATA::default()
    });
    send_as(bench, TARGET, message);
}

/// GLOBAL_POSITION_INT of another vehicle, above home by its height.
fn tell_position(bench: &mut Bench, target: &Moving, system: u8) {
    let vehicle = bench.autopilot.vehicle();
    let place = vehicle.frame().to_geodetic(&target.position_m);
    let heading = target.velocity_m_s.y.atan2(target.velocity_m_s.x).to_degrees().rem_euclid(360.0);
    let message = MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        time_boot_ms: (vehicle.time_us() / 1000) as u32,
        lat: (place.latitude_deg * 1e7).round() as i32,
        lon: (place.longitude_deg * 1e7).round() as i32,
        alt: (place.altitude_m * 1e3) as i32,
        relative_alt: (-target.position_m.z * 1e3) as i32,
        vx: (target.velocity_m_s.x * 100.0) as i16,
        vy: (target.velocity_m_s.y * 100.0) as i16,
        vz: 0,
        hdg: (heading * 100.0) as u16,
    });
    send_as(bench, system, message);
}

/// Flies for a time, s, while the target tells itself so many times a second, and looks at each moment.
fn follow(
    bench: &mut Bench,
    from_s: f64,
    seconds: f64,
    rate_hz: f64,
    target: fn(f64) -> Moving,
    send: impl Fn(&mut Bench, &Moving),
    mut look: impl FnMut(&Bench, &Moving),
) {
    let period = (100.0 / rate_hz) as usize;
    for step in 0..(seconds * 100.0) as usize {
        let time_s = from_s + step as f64 / 100.0;
        if step % period == 0 {
            send(bench, &target(time_s));
        }
        bench.fly(0.01);
        look(bench, &target(time_s + 0.01));
    }
}

/// Horizontally from the target to the vehicle, m, and the angle of that from where the target goes, rad.
fn beside(bench: &Bench, target: &Moving) -> (f64, f64) {
    let off = bench.autopilot.vehicle().outputs().position_m - target.position_m;
    let course = target.velocity_m_s.y.atan2(target.velocity_m_s.x);
    (off.xy().norm(), wrapped(off.y.atan2(off.x) - course))
}

fn px4(change: impl Fn(&mut VehicleSettings)) -> Bench {
    let mut settings = settings(Identity::Px4);
    change(&mut settings);
    Bench::hovering_with(&settings)
}

#[test]
fn px4_keeps_distance_and_angle_in_a_line_and_in_a_curve() {
    for (target, off_m, off_rad) in
        [(in_a_line as fn(f64) -> Moving, 0.3, 0.03), (in_a_curve as fn(f64) -> Moving, 0.6, 0.12)]
    {
        // A target that tells itself once a second, as MAVSDK lets it.
        let mut bench = px4(|settings| {
            settings.conduct.follow.distance_m = 10.0;
            settings.conduct.follow.height_m = 12.0;
        });
        assert_eq!(bench.set_mode(Mode::Follow), 0);
        assert_eq!(bench.autopilot.identity().custom_mode(bench.mode()), 4 << 16 | 8 << 24);
        follow(&mut bench, 0.0, 40.0, 1.0, target, tell, |_, _| {});
        let (mut distances, mut angles, mut headings) = (Vec::new(), Vec::new(), Vec::new());
        follow(&mut bench, 40.0, 20.0, 1.0, target, tell, |bench, target| {
            let (distance, angle) = beside(bench, target);
            distances.push((distance - 10.0).abs());
            angles.push(wrapped(angle - PI).abs());
            let way = target.position_m - bench.autopilot.vehicle().outputs().position_m;
            headings
                .push(wrapped(bench.autopilot.vehicle().outputs().attitude_rad.z - way.y.atan2(way.x)).abs());
        });
        let worst = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let (distance, angle, heading) = (worst(&distances), worst(&angles), worst(&headings));
        assert!(distance < off_m, "{distance} m from its distance");
        assert!(angle < off_rad, "{angle} rad from its angle");
        assert!(heading < 0.1, "{heading} rad beside the target");
        assert!((bench.position()[2] + 12.0).abs() < 0.2, "{:?}", bench.position());
    }
}

/// From the right, at a height above a target that is up a hill, and only after it has climbed.
#[test]
fn px4_follows_at_an_angle_and_above_the_target() {
    let mut bench = px4(|settings| {
        settings.conduct.follow.angle_rad = FRAC_PI_2;
        settings.conduct.follow.height = FollowHeight::Target;
        settings.conduct.follow.height_m = 15.0;
    });
    let hill = |time_s: f64| Moving {
        position_m: in_a_line(time_s).position_m - Vector3::z() * 5.0,
        ..in_a_line(time_s)
    };
    assert_eq!(bench.set_mode(Mode::Follow), 0);
    follow(&mut bench, 0.0, 1.5, 1.0, hill, tell, |_, _| {});
    let [x, ..] = bench.position();
    assert!(x.abs() < 1.0, "{x}: it climbs first");
    follow(&mut bench, 1.5, 50.0, 1.0, hill, tell, |_, _| {});
    let (distance, angle) = beside(&bench, &hill(51.5));
    assert!((distance - 8.0).abs() < 0.3 && (angle - FRAC_PI_2).abs() < 0.05, "{distance} {angle}");
    assert!((bench.position()[2] + 20.0).abs() < 0.2, "{:?}", bench.position());
}

#[test]
fn a_target_that_falls_silent_is_lost_and_found_again() {
    let mut bench = px4(|_| {});
    assert_eq!(bench.set_mode(Mode::Follow), 0);
    follow(&mut bench, 0.0, 20.0, 1.0, in_a_line, tell, |_, _| {});
    bench.heard.clear();
    bench.fly(8.0);
    assert!(bench.texts().iter().any(|text| text == "Target lost: holding"), "{:?}", bench.texts());
    let velocity = Vector3::from(bench.velocity()).norm();
    assert!(velocity < 0.1 && bench.mode() == Mode::Follow, "{velocity}");
    bench.heard.clear();
    follow(&mut bench, 28.0, 30.0, 2.0, in_a_line, tell, |_, _| {});
    assert!(bench.texts().iter().any(|text| text == "Following the target"), "{:?}", bench.texts());
    let (distance, _) = beside(&bench, &in_a_line(58.0));
    assert!((distance - 8.0).abs() < 0.4, "{distance}");
}

fn ardupilot(change: impl Fn(&mut VehicleSettings)) -> Bench {
    let mut settings = settings(Identity::ArduPilot);
    settings.conduct.follow.enabled = true;
    change(&mut settings);
    Bench::hovering_with(&settings)
}

fn told_as_vehicle(bench: &mut Bench, target: &Moving) {
    tell_position(bench, target, TARGET);
}

/// Behind and beside another vehicle, an offset that turns with it.
#[test]
fn ardupilot_keeps_its_offset_from_another_vehicle() {
    for target in [in_a_line as fn(f64) -> Moving, in_a_curve] {
        let mut bench = ardupilot(|settings| {
            let follow = &mut settings.conduct.follow;
            follow.offset_turns = true;
            (follow.offset_x_m, follow.offset_y_m, follow.offset_z_m) = (-12.0, 5.0, -10.0);
            follow.system_id = TARGET;
        });
        assert_eq!(bench.set_mode(Mode::Follow), 0);
        assert_eq!(bench.autopilot.identity().custom_mode(bench.mode()), 23);
        follow(&mut bench, 0.0, 40.0, 5.0, target, told_as_vehicle, |_, _| {});
        let mut worst: f64 = 0.0;
        follow(&mut bench, 40.0, 20.0, 5.0, target, told_as_vehicle, |bench, target| {
            let (distance, angle) = beside(bench, target);
            let expected = Vector3::new(-12.0, 5.0, 0.0);
            let (sin, cos) = angle.sin_cos();
            let off = Vector3::new(distance * cos, distance * sin, 0.0) - expected;
            worst = worst.max(off.norm());
        });
        assert!(worst < 0.7, "{worst} m off");
        assert!((bench.position()[2] + 10.0).abs() < 0.2, "{:?}", bench.position());
    }
}

#[test]
fn ardupilot_follows_only_whom_it_is_to_and_only_so_far() {
    const FAILED: u8 = 4;
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(bench.set_mode(Mode::Follow), FAILED);
    assert!(bench.texts().iter().any(|text| text.contains("FOLL_ENABLE")), "{:?}", bench.texts());

    let near = |_: f64| Moving { position_m: Vector3::new(20.0, 0.0, -10.0), velocity_m_s: Vector3::zeros() };
    let mut bench = ardupilot(|settings| settings.conduct.follow.offset_x_m = 5.0);
    assert_eq!(
        bench.command(MavCmd::MAV_CMD_DO_FOLLOW, [f32::from(TARGET), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        0
    );
    assert_eq!(bench.set_mode(Mode::Follow), 0);
    follow(&mut bench, 0.0, 8.0, 5.0, near, |bench, target| tell_position(bench, target, 43), |_, _| {});
    assert!(bench.position()[0].abs() < 0.2, "{:?}: that is somebody else", bench.position());
    follow(&mut bench, 0.0, 15.0, 5.0, near, told_as_vehicle, |_, _| {});
    assert!((bench.position()[0] - 25.0).abs() < 0.2, "{:?}", bench.position());
    // FOLL_DIST_MAX
    let far = |_: f64| Moving { position_m: Vector3::new(200.0, 0.0, -10.0), velocity_m_s: Vector3::zeros() };
    follow(&mut bench, 0.0, 8.0, 5.0, far, told_as_vehicle, |_, _| {});
    assert!((bench.position()[0] - 25.0).abs() < 0.5, "{:?}", bench.position());
}

/// Without an offset of its own it keeps the one that it has, and points where the other one points.
#[test]
fn ardupilot_keeps_the_offset_of_the_start_and_the_heading_of_the_target() {
    let mut bench = ardupilot(|settings| settings.conduct.follow.heading = FollowHeading::SameAsTarget);
    let east = |time_s: f64| Moving {
        position_m: Vector3::new(6.0, 3.0 * time_s - 8.0, -10.0),
        velocity_m_s: Vector3::new(0.0, 3.0, 0.0),
    };
    assert_eq!(bench.set_mode(Mode::Follow), 0);
    follow(&mut bench, 0.0, 30.0, 5.0, east, told_as_vehicle, |_, _| {});
    let off = Vector3::from(bench.position()) - east(30.0).position_m;
    assert!((off - Vector3::new(-6.0, 8.0, 0.0)).norm() < 0.5, "{off}");
    let heading = bench.autopilot.vehicle().outputs().attitude_rad.z;
    assert!((heading - FRAC_PI_2).abs() < 0.05, "{heading}");
}
