//! `--fault TIME:UNIT=KIND`

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::Fault;

/// Faults begin before this, s: thirty years.
const LATEST_S: f64 = 1e9;

/// A fault that begins at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScheduledFault {
    /// When, µs of simulation time.
    pub time_us: u64,
    /// What.
    pub fault: Fault,
}

impl fmt::Display for ScheduledFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}", self.time_us as f64 / 1e6, self.fault)
    }
}

impl FromStr for ScheduledFault {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("invalid fault `{text}`; use SECONDS:UNIT=KIND with 0 to {LATEST_S} seconds");
        let (time, fault) = text.split_once(':').ok_or_else(wrong)?;
        let time_s: f64 = time.trim().parse().map_err(|_| wrong())?;
        // NaN is not within.
        if !(0.0..=LATEST_S).contains(&time_s) {
            return Err(wrong());
        }
        let fault =
            fault.trim().parse::<Fault>().map_err(|error| format!("invalid fault `{text}`: {error}"))?;
        Ok(Self { time_us: (time_s * 1e6).round() as u64, fault })
    }
}

#[cfg(test)]
mod tests {
    use super::ScheduledFault;

    #[test]
    fn a_time_and_a_fault() {
        let scheduled: ScheduledFault = "12.5:rotor1=weak:0.6".parse().expect("a fault");
        assert_eq!(scheduled.time_us, 12_500_000);
        assert_eq!(scheduled.to_string(), "12.5:rotor1=weak:0.6");
    }

    #[test]
    fn what_is_none_is_refused() {
        for text in ["", "gps=off", "x:gps=off", "-1:gps=off", "nan:gps=off", "1e12:gps=off", "1:gps=hot"] {
            let error = text.parse::<ScheduledFault>().expect_err(text);
            assert!(error.contains("invalid fault"), "{error}");
        }
    }
}
