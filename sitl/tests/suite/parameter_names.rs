//! Every parameter of the table is set and read back over the wire, under both identities.

use crate::common;
use crate::common::Bench;
use crate::common::requests::set_parameter_as;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::parameters::{Description, ParameterTable, Value};

/// PX4's whole numbers travel as bytes, ArduPilot's as numbers.
fn set(identity: Identity, name: &str, value: Value) -> MavMessage {
    let (param_value, param_type) = match value {
        Value::Integer(value) if !identity.is_ardupilot() => {
            (f32::from_bits(value as u32), MavParamType::MAV_PARAM_TYPE_INT32)
        }
        other => (other.number() as f32, MavParamType::MAV_PARAM_TYPE_REAL32),
    };
    set_parameter_as(name, param_value, param_type)
}

/// Other values that the description offers, the farthest first.
fn others(present: Value, description: &Description) -> Vec<Value> {
    if !description.names.is_empty() {
        let named = description.names.iter().map(|named| match present {
            Value::Integer(_) => Value::Integer(named.value),
            Value::Real(_) => Value::Real(named.value as f32),
        });
        return named.filter(|other| *other != present).collect();
    }
    let range = &description.range;
    let candidates =
        [range.maximum, range.minimum, present.number() * 0.9, present.number() * 1.1, 0.01, 0.001, 1e-5];
    let value = |number: f64| match present {
        Value::Integer(_) => Value::Integer(number as i32),
        Value::Real(_) => Value::Real(number as f32),
    };
    candidates.into_iter().map(value).filter(|other| *other != present).collect()
}

#[test]
fn every_parameter_is_set_and_read_back() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut settings = common::settings(identity);
        // Ideal ones have no errors.
        settings.sensors.model = vehicle::estimation::SensorModel::Realistic;
        let mut bench = Bench::of(&settings);
        let table = ParameterTable::new(identity);
        for (index, entry) in table.entries().iter().enumerate() {
            let description = entry.describe();
            let present = |bench: &Bench| bench.autopilot.parameters().nth(index).expect("there").1;
            let before = present(&bench);
            // One takes nothing but zero, which it is.
            if description.read_only || ["SIM_SPEEDUP", "STAT_RESET"].contains(&entry.id) {
                continue;
            }
            let taken = others(before, &description).into_iter().find(|other| {
                bench.send(set(identity, entry.id, *other));
                present(&bench) == *other
            });
            let Some(taken) = taken else { panic!("{}: {:?}", entry.id, bench.texts()) };
            bench.heard.clear();
            bench.send(MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
                param_index: -1,
                target_system: 1,
                target_component: 1,
                param_id: entry.id.into(),
            }));
            let read = bench.heard.iter().find_map(|message| match message {
                Message::Typed(MavMessage::PARAM_VALUE(value)) => Some(value.param_value),
                _ => None,
            });
            let expected = match taken {
                Value::Integer(value) if !identity.is_ardupilot() => f32::from_bits(value as u32),
                other => other.number() as f32,
            };
            assert_eq!(read.map(f32::to_bits), Some(expected.to_bits()), "{}", entry.id);
            bench.send(set(identity, entry.id, before));
            assert_eq!(present(&bench), before, "{}: {:?}", entry.id, bench.texts());
        }
    }
}

/// Names that PX4's and ArduPilot's own tests, DroneKit's and MAVSDK's examples set, with the original's default where it is not a
/// property of the airframe.
#[test]
fn what_scripts_set_is_there_with_the_originals_default() {
    let expect = |identity: Identity, name: &str, default: f64| {
        let bench = Bench::new(identity);
        let value = bench.autopilot.parameters().find(|(id, _)| *id == name).map(|(_, value)| value.number());
        let value = value.unwrap_or_else(|| panic!("{name} is not there"));
        assert!((value - default).abs() < 1e-4 * default.abs().max(1.0), "{name} = {value}, not {default}");
    };
    for (name, default) in [
        ("EKF2_HGT_REF", 1.0),
        ("MIS_YAW_ERR", 12.0),
        ("MIS_TAKEOFF_ALT", 2.5),
        ("CBRK_SUPPLY_CHK", 0.0),
        ("MC_ROLLRATE_P", 0.15),
        ("SDLOG_MODE", 0.0),
        ("SIM_BAT_DRAIN", 60.0),
        ("COM_OF_LOSS_T", 1.0),
    ] {
        expect(Identity::Px4, name, default);
    }
    for (name, default) in [
        ("ATC_ANG_RLL_P", 4.5),
        ("EK3_ENABLE", 1.0),
        ("RTL_ALT", 1500.0),
        ("RTL_ALT_M", 15.0),
        ("FS_EKF_THRESH", 0.8),
        ("LOG_BACKEND_TYPE", 1.0),
        ("FRAME_CLASS", 1.0),
        ("SIM_WIND_DIR", 180.0),
        ("SIM_GPS1_ENABLE", 1.0),
        ("SIM_GPS_DISABLE", 0.0),
        ("SIM_BATT_VOLTAGE", 12.6),
    ] {
        expect(Identity::ArduPilot, name, default);
    }
}

/// Names from PX4's pages on safety, offboard control, external vision, payloads and configuration, and from ArduPilot's on visual odometry
/// and notch filters. Programs and parameter files set them on their way, and one that is unknown stops them.
#[test]
fn what_programs_set_on_their_way_is_there() {
    const PX4: &str = "COM_FAIL_ACT_T COM_FLT_TIME_MAX COM_FLTT_LOW_ACT COM_QC_ACT COM_POS_FS_EPH COM_VEL_FS_EVH COM_DLL_EXCEPT \
        COM_ARM_EKF_POS COM_ARM_EKF_HGT COM_ARM_EKF_YAW COM_RC_ARM_HYST COM_OBL_ACT COM_OBS_AVOID COM_TAKEOFF_ACT COM_KILL_DISARM \
        GF_SOURCE FD_EXT_ATS_EN MIS_DIST_1WP MPC_XY_MAN_EXPO MPC_USE_HTE MPC_MAN_Y_TAU EKF2_AID_MASK EKF2_HGT_MODE EKF2_EV_CTRL \
        EKF2_EV_POS_X EKF2_EV_DELAY SIM_GPS_USED CA_ROTOR_COUNT CA_ROTOR0_PX PWM_MAIN_FUNC1 BAT1_N_CELLS CP_DIST CP_GUIDE_ANG \
        PLD_HACC_RAD PLD_BTOUT TRIG_MODE TRIG_INTERFACE TRIG_DISTANCE PD_GRIPPER_EN PD_GRIPPER_TYPE MNT_MODE_IN MNT_MAV_SYSID \
        CAL_ACC0_ID CAL_GYRO0_ID CAL_MAG0_ID IMU_GYRO_RATEMAX SYS_CTRL_ALLOC SYS_VEHICLE_RESP WV_EN";
    const ARDUPILOT: &str = "VISO_TYPE VISO_DELAY_MS VISO_ORIENT VISO_POS_X VISO_POS_M_NSE INS_HNTCH_ENABLE INS_HNTCH_FREQ INS_HNTCH_BW \
        INS_HNTCH_REF BRD_TYPE FFT_ENABLE";
    for (identity, names) in [(Identity::Px4, PX4), (Identity::ArduPilot, ARDUPILOT)] {
        let table = ParameterTable::new(identity);
        let missing =
            names.split_whitespace().filter(|name| !table.entries().iter().any(|entry| entry.id == *name));
        assert_eq!(missing.collect::<Vec<_>>(), Vec::<&str>::new(), "{identity:?}");
    }
}
