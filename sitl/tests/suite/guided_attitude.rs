//! ArduPilot's attitudes from outside: GUIDED_NOGPS, and what the thrust of SET_ATTITUDE_TARGET asks for.

use crate::common::requests::local_target;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{AttitudeTargetTypemask, MavMessage, SET_ATTITUDE_TARGET_DATA};
use nalgebra::{UnitQuaternion, Vector3};
use vehicle::Mode;
use vehicle::identity::Identity;

/// SET_ATTITUDE_TARGET with angles, rad, and a thrust.
fn lean(bench: &mut Bench, [roll, pitch, yaw]: [f64; 3], thrust: f32) {
    let q = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    let rates = AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE
        | AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE
        | AttitudeTargetTypemask::ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE;
    bench.send(MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
        q: [q.w as f32, q.i as f32, q.j as f32, q.k as f32],
        thrust,
        target_system: 1,
        target_component: 1,
        type_mask: rates,
        ..SET_ATTITUDE_TARGET_DATA::default()
    }));
}

/// Places and velocities mean nothing without GPS; it stays level and at its height.
#[test]
fn guided_without_gps_takes_attitudes_only() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(bench.set_mode(Mode::GuidedAttitude), 0);
    assert_eq!(bench.autopilot.identity().custom_mode(bench.mode()), 20);
    bench.heard.clear();
    bench.send(local_target(0xdf8, [20.0, 0.0, -10.0], [0.0; 3]));
    bench.fly(3.0);
    let [x, _, z] = bench.position();
    assert!(x.abs() < 0.5 && (z + 10.0).abs() < 0.2, "{:?}", bench.position());
    assert!(bench.texts().iter().any(|text| text.contains("attitudes only")), "{:?}", bench.texts());
}

/// Half of the thrust holds the height, more climbs as a share of the fastest climb, less sinks; the lean is kept at that.
#[test]
fn the_thrust_of_an_attitude_asks_for_a_climb_rate() {
    for mode in [Mode::GuidedAttitude, Mode::Offboard] {
        let mut bench = Bench::hovering(Identity::ArduPilot);
        assert_eq!(bench.set_mode(mode), 0);
        bench.stream(3.0, |bench| lean(bench, [0.0; 3], 0.5));
        assert!((bench.position()[2] + 10.0).abs() < 0.2, "{:?}", bench.position());
        // A quarter above the middle is half of 4 m/s.
        bench.stream(3.0, |bench| lean(bench, [0.0; 3], 0.75));
        assert!((bench.velocity()[2] + 2.0).abs() < 0.15, "{:?}", bench.velocity());
        bench.stream(3.0, |bench| lean(bench, [0.0; 3], 0.25));
        assert!((bench.velocity()[2] - 1.5).abs() < 0.15, "{:?}", bench.velocity());
        // Ten degrees to the front at the same height.
        bench.stream(2.0, |bench| lean(bench, [0.0; 3], 0.5));
        let before = bench.position();
        bench.stream(3.0, |bench| lean(bench, [0.0, -0.17, 0.0], 0.5));
        let pitch = bench.autopilot.vehicle().outputs().attitude_rad.y;
        assert!((pitch + 0.17).abs() < 0.02 && bench.velocity()[0] > 3.0, "{pitch} {:?}", bench.velocity());
        assert!((bench.position()[2] - before[2]).abs() < 0.3, "{:?} {before:?}", bench.position());
    }
}

/// Without news for GUID_TIMEOUT it levels and keeps its height.
#[test]
fn without_news_it_levels() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(bench.set_mode(Mode::GuidedAttitude), 0);
    bench.stream(1.0, |bench| lean(bench, [0.1, 0.0, 0.5], 0.75));
    bench.fly(2.5);
    assert!((bench.autopilot.vehicle().outputs().attitude_rad.x - 0.1).abs() < 0.02, "it flies on");
    bench.fly(3.0);
    let outputs = bench.autopilot.vehicle().outputs();
    assert!(outputs.attitude_rad.xy().norm() < 0.02 && outputs.velocity_m_s.z.abs() < 0.1, "{outputs:?}");
    assert!((outputs.attitude_rad.z - 0.5).abs() < 0.05, "{}", outputs.attitude_rad.z);
    assert_eq!(bench.mode(), Mode::GuidedAttitude);
}

/// GUID_OPTIONS bit 3: thrust is thrust.
#[test]
fn an_option_makes_thrust_of_it() {
    let mut settings = settings(Identity::ArduPilot);
    settings.conduct.guided_options = 8;
    let mut bench = Bench::hovering_with(&settings);
    let hover = bench.autopilot.vehicle().simulation().configuration().airframe.hover_thrust_share() as f32;
    bench.stream(2.0, |bench| lean(bench, [0.0; 3], hover));
    assert!(bench.velocity()[2].abs() < 0.2, "{:?}", bench.velocity());
    bench.stream(1.0, |bench| lean(bench, [0.0; 3], 0.5));
    assert!(bench.velocity()[2] < -4.5, "{:?}", bench.velocity());
}

/// On the ground a climb takes off, and a descent lands and lets the rotors idle.
#[test]
fn it_takes_off_and_lands_by_its_thrust() {
    let mut bench = Bench::new(Identity::ArduPilot);
    assert_eq!(bench.set_mode(Mode::GuidedAttitude), 0);
    bench.arm();
    bench.stream(1.0, |bench| lean(bench, [0.0; 3], 0.5));
    assert!(bench.position()[2] > -0.05, "{:?}", bench.position());
    bench.stream(4.0, |bench| lean(bench, [0.0; 3], 0.7));
    assert!(bench.position()[2] < -3.0, "{:?}", bench.position());
    bench.stream(12.0, |bench| lean(bench, [0.0; 3], 0.3));
    let place = Vector3::from(bench.position());
    assert!(
        place.z > -0.1 && bench.autopilot.vehicle().steering_kind() == vehicle::SteeringKind::Idle,
        "{place}"
    );
}
