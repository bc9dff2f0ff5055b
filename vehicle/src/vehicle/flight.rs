//! One tick of the armed vehicle, by mode.

use quadrotor::Outputs;

use super::notice::Severity;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::state::Vehicle;
use super::steering::SteeringKind;
use super::sticks::Sticks;
use crate::mode::Mode;

/// So near to its height, m, a takeoff is over.
const TAKEOFF_REACHED_M: f64 = 0.2;
const TAKEOFF_SLOW_M_S: f64 = 0.3;

/// Whether a takeoff to z, m, is over.
pub fn is_slow_near(outputs: &Outputs, z_m: f64) -> bool {
    (outputs.position_m.z - z_m).abs() < TAKEOFF_REACHED_M && outputs.velocity_m_s.norm() < TAKEOFF_SLOW_M_S
}

impl Vehicle {
    pub(super) fn fly(&mut self) {
        match self.mode {
            _ if self.lost_rotor().is_some() => self.descend_without_rotor(),
            Mode::Takeoff => self.climb(),
            Mode::Hold => {}
            Mode::Position => self.follow_sticks(),
            Mode::Offboard => self.offboard(),
            Mode::Mission => {
                self.consult(|parts, situation, proposal| parts.mission.step(situation, proposal))
            }
            Mode::Land => self.descend(None),
            Mode::Return => self.return_home(),
        }
        if self.chooses_its_heading() {
            self.turn_to_region();
        }
        self.disarm_on_the_ground();
    }

    /// Changes to a mode, whatever speaks against it.
    pub(super) fn enter(&mut self, mode: Mode) {
        if mode != self.mode {
            self.say(Severity::Info, format!("{} mode", self.identity.mode_name(mode)));
        }
        if self.mode == Mode::Mission && mode != Mode::Mission {
            self.consult(|parts, _, proposal| parts.mission.leave(proposal));
        }
        self.mode = mode;
        self.takeoff_z_m = None;
        self.set_points.applied = false;
        match mode {
            Mode::Hold | Mode::Position => self.hold(),
            Mode::Offboard if !self.set_points_are_recent() => self.hold(),
            Mode::Return if self.steering.kind() != SteeringKind::Idle => self.begin_return(),
            Mode::Mission => {
                self.consult(|parts, situation, proposal| parts.mission.enter(situation, proposal))
            }
            _ => {}
        }
    }

    fn climb(&mut self) {
        let z = *self.takeoff_z_m.get_or_insert(self.home.position_m.z - self.conduct.takeoff_height_m);
        if self.steering.kind() == SteeringKind::Idle {
            let [x, y] = [self.outputs.position_m.x, self.outputs.position_m.y];
            let axes = [AxisTarget::Position(x), AxisTarget::Position(y), AxisTarget::Position(z)];
            self.follow(&PositionSetPoint { axes, yaw: YawTarget::Angle(self.outputs.attitude_rad.z) });
            self.say(Severity::Info, format!("Taking off to {:.1} m above home", self.home.position_m.z - z));
        }
        if is_slow_near(&self.outputs, z) {
            self.takeoff_z_m = None;
            self.mode = if self.identity.is_ardupilot() { Mode::Offboard } else { Mode::Hold };
            self.set_points = super::offboard::SetPoints::default();
            self.say(Severity::Info, "Takeoff height reached");
        }
    }

    fn follow_sticks(&mut self) {
        let timeout_us = (self.conduct.stick_timeout_s * 1e6) as u64;
        let sticks = match self.sticks {
            Some((sticks, time_us)) if self.time_us() - time_us <= timeout_us => sticks,
            Some(_) => {
                self.sticks = None;
                self.say(Severity::Warning, "Manual control lost: holding");
                Sticks::default()
            }
            None => {
                // Without sticks it holds; how it came here decides by what.
                return;
            }
        };
        let yaw_rate = self.simulation.configuration().limits.yaw_rate_rad_s;
        let set_point = sticks.set_point(&self.conduct, self.outputs.attitude_rad.z, yaw_rate);
        if self.steering.kind() != SteeringKind::Idle || set_point.leads_up(self.outputs.position_m.z) {
            self.follow(&set_point);
        }
    }

    fn disarm_on_the_ground(&mut self) {
        if !self.landed.is_landed() || self.steering.kind() != SteeringKind::Idle || self.mission_goes_on() {
            if !self.landed.is_landed() {
                self.grounded_since_us = self.time_us();
            }
            return;
        }
        let wait_s = if self.flown {
            self.conduct.disarm_after_landing_s
        } else {
            self.conduct.disarm_before_takeoff_s
        };
        let waited_s = (self.time_us() - self.grounded_since_us) as f64 / 1e6;
        if wait_s >= 0.0 && waited_s >= wait_s {
            self.stop_rotors(if self.flown { "Disarmed after landing" } else { "Disarmed: no takeoff" });
        }
    }
}
