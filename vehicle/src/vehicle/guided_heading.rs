//! Where ArduPilot's guided mode points the nose. A heading that has been asked for, and a place that is looked at, stay until the vehicle is
//! led in another way; then, and as long as nothing is asked for, the nose points to where it flies, as WP_YAW_BEHAVIOR says.

use super::heading_policy::HeadingPolicy;
use super::set_point::{AxisTarget, SetPoint};
use super::situation::Situation;

/// Ways of leading the vehicle in the guided mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lead {
    /// To a place that a command names.
    Command,
    /// To places.
    Place,
    /// By points of a trajectory.
    Trajectory,
    /// By velocities.
    Velocity,
    /// By accelerations.
    Acceleration,
    /// By attitudes.
    Attitude,
}

/// Slower than this share of the largest speed, the reference has no direction, as in ArduPilot.
const TRAVELS: f64 = 0.05;
/// Slower than this, m/s, nor has the vehicle.
const FLIES_M_S: f64 = 1.0;

impl Lead {
    /// That of a set-point.
    pub fn of(set_point: &SetPoint) -> Self {
        let Some(position) = set_point.position() else { return Self::Attitude };
        let any = |kind: fn(&AxisTarget) -> bool| position.axes.iter().any(kind);
        if any(|axis| matches!(axis, AxisTarget::Track { .. })) {
            Self::Trajectory
        } else if any(|axis| matches!(axis, AxisTarget::Position(_))) {
            Self::Place
        } else if any(|axis| matches!(axis, AxisTarget::Velocity(_))) {
            Self::Velocity
        } else {
            Self::Acceleration
        }
    }
}

impl HeadingPolicy {
    /// The heading, rad, and its rate, rad/s, of a flight that asks for none; `None`: it stays as it is.
    pub fn guided(self, situation: &Situation) -> Option<(f64, f64)> {
        let outputs = situation.outputs;
        match self {
            Self::NextPlace | Self::NextPlaceFirst | Self::NextPlaceExceptReturn => {
                // ψ = atan2(v_y, v_x),  ψ̇ = (v_x a_y − v_y a_x) / (v_x² + v_y²)
                let (v, a) = (outputs.setpoint.velocity_m_s.xy(), outputs.setpoint.acceleration_m_s2.xy());
                let rate_rad_s = (v.x * a.y - v.y * a.x) / v.norm_squared();
                (v.norm() > TRAVELS * situation.limits().speed_horizontal_m_s)
                    .then(|| (libm::atan2(v.y, v.x), rate_rad_s))
            }
            Self::Travel => {
                let v = outputs.velocity_m_s.xy();
                (v.norm() > FLIES_M_S).then(|| (libm::atan2(v.y, v.x), 0.0))
            }
            Self::Hold | Self::Home | Self::AwayFromHome => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::set_point::{PositionSetPoint, YawTarget};
    use super::{AxisTarget, HeadingPolicy, Lead, SetPoint};
    use crate::vehicle::scene::Scene;

    #[test]
    fn set_points_lead_by_the_most_that_they_say() {
        let track =
            AxisTarget::Track { position_m: 0.0, velocity_m_s: 1.0, acceleration_m_s2: 0.0, jerk_m_s3: 0.0 };
        for (axis, lead) in [
            (AxisTarget::Position(1.0), Lead::Place),
            (track, Lead::Trajectory),
            (AxisTarget::HOLD, Lead::Velocity),
            (AxisTarget::Acceleration(0.5), Lead::Acceleration),
        ] {
            let set_point = PositionSetPoint { axes: [axis; 3], yaw: YawTarget::Hold };
            assert_eq!(Lead::of(&SetPoint::Position(set_point)), lead);
        }
    }

    #[test]
    fn the_nose_points_along_the_reference_while_it_moves() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        let heading = |scene: &mut Scene, policy: HeadingPolicy| {
            let mut found = None;
            scene.show(|situation, _| found = policy.guided(situation));
            found
        };
        assert_eq!(heading(&mut scene, HeadingPolicy::NextPlace), None, "at rest");
        scene.outputs.setpoint.velocity_m_s = [0.0, 2.0, 0.0].into();
        scene.outputs.setpoint.acceleration_m_s2 = [-1.0, 0.0, 0.0].into();
        let (east_rad, rate_rad_s) = heading(&mut scene, HeadingPolicy::NextPlace).expect("a direction");
        assert!((east_rad - core::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert_eq!(rate_rad_s, 0.5);
        assert_eq!(heading(&mut scene, HeadingPolicy::Hold), None);
        assert_eq!(heading(&mut scene, HeadingPolicy::Travel), None, "the vehicle itself rests");
        scene.outputs.velocity_m_s = [-2.0, 0.0, 0.0].into();
        let (south_rad, _) = heading(&mut scene, HeadingPolicy::Travel).expect("a direction");
        assert!((south_rad.abs() - core::f64::consts::PI).abs() < 1e-12);
    }
}
