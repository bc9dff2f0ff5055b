//! How fast simulation time runs.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::value::within;

/// Pace of simulation time against the wall clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Speed {
    /// Time stands still.
    Paused,
    /// This many simulated seconds per second.
    Factor(f64),
    /// As fast as the machine can.
    Max,
}

/// Slowest factor that can be asked for; below it there is [`Speed::Paused`].
const SLOWEST: f64 = 0.01;
/// Fastest factor that can be asked for; beyond it there is [`Speed::Max`].
const FASTEST: f64 = 1000.0;
/// The parameter's value for [`Speed::Max`].
const MAX: f64 = -1.0;

impl Speed {
    /// As a parameter: 0 pauses, −1 is as fast as possible.
    pub fn to_parameter(self) -> f64 {
        match self {
            Self::Paused => 0.0,
            Self::Factor(factor) => factor,
            Self::Max => MAX,
        }
    }

    /// From a parameter; `None` outside 0.01 to 1000, 0 and −1.
    pub fn from_parameter(value: f64) -> Option<Self> {
        if value == 0.0 {
            Some(Self::Paused)
        } else if value == MAX {
            Some(Self::Max)
        } else {
            within(SLOWEST, FASTEST, value).map(Self::Factor)
        }
    }
}

impl FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "max" {
            return Ok(Self::Max);
        }
        text.parse::<f64>()
            .ok()
            .filter(|value| *value >= 0.0)
            .and_then(Self::from_parameter)
            .ok_or_else(|| format!("`{text}` is not a speed: 0 (paused), 0.01 to {FASTEST}, or `max`"))
    }
}

impl TryFrom<String> for Speed {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Speed> for String {
    fn from(speed: Speed) -> Self {
        match speed {
            Speed::Max => "max".to_owned(),
            other => other.to_parameter().to_string(),
        }
    }
}
