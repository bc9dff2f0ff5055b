//! The settings of the camera: their names, types and values, as extended parameters have them.

use mavlink::dialects::ardupilotmega::MavParamExtType;
use vehicle::equipment::{Camera, CameraMode, Drive, Operation};

use super::camera_messages::mode_id;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    Mode,
    Zoom,
    Focus,
}

impl Setting {
    /// All of them, in the order of the list.
    pub const ALL: [Self; 3] = [Self::Mode, Self::Zoom, Self::Focus];

    /// The one of a name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|setting| setting.name() == name)
    }

    /// Its name, as camera definitions of others have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mode => "CAM_MODE",
            Self::Zoom => "CAM_ZOOM",
            Self::Focus => "CAM_FOCUS",
        }
    }

    /// INT32 in place of the UINT32 of most camera definitions: MAVSDK's parameter plugin reads and sets no other whole numbers.
    pub fn kind(self) -> MavParamExtType {
        match self {
            Self::Mode => MavParamExtType::MAV_PARAM_EXT_TYPE_INT32,
            Self::Zoom | Self::Focus => MavParamExtType::MAV_PARAM_EXT_TYPE_REAL32,
        }
    }

    /// What its values may be, with the type.
    pub fn allowed(self) -> &'static str {
        match self {
            Self::Mode => "0 (image), 1 (video), 2 (survey) as INT32",
            Self::Zoom | Self::Focus => "0 to 100 (percent) as REAL32",
        }
    }

    /// Its present value as it travels.
    pub fn value(self, camera: &Camera) -> [u8; 4] {
        match self {
            Self::Mode => (mode_id(camera) as i32).to_le_bytes(),
            Self::Zoom => (camera.zoom_percent() as f32).to_le_bytes(),
            Self::Focus => (camera.focus_percent() as f32).to_le_bytes(),
        }
    }

    /// What a value asks of the camera; `None`: it has no such value.
    pub fn operation(self, bytes: [u8; 4]) -> Option<Operation> {
        let percent = f64::from(f32::from_le_bytes(bytes));
        let drive = (0.0..=100.0).contains(&percent).then_some(Drive::Range(percent));
        match self {
            Self::Mode => {
                let modes = [CameraMode::Image, CameraMode::Video, CameraMode::Survey];
                let index = usize::try_from(i32::from_le_bytes(bytes)).ok()?;
                modes.get(index).copied().map(Operation::SetCameraMode)
            }
            Self::Zoom => drive.map(Operation::Zoom),
            Self::Focus => drive.map(Operation::Focus),
        }
    }
}
