//! Arming and disarming.

use super::failsafe::Cause;
use super::notice::{Refusal, Severity};
use super::state::Vehicle;
use super::steering::Steering;
use crate::mode::Mode;

/// Leaning more than this, rad, it is not armed.
const LARGEST_LEAN_RAD: f64 = 0.52;

impl Vehicle {
    /// Everything that speaks against arming now; empty if nothing does.
    pub fn arming_obstacles(&self) -> Vec<String> {
        let mut obstacles = Vec::new();
        if !self.landed.is_landed() {
            obstacles.push("not on the ground".to_owned());
        }
        let [lean, pitch] = [self.outputs.attitude_rad.x.abs(), self.outputs.attitude_rad.y.abs()];
        if lean.max(pitch) > LARGEST_LEAN_RAD {
            obstacles.push(format!("leaning by {:.0} deg", lean.max(pitch).to_degrees()));
        }
        let (remaining, needed) = (self.battery_remaining(), self.conduct.battery_to_arm);
        if remaining < needed {
            obstacles.push(format!("battery at {:.0} %, needs {:.0} %", 100.0 * remaining, 100.0 * needed));
        }
        obstacles.extend(self.navigation_obstacles());
        obstacles.extend(self.rotor_obstacles());
        match self.mode {
            Mode::Land | Mode::Return => {
                obstacles.push(format!("not in {} mode", self.identity.mode_name(self.mode)));
            }
            Mode::Mission if !self.has_mission() => obstacles.push("no mission".to_owned()),
            Mode::Mission => {
                obstacles.extend(self.check_mission_places().err().map(|fault| format!("mission: {fault}")))
            }
            Mode::Offboard if !self.identity.is_ardupilot() && !self.set_points_are_recent() => {
                obstacles.push("no set-points".to_owned());
            }
            _ => {}
        }
        obstacles.extend(self.failsafe_obstacles());
        obstacles
    }

    /// Arms: the rotors idle. Arming an armed vehicle changes nothing.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] with what speaks against it, unless forced.
    pub fn arm(&mut self, force: bool) -> Result<(), Refusal> {
        if self.armed {
            return Ok(());
        }
        let obstacles = self.arming_obstacles();
        if !force && !obstacles.is_empty() {
            return Err(Refusal::later(format!("Arming denied: {}", obstacles.join("; "))));
        }
        self.armed = true;
        self.terminated = false;
        self.flown = !self.landed.is_landed();
        self.grounded_since_us = self.time_us();
        if !self.home.set_by_user && self.landed.is_landed() {
            self.home.position_m = self.outputs.position_m;
            self.home.yaw_rad = self.outputs.attitude_rad.z;
        }
        self.steering = Steering::Idle { yaw_rad: self.outputs.attitude_rad.z };
        if !self.landed.is_landed() {
            self.follow(&super::set_point::PositionSetPoint::HOLD);
        }
        self.say(Severity::Info, "Armed");
        Ok(())
    }

    /// Disarms. Disarming a disarmed vehicle changes nothing.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] in the air, unless forced.
    pub fn disarm(&mut self, force: bool) -> Result<(), Refusal> {
        if !self.armed {
            return Ok(());
        }
        if !force && !self.landed.is_landed() {
            return Err(Refusal::later("Disarming denied: not landed"));
        }
        self.stop_rotors(if force { "Disarmed by force" } else { "Disarmed" });
        Ok(())
    }

    /// Ends the flight at once: the rotors stop wherever it is.
    pub fn terminate(&mut self) {
        if self.armed {
            self.terminated = true;
            self.stop_rotors("Flight terminated");
        }
    }

    /// Whether its last flight has been terminated.
    pub fn is_terminated(&self) -> bool {
        self.terminated
    }

    pub(super) fn stop_rotors(&mut self, why: &str) {
        self.armed = false;
        self.flown = false;
        self.failsafe.release();
        self.failsafe.forget(Cause::SetPointsLost);
        self.takeoff_z_m = None;
        self.forget_command_speeds();
        self.region = None;
        self.idle();
        // A mode that ends on the ground is not one to be armed in.
        if self.mode == Mode::Mission {
            self.consult(|parts, _, proposal| parts.mission.leave(proposal));
        }
        if matches!(self.mode, Mode::Land | Mode::Return | Mode::Takeoff | Mode::Mission) {
            self.mode = self.identity.first_mode();
        }
        self.say(Severity::Info, why);
    }
}
