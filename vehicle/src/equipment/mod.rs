//! What the vehicle carries: servo outputs, relays, a gripper, a camera and a gimbal. They are models of what such equipment shows; none
//! of them changes the flight.
//!
//! ```text
//!  operation ──► equipment: servos, relays, gripper, camera ──► images
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
mod operation;
mod relays;
mod repetition;
mod servos;
mod surroundings;
mod trigger;
mod voice;

pub use camera::{Camera, CameraMode, STORAGE_MIB};
pub use controller::{Controller, GimbalControl};
pub use equipment::Equipment;
pub use gimbal::{Gimbal, GimbalLimits};
pub use gripper::Gripper;
pub use image::Image;
pub use lens::{Drive, FOCAL_LENGTH_MM, SENSOR_MM};
pub use operation::{Operation, Pointing, Switch};
pub use relays::{RELAYS, Relays};
pub use servos::{CHANNELS, FIRST_FREE_CHANNEL, Servos};
pub use surroundings::Surroundings;
pub use trigger::Oblique;
pub use voice::EquipmentVoice;
