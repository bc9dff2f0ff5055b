//! Health, battery, outputs, landed state and time.

use mavlink::dialects::ardupilotmega::{
    BATTERY_STATUS_DATA, EXTENDED_SYS_STATE_DATA, FENCE_STATUS_DATA, FenceBreach, FenceMitigate,
    MavBatteryChargeState, MavBatteryFault, MavBatteryFunction, MavBatteryType, MavLandedState, MavMessage,
    MavSysStatusSensor, MavSysStatusSensorExtended, MavVtolState, SERVO_OUTPUT_RAW_DATA, SYS_STATUS_DATA,
    SYSTEM_TIME_DATA,
};
use vehicle::fence::Breach;
use vehicle::{LandedState, Vehicle, Weakness};

use crate::codec::{boot_ms, boot_us};

/// Instruments and controllers that every vehicle has.
const ALWAYS_PRESENT: MavSysStatusSensor = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_GYRO
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_ACCEL)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_MAG)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_GPS)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ANGULAR_RATE_CONTROL)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_YAW_POSITION)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_AHRS)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_BATTERY)
    .union(MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK);

/// Which instruments and controllers the vehicle has.
fn present(vehicle: &Vehicle) -> MavSysStatusSensor {
    let mut present = ALWAYS_PRESENT;
    present.set(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_RC_RECEIVER, vehicle.pilot().has_radio);
    present.set(MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE, vehicle.has_fence());
    present.set(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_PROXIMITY, vehicle.has_proximity());
    present.set(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_LASER_POSITION, vehicle.has_rangefinder());
    present.set(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_VISION_POSITION, vehicle.aiding().vision.is_some());
    present
}

/// Those of them that are switched on.
fn enabled(vehicle: &Vehicle, present: MavSysStatusSensor) -> MavSysStatusSensor {
    let switches = [
        (vehicle.fence().is_some(), MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE),
        (vehicle.obstacles().rangefinder_is_on(), MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_LASER_POSITION),
        (vehicle.obstacles().proximity_is_on(), MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_PROXIMITY),
        (!vehicle.is_safe(), MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS),
    ];
    without_failed(present, &switches)
}

/// Those of them that work, or know enough.
fn health(vehicle: &Vehicle, present: MavSysStatusSensor) -> MavSysStatusSensor {
    let armable = vehicle.is_armed() || vehicle.arming_obstacles().is_empty();
    let sees_around = vehicle.measures_around() || !vehicle.has_proximity();
    let (instruments, validity) = (vehicle.instrument_health(), vehicle.validity());
    let position = validity.horizontal_position && validity.horizontal_velocity;
    let charged = vehicle.battery_remaining() >= vehicle.conduct().failsafe.battery_critical;
    let checks = [
        (instruments.gyroscope, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_GYRO),
        (instruments.accelerometer, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_ACCEL),
        (instruments.magnetometer, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_3D_MAG),
        (instruments.barometer, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE),
        (instruments.gps, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_GPS),
        (instruments.vision, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_VISION_POSITION),
        (validity.tilt && validity.heading, MavSysStatusSensor::MAV_SYS_STATUS_AHRS),
        (validity.vertical_position, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL),
        (position, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL),
        (vehicle.lost_rotor().is_none(), MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS),
        (charged, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_BATTERY),
        (vehicle.fence_record().now.is_none(), MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE),
        (!vehicle.pilot().lost, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_RC_RECEIVER),
        (sees_around, MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_PROXIMITY),
        // As in ArduPilot, one that is off is not healthy.
        (vehicle.obstacles().rangefinder_is_on(), MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_LASER_POSITION),
        (armable, MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK),
    ];
    // No fence is not breached, either: ArduPilot says so, and MAVProxy would tell a breach at the start.
    without_failed(present | MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE, &checks)
}

/// Those whose check, if there is one, is passed.
fn without_failed(sensors: MavSysStatusSensor, checks: &[(bool, MavSysStatusSensor)]) -> MavSysStatusSensor {
    let failed = checks.iter().filter(|(passed, _)| !passed);
    failed.fold(sensors, |sensors, (_, sensor)| sensors & !*sensor)
}

/// SYS_STATUS: which instruments work and which controllers know enough; the arming check tells whether it could be armed.
pub fn sys_status(vehicle: &Vehicle) -> MavMessage {
    let (present, battery) = (present(vehicle), vehicle.battery());
    MavMessage::SYS_STATUS(SYS_STATUS_DATA {
        onboard_control_sensors_present: present,
        onboard_control_sensors_enabled: enabled(vehicle, present),
        onboard_control_sensors_health: health(vehicle, present),
        voltage_battery: (battery.voltage_v() * 1e3).round() as u16,
        current_battery: (battery.current_a() * 1e2).round() as i16,
        battery_remaining: percent(vehicle),
        // The crate's default of flags is the first of them, not none.
        onboard_control_sensors_present_extended: MavSysStatusSensorExtended::empty(),
        onboard_control_sensors_enabled_extended: MavSysStatusSensorExtended::empty(),
        onboard_control_sensors_health_extended: MavSysStatusSensorExtended::empty(),
        ..SYS_STATUS_DATA::default()
    })
}

/// By the thresholds at which the failsafe acts.
fn charge_state(vehicle: &Vehicle) -> MavBatteryChargeState {
    let (remaining, settings) = (vehicle.battery_remaining(), &vehicle.conduct().failsafe);
    let is_weak = |weakness: Weakness| vehicle.failsafe().is_weak(weakness);
    // By its voltage ArduPilot's battery is critical at the worst.
    if remaining < settings.battery_emergency && !vehicle.identity().is_ardupilot() {
        MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_EMERGENCY
    } else if remaining < settings.battery_critical || is_weak(Weakness::Critical) {
        MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_CRITICAL
    } else if remaining < settings.battery_low || is_weak(Weakness::Low) {
        MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_LOW
    } else {
        MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_OK
    }
}

fn percent(vehicle: &Vehicle) -> i8 {
    (100.0 * vehicle.battery_remaining()).ceil() as i8
}

/// Cells before those of the extension of BATTERY_STATUS.
const FIRST_EXTENDED_CELL: usize = 10;

/// Voltages of some cells from the first one, mV, among those that there are.
fn cells<const N: usize>(first: usize, count: u8, cell_mv: u16, none: u16) -> [u16; N] {
    core::array::from_fn(|cell| if first + cell < usize::from(count) { cell_mv } else { none })
}

/// BATTERY_STATUS.
pub fn battery_status(vehicle: &Vehicle) -> MavMessage {
    let battery = vehicle.battery();
    let cell_mv = (battery.voltage_v() / f64::from(battery.cells()) * 1e3).round() as u16;
    MavMessage::BATTERY_STATUS(BATTERY_STATUS_DATA {
        current_consumed: (battery.drawn_ah() * 1e3).round() as i32,
        energy_consumed: (battery.energy_j() / 100.0).round() as i32,
        // Unknown.
        temperature: i16::MAX,
        voltages: cells(0, battery.cells(), cell_mv, u16::MAX),
        // Older readers know ten cells, and 0 for none of the others.
        voltages_ext: cells(FIRST_EXTENDED_CELL, battery.cells(), cell_mv, 0),
        current_battery: (battery.current_a() * 1e2).round() as i16,
        battery_function: MavBatteryFunction::MAV_BATTERY_FUNCTION_ALL,
        mavtype: MavBatteryType::MAV_BATTERY_TYPE_LIPO,
        battery_remaining: percent(vehicle),
        time_remaining: battery.time_remaining_s(vehicle.battery_capacity_ah()) as i32,
        charge_state: charge_state(vehicle),
        fault_bitmask: MavBatteryFault::empty(),
        ..BATTERY_STATUS_DATA::default()
    })
}

/// SERVO_OUTPUT_RAW: the speeds of the front, right, back and left rotor as pulses, 1000 µs at rest, 2000 µs at the most, and the servos
/// behind them, 0 where nothing drives one. With the safety switch on, nothing drives any.
pub fn servo_output_raw(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let fastest = vehicle.simulation().configuration().airframe.rotor_speed_max_rad_s;
    let [servo1_raw, servo2_raw, servo3_raw, servo4_raw] =
        outputs.rotor_speed_rad_s.map(|speed| match vehicle.is_safe() {
            true => 0,
            false => (1000.0 + 1000.0 * speed / fastest).round() as u16,
        });
    MavMessage::SERVO_OUTPUT_RAW(SERVO_OUTPUT_RAW_DATA {
        time_usec: boot_us(outputs.time_us),
        servo1_raw,
        servo2_raw,
        servo3_raw,
        servo4_raw,
        servo5_raw: vehicle.output_us(5),
        servo6_raw: vehicle.output_us(6),
        servo7_raw: vehicle.output_us(7),
        servo8_raw: vehicle.output_us(8),
        servo9_raw: vehicle.output_us(9),
        servo10_raw: vehicle.output_us(10),
        servo11_raw: vehicle.output_us(11),
        servo12_raw: vehicle.output_us(12),
        servo13_raw: vehicle.output_us(13),
        servo14_raw: vehicle.output_us(14),
        servo15_raw: vehicle.output_us(15),
        servo16_raw: vehicle.output_us(16),
        ..SERVO_OUTPUT_RAW_DATA::default()
    })
}

/// EXTENDED_SYS_STATE.
pub fn extended_sys_state(vehicle: &Vehicle) -> MavMessage {
    MavMessage::EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA {
        landed_state: match vehicle.landed_state() {
            LandedState::OnGround => MavLandedState::MAV_LANDED_STATE_ON_GROUND,
            LandedState::InAir => MavLandedState::MAV_LANDED_STATE_IN_AIR,
            LandedState::TakingOff => MavLandedState::MAV_LANDED_STATE_TAKEOFF,
            LandedState::Landing => MavLandedState::MAV_LANDED_STATE_LANDING,
        },
        // ArduPilot's copters say that they are one; PX4 says so only of a vehicle that could be something else.
        vtol_state: if vehicle.identity().is_ardupilot() {
            MavVtolState::MAV_VTOL_STATE_MC
        } else {
            MavVtolState::MAV_VTOL_STATE_UNDEFINED
        },
    })
}

/// FENCE_STATUS.
pub fn fence_status(vehicle: &Vehicle) -> MavMessage {
    let record = vehicle.fence_record();
    let (breach_type, breach_time) = match record.latest {
        None => (FenceBreach::FENCE_BREACH_NONE, 0),
        Some((Breach::Floor(_), time_us)) => (FenceBreach::FENCE_BREACH_MINALT, boot_ms(time_us)),
        Some((Breach::Height(_), time_us)) => (FenceBreach::FENCE_BREACH_MAXALT, boot_ms(time_us)),
        Some((_, time_us)) => (FenceBreach::FENCE_BREACH_BOUNDARY, boot_ms(time_us)),
    };
    MavMessage::FENCE_STATUS(FENCE_STATUS_DATA {
        breach_time,
        breach_count: record.count,
        breach_status: u8::from(record.now.is_some()),
        breach_type,
        breach_mitigation: FenceMitigate::FENCE_MITIGATE_NONE,
    })
}

/// SYSTEM_TIME: the wall clock's time at the start, and simulation time from there on.
pub fn system_time(vehicle: &Vehicle) -> MavMessage {
    MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA {
        time_unix_usec: vehicle.unix_start_us() + vehicle.time_us(),
        time_boot_ms: boot_ms(vehicle.time_us()),
    })
}
