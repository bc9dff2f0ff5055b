//! What the vehicle is steered to.

use mavlink::dialects::ardupilotmega::{
    ATTITUDE_TARGET_DATA, AttitudeTargetTypemask, MavFrame, MavMessage, PID_TUNING_DATA,
    POSITION_TARGET_GLOBAL_INT_DATA, POSITION_TARGET_LOCAL_NED_DATA, PidTuningAxis, PositionTargetTypemask,
};
use vehicle::{AxisTarget, Mode, PositionSetPoint, SteeringKind, TrackedAttitude, Vehicle, wrapped};

use crate::codec::{boot_ms, floats, scaled_degrees};
use crate::stream::Component;

/// ATTITUDE_TARGET: what the attitude controller tracks.
pub fn attitude_target(vehicle: &Vehicle) -> MavMessage {
    let TrackedAttitude { attitude, body_rate_rad_s: rate, thrust } = vehicle.tracked_attitude();
    MavMessage::ATTITUDE_TARGET(ATTITUDE_TARGET_DATA {
        time_boot_ms: boot_ms(vehicle.outputs().time_us),
        q: [attitude.w as f32, attitude.i as f32, attitude.j as f32, attitude.k as f32],
        body_roll_rate: rate.x as f32,
        body_pitch_rate: rate.y as f32,
        body_yaw_rate: rate.z as f32,
        thrust: thrust as f32,
        type_mask: AttitudeTargetTypemask::empty(),
    })
}

/// PID_TUNING: what the inner loops of GCS_PID_MASK are asked for and reach, body rates in rad/s and the acceleration down in m/s². They
/// predict: of a PID's terms there are none.
pub fn pid_tuning(component: &Component<'_>) -> Vec<MavMessage> {
    let (vehicle, told) = (component.vehicle, component.vehicle.conduct().told_loops);
    if told == 0 {
        return Vec::new();
    }
    let (asked, outputs) = (vehicle.tracked_attitude().body_rate_rad_s, vehicle.outputs());
    let rates = outputs.body_rate_rad_s;
    let (down, reached_down) = (outputs.setpoint.acceleration_m_s2.z, outputs.acceleration_m_s2.z);
    let loops = [
        (PidTuningAxis::PID_TUNING_ROLL, asked.x, rates.x),
        (PidTuningAxis::PID_TUNING_PITCH, asked.y, rates.y),
        (PidTuningAxis::PID_TUNING_YAW, asked.z, rates.z),
        (PidTuningAxis::PID_TUNING_ACCZ, down, reached_down),
    ];
    let chosen = (0..).zip(loops).filter(|(bit, _)| told & (1 << bit) != 0);
    let message = |(_, (axis, desired, achieved)): (u8, (_, f64, f64))| {
        MavMessage::PID_TUNING(PID_TUNING_DATA {
            axis,
            desired: desired as f32,
            achieved: achieved as f32,
            ..PID_TUNING_DATA::default()
        })
    };
    chosen.map(message).collect()
}

/// Everything is ignored while the vehicle is not steered by position.
fn type_mask(vehicle: &Vehicle) -> PositionTargetTypemask {
    const ALL_VALUES: u16 = 0b1101_1111_1111;
    match vehicle.steering_kind() {
        SteeringKind::Position => PositionTargetTypemask::empty(),
        _ => PositionTargetTypemask::from_bits_retain(ALL_VALUES),
    }
}

/// POSITION_TARGET_LOCAL_NED: the reference that the cascade tracks; for ArduPilot what the guided mode is asked for, and nothing in any
/// other mode.
pub fn position_target_local_ned(vehicle: &Vehicle) -> Option<MavMessage> {
    if !vehicle.identity().is_ardupilot() {
        return Some(reference_local_ned(vehicle));
    }
    let guided = matches!(vehicle.mode(), Mode::Offboard | Mode::Takeoff);
    vehicle.asked().filter(|_| guided).map(|asked| guided_target(vehicle, &asked))
}

/// What ArduPilot's guided mode is asked for: places alone, velocities and accelerations, or all three. Headings are never told.
fn guided_target(vehicle: &Vehicle, asked: &PositionSetPoint) -> MavMessage {
    const POSITION: u16 = 0b111;
    const VELOCITY: u16 = 0b111 << 3;
    const ACCELERATION: u16 = 0b111 << 6;
    const HEADING: u16 = 0b11 << 10;
    let now = vehicle.outputs().setpoint;
    let of = |kind: fn(&AxisTarget) -> bool| asked.axes.iter().any(kind);
    let ignored = if of(|axis| matches!(axis, AxisTarget::Track { .. })) {
        0
    } else if of(|axis| matches!(axis, AxisTarget::Position(_))) {
        VELOCITY | ACCELERATION
    } else if of(|axis| matches!(axis, AxisTarget::Velocity(_))) {
        POSITION
    } else {
        POSITION | VELOCITY
    };
    let [mut place, mut velocity, mut acceleration] =
        [now.position_m, now.velocity_m_s, now.acceleration_m_s2].map(|vector| floats(&vector));
    for (axis, target) in asked.axes.iter().enumerate() {
        match *target {
            AxisTarget::Position(position_m) => place[axis] = position_m as f32,
            AxisTarget::Velocity(velocity_m_s) => velocity[axis] = velocity_m_s as f32,
            AxisTarget::Acceleration(acceleration_m_s2) => acceleration[axis] = acceleration_m_s2 as f32,
            AxisTarget::Track { position_m, velocity_m_s, acceleration_m_s2, .. } => {
                place[axis] = position_m as f32;
                velocity[axis] = velocity_m_s as f32;
                acceleration[axis] = acceleration_m_s2 as f32;
            }
        }
    }
    let type_mask = PositionTargetTypemask::from_bits_retain(ignored | HEADING);
    local_ned(vehicle, [place, velocity, acceleration], type_mask)
}

/// The reference that the cascade tracks.
fn reference_local_ned(vehicle: &Vehicle) -> MavMessage {
    let reference = &vehicle.outputs().setpoint;
    let motion = [reference.position_m, reference.velocity_m_s, reference.acceleration_m_s2];
    local_ned(vehicle, motion.map(|vector| floats(&vector)), type_mask(vehicle))
}

/// A place, m, with its velocity, m/s, and acceleration, m/s², and the heading that the cascade tracks.
fn local_ned(
    vehicle: &Vehicle,
    [place, [vx, vy, vz], [afx, afy, afz]]: [[f32; 3]; 3],
    type_mask: PositionTargetTypemask,
) -> MavMessage {
    let outputs = vehicle.outputs();
    let reference = &outputs.setpoint;
    let [x, y, z] = floats(&vehicle.told_frame().told_m(&place.map(f64::from).into()));
    MavMessage::POSITION_TARGET_LOCAL_NED(POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms: boot_ms(outputs.time_us),
        x,
        y,
        z,
        vx,
        vy,
        vz,
        afx,
        afy,
        afz,
        yaw: wrapped(reference.yaw_rad) as f32,
        yaw_rate: reference.yaw_rate_rad_s as f32,
        type_mask,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
    })
}

/// POSITION_TARGET_GLOBAL_INT: where the vehicle is led, and the motion of the reference on the way there, which ArduPilot does not
/// tell; without such a place the reference.
pub fn position_target_global_int(vehicle: &Vehicle) -> MavMessage {
    const ALL_BUT_POSITION: u16 = 0b1111_1111_1000;
    let outputs = vehicle.outputs();
    let reference = &outputs.setpoint;
    let destination_m = vehicle.destination_m();
    let place = vehicle.place_of(&destination_m.unwrap_or(reference.position_m));
    let target = POSITION_TARGET_GLOBAL_INT_DATA {
        time_boot_ms: boot_ms(outputs.time_us),
        lat_int: scaled_degrees(place.latitude_deg),
        lon_int: scaled_degrees(place.longitude_deg),
        alt: place.altitude_m as f32,
        type_mask: PositionTargetTypemask::from_bits_retain(ALL_BUT_POSITION),
        coordinate_frame: MavFrame::MAV_FRAME_GLOBAL_INT,
        ..POSITION_TARGET_GLOBAL_INT_DATA::DEFAULT
    };
    if vehicle.identity().is_ardupilot() && destination_m.is_some() {
        return MavMessage::POSITION_TARGET_GLOBAL_INT(target);
    }
    let [vx, vy, vz] = floats(&reference.velocity_m_s);
    let [afx, afy, afz] = floats(&reference.acceleration_m_s2);
    MavMessage::POSITION_TARGET_GLOBAL_INT(POSITION_TARGET_GLOBAL_INT_DATA {
        vx,
        vy,
        vz,
        afx,
        afy,
        afz,
        yaw: wrapped(reference.yaw_rad) as f32,
        yaw_rate: reference.yaw_rate_rad_s as f32,
        type_mask: type_mask(vehicle),
        ..target
    })
}
