//! How well the vehicle keeps to what it is steered to.

use mavlink::dialects::ardupilotmega::{MavMessage, NAV_CONTROLLER_OUTPUT_DATA};
use vehicle::world::heading_deg;
use vehicle::{Mode, Vehicle};

/// NAV_CONTROLLER_OUTPUT: the tracking errors of the controllers. Across the leg of a mission, else across the heading; in
/// altitude and speed against the reference. A distance is that to where the vehicle is led, else to the reference.
pub fn nav_controller_output(vehicle: &Vehicle) -> MavMessage {
    let outputs = vehicle.outputs();
    let [roll_rad, pitch_rad] = outputs.tilt_reference_rad;
    let reference = &outputs.setpoint;
    let leg = vehicle.leg_errors().filter(|_| vehicle.mode() == Mode::Mission);
    let (sin, cos) = libm::sincos(outputs.attitude_rad.z);
    let across_m = outputs.tracking_error_m.y * cos - outputs.tracking_error_m.x * sin;
    let cross_track_m = leg.map_or(across_m, |(_, cross_track_m)| cross_track_m);
    let way_m = vehicle.destination_m().unwrap_or(reference.position_m) - outputs.position_m;
    let signed_deg = |angle_rad: f64| {
        let degrees = heading_deg(angle_rad);
        (if degrees > 180.0 { degrees - 360.0 } else { degrees }).round() as i16
    };
    MavMessage::NAV_CONTROLLER_OUTPUT(NAV_CONTROLLER_OUTPUT_DATA {
        nav_roll: roll_rad.to_degrees() as f32,
        nav_pitch: pitch_rad.to_degrees() as f32,
        // Up is positive: the reference above the vehicle.
        alt_error: outputs.tracking_error_m.z as f32,
        aspd_error: (reference.velocity_m_s.norm() - outputs.velocity_m_s.norm()) as f32,
        xtrack_error: cross_track_m as f32,
        nav_bearing: signed_deg(reference.yaw_rad),
        target_bearing: signed_deg(libm::atan2(way_m.y, way_m.x)),
        wp_dist: way_m.xy().norm().round() as u16,
    })
}
