//! The part of a reference's jerk and snap that is not seen from how the rotors turn a vehicle under a constant thrust.

use nalgebra::{Vector2, Vector3};

use crate::Configuration;
use crate::control::flat_attitude::FlatAttitude;
use crate::control::required_thrust::RequiredThrust;
use crate::guidance::heading::Heading;

/// What a vehicle on its reference has beside the jerk and the snap of [`HorizontalMotion`], which follow from its body rate and from
/// the torques of its rotors:
///
/// ```text
/// a = g e₃ − f R e₃
/// j = ȧ + f R (ω × e₃)          the thrust f changes
/// s = ä + f R (J⁻¹τ × e₃)       and the rate ω turns the thrust by itself
/// ```
///
/// [`HorizontalMotion`]: crate::control::vehicle_motion::HorizontalMotion
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UnseenMotion {
    /// North and east, m/s³.
    pub(crate) jerk_m_s3: Vector2<f64>,
    /// North and east, m/s⁴.
    pub(crate) snap_m_s4: Vector2<f64>,
}

impl UnseenMotion {
    /// Of a vehicle that is where its reference is.
    pub(crate) fn on(required: &RequiredThrust, heading: &Heading, configuration: &Configuration) -> Self {
        let RequiredThrust { acceleration_m_s2, jerk_m_s3, snap_m_s4 } = required;
        let flat = FlatAttitude::new(acceleration_m_s2, jerk_m_s3, snap_m_s4, heading);
        let inertia = configuration.believed_inertia_kg_m2();
        let rate = flat.body_rate_rad_s;
        // J⁻¹τ = ω̇ + J⁻¹ (ω × Jω)
        let torque = flat.angular_acceleration_rad_s2
            + rate.cross(&inertia.component_mul(&rate)).component_div(&inertia);
        let seen = |turn: &Vector3<f64>| flat.attitude * turn.cross(&Vector3::z()) * -flat.thrust_m_s2;
        Self { jerk_m_s3: (jerk_m_s3 - seen(&rate)).xy(), snap_m_s4: (snap_m_s4 - seen(&torque)).xy() }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::UnseenMotion;
    use crate::control::flat_attitude::FlatAttitude;
    use crate::control::required_thrust::RequiredThrust;
    use crate::guidance::heading::Heading;
    use crate::guidance::known_motion::motion;
    use crate::{Configuration, GRAVITY_M_S2, PositionReference};

    /// 6 sin 0.85 t, 3 sin 1.7 t: its thrust changes four times as often as it comes by.
    fn eight(time_s: f64) -> PositionReference {
        let axis = |size: f64, rate: f64, order: i32| {
            let angle = rate * time_s + f64::from(order) * core::f64::consts::FRAC_PI_2;
            size * libm::pow(rate, f64::from(order)) * libm::sin(angle)
        };
        motion(|order| Vector3::new(axis(6.0, 0.85, order), axis(3.0, 1.7, order), 0.0))
    }

    /// Acceleration under this thrust per mass, m/s², at this attitude.
    fn acceleration(thrust_m_s2: f64, attitude: &UnitQuaternion<f64>) -> Vector3<f64> {
        Vector3::z() * GRAVITY_M_S2 - attitude * Vector3::z() * thrust_m_s2
    }

    /// By differences: the jerk is that of the thrust alone, at the attitude of now; the snap is what is left of the whole one beside a
    /// body that its torques alone speed up, from rest.
    #[test]
    fn it_is_what_a_constant_thrust_and_the_torques_leave() {
        const H: f64 = 1e-3;
        let configuration = Configuration::default();
        let inertia = Vector3::from(configuration.airframe.inertia_kg_m2);
        for time_s in [0.0, 0.4, 1.1, 2.3] {
            let flat = |time_s: f64| FlatAttitude::of(&eight(time_s));
            let now = flat(time_s);
            let required = RequiredThrust::whole(&configuration, &eight(time_s));
            let unseen = UnseenMotion::on(&required, &Heading::fixed(0.0), &configuration);

            let thrust_alone = |later_s: f64| acceleration(flat(time_s + later_s).thrust_m_s2, &now.attitude);
            let jerk = (thrust_alone(H) - thrust_alone(-H)) / (2.0 * H);
            assert!((unseen.jerk_m_s3 - jerk.xy()).norm() < 1e-4, "{time_s}: {jerk}");

            // Euler: τ = J ω̇ + ω × Jω, with ω̇ by differences.
            let rate = now.body_rate_rad_s;
            let turning = (flat(time_s + H).body_rate_rad_s - flat(time_s - H).body_rate_rad_s) / (2.0 * H);
            let torque = inertia.component_mul(&turning) + rate.cross(&inertia.component_mul(&rate));
            let torques_alone = |later_s: f64| {
                let turned = torque.component_div(&inertia) * (later_s * later_s / 2.0);
                acceleration(now.thrust_m_s2, &(now.attitude * UnitQuaternion::from_scaled_axis(turned)))
            };
            let seen = (torques_alone(H) - torques_alone(0.0)) * (2.0 / (H * H));
            let whole = (eight(time_s + H).jerk_m_s3 - eight(time_s - H).jerk_m_s3) / (2.0 * H);
            assert!((unseen.snap_m_s4 - (whole - seen).xy()).norm() < 1e-3, "{time_s}: {whole} {seen}");
        }
    }

    #[test]
    fn a_level_straight_way_has_none() {
        let way = PositionReference {
            velocity_m_s: Vector3::new(3.0, 0.0, 0.0),
            snap_m_s4: Vector3::new(2.0, 1.0, 0.0),
            ..PositionReference::goal([0.0; 3], 0.0)
        };
        let configuration = Configuration::default();
        let required = RequiredThrust::whole(&configuration, &way);
        let unseen = UnseenMotion::on(&required, &Heading::fixed(0.3), &configuration);
        assert!(unseen.jerk_m_s3.norm() < 1e-12 && unseen.snap_m_s4.norm() < 1e-12, "{unseen:?}");
    }
}
