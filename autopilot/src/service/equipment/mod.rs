//! What the vehicle carries, as MAVLink sees it: servos, relays and gripper, the camera protocol, the settings of
//! the camera as extended parameters and in its definition, the gimbal manager with its device, and what the gimbal follows.
//!
//! Camera and gimbal have component ids of their own. Requests to these are answered from there, those to the autopilot or to all by the
//! autopilot. Whether they also send heartbeats, and speak of themselves, is a setting.

mod camera;
pub mod camera_definition;
mod camera_messages;
mod camera_parameters;
mod camera_setting;
mod gimbal;
mod gimbal_messages;
mod heartbeat;
mod mount_control;
mod operate;
mod outputs;
mod tracked_system;

pub use camera::CameraProtocol;
pub use camera_parameters::CameraParameters;
pub use gimbal::GimbalManager;
pub use heartbeat::EquipmentHeartbeats;
pub use outputs::Outputs;
pub use tracked_system::TrackedSystem;
