//! What clients ask of vehicle 1.

use mavlink::dialects::ardupilotmega::*;
use vehicle::world::Geodetic;

/// PARAM_SET of a real parameter.
pub fn set_parameter(name: &str, value: f32) -> MavMessage {
    set_parameter_as(name, value, MavParamType::MAV_PARAM_TYPE_REAL32)
}

/// PARAM_SET with a type.
pub fn set_parameter_as(name: &str, param_value: f32, param_type: MavParamType) -> MavMessage {
    MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value,
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
        param_type,
    })
}

/// SET_POSITION_TARGET_LOCAL_NED: a place, m, and a velocity, m/s, as far as the mask does not ignore them.
pub fn local_target(mask: u16, [x, y, z]: [f32; 3], [vx, vy, vz]: [f32; 3]) -> MavMessage {
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(mask),
        x,
        y,
        z,
        vx,
        vy,
        vz,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}

/// DO_REPOSITION as COMMAND_INT, to a place and an altitude in a frame, m.
pub fn reposition(place: &Geodetic, frame: MavFrame, altitude_m: f32) -> MavMessage {
    MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command: MavCmd::MAV_CMD_DO_REPOSITION,
        target_system: 1,
        target_component: 1,
        frame,
        param1: -1.0,
        param4: f32::NAN,
        x: (place.latitude_deg * 1e7).round() as i32,
        y: (place.longitude_deg * 1e7).round() as i32,
        z: altitude_m,
        ..COMMAND_INT_DATA::default()
    })
}
