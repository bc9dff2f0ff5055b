//! Which sensors the vehicle flies by.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// What stands between the true motion and the controllers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SensorModel {
    /// Nothing: the true motion is known.
    #[default]
    Ideal,
    /// Instruments with the noise of real ones, and an estimator.
    Realistic,
}

/// The sensors of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SensorSettings {
    /// Which.
    pub model: SensorModel,
    /// Seed of their noise.
    pub seed: u64,
}

impl FromStr for SensorModel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "ideal" => Ok(Self::Ideal),
            "realistic" => Ok(Self::Realistic),
            _ => Err(format!("must be ideal or realistic, not `{text}`")),
        }
    }
}
