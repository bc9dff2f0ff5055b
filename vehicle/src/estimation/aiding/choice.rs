//! What of GPS and of external vision is fused.

use serde::{Deserialize, Serialize};

use super::super::vision::VisionSettings;
use super::{Px4Aiding, SourceSets};
use crate::identity::Identity;

/// What is fused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aiding {
    /// Of the GPS receiver.
    pub gps: GpsUse,
    /// Of estimates from outside, if anything.
    pub vision: Option<VisionSettings>,
}

/// What is fused of a GPS receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GpsUse {
    /// Horizontal position.
    pub position: bool,
    /// Height.
    pub height: bool,
    /// Velocity.
    pub velocity: bool,
}

/// The parameters that decide it, those of both autopilots.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct AidingSettings {
    /// PX4's.
    pub px4: Px4Aiding,
    /// ArduPilot's.
    pub ardupilot: SourceSets,
}

impl Default for Aiding {
    /// GPS alone.
    fn default() -> Self {
        Self { gps: GpsUse { position: true, height: true, velocity: true }, vision: None }
    }
}

impl GpsUse {
    /// Whether it tells where the vehicle is, or how fast it moves.
    pub fn aids(&self) -> bool {
        self.position || self.velocity
    }
}

impl AidingSettings {
    /// What is fused by the parameters of an identity, under a set of sources, from 0.
    pub fn aiding(&self, identity: Identity, set: usize) -> Aiding {
        if identity.is_ardupilot() { self.ardupilot.aiding(set) } else { self.px4.aiding() }
    }
}
