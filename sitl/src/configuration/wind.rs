//! `--wind SPEED,FROM`.

use std::str::FromStr;

use super::ranged::numbers;

/// Steady wind.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct WindFrom {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Direction that it comes from, degrees from north through east.
    pub from_deg: f64,
}

impl FromStr for WindFrom {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("invalid wind `{text}`; use SPEED[,FROM]: 0 to 30 m/s, from -360 to 360 degrees");
        let numbers = numbers(text).ok_or_else(wrong)?;
        let (speed_m_s, from_deg) = match *numbers.as_slice() {
            [speed] => (speed, 0.0),
            [speed, from] => (speed, from),
            _ => return Err(wrong()),
        };
        let fits = (0.0..=30.0).contains(&speed_m_s) && from_deg.abs() <= 360.0;
        if fits { Ok(Self { speed_m_s, from_deg }) } else { Err(wrong()) }
    }
}
