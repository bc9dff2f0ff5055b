//! How fast the loops of an airframe may close.

use crate::design::controller_limits::COMMANDED_TILT_SHARE;
use crate::design::default_reach::{default_spare_thrust, default_tilt_rad};
use crate::plant::airframe::Airframe;
use crate::{Configuration, ConfigurationError, GRAVITY_M_S2, Limits, Mixer};

/// Angular frequencies at which the loops of a cascade close, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandwidths {
    /// Roll and pitch.
    pub tilt_rad_s: f64,
    /// Yaw.
    pub yaw_rad_s: f64,
    /// North and east.
    pub position_rad_s: f64,
    /// Altitude.
    pub altitude_rad_s: f64,
}

/// What bounds the bandwidths of an airframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agility {
    /// How late a torque comes that the attitude controller asks for: rotor lag and half a sample, s.
    torque_delay_s: f64,
    /// The same of a thrust that the altitude controller asks for, s.
    thrust_delay_s: f64,
    /// Largest angular acceleration about roll and pitch in hover, the smaller of the two, rad/s².
    pub(crate) tilt_acceleration_rad_s2: f64,
    /// The same about yaw, rad/s².
    pub(crate) yaw_acceleration_rad_s2: f64,
    /// Largest horizontal acceleration in level flight, m/s².
    pub(crate) horizontal_acceleration_m_s2: f64,
    /// Largest vertical acceleration in the weaker direction, m/s².
    vertical_acceleration_m_s2: f64,
}

impl Agility {
    /// Of an airframe under controllers with the default sample times.
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] when the rotors cannot make every torque.
    pub(crate) fn of(airframe: &Airframe) -> Result<Self, ConfigurationError> {
        let controllers = Configuration::default().controllers;
        let (weakest, strongest) = airframe.thrust_range_n();
        let weight_n = airframe.weight_n();
        let room_n = (weight_n - weakest).min(strongest - weight_n).max(0.0) / 4.0;
        let [roll_n_m, pitch_n_m, yaw_n_m] = Mixer::new(airframe)?.largest_torques_n_m(room_n);
        let [roll, pitch, yaw] = airframe.inertia_kg_m2;
        let limits = Limits::default();
        let up = default_spare_thrust(airframe);
        let down = 1.0 - limits.thrust_min;
        Ok(Self {
            torque_delay_s: airframe.mean_rotor_lag_s() + controllers.attitude.sample_time_s() / 2.0,
            thrust_delay_s: airframe.mean_rotor_lag_s() + controllers.altitude.sample_time_s() / 2.0,
            tilt_acceleration_rad_s2: (roll_n_m / roll).min(pitch_n_m / pitch),
            yaw_acceleration_rad_s2: yaw_n_m / yaw,
            horizontal_acceleration_m_s2: GRAVITY_M_S2
                * libm::tan(COMMANDED_TILT_SHARE * default_tilt_rad(airframe)),
            vertical_acceleration_m_s2: GRAVITY_M_S2 * up.min(down),
        })
    }
}

/// Share of 1/(rotor lag + half a sample) at which a loop may close: the delay, which the models do not have, turns the phase by 20°.
const OF_DELAY: f64 = 0.35;
/// The error of roll or pitch, rad, that may ask for all the torque there is in hover: α = ω² times the error. The default weights of
/// the paper's airframe close at 6.48 rad/s, and it has 8.5 rad/s².
const TILT_ERROR_RAD: f64 = 0.203_5;
/// Yaw closes at most at this share of roll and pitch.
const YAW_OF_TILT: f64 = 0.464_3;
/// The heading error that may ask for all the yaw torque, rad: 0.69 rad/s² and 3.01 rad/s.
const YAW_ERROR_RAD: f64 = 0.076_3;
/// Position closes at most at this share of roll and pitch.
const POSITION_OF_TILT: f64 = 0.275_2;
/// The error, m, that may ask for all the tilt: 3.7 m/s² and 1.78 rad/s.
const POSITION_ERROR_M: f64 = 1.162;
/// The error, m, that may ask for all the thrust in the weaker direction: 3.9 m/s² and 2.71 rad/s.
const ALTITUDE_ERROR_M: f64 = 0.532_3;

/// The bandwidths of an airframe with the default sample times, each the smallest of
///
/// ```text
/// roll, pitch   0.35/(rotor lag + ½ sample)    √(α / 0.2 rad)
/// yaw           0.46 of roll and pitch         √(α / 0.08 rad)
/// position      0.28 of roll and pitch         √(a / 1.2 m)
/// altitude      0.35/(rotor lag + ½ sample)    √(a / 0.5 m)
/// ```
///
/// with α the angular acceleration and a the acceleration that there is in hover: what the rotors do late costs phase, and what they cannot
/// do at all saturates.
///
/// # Errors
/// [`ConfigurationError::Layout`] when the rotors cannot make every torque.
pub fn default_bandwidths(airframe: &Airframe) -> Result<Bandwidths, ConfigurationError> {
    let agility = Agility::of(airframe)?;
    let saturating = |acceleration: f64, error: f64| libm::sqrt(acceleration / error);
    let tilt_rad_s =
        (OF_DELAY / agility.torque_delay_s).min(saturating(agility.tilt_acceleration_rad_s2, TILT_ERROR_RAD));
    Ok(Bandwidths {
        tilt_rad_s,
        yaw_rad_s: (YAW_OF_TILT * tilt_rad_s).min(saturating(agility.yaw_acceleration_rad_s2, YAW_ERROR_RAD)),
        position_rad_s: (POSITION_OF_TILT * tilt_rad_s)
            .min(saturating(agility.horizontal_acceleration_m_s2, POSITION_ERROR_M)),
        altitude_rad_s: (OF_DELAY / agility.thrust_delay_s)
            .min(saturating(agility.vertical_acceleration_m_s2, ALTITUDE_ERROR_M)),
    })
}
