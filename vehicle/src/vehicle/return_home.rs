//! The way home: climb, travel, descend.

use nalgebra::{UnitQuaternion, Vector3};

use super::notice::Severity;
use super::set_point::{AttitudeSetPoint, AxisTarget, PositionSetPoint, YawTarget};
use super::state::Vehicle;
use super::steering::SteeringKind;

/// Part of the way home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReturnPhase {
    /// To the height of the way.
    Climb,
    /// Above the place to land at.
    Travel,
    /// Down.
    Descend,
}

/// So near to a goal, m, and so slow, m/s, the next phase begins.
const REACHED_M: f64 = 0.5;
const SLOW_M_S: f64 = 0.5;
/// Share of the weight per error of the sink rate, s/m.
const SINK_GAIN: f64 = 0.5;

impl Vehicle {
    /// Begins the way home.
    pub(super) fn begin_return(&mut self) {
        let [x, y] = self.nearest_safe_point_m();
        self.return_way_m = self.way_m([x, y]);
        let place = self.outputs.position_m;
        let near = libm::hypot(place.x - x, place.y - y) < self.conduct.return_near_m;
        self.return_phase = if near { ReturnPhase::Descend } else { ReturnPhase::Climb };
        match self.return_phase {
            ReturnPhase::Climb => self.go_at_return_height(self.outputs.setpoint.position_m.xy().into()),
            _ => self.say(Severity::Info, "Returning: the place is near, landing"),
        }
    }

    /// One tick of the way home.
    pub(super) fn return_home(&mut self) {
        match self.return_phase {
            ReturnPhase::Climb if self.goal_is_reached() => {
                self.return_phase = ReturnPhase::Travel;
                self.travel();
            }
            ReturnPhase::Travel if self.goal_is_reached() && self.return_way_m.len() > 1 => {
                self.return_way_m.pop_front();
                self.travel();
            }
            ReturnPhase::Travel if self.goal_is_reached() => {
                self.return_phase = ReturnPhase::Descend;
                self.say(Severity::Info, "Above the place to return to, landing");
            }
            ReturnPhase::Descend => self.descend(self.return_way_m.back().copied()),
            _ => {}
        }
    }

    fn travel(&mut self) {
        if let Some(next) = self.return_way_m.front() {
            self.go_at_return_height(*next);
        }
    }

    fn go_at_return_height(&mut self, [x, y]: [f64; 2]) {
        let home_z = self.home.position_m.z;
        let mut z = self.outputs.position_m.z.min(home_z - self.conduct.return_height_m);
        if let Some(ceiling_z) = self.fence_ceiling_z_m() {
            z = z.max(ceiling_z);
        }
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
            match self.steering.kind() {
                // The blind one ends here, too.
                SteeringKind::Attitude => return self.idle(),
                SteeringKind::Idle => return,
                // It had only just begun to lift off.
                SteeringKind::Position | SteeringKind::Descent => {}
            }
        }
        if !self.knows_its_place() {
            self.descend_blind();
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

    /// A descent without an estimate of the place: level, the thrust by the sink rate. It drifts with the wind.
    fn descend_blind(&mut self) {
        let airframe = self.simulation.configuration().airframe;
        let (_, strongest_n) = airframe.thrust_range_n();
        let missing_m_s = self.sink_rate_m_s() - self.conduct.land_speed_m_s;
        let thrust_n = airframe.weight_n() * (1.0 + SINK_GAIN * missing_m_s).clamp(0.6, 1.4);
        let level = UnitQuaternion::from_euler_angles(0.0, 0.0, self.outputs.attitude_rad.z);
        let set_point = AttitudeSetPoint {
            attitude: Some(level),
            body_rate_rad_s: Vector3::zeros(),
            thrust: (thrust_n / strongest_n).clamp(0.0, 1.0),
        };
        self.steering.follow_attitude(&set_point, &self.outputs);
    }
}
