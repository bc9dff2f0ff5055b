//! `--airframe`: each preset flies from takeoff to landing with limits, battery and hover thrust of its own.

use crate::common::Bench;
use crate::common::requests::local_target;
use clap::Parser;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage, PARAM_REQUEST_READ_DATA};
use quadrotor::{AirframePreset, Configuration};
use sitl::configuration::{Arguments, Settings};
use sitl::hil::{ActuatorControls, Mount, Rig, STEP_US};
use vehicle::{BatteryPack, Mode, VehicleSettings};

/// The vehicle of a command line.
fn vehicle(arguments: &[&str]) -> VehicleSettings {
    let line = ["lmpc-sitl"].iter().chain(arguments);
    let arguments = Arguments::try_parse_from(line).expect("a command line");
    let settings = Settings::resolve(&arguments).expect("settings");
    settings.vehicles.into_iter().next().expect("a vehicle").vehicle
}

fn goal(position_m: [f32; 3]) -> MavMessage {
    let [x, y, z] = position_m;
    local_target(0b1001_1111_1000, [x, y, z], [0.0; 3])
}

#[test]
fn settings_follow_from_the_airframe() {
    for preset in AirframePreset::ALL {
        let settings = vehicle(&["--airframe", preset.name()]);
        let expected = Configuration::for_airframe(&preset.airframe()).expect("flies");
        assert_eq!(settings.configuration.airframe, expected.airframe, "{preset:?}");
        assert_eq!(settings.configuration.limits, expected.limits, "{preset:?}");
        assert_eq!(settings.configuration.controllers, expected.controllers, "{preset:?}");
        let pack = BatteryPack::of_airframe(&preset.airframe());
        assert_eq!((settings.battery, settings.conduct.battery_capacity_ah), (pack, pack.capacity_ah));
    }
    assert_eq!(vehicle(&["--airframe", "paper"]), vehicle(&[]), "the default");
    // --set comes on top, and a preset with drag needs none for the wind.
    let settings = vehicle(&["--airframe", "iris", "--set", "airframe.mass=1.7", "--wind", "3"]);
    assert_eq!(settings.configuration.airframe.mass_kg, 1.7);
    assert_eq!(settings.configuration.airframe.drag_n_s_m, AirframePreset::Iris.airframe().drag_n_s_m);
}

#[test]
fn each_preset_takes_off_flies_to_a_goal_and_lands() {
    const OFFBOARD_GOAL: [f64; 3] = [5.0, 5.0, -10.0];
    for preset in AirframePreset::ALL {
        let settings = vehicle(&["--airframe", preset.name()]);
        let mut bench = Bench::hovering_with(&settings);
        // Hovering takes the power that its pack is made for: half an hour's charge, within the sag of a full one.
        let flying = bench.autopilot.vehicle();
        let minutes = flying.battery().time_remaining_s(settings.battery.capacity_ah) / 60.0;
        assert!((15.0..45.0).contains(&minutes), "{preset:?}: {minutes} minutes");
        let cell_v = flying.battery().voltage_v() / f64::from(settings.battery.cells);
        assert!((3.8..4.2).contains(&cell_v), "{preset:?}: {cell_v} V");
        bench.send(MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            param_index: -1,
            target_system: 1,
            target_component: 1,
            param_id: "MPC_THR_HOVER".into(),
        }));
        let share = f64::from(bench.parameters().last().expect("an answer").param_value);
        assert!((share - preset.airframe().hover_thrust_share()).abs() < 0.01, "{preset:?}: {share}");

        let target = OFFBOARD_GOAL.map(|value| value as f32);
        bench.stream(0.5, |bench| bench.send(goal(target)));
        assert_eq!(bench.set_mode(Mode::Offboard), 0, "{preset:?}");
        bench.stream(25.0, |bench| bench.send(goal(target)));
        let off = bench.position().into_iter().zip(OFFBOARD_GOAL).map(|(at, goal)| (at - goal).abs());
        let off_m = off.fold(0.0, f64::max);
        assert!(off_m < 0.01, "{preset:?}: {off_m} m off");
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), 0);
        bench.fly_until("landed", 40.0, |bench| !bench.autopilot.vehicle().is_armed());
        let [north, east, down] = bench.position();
        assert!((north - 5.0).abs() < 0.3 && (east - 5.0).abs() < 0.3 && down.abs() < 0.02, "{preset:?}");
    }
}

/// Each system of a fleet has its own.
#[test]
fn a_fleet_can_mix_airframes() {
    let line = ["lmpc-sitl", "--vehicles", "3", "--airframe", "iris", "--airframe", "2:crazyflie"];
    let arguments = Arguments::try_parse_from(line).expect("a command line");
    let settings = Settings::resolve(&arguments).expect("settings");
    let masses = settings.vehicles.iter().map(|own| own.vehicle.configuration.airframe.mass_kg);
    assert_eq!(Vec::from_iter(masses), [1.52, 0.028, 1.52]);
    assert!(settings.notes.iter().any(|note| note.text.contains("system 2: airframe crazyflie: 0.028 kg")));
    for (line, expected) in [
        (["--airframe", "4:iris", "--vehicles", "3"], "--airframe: `4:iris`: there is no system 4"),
        (["--airframe", "iris", "--airframe", "heavy"], "`heavy` is a second airframe for all"),
    ] {
        let arguments = Arguments::try_parse_from(["lmpc-sitl"].iter().chain(&line)).expect("a command line");
        let refused = Settings::resolve(&arguments).expect_err("refused").to_string();
        assert!(refused.contains(expected), "{refused}");
    }
}

/// The plant for an external autopilot is the airframe's, with PX4's motors on the rotors that turn alike: all motors at the share
/// that hovers carry it, and the motors of one side roll it to the other.
#[test]
fn an_external_autopilot_flies_each_preset() {
    for preset in AirframePreset::ALL {
        let settings = vehicle(&["--airframe", preset.name()]);
        let airframe = preset.airframe();
        let (lowest, highest) = (airframe.rotor_speed_min_rad_s, airframe.rotor_speed_max_rad_s);
        let hover = (airframe.hover_rotor_speed_rad_s() - lowest) / (highest - lowest);
        let mut rig = Rig::new(&settings, Mount::X).expect("PX4's motors");
        let mut fly = |seconds: f64, motors: [f64; 4]| {
            for _ in 0..(seconds * 1e6 / STEP_US as f64) as usize {
                rig.control(&ActuatorControls { time_us: 0, lockstep: true, armed: true, motors });
                rig.step().expect("a flight");
            }
            rig.plant().body
        };
        fly(1.0, [hover + 0.03; 4]);
        let rising = fly(0.5, [hover; 4]).velocity_m_s;
        let still = fly(0.5, [hover; 4]).velocity_m_s;
        // What drag takes in half a second, and what the rotors were late by.
        assert!(rising.z < -0.1 && (still.z / rising.z - 1.0).abs() < 0.15, "{preset:?}: {rising} {still}");
        // More on the left, motors 2 and 3: to the right in the autopilot's axes.
        let [less, more] = [hover - 0.01, hover + 0.01];
        let rates = fly(0.2, [less, more, more, less]).body_rate_rad_s;
        let mount_rad = if preset.airframe().layout == quadrotor::RotorLayout::plus() { 45_f64 } else { 0.0 };
        let roll = rates.x * mount_rad.to_radians().cos() + rates.y * mount_rad.to_radians().sin();
        let pitch = rates.y * mount_rad.to_radians().cos() - rates.x * mount_rad.to_radians().sin();
        assert!(roll > 0.01 && pitch.abs() < 0.15 * roll, "{preset:?}: {rates}");
    }
}
