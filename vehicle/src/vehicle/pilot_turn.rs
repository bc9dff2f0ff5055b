//! A pilot of ArduPilot's turns the nose in modes that fly by themselves: the yaw stick goes before every other heading while it is
//! deflected. What it leaves stays until the vehicle is led in another way.

use super::commanded_turn::CommandedTurn;
use super::mission::Mission;
use super::motion::wrapped;
use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::SteeringKind;
use super::tick::TICK_S;
use crate::mode::Mode;
use crate::plan::step::{Turn, TurnDirection, TurnTo};

/// Of the options of the modes: the yaw stick does nothing.
const IGNORED: u8 = 4;
/// Share of the yaw acceleration with which the turn gets faster and slower: the shaper, which needs time to reach an acceleration, catches
/// up with the rest.
const SHARE: f64 = 0.5;
/// The heading that is asked for leads the vehicle by no more than this, rad.
const LEAD_RAD: f64 = 0.5;

/// The turn by hand.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PilotTurn {
    /// The heading that is asked for, rad, until the turn has ended.
    heading_rad: Option<f64>,
    rate_rad_s: f64,
}

impl PilotTurn {
    /// One tick: it decides about the heading where it may, until the turn is slowed down. Returns whether it does.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) -> bool {
        let limits = situation.limits();
        let asked_rad_s = asked_rad_s(situation, limits.yaw_rate_rad_s);
        if asked_rad_s.is_none() && (self.rate_rad_s == 0.0 || !may_turn(situation)) {
            self.rate_rad_s = 0.0;
            return false;
        }
        let change_rad_s = SHARE * limits.yaw_acceleration_rad_s2 * TICK_S;
        let missing_rad_s = asked_rad_s.unwrap_or(0.0) - self.rate_rad_s;
        self.rate_rad_s += missing_rad_s.clamp(-change_rad_s, change_rad_s);
        let now_rad = situation.outputs.attitude_rad.z;
        let before_rad = self.heading_rad.unwrap_or(situation.outputs.setpoint.yaw_rad);
        let ahead_rad = wrapped(before_rad + self.rate_rad_s * TICK_S - now_rad).clamp(-LEAD_RAD, LEAD_RAD);
        self.heading_rad = Some(now_rad + ahead_rad);
        proposal.turn_on(Some((now_rad + ahead_rad, self.rate_rad_s)));
        true
    }

    /// The turn has ended: the heading that it leaves is kept as one that a command asks for.
    pub fn end(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        turn: &mut CommandedTurn,
        mission: &mut Mission,
    ) {
        let Some(heading_rad) = self.heading_rad.take() else { return };
        proposal.turn_on(Some((heading_rad, 0.0)));
        let stay = Turn { to: TurnTo::Heading(heading_rad, TurnDirection::Shortest), rate_rad_s: None };
        match situation.mode {
            Mode::Mission | Mode::MissionLanding => mission.turn_by_command(&stay, situation),
            Mode::Offboard | Mode::Takeoff => {
                proposal.look_at(None);
                turn.begin(&stay, situation);
            }
            _ => {}
        }
    }
}

/// The rate of turn, rad/s, that the pilot asks for and may ask for.
fn asked_rad_s(situation: &Situation, fastest_rad_s: f64) -> Option<f64> {
    let sticks = situation.pilot.present_sticks()?;
    let rate_rad_s = sticks.turn_rad_s(&situation.conduct.sticks, fastest_rad_s);
    (rate_rad_s != 0.0 && may_turn(situation)).then_some(rate_rad_s)
}

fn may_turn(situation: &Situation) -> bool {
    let conduct = situation.conduct;
    let heeded = |options: u8| options & IGNORED == 0;
    let lands = situation.comes_down && conduct.sticks.move_landings;
    let flies = !situation.landed && situation.steering.kind() == SteeringKind::Position;
    situation.identity.is_ardupilot()
        && flies
        && match situation.mode {
            Mode::Offboard | Mode::Takeoff => heeded(conduct.guided_options),
            Mode::Mission | Mode::MissionLanding => heeded(conduct.auto_options) || situation.comes_down,
            Mode::Return => heeded(conduct.return_home.options) || lands,
            Mode::SmartReturn => heeded(conduct.trail.options) || lands,
            Mode::Land => conduct.sticks.move_landings,
            _ => false,
        }
}

#[cfg(test)]
mod tests {
    use super::{IGNORED, Mode, may_turn};
    use crate::identity::Identity;
    use crate::vehicle::scene::Scene;

    /// Options of each mode say whether the yaw stick counts; LAND_REPOSITION does on the way down.
    #[test]
    fn options_of_the_mode_decide_whether_the_stick_turns() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]).of_ardupilot();
        let may = |scene: &Scene, mode: Mode, comes_down: bool| {
            may_turn(&super::Situation { mode, comes_down, ..scene.situation() })
        };
        let flown = [Mode::Offboard, Mode::Takeoff, Mode::Mission, Mode::Return, Mode::SmartReturn];
        for mode in flown {
            assert!(may(&scene, mode, false), "{mode:?}");
        }
        assert!(may(&scene, Mode::Land, true) && !may(&scene, Mode::Hold, false));
        scene.conduct.guided_options |= IGNORED;
        scene.conduct.auto_options |= IGNORED;
        scene.conduct.return_home.options |= IGNORED;
        scene.conduct.trail.options |= IGNORED;
        for mode in flown {
            assert!(!may(&scene, mode, false), "{mode:?}");
        }
        assert!(may(&scene, Mode::Return, true) && may(&scene, Mode::Mission, true));
        scene.conduct.sticks.move_landings = false;
        assert!(!may(&scene, Mode::Return, true) && !may(&scene, Mode::Land, true));
        scene.identity = Identity::Px4;
        assert!(!may(&scene, Mode::Mission, true));
    }
}
