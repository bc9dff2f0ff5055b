//! A geometric tracking controller with feed-forward from differential flatness, as a comparison on smooth paths:
//! Lee, Leok, McClamroch, “Geometric tracking control of a quadrotor UAV on SE(3)”, CDC 2010; Mellinger and Kumar,
//! “Minimum snap trajectory generation and control for quadrotors”, ICRA 2011.

use nalgebra::{Matrix3, Rotation3, Vector3};
use quadrotor::{
    Configuration, ConfigurationError, GRAVITY_M_S2, Mixer, PlantState, PositionReference, Wrench,
    commanded_tilt_rad,
};

/// How often it samples, s: as the cascade's attitude controller.
pub const SAMPLE_S: f64 = 0.01;
/// Natural frequency of the position error, rad/s, with a damping of 1.
const POSITION_RAD_S: f64 = 2.5;
/// Natural frequency of the attitude error, rad/s, with a damping of 1.
const ATTITUDE_RAD_S: f64 = 12.0;
/// Step of the differences that make rate and acceleration of the reference's attitude, s.
const DIFFERENCE_S: f64 = 1e-3;

/// The controller of one vehicle under one reference.
pub struct Geometric<R> {
    mixer: Mixer,
    mass_kg: f64,
    inertia_kg_m2: Vector3<f64>,
    /// The rotors answer late, and a sample is held: the feed-forward is that of so much later, s.
    lead_s: f64,
    /// The farthest error that it answers, m, and the largest acceleration of an answer, m/s²: those of the limits of speed and tilt.
    farthest_m: f64,
    strongest_m_s2: f64,
    reference: R,
}

impl<R: Fn(f64) -> PositionReference> Geometric<R> {
    /// For a vehicle, whose mass and inertia it knows as well as the cascade does, and a reference over time, s.
    pub fn new(configuration: &Configuration, reference: R) -> Result<Self, ConfigurationError> {
        let airframe = &configuration.airframe;
        let factor = configuration.controllers.mass_factor;
        Ok(Self {
            mixer: Mixer::new(airframe)?,
            mass_kg: airframe.mass_kg * factor,
            inertia_kg_m2: Vector3::from(airframe.inertia_kg_m2) * factor,
            lead_s: airframe.rotor_time_constant_s + SAMPLE_S / 2.0,
            farthest_m: 2.0 * configuration.limits.speed_horizontal_m_s / POSITION_RAD_S,
            strongest_m_s2: GRAVITY_M_S2 * commanded_tilt_rad(configuration).tan(),
            reference,
        })
    }

    /// Rotor speeds, rad/s.
    pub fn rotor_speeds_rad_s(&self, time_s: f64, plant: &PlantState) -> [f64; 4] {
        let body = &plant.body;
        let (rotation, rate) = (body.rotation().to_rotation_matrix(), body.body_rate_rad_s);
        let reference = (self.reference)(time_s);
        let position = (body.position_m - reference.position_m).cap_magnitude(self.farthest_m);
        let velocity = body.velocity_m_s - reference.velocity_m_s;
        let feedback = -(position * POSITION_RAD_S + velocity * 2.0) * POSITION_RAD_S;
        let feedback = feedback.cap_magnitude(self.strongest_m_s2);

        let later_s = time_s + self.lead_s;
        let thrust = thrust_axis(&(self.acceleration(later_s) + feedback));
        let wanted = attitude(&thrust_axis(&(self.acceleration(time_s) + feedback)));
        let error = wanted.transpose() * rotation;
        let attitude_error = vee(&(error.matrix() - error.transpose().matrix())) / 2.0;
        let rate_error = rate - error.transpose() * self.rate(time_s);
        let slope =
            (self.rate(later_s + DIFFERENCE_S) - self.rate(later_s - DIFFERENCE_S)) / (2.0 * DIFFERENCE_S);
        let acceleration =
            error.transpose() * slope - (attitude_error * ATTITUDE_RAD_S + rate_error * 2.0) * ATTITUDE_RAD_S;
        let torque_n_m = self.inertia_kg_m2.component_mul(&acceleration)
            + rate.cross(&self.inertia_kg_m2.component_mul(&rate));
        let thrust_n = self.mass_kg * thrust.dot(&(rotation * Vector3::z()));
        self.mixer.rotor_speeds_rad_s(&Wrench { thrust_n, torque_n_m }, 0.0)
    }

    fn acceleration(&self, time_s: f64) -> Vector3<f64> {
        (self.reference)(time_s).acceleration_m_s2
    }

    /// Body rate of the reference in its own axes, rad/s.
    fn rate(&self, time_s: f64) -> Vector3<f64> {
        let at = |time_s: f64| attitude(&thrust_axis(&self.acceleration(time_s)));
        let (before, after) = (at(time_s - DIFFERENCE_S), at(time_s + DIFFERENCE_S));
        (before.transpose() * after).scaled_axis() / (2.0 * DIFFERENCE_S)
    }
}

/// Thrust per mass along the body's down axis that makes an acceleration, against the thrust's direction, m/s².
fn thrust_axis(acceleration_m_s2: &Vector3<f64>) -> Vector3<f64> {
    Vector3::z() * GRAVITY_M_S2 - acceleration_m_s2
}

/// The attitude with this down axis and the heading ψ = 0 (ZYX): its forward axis has no component to the east.
fn attitude(down: &Vector3<f64>) -> Rotation3<f64> {
    let down = down.normalize();
    let forward = Vector3::y().cross(&down).normalize();
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[forward, down.cross(&forward), down]))
}

/// The vector whose cross product is a skew-symmetric matrix.
fn vee(skew: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)])
}
