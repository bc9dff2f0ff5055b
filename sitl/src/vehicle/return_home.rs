//! The way home: climb, travel, descend.

use super::mode::Mode;
use super::notice::Severity;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::state::Vehicle;

/// Part of the way home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReturnPhase {
    /// To the height of the way.
    Climb,
    /// Above home.
    Travel,
    /// Down.
    Descend,
}

/// So near to a goal, m, and so slow, m/s, the next phase begins.
const REACHED_M: f64 = 0.5;
const SLOW_M_S: f64 = 0.5;

impl Vehicle {
    /// Begins the way home.
    pub(super) fn begin_return(&mut self) {
        let near = (self.outputs.position_m - self.home.position_m).xy().norm() < self.conduct.return_near_m;
        self.return_phase = if near { ReturnPhase::Descend } else { ReturnPhase::Climb };
        match self.return_phase {
            ReturnPhase::Climb => self.go_home_at_height(self.outputs.setpoint.position_m.xy().into()),
            _ => self.say(Severity::Info, "Returning: home is near, landing"),
        }
    }

    /// One tick of the way home.
    pub(super) fn return_home(&mut self) {
        let home = self.home.position_m;
        match self.return_phase {
            ReturnPhase::Climb if self.goal_is_reached() => {
                self.return_phase = ReturnPhase::Travel;
                self.go_home_at_height([home.x, home.y]);
            }
            ReturnPhase::Travel if self.goal_is_reached() => {
                self.return_phase = ReturnPhase::Descend;
                self.say(Severity::Info, "Above home, landing");
            }
            ReturnPhase::Descend => self.descend(Some([home.x, home.y])),
            _ => {}
        }
    }

    fn go_home_at_height(&mut self, [x, y]: [f64; 2]) {
        let lowest_z = self.home.position_m.z - self.conduct.return_height_m;
        let z = self.outputs.position_m.z.min(lowest_z);
        let axes = [AxisTarget::Position(x), AxisTarget::Position(y), AxisTarget::Position(z)];
        self.follow(&PositionSetPoint { axes, yaw: YawTarget::Hold });
    }

    /// Whether the vehicle has come to rest at the goal of the shaper.
    pub(super) fn goal_is_reached(&self) -> bool {
        let super::steering::Steering::Goal(goal) = &self.steering else { return false };
        (self.outputs.position_m - goal.position_m).norm() < REACHED_M
            && self.outputs.velocity_m_s.norm() < SLOW_M_S
    }

    /// One tick of a descent, above a place or wherever it comes to rest.
    pub(super) fn descend(&mut self, above: Option<[f64; 2]>) {
        if self.landed.is_landed() {
            return;
        }
        let height_m = -self.outputs.setpoint.position_m.z;
        let slow = self.conduct.land_speed_m_s;
        // Slower towards the ground, within what the shaper is allowed.
        let fastest = self.simulation.configuration().limits.speed_down_m_s.max(slow);
        let speed = (slow + 0.4 * (height_m - 2.0)).clamp(slow, fastest);
        let [x, y] = match above {
            Some([x, y]) => [AxisTarget::Position(x), AxisTarget::Position(y)],
            None => [AxisTarget::HOLD; 2],
        };
        self.follow(&PositionSetPoint { axes: [x, y, AxisTarget::Velocity(speed)], yaw: YawTarget::Hold });
    }

    /// Begins the mode that a return ends in or that a user asked for.
    pub(super) fn begin_landing(&mut self) {
        self.mode = Mode::Land;
    }
}
