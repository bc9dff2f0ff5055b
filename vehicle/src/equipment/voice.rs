//! Who speaks for the camera and the gimbal.

use serde::{Deserialize, Serialize};

/// Who clients meet when they look for a camera and a gimbal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EquipmentVoice {
    /// The autopilot speaks for them, as ArduPilot does. Requests to their own components are answered, but no heartbeats come from
    /// there: clients that take every heartbeat for the autopilot's are not misled.
    #[default]
    Autopilot,
    /// They are components of their own, with heartbeats of their own.
    Own,
}
