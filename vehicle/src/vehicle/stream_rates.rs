//! How often groups of messages are sent on the first links (ArduPilot: SRn_).

use serde::{Deserialize, Serialize};

/// Links whose rates have parameters.
const LINKS: usize = 3;

/// Rates of groups of messages on one link, Hz; 0: never; `None`: each message has its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct GroupRates {
    /// Instruments.
    pub raw_sensors: Option<u8>,
    /// State of the vehicle.
    pub extended_status: Option<u8>,
    /// Inputs and outputs.
    pub rc_channels: Option<u8>,
    /// Position.
    pub position: Option<u8>,
    /// Attitude.
    pub extra1: Option<u8>,
    /// What a pilot looks at.
    pub extra2: Option<u8>,
    /// The rest.
    pub extra3: Option<u8>,
}

/// The rates of the first links.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct StreamRates(pub [GroupRates; LINKS]);

impl StreamRates {
    /// Those of a link by its number; a link without parameters has none.
    pub fn of_link(&self, link: usize) -> GroupRates {
        self.0.get(link).copied().unwrap_or_default()
    }
}
