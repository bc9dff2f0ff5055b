//! The table of set-points: frames, masks and refusals, by identity.

#![allow(deprecated)] // Clients use what the dialect calls deprecated.

use crate::common::requests::set_parameter;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{
    AttitudeTargetTypemask, MavFrame, MavMessage, PARAM_REQUEST_READ_DATA, PositionTargetTypemask,
    SET_ATTITUDE_TARGET_DATA, SET_POSITION_TARGET_GLOBAL_INT_DATA, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use vehicle::Mode;
use vehicle::identity::Identity;

const POSITION_ONLY: u16 = 0b1101_1111_1000;
const VELOCITY_ONLY: u16 = 0b1101_1100_0111;
const POSITION_AND_VELOCITY: u16 = 0b1101_1100_0000;
const POSITION_VELOCITY_AND_ACCELERATION: u16 = 0b1100_0000_0000;

fn local(
    frame: MavFrame,
    mask: u16,
    position: [f32; 3],
    velocity: [f32; 3],
) -> SET_POSITION_TARGET_LOCAL_NED_DATA {
    let ([x, y, z], [vx, vy, vz]) = (position, velocity);
    SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: frame,
        type_mask: PositionTargetTypemask::from_bits_retain(mask),
        x,
        y,
        z,
        vx,
        vy,
        vz,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    }
}

fn send(bench: &mut Bench, target: &SET_POSITION_TARGET_LOCAL_NED_DATA) {
    bench.send(MavMessage::SET_POSITION_TARGET_LOCAL_NED(target.clone()));
}

/// Flies a set-point in the offboard mode.
fn offboard(bench: &mut Bench, target: &SET_POSITION_TARGET_LOCAL_NED_DATA, seconds: f64) {
    send(bench, target);
    if bench.mode() != Mode::Offboard {
        assert_eq!(bench.set_mode(Mode::Offboard), 0);
    }
    bench.stream(seconds, |bench| send(bench, target));
    assert_eq!(bench.mode(), Mode::Offboard);
}

fn turned_bench(identity: Identity) -> Bench {
    let mut bench = Bench::hovering(identity);
    let turn = [90.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(mavlink::dialects::ardupilotmega::MavCmd::MAV_CMD_CONDITION_YAW, turn), 0);
    bench.fly(12.0);
    bench
}

#[test]
fn a_place_in_the_local_frame_is_reached_through_the_shaper() {
    let mut bench = Bench::hovering(Identity::Px4);
    let target = local(MavFrame::MAV_FRAME_LOCAL_NED, POSITION_ONLY, [6.0, -3.0, -8.0], [0.0; 3]);
    offboard(&mut bench, &target, 1.0);
    // The reference is on its way, within the limits of jerk: a raw step would be at the goal.
    assert!(bench.autopilot.vehicle().outputs().setpoint.position_m.x < 2.0);
    offboard(&mut bench, &target, 9.0);
    assert!(bench.is_near([6.0, -3.0, -8.0]), "{:?}", bench.position());
}

#[test]
fn a_velocity_is_reached_and_kept() {
    let mut bench = Bench::hovering(Identity::Px4);
    let target = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY_ONLY, [0.0; 3], [2.0, -1.0, -0.5]);
    offboard(&mut bench, &target, 6.0);
    let [north, east, down] = bench.velocity();
    assert!((north - 2.0).abs() < 0.03 && (east + 1.0).abs() < 0.03 && (down + 0.5).abs() < 0.03);
}

#[test]
fn axes_mix_position_and_velocity() {
    let mut bench = Bench::hovering(Identity::Px4);
    // North by velocity, east holds its place, down by position.
    let mask = 0b1101_1111_0011_u16;
    let target = local(MavFrame::MAV_FRAME_LOCAL_NED, mask, [0.0, 0.0, -6.0], [1.5, 9.0, 9.0]);
    offboard(&mut bench, &target, 10.0);
    let (position, velocity) = (bench.position(), bench.velocity());
    assert!((velocity[0] - 1.5).abs() < 0.03 && velocity[1].abs() < 0.03, "{velocity:?}");
    assert!(position[1].abs() < 0.1 && (position[2] + 6.0).abs() < 0.1, "{position:?}");
}

/// A circle that begins at home: radius, m, and rate, rad/s.
struct Circle(f64, f64);

impl Circle {
    /// Its place at a time, s, north and east, m.
    fn place_m(&self, time_s: f64) -> [f64; 2] {
        let Self(radius, rate) = *self;
        let (s, c) = (rate * time_s).sin_cos();
        [radius * s, radius * (1.0 - c)]
    }

    /// Its point at a time, s, as a mask tells it.
    fn target(&self, mask: u16, time_s: f64) -> SET_POSITION_TARGET_LOCAL_NED_DATA {
        let Self(radius, rate) = *self;
        let (s, c) = (rate * time_s).sin_cos();
        let [x, y] = self.place_m(time_s);
        let velocity = [(radius * rate * c) as f32, (radius * rate * s) as f32, 0.0];
        let mut target = local(MavFrame::MAV_FRAME_LOCAL_NED, mask, [x as f32, y as f32, -10.0], velocity);
        if mask == POSITION_VELOCITY_AND_ACCELERATION {
            target.afx = (-radius * rate * rate * s) as f32;
            target.afy = (radius * rate * rate * c) as f32;
        }
        target
    }

    /// Flies it for 25 s. Each millisecond the point of a millisecond is sent, or none. Returns the distances from it after 8 s, m.
    fn flown(&self, mask: u16, sent: impl Fn(u64) -> Option<u64>) -> Vec<f64> {
        let mut bench = Bench::hovering(Identity::Px4);
        send(&mut bench, &self.target(mask, 0.0));
        assert_eq!(bench.set_mode(Mode::Offboard), 0);
        let begin_us = bench.autopilot.vehicle().time_us();
        let mut off_m = Vec::new();
        for millisecond in 0..25_000 {
            if let Some(of_millisecond) = sent(millisecond) {
                send(&mut bench, &self.target(mask, of_millisecond as f64 / 1e3));
            }
            bench.fly(0.001);
            if millisecond > 8_000 {
                let time_s = (bench.autopilot.vehicle().time_us() - begin_us) as f64 / 1e6;
                let ([x, y, _], [north, east]) = (bench.position(), self.place_m(time_s));
                off_m.push((x - north).hypot(y - east));
            }
        }
        assert_eq!(bench.mode(), Mode::Offboard);
        off_m
    }
}

/// A point each so many milliseconds.
fn each(period_ms: u64) -> impl Fn(u64) -> Option<u64> {
    move |millisecond| (millisecond % period_ms == 0).then_some(millisecond)
}

#[test]
fn a_streamed_circle_is_followed_to_centimetres() {
    let off_m = Circle(3.0, 0.5).flown(POSITION_VELOCITY_AND_ACCELERATION, each(50));
    let worst = off_m.iter().fold(0.0, |worst: f64, off| worst.max(*off));
    assert!(worst < 0.03, "{worst} m off");
}

/// The acceleration that is not sent is found from the velocities, whatever the rate. Points that are late take the vehicle back, and the
/// acceleration with them: measured 0.11 m. Without any acceleration, points on time leave 0.69 m.
#[test]
fn a_circle_streamed_without_acceleration_is_followed_as_well() {
    // As if by chance: every point is up to 16 ms late, and one of ten is lost.
    let late_or_lost = |millisecond: u64| {
        let (point, after) = (millisecond / 50, millisecond % 50);
        (after == point * 7 % 17 && point % 10 != 3).then_some(point * 50)
    };
    let rms = |sent: &dyn Fn(u64) -> Option<u64>| {
        let off_m = Circle(5.0, 0.5).flown(POSITION_AND_VELOCITY, sent);
        (off_m.iter().map(|off| off * off).sum::<f64>() / off_m.len() as f64).sqrt()
    };
    for (sent, bar_m) in [
        (&each(100) as &dyn Fn(u64) -> Option<u64>, 0.03),
        (&each(50), 0.03),
        (&each(20), 0.03),
        (&late_or_lost, 0.15),
    ] {
        let off_m = rms(sent);
        assert!(off_m < bar_m, "{off_m} m, not {bar_m}");
    }
}

#[test]
fn offset_and_body_frames_are_relative() {
    // Heading east.
    let mut bench = turned_bench(Identity::Px4);
    let once = local(MavFrame::MAV_FRAME_LOCAL_OFFSET_NED, POSITION_ONLY, [2.0, 0.0, -1.0], [0.0; 3]);
    send(&mut bench, &once);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    let hold = local(MavFrame::MAV_FRAME_LOCAL_NED, POSITION_ONLY, [2.0, 0.0, -11.0], [0.0; 3]);
    offboard(&mut bench, &hold, 6.0);
    assert!(bench.is_near([2.0, 0.0, -11.0]), "{:?}", bench.position());
    let forward = local(MavFrame::MAV_FRAME_BODY_NED, VELOCITY_ONLY, [0.0; 3], [1.0, 0.0, 0.0]);
    offboard(&mut bench, &forward, 5.0);
    let [north, east, _] = bench.velocity();
    assert!(north.abs() < 0.05 && (east - 1.0).abs() < 0.05, "{:?}", bench.velocity());
}

#[test]
fn ardupilots_body_frame_is_a_turned_offset() {
    let mut bench = turned_bench(Identity::ArduPilot);
    let once = local(MavFrame::MAV_FRAME_BODY_NED, POSITION_ONLY, [3.0, 0.0, 0.0], [0.0; 3]);
    send(&mut bench, &once);
    bench.fly(8.0);
    assert!(bench.is_near([0.0, 3.0, -10.0]), "{:?}", bench.position());
    // A position has no timeout, a velocity ends after three seconds.
    let moving = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY_ONLY, [0.0; 3], [1.0, 0.0, 0.0]);
    send(&mut bench, &moving);
    bench.fly(2.9);
    assert!(bench.velocity()[0] > 0.9);
    bench.fly(4.0);
    assert!(bench.velocity()[0].abs() < 0.02 && bench.mode() == Mode::Offboard);
}

#[test]
fn global_frames_differ_in_their_zero_of_altitude() {
    let mut bench = Bench::hovering(Identity::Px4);
    let goal = nalgebra::Vector3::new(8.0, 4.0, -7.0);
    let place = bench.autopilot.vehicle().frame().to_geodetic(&goal);
    for (frame, altitude) in [
        (MavFrame::MAV_FRAME_GLOBAL, 495.0),
        (MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, 7.0),
        (MavFrame::MAV_FRAME_GLOBAL_TERRAIN_ALT_INT, 7.0),
    ] {
        let target = SET_POSITION_TARGET_GLOBAL_INT_DATA {
            target_system: 1,
            target_component: 1,
            coordinate_frame: frame,
            type_mask: PositionTargetTypemask::from_bits_retain(POSITION_ONLY),
            lat_int: (place.latitude_deg * 1e7).round() as i32,
            lon_int: (place.longitude_deg * 1e7).round() as i32,
            alt: altitude,
            ..SET_POSITION_TARGET_GLOBAL_INT_DATA::default()
        };
        let message = MavMessage::SET_POSITION_TARGET_GLOBAL_INT(target);
        bench.send(message.clone());
        if bench.mode() != Mode::Offboard {
            assert_eq!(bench.set_mode(Mode::Offboard), 0);
        }
        bench.stream(8.0, |bench| bench.send(message.clone()));
        assert!(bench.is_near([8.0, 4.0, -7.0]), "{frame:?}: {:?}", bench.position());
    }
}

#[test]
fn what_means_nothing_is_refused_and_says_so() {
    let refused = |target: &SET_POSITION_TARGET_LOCAL_NED_DATA, why: &str| {
        let mut bench = Bench::hovering(Identity::Px4);
        bench.heard.clear();
        send(&mut bench, target);
        assert!(bench.texts().iter().any(|text| text.contains(why)), "{why}: {:?}", bench.texts());
        assert_eq!(bench.set_mode(Mode::Offboard), 1, "it is no set-point: {why}");
        bench.fly(1.0);
        assert!(bench.is_near([0.0, 0.0, -10.0]));
    };
    let ned = MavFrame::MAV_FRAME_LOCAL_NED;
    let nothing = "it contains no target";
    refused(&local(ned, 0b1101_1111_1111, [1.0; 3], [0.0; 3]), nothing);
    refused(&local(ned, 0b1001_1111_1111, [1.0; 3], [0.0; 3]), nothing);
    // With an acceleration: it would be a force.
    refused(&local(ned, 0b1110_0011_1111, [1.0; 3], [0.0; 3]), "force is not supported");
    refused(&local(ned, POSITION_ONLY, [f32::NAN; 3], [0.0; 3]), nothing);
    let fast = local(ned, VELOCITY_ONLY, [0.0; 3], [300.0, 0.0, 0.0]);
    refused(&fast, "Set-point rejected: velocity 300.00 m/s; allowed -50 to 50 m/s");
    refused(&local(MavFrame::MAV_FRAME_BODY_FRD, POSITION_ONLY, [1.0; 3], [0.0; 3]), "frame 12");
    refused(&local(MavFrame::MAV_FRAME_BODY_NED, POSITION_ONLY, [1.0; 3], [0.0; 3]), nothing);
}

#[test]
fn ardupilot_stops_where_it_makes_no_sense() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    let moving = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY_ONLY, [0.0; 3], [2.0, 0.0, 0.0]);
    offboard(&mut bench, &moving, 3.0);
    assert!(bench.velocity()[0] > 1.5);
    let wrong = local(MavFrame::MAV_FRAME_LOCAL_NED, VELOCITY_ONLY, [0.0; 3], [f32::NAN, 0.0, 0.0]);
    send(&mut bench, &wrong);
    bench.fly(3.0);
    assert!(bench.velocity()[0].abs() < 0.05, "{:?}", bench.velocity());
}

#[test]
fn a_position_with_a_velocity_runs_on_until_it_is_lost() {
    let mut bench = Bench::hovering(Identity::Px4);
    let target =
        local(MavFrame::MAV_FRAME_LOCAL_NED, POSITION_AND_VELOCITY, [0.0, 0.0, -10.0], [1.0, 0.0, 0.0]);
    send(&mut bench, &target);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.fly(0.99);
    let reference = bench.autopilot.vehicle().outputs().setpoint;
    assert!(reference.position_m.x > 0.8 && bench.mode() == Mode::Offboard, "{reference:?}");
    bench.fly(0.1);
    assert_eq!(bench.mode(), Mode::Hold);
    assert!(bench.texts().iter().any(|text| text == "Set-points lost: holding"), "{:?}", bench.texts());
    bench.fly(6.0);
    assert!(bench.velocity()[0].abs() < 0.02);
}

#[test]
fn an_attitude_without_thrust_names_the_bit_of_the_mask() {
    let mut bench = Bench::hovering(Identity::Px4);
    for (mask, thrust, told) in [
        (64, 0.5, "Attitude rejected: send thrust; clear mask bit 64"),
        (0, 1.5, "Attitude rejected: thrust must be from 0 to 1"),
    ] {
        bench.heard.clear();
        bench.send(MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            target_system: 1,
            target_component: 1,
            type_mask: AttitudeTargetTypemask::from_bits_retain(mask),
            q: [1.0, 0.0, 0.0, 0.0],
            thrust,
            ..SET_ATTITUDE_TARGET_DATA::default()
        }));
        assert_eq!(bench.texts(), [told]);
    }
}

#[test]
fn attitude_and_thrust_lean_and_rates_turn() {
    let mut bench = Bench::hovering(Identity::Px4);
    let airframe = bench.autopilot.vehicle().simulation().configuration().airframe;
    let hover = (airframe.weight_n() / airframe.thrust_range_n().1) as f32;
    let lean = 0.1_f32;
    let target = |mask: u8, rate: f32| {
        MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            target_system: 1,
            target_component: 1,
            type_mask: AttitudeTargetTypemask::from_bits_retain(mask),
            q: [(lean / 2.0).cos(), (lean / 2.0).sin(), 0.0, 0.0],
            body_yaw_rate: rate,
            thrust: hover,
            ..SET_ATTITUDE_TARGET_DATA::default()
        })
    };
    bench.send(target(0b111, 0.0));
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.stream(2.0, |bench| bench.send(target(0b111, 0.0)));
    let outputs = *bench.autopilot.vehicle().outputs();
    assert!((outputs.attitude_rad.x - 0.1).abs() < 0.01, "{}", outputs.attitude_rad);
    assert!(outputs.velocity_m_s.y > 1.0, "it leans to the right: {}", outputs.velocity_m_s);
    let level_mask = 0b1000_0000;
    bench.stream(4.0, |bench| bench.send(target(level_mask, 0.5)));
    let rate = bench.autopilot.vehicle().outputs().body_rate_rad_s.z;
    assert!((rate - 0.5).abs() < 0.05, "{rate}");
    // Without news it brakes and holds.
    bench.fly(10.0);
    assert_eq!(bench.mode(), Mode::Hold);
    assert!(bench.autopilot.vehicle().outputs().velocity_m_s.norm() < 0.1);
}

/// Full thrust leaves room for the attitude, whatever it is and in wind, too.
#[test]
fn an_attitude_is_kept_at_full_thrust() {
    for (roll_deg, pitch_deg, wind_m_s) in [(20.0_f32, 0.0_f32, 0.0), (0.0, -20.0, 0.0), (-14.0, 14.0, 12.0)]
    {
        let mut start = settings(Identity::Px4);
        start.wind.speed_m_s = wind_m_s;
        let mut bench = Bench::hovering_with(&start);
        bench.fly(5.0);
        let (roll, pitch) = (roll_deg.to_radians() / 2.0, pitch_deg.to_radians() / 2.0);
        let target = MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            target_system: 1,
            target_component: 1,
            type_mask: AttitudeTargetTypemask::from_bits_retain(0b111),
            // Pitch, then roll, without yaw.
            q: [
                pitch.cos() * roll.cos(),
                pitch.cos() * roll.sin(),
                pitch.sin() * roll.cos(),
                -pitch.sin() * roll.sin(),
            ],
            thrust: 1.0,
            ..SET_ATTITUDE_TARGET_DATA::default()
        });
        bench.send(target.clone());
        assert_eq!(bench.set_mode(Mode::Offboard), 0);
        bench.stream(3.0, |bench| bench.send(target.clone()));
        let truth = bench.autopilot.vehicle().truth();
        let angles_deg = truth.attitude_rad.map(f64::to_degrees);
        let told = format!("{roll_deg}° {pitch_deg}° in {wind_m_s} m/s: {angles_deg}");
        assert!((angles_deg.x - f64::from(roll_deg)).abs() < 2.0, "{told}");
        assert!((angles_deg.y - f64::from(pitch_deg)).abs() < 2.0, "{told}");
        assert!(truth.velocity_m_s.z < -10.0, "it climbs: {}", truth.velocity_m_s);
    }
}

/// Whatever the mass: the parameter and ATTITUDE_TARGET tell the thrust that hovers, and a set-point with it does.
#[test]
fn the_thrust_that_hovers_is_told() {
    for (identity, id, mass_kg) in [
        (Identity::Px4, "MPC_THR_HOVER", 0.7),
        (Identity::Px4, "MPC_THR_HOVER", 1.1),
        (Identity::ArduPilot, "MOT_THST_HOVER", 0.7),
    ] {
        let mut settings = settings(identity);
        settings.configuration.airframe.mass_kg = mass_kg;
        let mut bench = Bench::hovering_with(&settings);
        bench.fly(5.0);
        bench.heard.clear();
        let read = PARAM_REQUEST_READ_DATA {
            param_index: -1,
            target_system: 1,
            target_component: 1,
            param_id: id.into(),
        };
        bench.send(MavMessage::PARAM_REQUEST_READ(read));
        let hover = bench.parameters().last().expect("answered").param_value;
        // m g / (4 k₁ ω²), all default values but the mass.
        let expected = mass_kg * 9.80665 / (4.0 * 2.7e-5 * 450.0 * 450.0);
        assert!((f64::from(hover) - expected).abs() < 1e-6, "{id} {hover} {expected}");
        bench.fly(2.0);
        let told = bench.heard.iter().rev().find_map(|message| match message {
            autopilot::codec::Message::Typed(MavMessage::ATTITUDE_TARGET(told)) => Some(told.thrust),
            _ => None,
        });
        assert!((told.expect("streamed") - hover).abs() < 1e-4, "{told:?} {hover}");

        let target = MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            target_system: 1,
            target_component: 1,
            type_mask: AttitudeTargetTypemask::from_bits_retain(0b111),
            q: [1.0, 0.0, 0.0, 0.0],
            thrust: hover,
            ..SET_ATTITUDE_TARGET_DATA::default()
        });
        // ArduPilot takes it for a climb rate otherwise.
        if identity.is_ardupilot() {
            bench.send(set_parameter("GUID_OPTIONS", 8.0));
        }
        bench.send(target.clone());
        assert_eq!(bench.set_mode(Mode::Offboard), 0);
        let before = bench.position()[2];
        bench.stream(5.0, |bench| bench.send(target.clone()));
        let sunk = bench.position()[2] - before;
        assert!(sunk.abs() < 0.05, "{id} at {mass_kg} kg: {sunk} m in 5 s");
    }
}

#[test]
fn outside_its_mode_a_set_point_moves_nothing() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::hovering(identity);
        if identity.is_ardupilot() {
            bench.set_mode(Mode::Position);
        }
        let target = local(MavFrame::MAV_FRAME_LOCAL_NED, POSITION_ONLY, [6.0, -3.0, -8.0], [0.0; 3]);
        bench.stream(3.0, |bench| send(bench, &target));
        assert!(bench.is_near([0.0, 0.0, -10.0]), "{identity:?} {:?}", bench.position());
    }
}

#[test]
fn the_heading_of_the_target_stays_within_half_a_turn() {
    const TURNING: u16 = 0b0101_1100_0111;
    let mut bench = Bench::hovering(Identity::Px4);
    let mut target = local(MavFrame::MAV_FRAME_LOCAL_NED, TURNING, [0.0; 3], [0.0; 3]);
    target.yaw_rate = 0.7;
    bench.heard.clear();
    offboard(&mut bench, &target, 15.0);
    let told: Vec<f32> = bench
        .heard
        .iter()
        .filter_map(|message| match message {
            autopilot::codec::Message::Typed(message) => Some(message),
            _ => None,
        })
        .filter_map(|message| match message {
            MavMessage::POSITION_TARGET_LOCAL_NED(told) => Some(told.yaw),
            _ => None,
        })
        .collect();
    assert!(told.iter().any(|yaw| *yaw > 2.7) && told.iter().any(|yaw| *yaw < -2.7), "{told:?}");
    assert!(told.iter().all(|yaw| yaw.abs() <= core::f32::consts::PI + 1e-6), "{told:?}");
}

/// A client that has streamed since before the takeoff may have the offboard mode at once when that ends: its set-points are as recent.
#[test]
fn set_points_that_come_during_a_takeoff_count_after_it() {
    let mut bench = Bench::of(&settings(Identity::Px4));
    let target = local(MavFrame::MAV_FRAME_LOCAL_NED, POSITION_ONLY, [3.0, 0.0, -4.0], [0.0; 3]);
    bench.arm();
    assert_eq!(bench.set_mode(Mode::Takeoff), 0);
    bench.fly(0.5);
    for _ in 0..200 {
        send(&mut bench, &target);
        for _ in 0..10 {
            bench.fly(0.05);
            if bench.mode() == Mode::Hold {
                assert_eq!(bench.set_mode(Mode::Offboard), 0);
                bench.stream(6.0, |bench| send(bench, &target));
                assert!(bench.is_near([3.0, 0.0, -4.0]), "{:?}", bench.position());
                return;
            }
        }
    }
    panic!("the takeoff did not end");
}
