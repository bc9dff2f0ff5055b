//! `--noise PRESET` or `--noise POSITION,VELOCITY,ATTITUDE,BODY_RATE`.

use std::str::FromStr;

use super::ranged::numbers;

/// Standard deviations of the white noise on what the controllers measure.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MeasurementNoise {
    /// Position, per axis, m.
    pub position_m: f64,
    /// Velocity, per axis, m/s.
    pub velocity_m_s: f64,
    /// Attitude, per body axis, rad.
    pub attitude_rad: f64,
    /// Body rates, rad/s.
    pub body_rate_rad_s: f64,
}

/// Cameras around a room: millimetres, a tenth of a degree.
const MOTION_CAPTURE: MeasurementNoise =
    MeasurementNoise { position_m: 0.001, velocity_m_s: 0.01, attitude_rad: 0.002, body_rate_rad_s: 0.005 };
/// Differential satellite navigation: centimetres, a third of a degree.
const RTK_GPS: MeasurementNoise =
    MeasurementNoise { position_m: 0.02, velocity_m_s: 0.05, attitude_rad: 0.005, body_rate_rad_s: 0.01 };

impl MeasurementNoise {
    /// The values by the dotted names of the closed loop's parameters.
    pub fn parameters(&self) -> [(&'static str, f64); 4] {
        [
            ("sensor.position_noise", self.position_m),
            ("sensor.velocity_noise", self.velocity_m_s),
            ("sensor.attitude_noise", self.attitude_rad),
            ("sensor.body_rate_noise", self.body_rate_rad_s),
        ]
    }
}

impl FromStr for MeasurementNoise {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "motion-capture" => return Ok(MOTION_CAPTURE),
            "rtk-gps" => return Ok(RTK_GPS),
            _ => {}
        }
        let four = numbers(text).and_then(|numbers| <[f64; 4]>::try_from(numbers).ok());
        match four {
            Some([position_m, velocity_m_s, attitude_rad, body_rate_rad_s])
                if (0.0..=10.0).contains(&position_m)
                    && (0.0..=10.0).contains(&velocity_m_s)
                    && (0.0..=0.5).contains(&attitude_rad)
                    && (0.0..=10.0).contains(&body_rate_rad_s) =>
            {
                Ok(Self { position_m, velocity_m_s, attitude_rad, body_rate_rad_s })
            }
            _ => Err(format!(
                "invalid noise `{text}`; use motion-capture, rtk-gps or POSITION,VELOCITY,ATTITUDE,BODY_RATE: from 0,0,0,0 to \
                 10,10,0.5,10 in m, m/s, rad and rad/s"
            )),
        }
    }
}
