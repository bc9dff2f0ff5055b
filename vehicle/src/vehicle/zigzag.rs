//! ArduPilot's zigzag mode: a pilot marks two ends, A and B, and a switch then flies across between the lines that stand upright on the way
//! from one to the other.
//!
//! ```text
//!   A ───────────────► B      the switch at its high end: across to the line of B
//!   │                  │
//!   │ ◄─────────────── │      at its low end: across to the line of A
//! ```

use nalgebra::{Vector2, Vector3};
use quadrotor::PositionReference;

use super::fence_watch::check_goal;
use super::manual_control::fly_by_velocity;
use super::motion::Motion;
use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::Steering;
use super::stick_climb::StickClimb;
use super::tick::TICK_S;

/// Nearer than this to where it goes, m, it has arrived once its reference rests.
const ARRIVED_M: f64 = 3.0;
/// So slow, m/s, and so near to the goal, m, a reference rests.
const RESTS_M_S: f64 = 0.01;
const RESTS_M: f64 = 0.01;

/// One of the two ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The first.
    A,
    /// The second.
    B,
}

/// What is marked, and where it flies.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ZigZag {
    /// NED, m.
    ends_m: [Option<Vector2<f64>>; 2],
    goes_to: Option<End>,
    /// Since when it has been there, µs.
    arrived_us: Option<u64>,
}

impl ZigZag {
    /// The mode begins: nothing is marked.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        *self = Self::default();
        proposal.hold(situation);
    }

    /// Marks an end, or flies across to it once both are marked.
    pub fn choose(&mut self, end: End, situation: &Situation, proposal: &mut Proposal) {
        match self.across() {
            Some(across) if situation.flies() && !situation.landed => {
                self.go(end, across, situation, proposal);
            }
            Some(_) => {}
            None => {
                self.ends_m[end as usize] = Some(situation.outputs.setpoint.position_m.xy());
                proposal.say(Severity::Info, format!("ZigZag: point {end:?} stored"));
            }
        }
    }

    /// Gives the way back to the pilot, where it is.
    pub fn stop(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if self.goes_to.take().is_some() {
            proposal.say(Severity::Info, "ZigZag: manual control");
            // It stops to gain speed at once, and does not let go of that first.
            let now = proposal.steering().present(situation.outputs);
            let coasting = PositionReference { acceleration_m_s2: Vector3::zeros(), ..now };
            proposal.steer(Steering::Motion(Motion::from(
                coasting,
                PositionSetPoint::HOLD,
                situation.time_us,
            )));
        }
    }

    /// One tick of the mode.
    pub fn step(&mut self, climb: &mut StickClimb, situation: &Situation, proposal: &mut Proposal) {
        if self.goes_to.is_none() {
            fly_by_velocity(climb, situation, proposal);
        } else if situation.landed || self.has_waited(situation, proposal) {
            self.goes_to = None;
            proposal.say(Severity::Info, "ZigZag: manual control");
        } else {
            turn_by_stick(situation, proposal);
        }
    }

    /// From A to B, if both are marked.
    fn across(&self) -> Option<Vector2<f64>> {
        let [a, b] = self.ends_m;
        (b? - a?).try_normalize(f64::EPSILON)
    }

    fn go(&mut self, end: End, across: Vector2<f64>, situation: &Situation, proposal: &mut Proposal) {
        let Some(end_m) = self.ends_m[end as usize] else { return };
        let here_m = situation.outputs.setpoint.position_m;
        let goal_m = here_m.xy() + across * across.dot(&(end_m - here_m.xy()));
        let goal_m = Vector3::new(goal_m.x, goal_m.y, here_m.z);
        if let Err(refusal) = check_goal(situation, "ZigZag", &goal_m) {
            proposal.say(Severity::Warning, refusal.to_string());
            return;
        }
        (self.goes_to, self.arrived_us) = (Some(end), None);
        proposal.say(Severity::Info, format!("ZigZag: moving to {end:?}"));
        let axes = goal_m.data.0[0].map(AxisTarget::Position);
        proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
    }

    /// Whether it has been where it goes for as long as it is to wait there.
    fn has_waited(&mut self, situation: &Situation, proposal: &Proposal) -> bool {
        let Some(goal_m) = proposal.steering().resting_place_m() else { return true };
        let now = &situation.outputs.setpoint;
        let rests = (now.position_m - goal_m).norm() < RESTS_M && now.velocity_m_s.norm() < RESTS_M_S;
        let near = (situation.outputs.position_m - goal_m).norm() < ARRIVED_M;
        if self.arrived_us.is_none() && !(rests && near) {
            return false;
        }
        let since_us = *self.arrived_us.get_or_insert(situation.time_us);
        (situation.time_us - since_us) as f64 >= 1e6 * situation.conduct.zigzag_wait_s
    }
}

/// The pilot has the heading on the way.
fn turn_by_stick(situation: &Situation, proposal: &mut Proposal) {
    let Some(sticks) = situation.pilot.sticks else { return };
    let fastest_rad_s = situation.limits().yaw_rate_rad_s;
    let rate_rad_s = sticks.turn_rad_s(&situation.conduct.sticks, fastest_rad_s);
    let Steering::Goal(goal) = proposal.steering() else { return };
    let (yaw_rad, turned) = (goal.yaw_rad, goal.yaw_rate_rad_s != 0.0);
    if rate_rad_s != 0.0 {
        proposal.turn_on(Some((yaw_rad + rate_rad_s * TICK_S, rate_rad_s)));
    } else if turned {
        proposal.turn_on(None);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::{End, ZigZag};
    use crate::vehicle::scene::{Scene, said};

    /// It stands at a place and marks, or goes on to, an end. What is said, and where it goes to.
    fn choose(
        zigzag: &mut ZigZag,
        scene: &mut Scene,
        at_m: [f64; 2],
        end: End,
    ) -> (Vec<String>, Option<Vector2<f64>>) {
        scene.come_to([at_m[0], at_m[1], -5.0], [0.0; 3]);
        let requests = scene.show(|situation, proposal| zigzag.choose(end, situation, proposal));
        let goal = scene.steering.resting_place_m().filter(|_| zigzag.goes_to.is_some());
        (said(&requests).into_iter().map(str::to_owned).collect(), goal.map(|goal| goal.xy()))
    }

    /// From A at the origin to B 20 m east. Ten metres farther north it goes across to the line of A, and back.
    #[test]
    fn it_goes_across_to_the_line_of_the_other_end() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -5.0]);
        let mut zigzag = ZigZag::default();
        let (told, goal) = choose(&mut zigzag, &mut scene, [0.0, 0.0], End::A);
        assert_eq!((told, goal), (vec!["ZigZag: point A stored".to_owned()], None));
        let (told, goal) = choose(&mut zigzag, &mut scene, [0.0, 20.0], End::B);
        assert_eq!((told, goal), (vec!["ZigZag: point B stored".to_owned()], None));
        let (told, goal) = choose(&mut zigzag, &mut scene, [10.0, 21.0], End::A);
        assert_eq!(told, ["ZigZag: moving to A"]);
        assert!(goal.is_some_and(|goal| (goal - Vector2::new(10.0, 0.0)).norm() < 1e-9), "{goal:?}");
        let (_, goal) = choose(&mut zigzag, &mut scene, [25.0, 3.0], End::B);
        assert!(goal.is_some_and(|goal| (goal - Vector2::new(25.0, 20.0)).norm() < 1e-9), "{goal:?}");
    }

    /// B is 20 m away, and the fence 15 m.
    #[test]
    fn it_does_not_go_beyond_the_fence() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -5.0]);
        let mut zigzag = ZigZag::default();
        for (at_m, end) in [([0.0, 0.0], End::A), ([0.0, 20.0], End::B)] {
            choose(&mut zigzag, &mut scene, at_m, end);
        }
        scene.conduct.failsafe.fence_radius_m = 15.0;
        let (told, goal) = choose(&mut zigzag, &mut scene, [10.0, 0.0], End::B);
        assert_eq!((told, goal), (vec!["ZigZag rejected: farther than 15 m from home".to_owned()], None));
    }

    #[test]
    fn the_switch_in_its_middle_gives_the_way_back() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -5.0]);
        let mut zigzag = ZigZag::default();
        for (at_m, end) in [([0.0, 0.0], End::A), ([0.0, 20.0], End::B), ([10.0, 20.0], End::A)] {
            choose(&mut zigzag, &mut scene, at_m, end);
        }
        let stopped = scene.show(|situation, proposal| zigzag.stop(situation, proposal));
        assert_eq!(said(&stopped), ["ZigZag: manual control"]);
        assert!(zigzag.goes_to.is_none());
        let again = scene.show(|situation, proposal| zigzag.stop(situation, proposal));
        assert!(said(&again).is_empty());
    }
}
