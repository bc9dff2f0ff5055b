//! Set-points from outside.

use super::failsafe::Cause;
use super::notice::{Refusal, Severity};
use super::set_point::{PositionSetPoint, SetPoint};
use super::state::Vehicle;
use super::steering::SteeringKind;
use crate::mode::Mode;

/// What has come of set-points.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SetPoints {
    /// The latest, and when it came, µs.
    pub latest: Option<(SetPoint, u64)>,
    /// Whether it has been steered to.
    pub applied: bool,
    /// Whether it has run out (ArduPilot: it then holds its place until the next one).
    pub expired: bool,
}

impl Vehicle {
    /// Takes a set-point. It proves that its sender is alive in every mode, and is flown in the offboard mode.
    ///
    /// # Errors
    /// [`Refusal`] in ArduPilot's identity on the ground, where only a takeoff lifts off, and outside its mode.
    pub fn set_point(&mut self, set_point: SetPoint) -> Result<(), Refusal> {
        if self.identity.is_ardupilot() {
            if self.mode != Mode::Offboard {
                return Err(Refusal::later("Set-point ignored: not in Guided mode"));
            }
            let position = matches!(set_point, SetPoint::Position(_));
            if position && self.steering.kind() == SteeringKind::Idle {
                return Err(Refusal::later("Set-point ignored: take off first"));
            }
        }
        if let SetPoint::Position(position) = &set_point {
            self.check_set_point(position)?;
        }
        self.see(Cause::SetPointsLost, false);
        self.set_points =
            SetPoints { latest: Some((set_point, self.time_us())), applied: false, expired: false };
        Ok(())
    }

    /// Whether the latest set-point is young enough to fly on.
    pub fn set_points_are_recent(&self) -> bool {
        let timeout_us = (self.conduct.set_point_timeout_s * 1e6) as u64;
        self.set_points.latest.is_some_and(|(_, time_us)| self.time_us() - time_us <= timeout_us)
    }

    /// One tick of the offboard mode.
    pub(super) fn offboard(&mut self) {
        if !self.set_points_are_recent() {
            self.set_points_have_stopped();
            return;
        }
        if self.set_points.applied {
            return;
        }
        let Some((set_point, _)) = self.set_points.latest else { return };
        match set_point {
            SetPoint::Attitude(attitude) => self.steering.follow_attitude(&attitude, &self.outputs),
            // On the ground it idles until it is led upwards, and looks again with the next tick.
            SetPoint::Position(position)
                if self.steering.kind() == SteeringKind::Idle
                    && !position.leads_up(self.outputs.position_m.z) =>
            {
                return;
            }
            SetPoint::Position(position) => {
                let limits = self.simulation.configuration().limits;
                self.follow(&position.within(&limits));
            }
        }
        self.set_points.applied = true;
    }

    fn set_points_have_stopped(&mut self) {
        if self.identity.is_ardupilot() {
            self.guided_without_news();
            return;
        }
        self.see(Cause::SetPointsLost, true);
        // With an action that leaves the mode as it is, it holds its place there.
        if self.mode == Mode::Offboard && !self.set_points.expired {
            self.set_points.expired = true;
            self.hold();
        }
    }

    /// ArduPilot stays in its mode: a velocity, an acceleration or an attitude ends, a position stays.
    fn guided_without_news(&mut self) {
        let ends = match self.set_points.latest {
            Some((SetPoint::Position(position), _)) => position.runs_on(),
            Some((SetPoint::Attitude(_), _)) => true,
            None => false,
        };
        if ends && !self.set_points.expired && self.steering.kind() != SteeringKind::Idle {
            self.set_points.expired = true;
            self.say(Severity::Warning, "Set-points stopped: holding");
            self.follow(&PositionSetPoint::HOLD);
        }
    }
}
