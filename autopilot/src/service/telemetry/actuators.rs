//! What the rotors are told, and what they do.

use mavlink::dialects::ardupilotmega::{
    ACTUATOR_CONTROL_TARGET_DATA, ACTUATOR_OUTPUT_STATUS_DATA, MavMessage,
};
use nalgebra::Vector3;
use vehicle::Vehicle;

/// Rotors, and as many bits of ACTUATOR_OUTPUT_STATUS.
const ROTORS: u32 = 0b1111;

/// ACTUATOR_OUTPUT_STATUS: the speeds of the rotors as shares of the fastest, in the order of SERVO_OUTPUT_RAW.
pub fn actuator_output_status(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let fastest = vehicle.simulation().configuration().airframe.rotor_speed_max_rad_s;
    let mut actuator = [0.0; 32];
    for (share, speed) in actuator.iter_mut().zip(outputs.rotor_speed_rad_s) {
        *share = (speed / fastest) as f32;
    }
    MavMessage::ACTUATOR_OUTPUT_STATUS(ACTUATOR_OUTPUT_STATUS_DATA {
        time_usec: outputs.time_us,
        active: ROTORS,
        actuator,
    })
}

/// ACTUATOR_CONTROL_TARGET of the group of flight controls: roll, pitch, yaw and thrust that the rotors make together, as shares of the
/// largest that they could make.
pub fn actuator_control_target(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let airframe = &vehicle.simulation().configuration().airframe;
    let share =
        |speed: f64| (speed / airframe.rotor_speed_max_rad_s) * (speed / airframe.rotor_speed_max_rad_s);
    let mut torque = Vector3::<f64>::zeros();
    let (mut thrust, mut reach) = (0.0, Vector3::<f64>::zeros());
    for (rotor, speed) in airframe.layout.rotors.iter().zip(outputs.rotor_speed_rad_s) {
        // Thrust is upwards: it rolls to the left of a rotor at the right, and pitches up in front of one at the front.
        let arm = Vector3::new(-rotor.y, rotor.x, rotor.direction.torque_sign());
        torque += arm * share(speed);
        reach += arm.abs() / 2.0;
        thrust += share(speed) / 4.0;
    }
    let mut controls = [0.0; 8];
    let parts = [torque.x / reach.x, torque.y / reach.y, torque.z / reach.z, thrust];
    for (control, part) in controls.iter_mut().zip(parts) {
        *control = part as f32;
    }
    MavMessage::ACTUATOR_CONTROL_TARGET(ACTUATOR_CONTROL_TARGET_DATA {
        time_usec: outputs.time_us,
        controls,
        group_mlx: 0,
    })
}
