//! Which component a message comes from.

use mavlink::dialects::ardupilotmega::MavComponent;

use crate::codec::COMPONENT;

/// A component of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Speaker {
    /// The autopilot.
    #[default]
    Autopilot,
    /// The camera.
    Camera,
    /// The gimbal.
    Gimbal,
}

impl Speaker {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Autopilot, Self::Camera, Self::Gimbal];

    /// Its component id.
    pub const fn id(self) -> u8 {
        match self {
            Self::Autopilot => COMPONENT,
            Self::Camera => MavComponent::MAV_COMP_ID_CAMERA as u8,
            Self::Gimbal => MavComponent::MAV_COMP_ID_GIMBAL as u8,
        }
    }

    /// Who is meant by a component id; zero, which means all of them, is the autopilot's to answer.
    pub fn of(component: u8) -> Option<Self> {
        if component == 0 {
            return Some(Self::Autopilot);
        }
        Self::ALL.into_iter().find(|speaker| speaker.id() == component)
    }
}
