//! Messages of the gimbal and of its manager.

use mavlink::dialects::ardupilotmega::{
    GIMBAL_DEVICE_ATTITUDE_STATUS_DATA, GIMBAL_DEVICE_INFORMATION_DATA, GIMBAL_MANAGER_INFORMATION_DATA,
    GIMBAL_MANAGER_STATUS_DATA, GimbalDeviceCapFlags, GimbalDeviceCapFlagsU16, GimbalDeviceErrorFlags,
    GimbalDeviceFlags, GimbalManagerCapFlags, GimbalManagerFlags, MOUNT_STATUS_DATA, MavMessage,
    MavMountMode,
};
use vehicle::equipment::{EquipmentVoice, Gimbal};
use vehicle::{Vehicle, wrapped};

use super::camera_messages::quaternion;
use crate::codec::boot_ms;
use crate::service::version;
use crate::speaker::Speaker;
use crate::stream::Component;

/// Number of a gimbal that is no component of its own.
const OF_AUTOPILOT: u8 = 1;

/// What the manager calls the gimbal: its component, or a small number where it has none of its own.
pub fn device_id(component: &Component<'_>) -> u8 {
    match component.parameters.settings().equipment {
        EquipmentVoice::Own => Speaker::Gimbal.id(),
        EquipmentVoice::Autopilot => OF_AUTOPILOT,
    }
}

/// What the gimbal calls itself: 0 where its component says it all.
fn own_id(component: &Component<'_>) -> u8 {
    match component.parameters.settings().equipment {
        EquipmentVoice::Own => 0,
        EquipmentVoice::Autopilot => OF_AUTOPILOT,
    }
}

/// GIMBAL_MANAGER_INFORMATION.
pub fn manager_information(component: &Component<'_>) -> MavMessage {
    let [roll, pitch, yaw] = ranges(component.vehicle);
    // The manager's flags begin with those of the device.
    let able = GimbalManagerCapFlags::from_bits_truncate(capabilities().bits())
        | GimbalManagerCapFlags::GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL
        | GimbalManagerCapFlags::GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_LOCAL;
    MavMessage::GIMBAL_MANAGER_INFORMATION(GIMBAL_MANAGER_INFORMATION_DATA {
        time_boot_ms: boot_ms(component.vehicle.time_us()),
        cap_flags: able,
        roll_min: roll[0],
        roll_max: roll[1],
        pitch_min: pitch[0],
        pitch_max: pitch[1],
        yaw_min: yaw[0],
        yaw_max: yaw[1],
        gimbal_device_id: device_id(component),
    })
}

/// GIMBAL_MANAGER_STATUS.
pub fn manager_status(component: &Component<'_>) -> MavMessage {
    let vehicle = component.vehicle;
    let control = vehicle.equipment().gimbal_control();
    let numbers = |who: Option<vehicle::equipment::Controller>| {
        who.map_or((0, 0), |controller| (controller.system, controller.component))
    };
    let (primary, secondary) = (numbers(control.primary), numbers(control.secondary));
    let flags = u32::from(flags(vehicle.equipment().gimbal()).bits());
    MavMessage::GIMBAL_MANAGER_STATUS(GIMBAL_MANAGER_STATUS_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        flags: GimbalManagerFlags::from_bits_truncate(flags),
        gimbal_device_id: device_id(component),
        primary_control_sysid: primary.0,
        primary_control_compid: primary.1,
        secondary_control_sysid: secondary.0,
        secondary_control_compid: secondary.1,
    })
}

/// GIMBAL_DEVICE_INFORMATION.
pub fn device_information(component: &Component<'_>) -> MavMessage {
    let [roll, pitch, yaw] = ranges(component.vehicle);
    let able = capabilities();
    MavMessage::GIMBAL_DEVICE_INFORMATION(GIMBAL_DEVICE_INFORMATION_DATA {
        uid: u64::from(component.parameters.system_id()),
        time_boot_ms: boot_ms(component.vehicle.time_us()),
        firmware_version: version().swap_bytes(),
        hardware_version: 0,
        roll_min: roll[0],
        roll_max: roll[1],
        pitch_min: pitch[0],
        pitch_max: pitch[1],
        yaw_min: yaw[0],
        yaw_max: yaw[1],
        cap_flags: GimbalDeviceCapFlagsU16::from_bits_truncate((able.bits() & u32::from(u16::MAX)) as u16),
        custom_cap_flags: 0,
        vendor_name: "LMPC".into(),
        model_name: "Simulated gimbal".into(),
        custom_name: "".into(),
        gimbal_device_id: own_id(component),
        cap_flags2: able,
    })
}

/// GIMBAL_DEVICE_ATTITUDE_STATUS: its yaw is from north while it is locked, else from the nose.
pub fn attitude_status(component: &Component<'_>) -> MavMessage {
    let vehicle = component.vehicle;
    let gimbal = vehicle.equipment().gimbal();
    let outputs = vehicle.outputs();
    let (locked, heading_rad) = (gimbal.is_locked(), outputs.attitude_rad.z);
    let mut attitude_rad = gimbal.angles_rad();
    attitude_rad.z = gimbal.yaw_in(locked, heading_rad);
    let rates = gimbal.rates_rad_s();
    let turning_rad_s = if locked { outputs.body_rate_rad_s.z } else { 0.0 };
    let [roll_limit, pitch_limit, yaw_limit] = gimbal.at_limit();
    let failures = [
        (roll_limit, GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_ROLL_LIMIT),
        (pitch_limit, GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_PITCH_LIMIT),
        (yaw_limit, GimbalDeviceErrorFlags::GIMBAL_DEVICE_ERROR_FLAGS_AT_YAW_LIMIT),
    ];
    let failures = failures.into_iter().filter(|(at, _)| *at);
    MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(GIMBAL_DEVICE_ATTITUDE_STATUS_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        q: quaternion(&attitude_rad),
        angular_velocity_x: rates.x as f32,
        angular_velocity_y: rates.y as f32,
        angular_velocity_z: (rates.z + turning_rad_s) as f32,
        failure_flags: failures.fold(GimbalDeviceErrorFlags::empty(), |all, (_, flag)| all | flag),
        flags: flags(gimbal),
        target_system: 0,
        target_component: 0,
        delta_yaw: wrapped(heading_rad) as f32,
        delta_yaw_velocity: outputs.body_rate_rad_s.z as f32,
        gimbal_device_id: own_id(component),
    })
}

/// MOUNT_STATUS, the older message: pitch, roll and yaw from the nose, hundredths of a degree.
pub fn mount_status(vehicle: &Vehicle) -> MavMessage {
    let gimbal = vehicle.equipment().gimbal();
    let hundredths = |angle_rad: f64| (angle_rad.to_degrees() * 1e2).round() as i32;
    let [roll, pitch, yaw] = gimbal.angles_rad().data.0[0];
    MavMessage::MOUNT_STATUS(MOUNT_STATUS_DATA {
        pointing_a: hundredths(pitch),
        pointing_b: hundredths(roll),
        pointing_c: hundredths(yaw),
        target_system: 0,
        target_component: 0,
        mount_mode: if gimbal.is_retracted() {
            MavMountMode::MAV_MOUNT_MODE_RETRACT
        } else if gimbal.is_neutral() {
            MavMountMode::MAV_MOUNT_MODE_NEUTRAL
        } else if gimbal.tracks() {
            MavMountMode::MAV_MOUNT_MODE_GPS_POINT
        } else if gimbal.is_pointed_by_radio() {
            MavMountMode::MAV_MOUNT_MODE_RC_TARGETING
        } else {
            MavMountMode::MAV_MOUNT_MODE_MAVLINK_TARGETING
        },
    })
}

/// Ranges of roll, pitch and yaw, rad.
fn ranges(vehicle: &Vehicle) -> [[f32; 2]; 3] {
    let limits = vehicle.conduct().equipment.mount.limits();
    [limits.roll_rad, limits.pitch_rad, limits.yaw_rad].map(|range| range.map(|angle| angle as f32))
}

fn capabilities() -> GimbalDeviceCapFlags {
    GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_RETRACT
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_NEUTRAL
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_AXIS
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_LOCK
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_AXIS
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_LOCK
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_AXIS
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_FOLLOW
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_LOCK
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_SUPPORTS_INFINITE_YAW
        | GimbalDeviceCapFlags::GIMBAL_DEVICE_CAP_FLAGS_SUPPORTS_YAW_IN_EARTH_FRAME
}

fn flags(gimbal: &Gimbal) -> GimbalDeviceFlags {
    let level = GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_ROLL_LOCK
        | GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_PITCH_LOCK
        | GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_ACCEPTS_YAW_IN_EARTH_FRAME;
    let yaw = if gimbal.is_locked() {
        GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_LOCK
            | GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_IN_EARTH_FRAME
    } else {
        GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME
    };
    let state = if gimbal.is_retracted() {
        GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_RETRACT
    } else if gimbal.is_neutral() {
        GimbalDeviceFlags::GIMBAL_DEVICE_FLAGS_NEUTRAL
    } else {
        GimbalDeviceFlags::empty()
    };
    level | yaw | state
}
