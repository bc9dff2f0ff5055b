//! Set-points from outside.

use super::failsafe::Cause;
use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::{PositionSetPoint, SetPoint};
use super::situation::Situation;
use super::steering::SteeringKind;
use crate::mode::Mode;

/// What has come of set-points.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Offboard {
    /// The latest, and when it came, µs.
    latest: Option<(SetPoint, u64)>,
    /// Whether it has been steered to.
    applied: bool,
    /// Whether it has run out (ArduPilot: it then holds its place until the next one).
    expired: bool,
}

impl Offboard {
    /// Takes a set-point that came at a time, µs.
    pub fn take(&mut self, set_point: SetPoint, time_us: u64) {
        *self = Self { latest: Some((set_point, time_us)), applied: false, expired: false };
    }

    /// Forgets all set-points: something else has been asked for.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Another mode begins: a set-point that is still young is steered to anew.
    pub fn begin(&mut self) {
        self.applied = false;
    }

    /// Whether the latest set-point has been steered to.
    pub fn is_applied(&self) -> bool {
        self.applied
    }

    /// Whether the latest set-point is not older than a timeout, s, at a time, µs.
    pub fn is_recent(&self, time_us: u64, timeout_s: f64) -> bool {
        let timeout_us = (timeout_s * 1e6) as u64;
        self.latest.is_some_and(|(_, taken_us)| time_us - taken_us <= timeout_us)
    }

    /// One tick of the offboard mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if !situation.set_points_are_recent {
            match situation.identity.is_ardupilot() {
                true => self.guided_without_news(situation, proposal),
                false => proposal.see(Cause::SetPointsLost, true),
            }
            return;
        }
        if self.applied {
            return;
        }
        let Some((set_point, _)) = self.latest else { return };
        match set_point {
            SetPoint::Attitude(attitude) => proposal.follow_attitude(situation, &attitude),
            // On the ground it idles until it is led upwards, and looks again with the next tick.
            SetPoint::Position(position)
                if proposal.steering().kind() == SteeringKind::Idle
                    && !position.leads_up(situation.outputs.position_m.z) =>
            {
                return;
            }
            SetPoint::Position(position) => {
                proposal.follow(situation, &position.within(situation.limits()));
            }
        }
        self.applied = true;
    }

    /// The failsafe has taken in that set-points have stopped. With an action that leaves the mode as it is, the vehicle holds
    /// its place there.
    pub fn hold_without_news(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let follows = situation.mode == Mode::Offboard && situation.lost_rotor.is_none();
        let stopped = !situation.set_points_are_recent && !situation.identity.is_ardupilot();
        if follows && stopped && !self.expired {
            self.expired = true;
            proposal.hold(situation);
        }
    }

    /// ArduPilot stays in its mode: a velocity, an acceleration or an attitude ends, a position stays.
    fn guided_without_news(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let ends = match self.latest {
            Some((SetPoint::Position(position), _)) => position.runs_on(),
            Some((SetPoint::Attitude(_), _)) => true,
            None => false,
        };
        if ends && !self.expired && proposal.steering().kind() != SteeringKind::Idle {
            self.expired = true;
            proposal.say(Severity::Warning, "Set-points stopped: holding");
            proposal.follow(situation, &PositionSetPoint::HOLD);
        }
    }
}
