//! The climb of a takeoff.

use quadrotor::Outputs;

use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::SteeringKind;
use crate::mode::Mode;

/// So near to its height, m, and so slow, m/s, a takeoff is over.
const REACHED_M: f64 = 0.2;
const SLOW_M_S: f64 = 0.3;

/// Whether a climb to z, m, is over.
pub fn is_slow_near(outputs: &Outputs, z_m: f64) -> bool {
    (outputs.position_m.z - z_m).abs() < REACHED_M && outputs.velocity_m_s.norm() < SLOW_M_S
}

/// A takeoff.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Takeoff {
    /// z of the goal, m.
    goal_z_m: Option<f64>,
}

impl Takeoff {
    /// Where it leads, z, m, once that has been decided.
    pub fn goal_z_m(&self) -> Option<f64> {
        self.goal_z_m
    }

    /// Climbs to z, m, and not to the height of the parameter.
    pub fn aim(&mut self, z_m: f64) {
        self.goal_z_m = Some(z_m);
    }

    /// The mode is entered anew, or the flight is over.
    pub fn forget(&mut self) {
        self.goal_z_m = None;
    }

    /// One tick of the takeoff mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let home_z_m = situation.home.position_m.z;
        let z = *self.goal_z_m.get_or_insert(home_z_m - situation.conduct.takeoff_height_m);
        let outputs = situation.outputs;
        if proposal.steering().kind() == SteeringKind::Idle {
            let [x, y] = [outputs.position_m.x, outputs.position_m.y];
            let axes = [AxisTarget::Position(x), AxisTarget::Position(y), AxisTarget::Position(z)];
            let yaw = YawTarget::Angle(outputs.attitude_rad.z);
            proposal.follow(situation, &PositionSetPoint { axes, yaw });
            proposal.say(Severity::Info, format!("Taking off to {:.1} m above home", home_z_m - z));
        }
        if is_slow_near(outputs, z) {
            self.goal_z_m = None;
            let guided = situation.identity.is_ardupilot();
            proposal.go_on_in(if guided { Mode::Offboard } else { Mode::Hold });
            proposal.say(Severity::Info, "Takeoff height reached");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, Takeoff};
    use crate::identity::Identity;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    #[test]
    fn it_climbs_to_its_height_and_goes_on_in_the_mode_of_the_identity() {
        for (identity, then) in [(Identity::Px4, Mode::Hold), (Identity::ArduPilot, Mode::Offboard)] {
            let mut scene = Scene::on_the_ground();
            (scene.identity, scene.mode) = (identity, Mode::Takeoff);
            let mut takeoff = Takeoff::default();
            let requests = scene.show(|situation, proposal| takeoff.step(situation, proposal));
            assert_eq!(said(&requests), ["Taking off to 2.5 m above home"]);
            assert_eq!(scene.goal_m(), Some([0.0, 0.0, -2.5]));
            scene.come_to([0.0, 0.0, -2.4], [0.0, 0.0, -0.5]);
            assert!(
                scene.show(|situation, proposal| takeoff.step(situation, proposal)).is_empty(),
                "too fast"
            );
            scene.come_to([0.0, 0.0, -2.4], [0.0; 3]);
            let requests = scene.show(|situation, proposal| takeoff.step(situation, proposal));
            assert_eq!(requests.first(), Some(&Request::GoOnIn(then)));
            assert_eq!(takeoff.goal_z_m(), None);
        }
    }
}
