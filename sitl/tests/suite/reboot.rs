//! Reboots, tests of motors, calibration of the magnetometer, and crashes.

use crate::common;
use crate::common::Bench;
use crate::common::plan_client::{items, result, upload};
use crate::common::requests::set_parameter_as;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{
    FailureUnit, MAG_CAL_REPORT_DATA, MagCalStatus, MavCmd, MavMessage, MavParamType, MavResult,
    PARAM_REQUEST_READ_DATA,
};
use sitl::record::Digest;
use vehicle::identity::Identity;
use vehicle::plan::PlanKind;
use vehicle::{LandedState, Mode};

const ACCEPTED: u8 = MavResult::MAV_RESULT_ACCEPTED as u8;
const DENIED: u8 = MavResult::MAV_RESULT_DENIED as u8;
const UNSUPPORTED: u8 = MavResult::MAV_RESULT_UNSUPPORTED as u8;
const FAILED: u8 = MavResult::MAV_RESULT_FAILED as u8;

fn set(bench: &mut Bench, name: &str, value: f64) {
    let ardupilot = bench.autopilot.identity().is_ardupilot();
    let table = bench.autopilot.parameter_table();
    let whole = table.find(name).expect(name).describe().whole;
    let (param_value, param_type) = match (whole, ardupilot) {
        (true, false) => (f32::from_bits(value as i32 as u32), MavParamType::MAV_PARAM_TYPE_INT32),
        _ => (value as f32, MavParamType::MAV_PARAM_TYPE_REAL32),
    };
    bench.send(set_parameter_as(name, param_value, param_type));
}

fn parameter(bench: &mut Bench, name: &str) -> f64 {
    bench.heard.clear();
    bench.send(MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
    }));
    f64::from(bench.parameters().last().expect(name).param_value)
}

fn reboot(bench: &mut Bench, kind: f32, force: f32) -> u8 {
    bench.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, [kind, 0.0, 0.0, 0.0, 0.0, force, 0.0])
}

/// What clients see: the answer first, then time that begins anew, the same parameters, and everything else as at the start.
#[test]
fn a_reboot_keeps_parameters_and_begins_everything_else_anew() {
    let mut bench = Bench::started_at(&common::settings(Identity::ArduPilot), 1_720_000_000_000_000);
    set(&mut bench, "FS_GCS_ENABLE", 5.0);
    assert_eq!(parameter(&mut bench, "STAT_BOOTCNT"), 1.0);
    // ArduPilot's own tests wait for this.
    assert!(parameter(&mut bench, "STAT_RESET") > 0.0);
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0]), 0);
    bench.fly(6.0);
    let used = bench.autopilot.vehicle().battery_remaining();
    assert_eq!(reboot(&mut bench, 1.0, 0.0), FAILED, "armed");
    assert_eq!(bench.autopilot.boots(), 1);
    assert_eq!(reboot(&mut bench, 1.0, 20_190_226.0), ACCEPTED, "forced");
    bench.fly(0.19);
    assert_eq!(bench.autopilot.boots(), 1, "the answer leaves first");
    let before_us = bench.autopilot.time_us();
    bench.fly(0.1);
    assert_eq!(bench.autopilot.boots(), 2);
    assert_eq!(bench.autopilot.time_us(), before_us + 100_000, "time of the program goes on");
    let vehicle = bench.autopilot.vehicle();
    assert!(vehicle.time_us() < 100_000 && !vehicle.is_armed() && vehicle.position_is_start());
    assert!(vehicle.battery_remaining() > used && vehicle.mode() == Identity::ArduPilot.first_mode());
    let boot_us = 1_720_000_000_000_000 + before_us;
    assert!(vehicle.unix_start_us().abs_diff(boot_us) < 100_000);
    assert!(bench.texts().iter().any(|text| text.starts_with("lmpc-sitl")), "it introduces itself again");
    assert_eq!(parameter(&mut bench, "FS_GCS_ENABLE"), 5.0);
    assert_eq!(parameter(&mut bench, "STAT_BOOTCNT"), 2.0);
    assert!((5.0..7.0).contains(&parameter(&mut bench, "STAT_FLTTIME")));
    // A vehicle that has booted flies as one that has started.
    bench.heard.clear();
    assert_eq!(bench.set_mode(Mode::Offboard), 0);
    bench.arm();
}

/// In both autopilots, plans are in memory that outlasts a boot.
#[test]
fn a_reboot_keeps_plans() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::new(identity);
        for kind in PlanKind::ALL {
            let heard = upload(&mut bench, kind, &items(kind, 2));
            assert_eq!(result(&heard), Some(ACCEPTED), "{identity:?} {kind:?}");
        }
        let before = bench.autopilot.vehicle().plans().clone();
        assert!(PlanKind::ALL.iter().all(|kind| before.get(*kind).items().len() == 2));
        assert_eq!(reboot(&mut bench, 1.0, 0.0), ACCEPTED);
        bench.fly(0.5);
        assert_eq!(bench.autopilot.boots(), 2);
        assert_eq!(bench.autopilot.vehicle().plans(), &before, "{identity:?}");
    }
}

trait AtStart {
    fn position_is_start(&self) -> bool;
}

impl AtStart for vehicle::Vehicle {
    fn position_is_start(&self) -> bool {
        self.truth().position_m.norm() < 0.01
    }
}

#[test]
fn each_autopilot_answers_in_its_own_way() {
    let mut px4 = Bench::new(Identity::Px4);
    assert_eq!(reboot(&mut px4, 0.0, 0.0), ACCEPTED, "PX4 takes 0 for nothing");
    assert_eq!(reboot(&mut px4, 2.0, 0.0), UNSUPPORTED);
    assert!(px4.texts().iter().any(|text| text.contains("stop lmpc-sitl itself")));
    px4.arm();
    assert_eq!(reboot(&mut px4, 1.0, 20_190_226.0), DENIED, "PX4 knows no force");
    let mut ardupilot = Bench::new(Identity::ArduPilot);
    assert_eq!(reboot(&mut ardupilot, 0.0, 0.0), UNSUPPORTED);
    assert_eq!(reboot(&mut ardupilot, 7.0, 0.0), UNSUPPORTED);
    assert_eq!(reboot(&mut ardupilot, 3.0, 0.0), ACCEPTED);
}

/// Two runs with a reboot in them are the same, bit for bit.
#[test]
fn a_reboot_is_deterministic() {
    let digest = || {
        let (mut bench, mut digest) = (Bench::new(Identity::Px4), Digest::default());
        for round in 0..2 {
            bench.arm();
            assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
            for _ in 0..3_000 {
                bench.fly(0.001);
                digest.update(bench.autopilot.vehicle());
            }
            bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [0.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            assert_eq!(reboot(&mut bench, 1.0, 0.0), ACCEPTED);
            bench.fly(0.3);
            assert_eq!(bench.autopilot.boots(), round + 2);
        }
        digest.value()
    };
    assert_eq!(digest(), digest());
}

#[test]
fn a_motor_turns_alone_and_for_as_long_as_asked() {
    for (identity, command, parameters) in [
        (Identity::ArduPilot, MavCmd::MAV_CMD_DO_MOTOR_TEST, [2.0, 0.0, 40.0, 1.0, 1.0, 0.0, 0.0]),
        (Identity::ArduPilot, MavCmd::MAV_CMD_DO_MOTOR_TEST, [2.0, 1.0, 1400.0, 1.0, 0.0, 0.0, 0.0]),
        (Identity::Px4, MavCmd::MAV_CMD_ACTUATOR_TEST, [0.4, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0]),
    ] {
        let mut bench = Bench::new(identity);
        assert_eq!(bench.command(command, parameters), ACCEPTED, "{identity:?}");
        bench.fly(0.9);
        let vehicle = bench.autopilot.vehicle();
        let fastest = vehicle.simulation().configuration().airframe.rotor_speed_max_rad_s;
        let shares = vehicle.truth().rotor_speed_rad_s.map(|speed| speed / fastest);
        assert!((shares[1] - 0.4).abs() < 0.02, "{shares:?}");
        assert!(shares[0] < 0.02 && shares[2] < 0.02 && shares[3] < 0.02, "{shares:?}");
        assert!(!vehicle.is_armed() && vehicle.landed_state() == LandedState::OnGround);
        bench.fly(1.0);
        let still = bench.autopilot.vehicle().truth().rotor_speed_rad_s;
        assert!(still.iter().all(|speed| *speed < 1.0), "{still:?}");
        let texts = bench.texts();
        assert!(texts.iter().any(|text| text == "starting motor test"), "{texts:?}");
        assert!(texts.iter().any(|text| text == "finished motor test"), "{texts:?}");
        bench.arm();
        assert_ne!(bench.command(command, parameters), ACCEPTED, "armed");
    }
}

fn reports(bench: &Bench) -> Vec<MAG_CAL_REPORT_DATA> {
    let report = |message: &Message| match message {
        Message::Typed(MavMessage::MAG_CAL_REPORT(report)) => Some(report.clone()),
        _ => None,
    };
    bench.heard.iter().filter_map(report).collect()
}

#[test]
fn a_magnetometer_is_calibrated_as_ardupilot_does() {
    let mut bench = Bench::new(Identity::ArduPilot);
    let start = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_START_MAG_CAL, start), ACCEPTED);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_ACCEPT_MAG_CAL, [0.0; 7]), FAILED, "too early");
    bench.fly(8.0);
    let told: Vec<_> = bench
        .heard
        .iter()
        .filter_map(|message| match message {
            Message::Typed(MavMessage::MAG_CAL_PROGRESS(told)) => {
                Some((told.cal_status, told.completion_pct))
            }
            _ => None,
        })
        .collect();
    assert_eq!(told.first().map(|(status, _)| *status), Some(MagCalStatus::MAG_CAL_WAITING_TO_START));
    assert_eq!(told.last().map(|(status, _)| *status), Some(MagCalStatus::MAG_CAL_RUNNING_STEP_TWO));
    assert!(told.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{told:?}");
    assert!(reports(&bench).is_empty());
    bench.fly(5.0);
    let all = reports(&bench);
    assert!(all.len() >= 2 && all[0].cal_status == MagCalStatus::MAG_CAL_SUCCESS && all[0].autosaved == 0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_ACCEPT_MAG_CAL, [0.0; 7]), ACCEPTED);
    bench.heard.clear();
    bench.fly(2.0);
    assert!(reports(&bench).is_empty());
    // Saved by itself, with a reboot behind it.
    assert_eq!(
        bench.command(MavCmd::MAV_CMD_DO_START_MAG_CAL, [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]),
        ACCEPTED
    );
    bench.fly(12.0);
    assert_eq!(bench.autopilot.boots(), 2);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_START_MAG_CAL, start), ACCEPTED);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_CANCEL_MAG_CAL, [0.0; 7]), ACCEPTED);
    bench.heard.clear();
    bench.fly(13.0);
    assert!(reports(&bench).is_empty());
    assert_eq!(bench.command(MavCmd::MAV_CMD_FIXED_MAG_CAL_YAW, [0.0; 7]), ACCEPTED);
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_START_MAG_CAL, start), FAILED, "armed");
}

/// Two rotors that stop let the vehicle fall; it lies there, and its rotors stop.
#[test]
fn a_vehicle_that_has_fallen_is_disarmed() {
    for identity in [Identity::ArduPilot, Identity::Px4] {
        let mut bench = Bench::hovering(identity);
        set(&mut bench, "SYS_FAILURE_EN", 1.0);
        for motor in [1.0, 2.0] {
            let unit = FailureUnit::FAILURE_UNIT_SYSTEM_MOTOR as u32 as f32;
            assert_eq!(
                bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, [unit, 1.0, motor, 0.0, 0.0, 0.0, 0.0]),
                ACCEPTED
            );
        }
        bench.fly_until("disarmed", 30.0, |bench| !bench.autopilot.vehicle().is_armed());
        let texts = bench.texts();
        assert_eq!(texts.last().map(String::as_str), Some("Disarmed: landed without rotor 1"), "{texts:?}");
    }
}
