//! What ArduPilot's SIM_ parameters and its battery and failsafe parameters do in flight.

use crate::common;
use crate::common::Bench;
use crate::common::requests::set_parameter;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::fault::Sensor;
use vehicle::identity::Identity;
use vehicle::{Mode, VehicleSettings};

fn set(bench: &mut Bench, name: &str, value: f32) {
    bench.heard.clear();
    bench.send(set_parameter(name, value));
    let refused =
        bench.heard.iter().any(|message| matches!(message, Message::Typed(MavMessage::PARAM_ERROR(_))));
    assert!(!refused, "{name} = {value}: {:?}", bench.texts());
}

fn read(bench: &Bench, name: &str) -> f64 {
    let found = bench.autopilot.parameters().find(|(id, _)| *id == name);
    found.map(|(_, value)| value.number()).expect(name)
}

fn realistic() -> VehicleSettings {
    let mut settings = common::settings(Identity::ArduPilot);
    settings.sensors = SensorSettings { model: SensorModel::Realistic, seed: 3 };
    settings
}

/// ArduPilot's direction is where the wind comes from; a change takes effect with a time constant; the airframe, which has no drag of
/// its own, is given some, so that the wind is felt.
#[test]
fn wind_blows_as_the_parameters_say() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(read(&bench, "SIM_WIND_DIR"), 180.0);
    set(&mut bench, "SIM_WIND_DIR", 90.0);
    set(&mut bench, "SIM_WIND_SPD", 6.0);
    assert!(bench.texts().iter().any(|text| text.starts_with("wind needs drag")), "{:?}", bench.texts());
    let wind = |bench: &Bench| bench.autopilot.vehicle().wind_m_s();
    bench.fly(5.0);
    // From the east it blows west; after one time constant it has 63 % of its speed.
    assert!((wind(&bench).y + 6.0 * 0.632).abs() < 0.1, "{}", wind(&bench));
    bench.fly(25.0);
    assert!((wind(&bench).y + 6.0).abs() < 0.05 && wind(&bench).x.abs() < 1e-9, "{}", wind(&bench));
    let lean = bench.autopilot.vehicle().truth().attitude_rad.xy().norm();
    assert!(lean > 0.05, "{lean}");
    set(&mut bench, "SIM_WIND_TC", 0.0);
    set(&mut bench, "SIM_WIND_DIR_Z", 30.0);
    bench.fly(0.1);
    assert!((wind(&bench).z + 3.0).abs() < 0.01, "an updraft: {}", wind(&bench));
    set(&mut bench, "SIM_WIND_DIR_Z", 0.0);
    // Ten of sixty metres up: the square root of a sixth of the speed.
    set(&mut bench, "SIM_WIND_T", 0.0);
    bench.fly(0.1);
    assert!((wind(&bench).y + 6.0 * (1.0_f64 / 6.0).sqrt()).abs() < 0.1, "{}", wind(&bench));
    set(&mut bench, "SIM_WIND_T", 2.0);
    bench.fly(0.1);
    assert!((wind(&bench).y + 5.5).abs() < 0.05, "0.01/s times 50 m slower: {}", wind(&bench));
    set(&mut bench, "SIM_WIND_T", 1.0);
    set(&mut bench, "SIM_WIND_TURB", 1.0);
    let before = wind(&bench);
    bench.fly(2.0);
    assert!((wind(&bench) - before).norm() > 0.01, "gusts");
}

/// PX4's own simulation names the air's speed from the north and from the east; the vehicle has the same wind by both names.
#[test]
fn px4s_names_of_the_wind_change_it_in_flight() {
    let mut bench = Bench::hovering(Identity::Px4);
    set(&mut bench, "SIH_WIND_N", 3.0);
    set(&mut bench, "SIH_WIND_E", -4.0);
    assert_eq!((read(&bench, "SIM_WIND_SPD"), read(&bench, "SIH_WIND_E")), (5.0, -4.0));
    bench.fly(40.0);
    let wind = bench.autopilot.vehicle().wind_m_s();
    assert!((wind.x + 3.0).abs() < 0.01 && (wind.y - 4.0).abs() < 0.01, "{wind}");
    set(&mut bench, "SIH_WIND_N", 0.0);
    set(&mut bench, "SIH_WIND_E", 0.0);
    assert_eq!(read(&bench, "SIM_WIND_SPD"), 0.0);
}

/// The parameters show the wind that the command line has asked for, and a reset brings it back.
#[test]
fn the_wind_of_the_start_is_shown() {
    let mut settings = common::settings(Identity::ArduPilot);
    settings.wind = vehicle::world::WindSettings { speed_m_s: 3.0, from_rad: 1.0, gusts_m_s: 0.0, seed: 1 };
    let mut bench = Bench::of(&settings);
    assert_eq!(read(&bench, "SIM_WIND_SPD"), 3.0);
    assert!((read(&bench, "SIM_WIND_DIR") - 1.0_f64.to_degrees()).abs() < 1e-4);
    set(&mut bench, "SIM_WIND_SPD", 1.0);
    let parameters = [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_PREFLIGHT_STORAGE, parameters), 0);
    assert_eq!(read(&bench, "SIM_WIND_SPD"), 3.0);
}

/// The gauge follows, and the failsafes act: by voltage after BATT_LOW_TIMER, as ArduPilot's suite drains its battery.
#[test]
fn a_battery_is_charged_to_a_voltage_and_is_low_by_it() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    for (name, value) in [
        ("BATT_LOW_VOLT", 11.5),
        ("BATT_CRT_VOLT", 10.1),
        ("BATT_LOW_TIMER", 2.0),
        ("BATT_FS_LOW_ACT", 2.0),
        ("BATT_FS_CRT_ACT", 1.0),
        ("BATT_FS_VOLTSRC", 1.0),
    ] {
        set(&mut bench, name, value);
    }
    set(&mut bench, "SIM_BATT_VOLTAGE", 11.4);
    bench.fly(0.1);
    let battery = *bench.autopilot.vehicle().battery();
    assert!((battery.resting_voltage_v() - 11.4).abs() < 0.02, "{battery:?}");
    assert_eq!(bench.autopilot.vehicle().mode(), Mode::Offboard, "not for two seconds yet");
    bench.fly(2.0);
    assert_eq!(bench.autopilot.vehicle().mode(), Mode::Return, "{:?}", bench.texts());
    assert!(bench.texts().iter().any(|text| text.starts_with("Battery 1 is low")), "{:?}", bench.texts());
    set(&mut bench, "SIM_BATT_VOLTAGE", 10.05);
    bench.fly(2.2);
    assert_eq!(bench.autopilot.vehicle().mode(), Mode::Land, "{:?}", bench.texts());
    assert!(
        bench.texts().iter().any(|text| text.starts_with("Battery 1 is critical")),
        "{:?}",
        bench.texts()
    );
}

#[test]
fn a_battery_is_low_by_its_remaining_charge() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    set(&mut bench, "BATT_FS_LOW_ACT", 1.0);
    bench.fly(1.0);
    assert_eq!(bench.autopilot.vehicle().mode(), Mode::Offboard);
    set(&mut bench, "BATT_LOW_MAH", 100_000.0);
    bench.fly(0.1);
    assert_eq!(bench.autopilot.vehicle().mode(), Mode::Land, "{:?}", bench.texts());
}

/// By the new name and the old one, which is its opposite.
#[test]
fn gps_is_lost_and_found() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    let healthy = |bench: &Bench| bench.autopilot.vehicle().instrument_health().gps;
    set(&mut bench, "SIM_GPS_DISABLE", 1.0);
    assert_eq!(read(&bench, "SIM_GPS1_ENABLE"), 0.0);
    bench.fly(1.0);
    assert!(!healthy(&bench));
    set(&mut bench, "SIM_GPS1_ENABLE", 1.0);
    assert_eq!(read(&bench, "SIM_GPS_DISABLE"), 0.0);
    bench.fly(0.1);
    assert!(healthy(&bench));
    // PX4 stops using it by the estimator's parameter.
    let mut bench = Bench::hovering(Identity::Px4);
    for (name, value, sensor) in [
        ("EKF2_GPS_CTRL", 0_u32, Sensor::Gps),
        ("EKF2_BARO_CTRL", 0, Sensor::Barometer),
        ("EKF2_MAG_TYPE", 5, Sensor::Magnetometer),
    ] {
        assert_eq!(bench.autopilot.vehicle().faults().sensor(sensor), None);
        common::failsafe_bench::set(&mut bench, name, f64::from(value));
        assert!(bench.autopilot.vehicle().faults().sensor(sensor).is_some(), "{name}");
    }
}

/// A quarter of the thrust of one rotor is more than the others can make up for.
#[test]
fn rotors_become_weak() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    set(&mut bench, "SIM_ENGINE_MUL", 0.8);
    set(&mut bench, "SIM_ENGINE_FAIL", 2.0);
    bench.fly(3.0);
    let speeds = bench.autopilot.vehicle().truth().rotor_speed_rad_s;
    let command = bench.autopilot.vehicle().simulation().rotor_command_rad_s();
    // Thrust goes with the square of the speed.
    assert!((speeds[1] / command[1] - 0.8_f64.sqrt()).abs() < 0.02, "{speeds:?} {command:?}");
    assert!((speeds[0] / command[0] - 1.0).abs() < 0.02, "{speeds:?} {command:?}");
    set(&mut bench, "SIM_ENGINE_FAIL", 0.0);
    bench.fly(2.0);
    let speeds = bench.autopilot.vehicle().truth().rotor_speed_rad_s;
    let command = bench.autopilot.vehicle().simulation().rotor_command_rad_s();
    assert!((speeds[1] / command[1] - 1.0).abs() < 0.02, "{speeds:?} {command:?}");
}

/// Each error is in what the instrument says, by its amount and sign.
#[test]
fn instruments_are_wrong_by_what_is_set() {
    let mut bench = Bench::of(&realistic());
    bench.fly(3.0);
    let readings = |bench: &Bench| bench.autopilot.vehicle().readings();
    let mean = |bench: &mut Bench, what: &dyn Fn(&Bench) -> f64| {
        let mut sum = 0.0;
        for _ in 0..100 {
            bench.fly(0.02);
            sum += what(bench);
        }
        sum / 100.0
    };
    type Reading = fn(&vehicle::estimation::Readings) -> f64;
    let checks: [(&str, f32, f64, f64, Reading); 8] = [
        ("SIM_ACC1_BIAS_X", 0.5, 0.5, 0.02, |now| now.inertial.specific_force_m_s2.x),
        ("SIM_ACC1_BIAS_Z", -0.5, -0.5, 0.02, |now| now.inertial.specific_force_m_s2.z),
        ("SIM_GYR1_BIAS_Y", 0.05, 0.05, 0.002, |now| now.inertial.body_rate_rad_s.y),
        ("SIM_BARO_GLITCH", 30.0, 30.0, 0.3, |now| now.barometer.expect("read").altitude_m()),
        ("SIM_MAG1_OFS_Y", 50.0, 0.05, 0.001, |now| now.magnetometer.expect("read").field_gauss.y),
        // 111 m and a bit to the north; the receiver wanders by itself.
        ("SIM_GPS1_GLTCH_X", 0.001, 111.3, 2.0, |now| now.gps.expect("read").position_m.x),
        ("SIM_GPS_GLITCH_Z", 20.0, -20.0, 2.0, |now| now.gps.expect("read").position_m.z),
        ("SIM_GPS1_NUMSATS", 6.0, -6.0, 0.1, |now| f64::from(now.gps.expect("read").satellites)),
    ];
    for (name, value, expected, tolerance, reading) in checks {
        let default = read(&bench, name) as f32;
        let before = mean(&mut bench, &|bench| reading(&readings(bench)));
        set(&mut bench, name, value);
        bench.fly(0.4);
        let after = mean(&mut bench, &|bench| reading(&readings(bench)));
        assert!((after - before - expected).abs() < tolerance, "{name}: {before} {after}");
        set(&mut bench, name, default);
        bench.fly(0.4);
    }
    set(&mut bench, "SIM_BARO_DRIFT", 2.0);
    let before = mean(&mut bench, &|bench| readings(bench).barometer.expect("read").altitude_m());
    bench.fly(3.0);
    let after = mean(&mut bench, &|bench| readings(bench).barometer.expect("read").altitude_m());
    assert!((after - before - 10.0).abs() < 0.5, "five seconds at 2 m/s: {before} {after}");
    set(&mut bench, "SIM_ACCEL1_FAIL", 3.0);
    bench.fly(0.01);
    assert_eq!(readings(&bench).inertial.specific_force_m_s2, nalgebra::Vector3::repeat(3.0));
}

/// Noise has the asked standard deviation on top of the part's own.
#[test]
fn instruments_are_as_noisy_as_is_set() {
    let mut bench = Bench::of(&realistic());
    bench.fly(3.0);
    type Reading = fn(&vehicle::estimation::Readings) -> f64;
    let checks: [(&str, f32, f64, Reading); 4] = [
        ("SIM_ACC1_RND", 2.0, 2.0, |now| now.inertial.specific_force_m_s2.y),
        ("SIM_GYR1_RND", 10.0, 10.0_f64.to_radians(), |now| now.inertial.body_rate_rad_s.x),
        ("SIM_BARO_RND", 3.0, 3.0, |now| now.barometer.expect("read").altitude_m()),
        ("SIM_MAG_RND", 40.0, 0.04, |now| now.magnetometer.expect("read").field_gauss.z),
    ];
    for (name, value, expected, reading) in checks {
        set(&mut bench, name, value);
        let samples: Vec<f64> = (0..400)
            .map(|_| {
                bench.fly(0.02);
                reading(&bench.autopilot.vehicle().readings())
            })
            .collect();
        let mean = samples.iter().sum::<f64>() / 400.0;
        let spread = (samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / 400.0).sqrt();
        // Five standard errors of a standard deviation of 400 samples.
        assert!((spread / expected - 1.0).abs() < 5.0 / 800.0_f64.sqrt(), "{name}: {spread}");
        set(&mut bench, name, 0.0);
    }
}

/// Ideal sensors have nothing that could be wrong: silence is refused no error, an error is.
#[test]
fn errors_need_realistic_sensors() {
    let mut bench = Bench::new(Identity::ArduPilot);
    bench.send(set_parameter("SIM_ACC1_BIAS_X", 1.0));
    let texts = bench.texts();
    let told = "SIM_ACC1_BIAS_X: ideal sensors have no errors; start with --sensors realistic";
    assert!(texts.iter().any(|text| text == told), "{texts:?}");
    assert_eq!(read(&bench, "SIM_ACC1_BIAS_X"), 0.0);
    set(&mut bench, "SIM_BARO_DISABLE", 1.0);
    bench.fly(1.0);
    assert!(!bench.autopilot.vehicle().instrument_health().barometer);
}

/// Bit 1: a mission goes on without its ground station, and another mode does not.
#[test]
fn a_mission_goes_on_when_the_options_say_so() {
    for (options, mode, expected) in [
        (2.0, Mode::Position, Mode::Return),
        (16.0, Mode::Position, Mode::Position),
        (16.0, Mode::Hold, Mode::Return),
    ] {
        let mut bench = Bench::hovering(Identity::ArduPilot);
        assert_eq!(read(&bench, "FS_OPTIONS"), 16.0, "the original's default");
        set(&mut bench, "FS_GCS_ENABLE", 1.0);
        set(&mut bench, "FS_OPTIONS", options);
        assert_eq!(bench.set_mode(mode), 0);
        common::failsafe_bench::lose_ground_station(&mut bench);
        bench.fly(0.1);
        assert_eq!(bench.autopilot.vehicle().mode(), expected, "{options} {mode:?}: {:?}", bench.texts());
    }
}

/// Gusts and noise are those of the seed.
#[test]
fn changes_of_the_simulation_repeat_bit_for_bit() {
    let fly = || {
        let mut bench = Bench::of(&realistic());
        for (name, value) in [("SIM_WIND_SPD", 4.0), ("SIM_WIND_TURB", 1.0), ("SIM_ACC1_RND", 0.5)] {
            set(&mut bench, name, value);
            bench.fly(0.5);
        }
        let vehicle = bench.autopilot.vehicle();
        (vehicle.wind_m_s(), vehicle.readings().inertial.specific_force_m_s2, vehicle.outputs().quaternion)
    };
    assert_eq!(fly(), fly());
}
