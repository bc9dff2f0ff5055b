//! What the vehicle carries: servo outputs, relays, a gripper, a parachute, a camera and a gimbal. They are models of what such equipment
//! shows; but for an open parachute none of them changes the flight.
//!
//! ```text
//!  operation ──► equipment: servos, relays, gripper, parachute, camera ──► images
//!  surroundings ──►              gimbal ──► attitude
//! ```

mod camera;
mod capture;
mod controller;
#[allow(clippy::module_inception)] // Named after what it defines.
mod equipment;
mod gimbal;
mod gripper;
mod image;
mod lens;
mod mount;
mod operation;
mod output;
mod parachute;
mod relays;
mod repetition;
mod servos;
mod settings;
mod surroundings;
mod trigger;
mod voice;

pub use camera::{Camera, CameraMode, STORAGE_MIB};
pub use controller::{Controller, GimbalControl};
pub use equipment::Equipment;
pub use gimbal::{Gimbal, GimbalLimits};
pub use gripper::{Grip, Gripper};
pub use image::Image;
pub use lens::{Drive, FOCAL_LENGTH_MM, SENSOR_MM};
pub use mount::{GimbalMode, MountSettings};
pub use operation::{Operation, Pointing, Switch};
pub use output::{GimbalAxis, Output, OutputFunction};
pub use parachute::{Parachute, ParachuteOrder, ParachuteSettings};
pub use relays::{RELAYS, Relays};
pub use servos::{CHANNELS, FIRST_FREE_CHANNEL, Servos};
pub use settings::EquipmentSettings;
pub use surroundings::Surroundings;
pub use trigger::Oblique;
pub use voice::EquipmentVoice;
