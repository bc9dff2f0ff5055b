//! Units that break in flight, by command and by schedule.

use crate::common;
use crate::common::recording::Recording;
use crate::common::{Bench, settings};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use vehicle::estimation::SensorModel;
use vehicle::fault::{Fault, ScheduledFault, Sensor, SensorFault};
use vehicle::identity::Identity;
use vehicle::world::WindSettings;
use vehicle::{LandedState, Mode, VehicleSettings};

/// MAV_RESULT.
const TEMPORARILY_REJECTED: u8 = 1;
const FAILED: u8 = 4;
const DENIED: u8 = 2;
const UNSUPPORTED: u8 = 3;

/// FAILURE_UNIT and FAILURE_TYPE.
const BATTERY: f32 = 100.0;
const MOTOR: f32 = 101.0;
const OK: f32 = 0.0;
const OFF: f32 = 1.0;
const STUCK: f32 = 2.0;
const WRONG: f32 = 4.0;

fn obstacles(bench: &Bench) -> Vec<String> {
    bench.autopilot.vehicle().arming_obstacles().iter().map(ToString::to_string).collect()
}

fn inject(bench: &mut Bench, unit: f32, kind: f32, instance: f32) -> u8 {
    bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, [unit, kind, instance, 0.0, 0.0, 0.0, 0.0])
}

fn tilt_rad(bench: &Bench) -> f64 {
    let [w, x, y, z] = bench.autopilot.vehicle().truth().quaternion;
    (w * w - x * x - y * y + z * z).clamp(-1.0, 1.0).acos()
}

/// Flies until it is disarmed and returns the largest tilt, rad, and the sink rate a tenth of a second before.
fn fly_down(bench: &mut Bench) -> (f64, f64) {
    let mut largest: f64 = 0.0;
    let mut sinks = std::collections::VecDeque::from([0.0; 12]);
    while bench.autopilot.vehicle().is_armed() {
        bench.fly(0.01);
        if bench.position()[2] < -0.2 {
            largest = largest.max(tilt_rad(bench));
        }
        sinks.pop_front();
        sinks.push_back(bench.velocity()[2]);
        assert!(bench.autopilot.vehicle().time_us() < 120_000_000, "still up: {:?}", bench.position());
    }
    (largest, sinks[0])
}

#[test]
fn a_lost_rotor_is_told_and_it_comes_down_spinning() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::hovering(identity);
        assert_eq!(inject(&mut bench, MOTOR, OFF, 2.0), 0);
        bench.fly(0.1);
        assert_eq!(bench.autopilot.vehicle().lost_rotor(), Some(1));
        let texts = bench.texts();
        assert!(texts.iter().any(|text| text == "Failure injected: rotor2=off"), "{texts:?}");
        assert!(texts.iter().any(|text| text == "Rotor 2 lost: descending without yaw control"), "{texts:?}");
        assert_eq!(bench.mode(), Mode::Land);
        // Nothing else can be flown now. ArduPilot calls what it refuses for the moment a failure.
        let refused = if identity.is_ardupilot() { FAILED } else { TEMPORARILY_REJECTED };
        assert_eq!(bench.set_mode(Mode::Hold), refused);
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, [0.0; 7]), refused);
        let mut pause = [f32::NAN; 7];
        pause[1] = 1.0;
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPOSITION, pause), refused);
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), 0);

        let (tilt, sink) = fly_down(&mut bench);
        assert!(!bench.texts().iter().any(|text| text.contains("falls")), "{:?}", bench.texts());
        assert!(tilt < 40_f64.to_radians(), "it tumbled: {}", tilt.to_degrees());
        assert!(sink < 0.9, "it touched down at {sink} m/s");
        assert!(
            bench.texts().iter().any(|text| text == "Disarmed: landed without rotor 2"),
            "{:?}",
            bench.texts()
        );
        // Spinning on the ground is not standing on it.
        assert_eq!(bench.autopilot.vehicle().landed_state(), LandedState::InAir);
        bench.fly(3.0);
        assert_eq!(bench.autopilot.vehicle().landed_state(), LandedState::OnGround);
        assert!(tilt_rad(&bench) < 0.02 && bench.position()[2].abs() < 0.02, "{:?}", bench.position());
        // Until it is mended it does not fly again, whatever the mode.
        assert_eq!(bench.set_mode(Mode::Position), 0, "{:?}", bench.texts());
        assert_eq!(obstacles(&bench), ["rotor 2 failed"]);
        assert_eq!(inject(&mut bench, MOTOR, OK, 0.0), 0);
        assert!(bench.autopilot.vehicle().arming_obstacles().is_empty());
    }
}

/// On two rotors nothing can be held: it is told, not called a descent.
#[test]
fn two_lost_rotors_are_a_fall() {
    for (rotors, first) in
        [(vec![0.0], "Rotor 1 lost"), (vec![2.0], "Rotor 2 lost: descending without yaw control")]
    {
        let mut bench = Bench::hovering(Identity::Px4);
        for rotor in rotors {
            assert_eq!(inject(&mut bench, MOTOR, OFF, rotor), 0);
        }
        bench.fly(0.7);
        let falls =
            |bench: &Bench| bench.texts().iter().filter(|text| text.ends_with("rotor lost: falling")).count();
        assert!(bench.texts().iter().any(|text| text == first), "{:?}", bench.texts());
        let all = first == "Rotor 1 lost";
        assert_eq!(falls(&bench), usize::from(all), "{:?}", bench.texts());
        if !all {
            assert_eq!(inject(&mut bench, MOTOR, OFF, 3.0), 0);
            bench.fly(0.2);
            assert_eq!(falls(&bench), 1, "{:?}", bench.texts());
        }
        bench.fly_until("down", 20.0, |bench| !bench.autopilot.vehicle().is_armed());
    }
}

#[test]
fn a_rotor_is_lost_at_full_speed_and_near_the_ground() {
    // 2.5 m up.
    let mut bench = Bench::new(Identity::Px4);
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
    bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
    assert_eq!(inject(&mut bench, MOTOR, OFF, 4.0), 0);
    let (tilt, sink) = fly_down(&mut bench);
    assert!(tilt < 45_f64.to_radians() && sink < 0.9, "{} {sink}", tilt.to_degrees());

    // 8 m/s to the east.
    let mut bench = Bench::hovering(Identity::Px4);
    let place = bench.autopilot.vehicle().frame().to_geodetic(&nalgebra::Vector3::new(0.0, 100.0, -10.0));
    let [latitude, longitude] = [place.latitude_deg as f32, place.longitude_deg as f32];
    let goal = [-1.0, 1.0, 0.0, f32::NAN, latitude, longitude, 498.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPOSITION, goal), 0);
    bench.fly_until("fast", 10.0, |bench| bench.velocity()[1] > 7.8);
    assert_eq!(inject(&mut bench, MOTOR, OFF, 1.0), 0);
    let (tilt, sink) = fly_down(&mut bench);
    assert!(tilt < 45_f64.to_radians() && sink < 0.9, "{} {sink}", tilt.to_degrees());
}

#[test]
fn a_weak_rotor_flies_on_and_a_stuck_one_lands() {
    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(inject(&mut bench, MOTOR, WRONG, 3.0), 0);
    bench.fly(8.0);
    assert!(bench.is_near([0.0, 0.0, -10.0]) && bench.autopilot.vehicle().lost_rotor().is_none());

    let mut bench = Bench::hovering(Identity::Px4);
    assert_eq!(inject(&mut bench, MOTOR, STUCK, 3.0), 0);
    bench.fly(1.0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), 0);
    let (tilt, sink) = fly_down(&mut bench);
    assert!(tilt < 15_f64.to_radians() && sink < 0.9, "{} {sink}", tilt.to_degrees());
    bench.fly(3.0);
    assert_eq!(bench.autopilot.vehicle().landed_state(), LandedState::OnGround);
}

#[test]
fn a_rotor_that_never_turned_disarms_on_the_ground() {
    let mut bench = Bench::new(Identity::Px4);
    assert_eq!(inject(&mut bench, MOTOR, OFF, 1.0), 0);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), TEMPORARILY_REJECTED);
    let force = [1.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, force), 0);
    bench.fly(0.2);
    assert!(!bench.autopilot.vehicle().is_armed());
    assert!(bench.texts().iter().any(|text| text == "Disarmed: rotor 1 failed"), "{:?}", bench.texts());
}

#[test]
fn faults_come_and_go_by_the_schedule() {
    let mut start = settings(Identity::Px4);
    start.faults = ["2.5:battery=ok", "1:battery=off"].map(|text| text.parse().expect("a fault")).to_vec();
    let mut bench = Bench::of(&start);
    let remaining = |bench: &Bench| bench.autopilot.vehicle().battery_remaining();
    bench.fly(0.999);
    assert!(remaining(&bench) > 0.99);
    bench.fly(0.002);
    assert_eq!(remaining(&bench), 0.0);
    assert_eq!(obstacles(&bench), ["battery at 0 %, required 15 %"]);
    bench.fly(1.1);
    let voltage = bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(MavMessage::SYS_STATUS(status)) => {
            Some((status.voltage_battery, status.battery_remaining))
        }
        _ => None,
    });
    let (voltage_mv, percent) = voltage.expect("SYS_STATUS");
    assert!((9_500..9_900).contains(&voltage_mv) && percent == 0, "{voltage_mv} {percent}");
    bench.fly(0.5);
    assert!(remaining(&bench) > 0.99);
    let told: Vec<_> = bench.texts().into_iter().filter(|text| text.starts_with("Failure")).collect();
    assert_eq!(told, ["Failure injected: battery=off", "Failure injected: battery=ok"]);
}

#[test]
fn what_has_no_meaning_is_refused_with_the_reason() {
    let mut bench = Bench::new(Identity::Px4);
    for (unit, kind, instance, result, reason) in [
        (5.0, OFF, 0.0, UNSUPPORTED, "unknown failure unit 5"),
        (MOTOR, 9.0, 0.0, UNSUPPORTED, "unknown failure type 9"),
        (MOTOR, OFF, 5.0, UNSUPPORTED, "unknown motor 5"),
        (MOTOR, 3.0, 1.0, UNSUPPORTED, "a motor cannot be `garbage`"),
        (BATTERY, 6.0, 0.0, UNSUPPORTED, "a battery cannot be `delayed`"),
        (4.0, OFF, 3.0, UNSUPPORTED, "unknown instance 3"),
        (0.5, OFF, 0.0, DENIED, "requires unit"),
    ] {
        assert_eq!(inject(&mut bench, unit, kind, instance), result, "{reason}");
        assert!(bench.texts().iter().any(|text| text.contains(reason)), "{reason}: {:?}", bench.texts());
    }
    assert_eq!(bench.autopilot.vehicle().faults(), vehicle::fault::Faults::default());
}

/// Ideal sensors read the truth: what would change nothing is not accepted. Realistic ones take it all, and show it.
#[test]
fn what_would_change_nothing_is_refused() {
    for model in [SensorModel::Ideal, SensorModel::Realistic] {
        let mut start = settings(Identity::Px4);
        start.sensors.model = model;
        let mut bench = Bench::of(&start);
        for unit in 0..=4 {
            for kind in 0..=7 {
                let reads = matches!(kind, 3..=6) && model == SensorModel::Ideal;
                let expected = if reads { UNSUPPORTED } else { 0 };
                assert_eq!(
                    inject(&mut bench, unit as f32, kind as f32, 0.0),
                    expected,
                    "{model:?} {unit} {kind}"
                );
                let why = bench.texts().iter().any(|text| text.contains("start with --sensors realistic"));
                assert_eq!(why, reads, "{model:?} {unit} {kind}: {:?}", bench.texts());
            }
            assert_eq!(inject(&mut bench, unit as f32, OK, 0.0), 0);
        }
    }
}

/// Standing, each fault shows in what the instrument reads: mean and spread of 2 s, and how many readings differ.
#[test]
fn broken_instruments_read_what_their_faults_say() {
    let field = |bench: &Bench, sensor: Sensor| {
        let readings = bench.autopilot.vehicle().readings();
        match sensor {
            Sensor::Gyroscope => readings.inertial.body_rate_rad_s.x,
            Sensor::Accelerometer => readings.inertial.specific_force_m_s2.x,
            Sensor::Magnetometer => readings.magnetometer.expect("a field").field_gauss.x,
            Sensor::Barometer => readings.barometer.expect("a pressure").pressure_pa,
            Sensor::Gps => readings.gps.expect("a fix").position_m.x,
        }
    };
    let read = |sensor, fault: Option<SensorFault>| {
        let mut start = settings(Identity::Px4);
        start.sensors.model = SensorModel::Realistic;
        let fault = Fault::Sensor(sensor, fault);
        start.faults = vec![ScheduledFault { time_us: 3_000_000, fault }];
        let mut bench = Bench::of(&start);
        // At 3 s it begins, a delay is over after half a second.
        bench.fly(3.6);
        let mut values = Vec::new();
        for _ in 0..2000 {
            bench.fly(0.001);
            values.push(field(&bench, sensor));
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let spread =
            (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
        let changes = values.windows(2).filter(|pair| pair[0] != pair[1]).count();
        (mean, spread, changes)
    };
    for sensor in Sensor::ALL {
        let (mean, spread, changes) = read(sensor, None);
        for silent in [SensorFault::Off, SensorFault::Stuck] {
            assert_eq!(read(sensor, Some(silent)).2, 0, "{sensor:?} {silent:?}");
        }
        let (_, garbage, _) = read(sensor, Some(SensorFault::Garbage));
        assert!((0.5..1.5).contains(&(garbage / sensor.garbage())), "{sensor:?}: {garbage}");
        let (wrong, ..) = read(sensor, Some(SensorFault::Wrong));
        assert!(((wrong - mean) / sensor.offset() - 1.0).abs() < 0.2, "{sensor:?}: {wrong} {mean}");
        let (_, _, slow) = read(sensor, Some(SensorFault::Slow));
        // A half of an inertial reading changes nothing until its other half has come.
        let expected = changes / SensorFault::SLOWNESS as usize;
        assert!(slow.abs_diff(expected) <= 2, "{sensor:?}: {slow} {expected}");
        let (_, _, intermittent) = read(sensor, Some(SensorFault::Intermittent));
        assert!(
            (changes / 4..changes * 3 / 4).contains(&intermittent),
            "{sensor:?}: {intermittent} {changes}"
        );
        let (delayed, delayed_spread, _) = read(sensor, Some(SensorFault::Delayed));
        assert!((delayed - mean).abs() <= 3.0 * (spread + delayed_spread), "{sensor:?}: {delayed} {mean}");
    }
}

#[test]
fn a_parameter_forbids_it_as_px4_begins() {
    assert!(VehicleSettings::new(Identity::ArduPilot).conduct.failure_injection);
    let mut bench = Bench::of(&VehicleSettings::new(Identity::Px4));
    assert_eq!(inject(&mut bench, 4.0, OFF, 0.0), DENIED);
    assert!(bench.texts().iter().any(|text| text.contains("set SYS_FAILURE_EN to 1")), "{:?}", bench.texts());
    assert_eq!(bench.autopilot.vehicle().faults(), vehicle::fault::Faults::default());
}

/// In wind and gusts, and by instruments and the estimator instead of the true motion. Measured: 29° to 38°, 9 to 20 m.
#[test]
fn a_rotor_is_lost_in_wind_and_by_realistic_sensors() {
    for (speed_m_s, gusts_m_s) in [(0.0, 0.0), (6.0, 1.5)] {
        for model in [SensorModel::Ideal, SensorModel::Realistic] {
            let mut start = settings(Identity::Px4);
            start.wind = WindSettings { speed_m_s, from_rad: 1.0, gusts_m_s, seed: 5 };
            start.configuration.airframe.drag_n_s_m = [if speed_m_s > 0.0 { 0.15 } else { 0.0 }; 3];
            start.sensors.model = model;
            let mut bench = Bench::of(&start);
            bench.fly(3.0);
            bench.arm();
            let takeoff = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 498.0];
            assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), 0);
            bench.fly_until("takeoff", 20.0, |bench| bench.mode() != Mode::Takeoff);
            assert_eq!(inject(&mut bench, MOTOR, OFF, 1.0), 0);
            let (tilt, sink) = fly_down(&mut bench);
            let drift = bench.autopilot.vehicle().truth().position_m.xy().norm();
            assert!(tilt < 42_f64.to_radians() && sink < 0.9, "{} {sink}", tilt.to_degrees());
            assert!(drift < 25.0, "{drift}");
        }
    }
}

/// A record with scheduled and injected faults, flown again.
#[test]
fn broken_flights_replay_bit_for_bit() {
    let mut vehicle = settings(Identity::Px4);
    vehicle.sensors.model = SensorModel::Realistic;
    vehicle.faults = ["2:gps=slow", "9:barometer=garbage", "12:rotor4=weak:0.8", "16:rotor2=off"]
        .map(|text| text.parse().expect("a fault"))
        .to_vec();
    let mut recording = Recording::of(&vehicle);
    let messages = [
        (4_000, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (4_100, MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]),
        (10_500, MavCmd::MAV_CMD_INJECT_FAILURE, [2.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ];
    for millisecond in 0..30_000 {
        for (_, command, parameters) in messages.into_iter().filter(|(at, ..)| *at == millisecond) {
            recording.send(common::command_long(command, parameters, 0));
        }
        if millisecond == 16_100 {
            assert_eq!(recording.bench.autopilot.vehicle().lost_rotor(), Some(1));
        }
        recording.step();
    }
    let record = recording.finish();
    record.assert_same();
    // Without one of the faults it is another one.
    record.assert_depends_on("16000000", "26000000");
}
