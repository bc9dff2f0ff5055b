//! The part of a reference's jerk and snap that is not seen from how a vehicle turns under a constant thrust.

use nalgebra::Vector2;

use crate::control::flat_attitude::FlatThrust;
use crate::control::required_thrust::RequiredThrust;

/// What a vehicle on its reference has beside the jerk and the snap of [`HorizontalMotion`], which follow from how it turns under the thrust
/// of now:
///
/// ```text
/// a = g e₃ − f b₃
/// j = ȧ + f ḃ₃ = −f' b₃
/// s = ä + f b̈₃ = −f" b₃ − 2 f' ḃ₃         with the thrust per mass f along −b₃ = −R e₃
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
    pub(crate) fn on(required: &RequiredThrust) -> Self {
        let RequiredThrust { acceleration_m_s2, jerk_m_s3, snap_m_s4 } = required;
        let thrust = FlatThrust::new(acceleration_m_s2, jerk_m_s3, snap_m_s4);
        let FlatThrust { size_rate_m_s3, size_acceleration_m_s4, down, down_rate, .. } = thrust;
        Self {
            jerk_m_s3: (down * -size_rate_m_s3).xy(),
            snap_m_s4: (down * -size_acceleration_m_s4 - down_rate * (2.0 * size_rate_m_s3)).xy(),
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::UnseenMotion;
    use crate::control::flat_attitude::FlatAttitude;
    use crate::control::required_thrust::RequiredThrust;
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
    /// body that turns under a constant thrust.
    #[test]
    fn it_is_what_a_constant_thrust_leaves() {
        const H: f64 = 1e-3;
        let configuration = Configuration::default();
        for time_s in [0.0, 0.4, 1.1, 2.3] {
            let flat = |time_s: f64| FlatAttitude::of(&eight(time_s));
            let now = flat(time_s);
            let required = RequiredThrust::whole(&configuration, &eight(time_s));
            let unseen = UnseenMotion::on(&required);

            let thrust_alone = |later_s: f64| acceleration(flat(time_s + later_s).thrust_m_s2, &now.attitude);
            let jerk = (thrust_alone(H) - thrust_alone(-H)) / (2.0 * H);
            assert!((unseen.jerk_m_s3 - jerk.xy()).norm() < 1e-4, "{time_s}: {jerk}");

            // The attitude goes its way under the thrust of now.
            let turns_alone = |later_s: f64| acceleration(now.thrust_m_s2, &flat(time_s + later_s).attitude);
            let seen = (turns_alone(H) - turns_alone(0.0) * 2.0 + turns_alone(-H)) / (H * H);
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
        let unseen = UnseenMotion::on(&required);
        assert!(unseen.jerk_m_s3.norm() < 1e-12 && unseen.snap_m_s4.norm() < 1e-12, "{unseen:?}");
    }
}
