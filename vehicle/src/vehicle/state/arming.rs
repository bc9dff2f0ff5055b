//! Arming and disarming.

use quadrotor::RotorFault;

use super::super::notice::{Refusal, Severity};
use super::super::plans::{check_reach, check_way};
use super::super::set_point::PositionSetPoint;
use super::Vehicle;
use crate::mode::Mode;

/// Leaning more than this, rad, it is not armed.
const LARGEST_LEAN_RAD: f64 = 0.52;

impl Vehicle {
    /// Everything that speaks against arming now; empty if nothing does.
    pub fn arming_obstacles(&self) -> Vec<String> {
        let situation = self.situation();
        let mut obstacles = Vec::new();
        if !situation.landed {
            obstacles.push("not on the ground".to_owned());
        }
        let attitude_rad = situation.outputs.attitude_rad;
        let [lean, pitch] = [attitude_rad.x.abs(), attitude_rad.y.abs()];
        if lean.max(pitch) > LARGEST_LEAN_RAD {
            obstacles.push(format!("tilted by {:.0} deg", lean.max(pitch).to_degrees()));
        }
        let (remaining, needed) = (situation.battery_remaining, situation.conduct.battery_to_arm);
        if remaining < needed {
            obstacles.push(format!(
                "battery at {:.0} %, required {:.0} %",
                100.0 * remaining,
                100.0 * needed
            ));
        }
        obstacles.extend(self.perception.obstacles(situation.mode.needs()));
        obstacles.extend(self.throttle_obstacle());
        let touched = self.machines.obstacles.touched(&situation);
        obstacles.extend(touched.map(|obstacle| format!("touches {}", obstacle.name)));
        obstacles.extend(self.machines.remote_id.obstacle(&situation).map(str::to_owned));
        obstacles.extend(rotor_obstacles(self.faults().rotors()));
        let identity = situation.identity;
        match situation.mode {
            Mode::Land | Mode::Return | Mode::SmartReturn | Mode::Orbit | Mode::Follow => {
                obstacles.push(format!("{} mode is active", identity.mode_name(situation.mode)));
            }
            Mode::Mission if !self.has_mission() => obstacles.push("no mission".to_owned()),
            Mode::Mission => {
                let program = self.machines.mission.program();
                let fault = check_reach(&situation, program).and(check_way(&situation, program)).err();
                obstacles.extend(fault.map(|fault| format!("mission: {}", fault.located(identity))));
            }
            Mode::Offboard if !identity.is_ardupilot() && !situation.set_points_are_recent => {
                obstacles.push("no set-points".to_owned());
            }
            _ => {}
        }
        obstacles.extend(self.machines.failsafe.obstacles(&situation));
        obstacles
    }

    /// Arms: the rotors idle. Arming an armed vehicle changes nothing.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] with what speaks against it, unless forced.
    pub fn arm(&mut self, force: bool) -> Result<(), Refusal> {
        if self.is_armed() {
            return Ok(());
        }
        let obstacles = self.arming_obstacles();
        if !force && !obstacles.is_empty() {
            return Err(Refusal::later(format!("Arming denied: {}", obstacles.join("; "))));
        }
        self.decided.arm();
        self.machines.receiver.arm();
        self.consult(|parts, situation, proposal| {
            parts.landing.arm(situation.time_us);
            parts.smart_return.arm(situation);
            if !situation.home.set_by_user && situation.landed {
                proposal.move_home_here(situation);
            }
            proposal.idle(situation);
            if !situation.landed {
                proposal.follow(situation, &PositionSetPoint::HOLD);
            }
            proposal.say(Severity::Info, "Armed");
        });
        Ok(())
    }

    /// Disarms. Disarming a disarmed vehicle changes nothing.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] in the air, unless forced.
    pub fn disarm(&mut self, force: bool) -> Result<(), Refusal> {
        if !self.is_armed() {
            return Ok(());
        }
        if !force && !self.situation().landed {
            return Err(Refusal::later("Disarming denied: not landed"));
        }
        self.stop_rotors(if force { "Disarmed by force" } else { "Disarmed" });
        Ok(())
    }
}

/// Rotors that do not answer on the ground.
fn rotor_obstacles(faults: [Option<RotorFault>; 4]) -> impl Iterator<Item = String> {
    let silent = |fault: Option<RotorFault>| matches!(fault, Some(RotorFault::Off | RotorFault::Stuck));
    let numbered = (1..).zip(faults);
    numbered.filter(move |(_, fault)| silent(*fault)).map(|(number, _)| format!("rotor {number} failed"))
}
