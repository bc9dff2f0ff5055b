//! A turn that a command asks for, beside whatever the mode flies.

use super::proposal::Proposal;
use super::situation::Situation;
use super::tick::TICK_S;
use super::turning::Turning;
use crate::plan::step::Turn;

/// The turn, and the heading at its end, which is kept until something else asks for one.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct CommandedTurn {
    turning: Option<Turning>,
}

impl CommandedTurn {
    /// Turns from the heading that is asked for now.
    pub fn begin(&mut self, turn: &Turn, situation: &Situation) {
        let asked = self.turning.map(|turning| turning.heading().into());
        self.turning =
            Some(Turning::new(turn, asked.unwrap_or_else(|| heading_now(situation)), situation.limits()));
    }

    /// Something else decides about the heading.
    pub fn forget(&mut self) {
        self.turning = None;
    }

    /// Whether it decides about the heading.
    pub fn is_on(&self) -> bool {
        self.turning.is_some()
    }

    /// One tick of it.
    pub fn step(&mut self, proposal: &mut Proposal) {
        let Some(turning) = &mut self.turning else { return };
        turning.step(TICK_S);
        proposal.turn_on(Some(turning.heading()));
    }
}

/// The heading that is followed, rad, and its rate, rad/s.
pub fn heading_now(situation: &Situation) -> [f64; 2] {
    let now = &situation.outputs.setpoint;
    [now.yaw_rad, now.yaw_rate_rad_s]
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::CommandedTurn;
    use crate::plan::step::{Turn, TurnDirection, TurnTo};
    use crate::vehicle::scene::Scene;
    use crate::vehicle::set_point::PositionSetPoint;
    use crate::vehicle::steering::Steering;
    use crate::vehicle::turning::SHARE;

    /// Heading of the goal, rad, and its rate, rad/s.
    fn heading(scene: &Scene) -> (f64, f64) {
        match scene.steering {
            Steering::Goal(goal) => (goal.yaw_rad, goal.yaw_rate_rad_s),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn it_turns_at_its_rate_in_its_direction_and_stays() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        let goal = scene.outputs.setpoint;
        scene.show(|_, proposal| proposal.steer(Steering::Goal(goal)));
        let mut commanded = CommandedTurn::default();
        let to = TurnTo::Heading(-FRAC_PI_2, TurnDirection::Clockwise);
        let turn = Turn { to, rate_rad_s: Some(0.25) };
        scene.show(|situation, _| commanded.begin(&turn, situation));
        for _ in 0..4_000 {
            scene.show(|_, proposal| commanded.step(proposal));
        }
        let (yaw_rad, rate_rad_s) = heading(&scene);
        // Less what it lags behind while it reaches its rate.
        let acceleration_rad_s2 = SHARE * scene.limits.wanted().yaw_acceleration_rad_s2;
        let expected_rad = 1.0 - 0.25 * 0.25 / (2.0 * acceleration_rad_s2);
        assert!((yaw_rad - expected_rad).abs() < 1e-3, "{yaw_rad}");
        assert!((rate_rad_s - 0.25).abs() < 1e-9, "{rate_rad_s}");
        for _ in 0..20_000 {
            scene.show(|_, proposal| commanded.step(proposal));
        }
        let (yaw_rad, rate_rad_s) = heading(&scene);
        assert!((yaw_rad - 3.0 * FRAC_PI_2).abs() < 1e-9 && rate_rad_s == 0.0, "{yaw_rad} {rate_rad_s}");
        // Set-points without a heading leave it where it is.
        scene.show(|situation, proposal| {
            proposal.follow(situation, &PositionSetPoint::HOLD);
            commanded.step(proposal);
        });
        assert!(commanded.is_on());
        commanded.forget();
        assert!(!commanded.is_on());
    }
}
