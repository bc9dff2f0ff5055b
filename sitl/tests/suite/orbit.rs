//! Orbits: the circle that is flown, its heading, its status, and ArduPilot's circle by its parameters.

use core::f64::consts::PI;

use crate::common::requests::set_parameter;
use crate::common::{Bench, settings};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{COMMAND_INT_DATA, MANUAL_CONTROL_DATA, MavCmd, MavFrame, MavMessage};
use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::{HeadingPolicy, Mode, OrbitSettings, VehicleSettings, wrapped};

const NAN: f32 = f32::NAN;

/// DO_ORBIT around a place of the local frame, at the height of now.
fn orbit(bench: &mut Bench, [x, y]: [f64; 2], radius: f32, speed: f32, behaviour: f32, way: f32) -> u8 {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(x, y, bench.position()[2]));
    bench.heard.clear();
    bench.send(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        target_system: 1,
        target_component: 1,
        // As MAVSDK sends it: an altitude above sea level in this frame.
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        command: MavCmd::MAV_CMD_DO_ORBIT,
        param1: radius,
        param2: speed,
        param3: behaviour,
        param4: way,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: place.altitude_m as f32,
        ..COMMAND_INT_DATA::default()
    }));
    bench.acks().last().expect("answered").result
}

/// What is seen of a circle.
#[derive(Debug, Default)]
struct Seen {
    /// Farthest from the radius and from the height, m.
    off_radius_m: f64,
    off_height_m: f64,
    /// Angle flown, rad, clockwise positive, and the farthest heading from the expected one, rad.
    swept_rad: f64,
    off_heading_rad: f64,
    speed_m_s: f64,
}

/// Looks at the flight around a centre for a time, s. The heading is expected at an angle from the direction to the centre, rad.
fn look(bench: &mut Bench, centre_m: Vector3<f64>, radius_m: f64, heading_rad: f64, seconds: f64) -> Seen {
    let mut seen = Seen::default();
    let mut before: Option<f64> = None;
    for _ in 0..(seconds * 100.0) as usize {
        bench.fly(0.01);
        let outputs = *bench.autopilot.vehicle().outputs();
        let off = outputs.position_m - centre_m;
        let angle = off.y.atan2(off.x);
        seen.swept_rad += before.map_or(0.0, |before| wrapped(angle - before));
        before = Some(angle);
        let off_heading = wrapped(outputs.attitude_rad.z - angle - PI - heading_rad).abs();
        seen.off_radius_m = seen.off_radius_m.max((off.xy().norm() - radius_m).abs());
        seen.off_height_m = seen.off_height_m.max(off.z.abs());
        seen.off_heading_rad = seen.off_heading_rad.max(off_heading);
        seen.speed_m_s = outputs.velocity_m_s.xy().norm();
    }
    seen
}

/// Circles of 10 to 50 m at 2 to 5 m/s are kept to a few decimetres, the nose at the centre.
#[test]
fn an_orbit_keeps_its_radius_and_points_to_its_centre() {
    for (radius, speed) in [(10.0_f32, 2.0_f32), (-10.0, 4.0), (20.0, 5.0), (-50.0, 5.0)] {
        let mut bench = Bench::hovering(Identity::Px4);
        let z = bench.autopilot.vehicle().outputs().setpoint.position_m.z;
        let (r, v) = (f64::from(radius.abs()), f64::from(speed));
        // The vehicle is inside of the circle, near it.
        let centre = [r - 3.0, 0.0];
        assert_eq!(orbit(&mut bench, centre, radius, speed, 0.0, NAN), 0);
        assert_eq!(bench.mode(), Mode::Orbit);
        bench.fly(25.0);
        let centre_m = Vector3::new(centre[0], centre[1], z);
        let seen = look(&mut bench, centre_m, r, 0.0, 20.0);
        assert!(seen.off_radius_m < 0.2 && seen.off_height_m < 0.2, "{radius} m, {speed} m/s: {seen:?}");
        assert!(seen.off_heading_rad < 3_f64.to_radians(), "{radius} m, {speed} m/s: {seen:?}");
        let expected = v / r * 20.0 * f64::from(radius.signum());
        assert!((seen.swept_rad / expected - 1.0).abs() < 0.02, "{seen:?}, expected {expected}");
    }
}

/// PX4 lets no more than 2 m/s² point to the centre: the radius goes before the speed.
#[test]
fn an_orbit_that_is_too_fast_for_its_radius_is_flown_slower() {
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 8.0, 0.0, NAN), 0);
    bench.fly(25.0);
    let z = bench.autopilot.vehicle().outputs().setpoint.position_m.z;
    let seen = look(&mut bench, Vector3::new(10.0, 0.0, z), 10.0, 0.0, 10.0);
    assert!((seen.speed_m_s - 20_f64.sqrt()).abs() < 0.15 && seen.off_radius_m < 0.3, "{seen:?}");
}

#[test]
fn yaw_behaviours_are_kept_and_the_status_is_told() {
    let mut bench = Bench::hovering(Identity::Px4);
    let z = bench.autopilot.vehicle().outputs().setpoint.position_m.z;
    // Tangent to the circle, clockwise: a quarter turn from the centre counter-clockwise.
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 3.0, 3.0, NAN), 0);
    bench.fly(25.0);
    let seen = look(&mut bench, Vector3::new(10.0, 0.0, z), 10.0, -PI / 2.0, 10.0);
    assert!(seen.off_heading_rad < 0.06, "{seen:?}");
    bench.heard.clear();
    bench.fly(2.0);
    let status = |message: &Message| match message {
        Message::Typed(MavMessage::ORBIT_EXECUTION_STATUS(status)) => Some(status.clone()),
        _ => None,
    };
    let told: Vec<_> = bench.heard.iter().filter_map(status).collect();
    assert!((3..=5).contains(&told.len()), "{}", told.len());
    // ORBIT_EXECUTION_STATUS at ten per second, as clients can ask.
    let often = [360.0, 100_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, often), 0);
    bench.heard.clear();
    bench.fly(1.0);
    assert!((9..=11).contains(&bench.heard.iter().filter_map(status).count()));
    let centre = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(10.0, 0.0, z));
    assert!((f64::from(told[0].x) / 1e7 - centre.latitude_deg).abs() < 1e-6 && told[0].radius == 10.0);
    assert!((f64::from(told[0].z) - centre.altitude_m).abs() < 0.1, "{} {}", told[0].z, centre.altitude_m);
    // The heading of the start, and another way round: both are taken up on the same orbit.
    let heading = bench.autopilot.vehicle().outputs().attitude_rad.z;
    assert_eq!(orbit(&mut bench, [10.0, 0.0], -10.0, NAN, 1.0, NAN), 0);
    bench.fly(12.0);
    let before = bench.autopilot.vehicle().outputs().attitude_rad.z;
    assert!(wrapped(before - heading).abs() < 0.06, "{before} {heading}");
    let seen = look(&mut bench, Vector3::new(10.0, 0.0, z), 10.0, 0.0, 5.0);
    assert!(seen.swept_rad < -1.0, "{seen:?}");
    assert!(wrapped(bench.autopilot.vehicle().outputs().attitude_rad.z - heading).abs() < 0.06);
    // Another mode ends it.
    assert_eq!(bench.set_mode(Mode::Hold), 0);
    bench.fly(1.0);
    bench.heard.clear();
    bench.fly(2.0);
    assert!(bench.heard.iter().filter_map(status).next().is_none());
}

#[test]
fn a_part_of_a_circle_ends_where_it_is_to() {
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 3.0, 0.0, PI as f32), 0);
    bench.fly_until("half a circle", 40.0, |bench| bench.mode() == Mode::Hold);
    bench.fly(3.0);
    let [x, y, _] = bench.position();
    assert!((x - 20.0).abs() < 0.2 && y.abs() < 0.2, "{x} {y}");
}

#[test]
fn orbits_that_cannot_be_flown_are_refused() {
    const TEMPORARILY_REJECTED: u8 = 1;
    const DENIED: u8 = 2;
    const UNSUPPORTED: u8 = 3;
    let mut bench = Bench::new(Identity::Px4);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 3.0, 0.0, NAN), TEMPORARILY_REJECTED);
    let mut settings = settings(Identity::Px4);
    settings.conduct.failsafe.fence_radius_m = 25.0;
    let mut bench = Bench::hovering_with(&settings);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 20.0, 3.0, 0.0, NAN), DENIED);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 3.0, 9.0, NAN), DENIED);
    assert_eq!(bench.mode(), Mode::Hold);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 3.0, 5.0, NAN), 0);
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(orbit(&mut bench, [10.0, 0.0], 10.0, 3.0, 0.0, NAN), UNSUPPORTED);
    assert!(bench.texts().iter().any(|text| text.contains("CIRCLE mode")), "{:?}", bench.texts());
}

fn circle(orbit: OrbitSettings) -> VehicleSettings {
    let mut settings = settings(Identity::ArduPilot);
    settings.conduct.orbit = orbit;
    settings.conduct.heading_policy = HeadingPolicy::Hold;
    settings
}

/// ArduPilot: the centre lies ahead by the radius, and the rate is an angle per time.
#[test]
fn ardupilot_circles_around_a_place_ahead_of_it() {
    let orbit =
        OrbitSettings { radius_m: 12.0, rate_rad_s: -15_f64.to_radians(), ..OrbitSettings::default() };
    let mut bench = Bench::hovering_with(&circle(orbit));
    assert_eq!(bench.set_mode(Mode::Orbit), 0);
    assert_eq!(bench.autopilot.identity().custom_mode(bench.mode()), 7);
    bench.fly(10.0);
    let z = bench.autopilot.vehicle().outputs().setpoint.position_m.z;
    // The vehicle looks north.
    let centre_m = Vector3::new(12.0, 0.0, z);
    let seen = look(&mut bench, centre_m, 12.0, 0.0, 20.0);
    assert!(seen.off_radius_m < 0.2 && seen.off_heading_rad < 0.06, "{seen:?}");
    assert!((seen.swept_rad / (-15_f64.to_radians() * 20.0) - 1.0).abs() < 0.03, "{seen:?}");
    // A parameter that changes is flown at once, around the same centre.
    bench.send(set_parameter("CIRCLE_RADIUS", 800.0));
    bench.fly(15.0);
    let seen = look(&mut bench, centre_m, 8.0, 0.0, 10.0);
    assert!(seen.off_radius_m < 0.2, "{seen:?}");
}

/// Without a radius it turns on the spot.
#[test]
fn ardupilot_turns_on_the_spot_without_a_radius() {
    let mut bench =
        Bench::hovering_with(&circle(OrbitSettings { radius_m: 0.0, ..OrbitSettings::default() }));
    let before = bench.position();
    assert_eq!(bench.set_mode(Mode::Orbit), 0);
    bench.fly(4.0);
    let mut turned = 0.0;
    let mut last = bench.autopilot.vehicle().outputs().attitude_rad.z;
    for _ in 0..1000 {
        bench.fly(0.01);
        let now = bench.autopilot.vehicle().outputs().attitude_rad.z;
        turned += wrapped(now - last);
        last = now;
    }
    assert!((turned - 200_f64.to_radians()).abs() < 0.1, "{turned}");
    assert!((Vector3::from(bench.position()) - Vector3::from(before)).norm() < 0.2);
}

/// What is not there is refused by its name, with what to use instead.
#[test]
fn absent_modes_name_a_remedy() {
    const UNSUPPORTED: u8 = 3;
    const FAILED: u8 = 4;
    for (identity, main, sub, name, instead) in [
        (Identity::ArduPilot, 15.0, 0.0, "AutoTune", "need no tuning"),
        (Identity::ArduPilot, 11.0, 0.0, "Drift", "Loiter"),
        (Identity::ArduPilot, 28.0, 0.0, "Turtle", "restart"),
        (Identity::Px4, 4.0, 9.0, "Precision Land", "use Land"),
        (Identity::Px4, 4.0, 11.0, "External 1", "Offboard"),
    ] {
        let mut bench = Bench::new(identity);
        let result = bench.command(MavCmd::MAV_CMD_DO_SET_MODE, [1.0, main, sub, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(result, if identity.is_ardupilot() { FAILED } else { UNSUPPORTED }, "{name}");
        let texts = bench.texts();
        assert!(texts.iter().any(|text| text.contains(name) && text.contains(instead)), "{texts:?}");
    }
}

/// The throttle climbs on a circle, and the yaw stick takes the heading of ArduPilot's.
#[test]
fn sticks_change_height_and_heading_of_a_circle() {
    let mut bench = Bench::hovering_with(&circle(OrbitSettings::default()));
    assert_eq!(bench.set_mode(Mode::Orbit), 0);
    bench.fly(8.0);
    let before = bench.position()[2];
    let sticks = |bench: &mut Bench, z: i16, r: i16| {
        bench.send(MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
            z,
            r,
            target: 1,
            ..MANUAL_CONTROL_DATA::default()
        }));
    };
    bench.stream(4.0, |bench| sticks(bench, 1000, 0));
    bench.stream(4.0, |bench| sticks(bench, 500, 0));
    let z = bench.position()[2];
    assert!(z < before - 3.0, "{before} {z}");
    let seen = look(&mut bench, Vector3::new(10.0, 0.0, z), 10.0, 0.0, 0.4);
    assert!(seen.off_radius_m < 0.2 && seen.off_height_m < 0.2 && seen.off_heading_rad < 0.06, "{seen:?}");
    bench.stream(2.0, |bench| sticks(bench, 500, 1000));
    let seen = look(&mut bench, Vector3::new(10.0, 0.0, z), 10.0, 0.0, 0.4);
    assert!(seen.off_radius_m < 0.2 && seen.off_heading_rad > 0.3, "{seen:?}");
}
