//! What is known of a flight at an instant.

use nalgebra::{UnitQuaternion, Vector3};

use crate::control::learning::averaging::SampledAveraging;
use crate::control::learning::motion_equation::MeasuredMotion;
use crate::{Configuration, GRAVITY_M_S2, wrench_of_rotors};

/// Less thrust than this share of the weight is free fall, which shows no mass.
const LEAST_THRUST_SHARE: f64 = 0.2;
/// Share of a rotor's range of speeds from its upper end at which it is saturated.
const SATURATED_SHARE: f64 = 1e-3;

/// An instant of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FlightSample<'a> {
    /// What is measured of the motion.
    pub(crate) motion: MeasuredMotion,
    /// The velocity that the controllers go by, NED, m/s.
    pub(crate) velocity_m_s: Vector3<f64>,
    /// Whether nothing touches the vehicle.
    pub(crate) is_clear: bool,
    /// FRD into NED.
    pub(crate) attitude: UnitQuaternion<f64>,
    /// Speeds of the rotors, measured or by their model, rad/s.
    pub(crate) rotor_speed_rad_s: &'a [f64; 4],
    /// Commanded speeds of the rotors until now, rad/s.
    pub(crate) rotor_command_rad_s: &'a [f64; 4],
    /// When, µs.
    pub(crate) time_us: u64,
    /// Of samples like this one.
    pub(crate) averaging: &'a SampledAveraging,
}

impl FlightSample<'_> {
    /// Thrust of the rotors per mass of the airframe, m/s².
    pub(super) fn thrust_per_mass_m_s2(&self, configuration: &Configuration) -> f64 {
        let airframe = &configuration.airframe;
        wrench_of_rotors(airframe, self.rotor_speed_rad_s).thrust_n / airframe.mass_kg
    }

    /// Whether it belongs to a flight that shows a mass, under a thrust per mass, m/s²: clear of the ground, and not in free fall.
    pub(super) fn flies(&self, thrust_m_s2: f64) -> bool {
        self.is_clear && thrust_m_s2 > LEAST_THRUST_SHARE * GRAVITY_M_S2
    }

    /// Whether a rotor is commanded to the upper end of its range, where it may lack the power to do as it is told. As slowly as it can
    /// turn, it does.
    pub(super) fn is_saturated(&self, configuration: &Configuration) -> bool {
        let airframe = &configuration.airframe;
        let (slowest, fastest) = (airframe.rotor_speed_min_rad_s, airframe.rotor_speed_max_rad_s);
        let margin = SATURATED_SHARE * (fastest - slowest);
        let is_free = |speed: &f64| *speed < fastest - margin;
        !self.rotor_command_rad_s.iter().all(is_free)
    }
}
