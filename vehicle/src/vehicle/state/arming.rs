//! Arming and disarming.

use quadrotor::RotorFault;

use super::super::arming_obstacle::{ArmingObstacle, ArmingSubject as Subject, joined};
use super::super::notice::{Refusal, Severity};
use super::super::plans::{check_reach, check_way};
use super::super::set_point::PositionSetPoint;
use super::Vehicle;
use crate::mode::{Mode, Needs};

/// Leaning more than this, rad, it is not armed.
const LARGEST_LEAN_RAD: f64 = 0.52;

impl Vehicle {
    /// Everything that speaks against arming now; empty if nothing does.
    pub fn arming_obstacles(&self) -> Vec<ArmingObstacle> {
        let mut obstacles = self.all_obstacles();
        if self.identity().is_ardupilot() {
            if self.conduct().arming.skips_all() {
                obstacles.retain(|obstacle| obstacle.subject.is_of_mode());
            } else {
                obstacles.extend(self.ardupilot_obstacles());
                let settings = &self.conduct().arming;
                obstacles.retain(|obstacle| !settings.skips(obstacle.subject));
            }
        }
        let safety = self.machines.safety.obstacle();
        obstacles.extend(safety.map(|text| ArmingObstacle::from(text.to_owned())));
        obstacles
    }

    fn all_obstacles(&self) -> Vec<ArmingObstacle> {
        let situation = self.situation();
        let mut obstacles = Vec::new();
        if !situation.landed {
            obstacles.push(ArmingObstacle::new(Subject::Ground, "not on the ground"));
        }
        let attitude_rad = situation.outputs.attitude_rad;
        let [lean, pitch] = [attitude_rad.x.abs(), attitude_rad.y.abs()];
        if lean.max(pitch) > LARGEST_LEAN_RAD {
            let text = format!("tilted by {:.0} deg", lean.max(pitch).to_degrees());
            obstacles.push(ArmingObstacle::new(Subject::Tilt, text));
        }
        let (remaining, needed) = (situation.battery_remaining, situation.conduct.battery_to_arm);
        if remaining < needed {
            let text = format!("battery at {:.0} %, required {:.0} %", 100.0 * remaining, 100.0 * needed);
            obstacles.push(ArmingObstacle::new(Subject::Battery, text));
        }
        let ardupilot = situation.identity.is_ardupilot();
        let needs_place = ardupilot && situation.conduct.arming.needs_place;
        let needs = if needs_place { Needs::Place } else { situation.mode.needs() };
        obstacles.extend(self.perception.obstacles(needs, ardupilot));
        obstacles.extend(self.throttle_obstacle().map(ArmingObstacle::from));
        if situation.pilot.is_calibrating {
            obstacles.push(ArmingObstacle::from("RC calibrating".to_owned()));
        }
        let touched = self.machines.obstacles.touched(&situation);
        obstacles.extend(touched.map(|obstacle| ArmingObstacle::from(format!("touches {}", obstacle.name))));
        let remote_id = self.machines.remote_id.obstacle(&situation).map(str::to_owned);
        obstacles.extend(remote_id.map(ArmingObstacle::from));
        obstacles.extend(rotor_obstacles(self.faults().rotors()));
        let identity = situation.identity;
        let in_auto = identity.is_ardupilot() && situation.mode == Mode::Mission;
        if in_auto && !situation.conduct.auto_allows_arming() {
            let text = format!("{} mode not armable", identity.mode_name(Mode::Mission));
            obstacles.push(ArmingObstacle::new(Subject::Mode, text));
        }
        match situation.mode {
            // ArduPilot's Hold is Brake, which ends a flight; PX4's begins one.
            Mode::Land | Mode::Return | Mode::SmartReturn | Mode::Orbit | Mode::Follow | Mode::Hold
                if identity.is_ardupilot() || situation.mode != Mode::Hold =>
            {
                let name = identity.mode_name(situation.mode);
                let text = if identity.is_ardupilot() {
                    format!("{name} mode not armable")
                } else {
                    format!("{name} mode is active")
                };
                obstacles.push(ArmingObstacle::new(Subject::Mode, text));
            }
            Mode::Mission if !self.has_mission() => {
                obstacles.push(ArmingObstacle::new(Subject::Mission, "no mission"));
            }
            Mode::Mission => {
                let program = self.machines.mission.program();
                let fault = check_reach(&situation, program)
                    .and_then(|()| check_way(&situation, program, false))
                    .err();
                let text = fault.map(|fault| format!("mission: {}", fault.located(identity)));
                obstacles.extend(text.map(|text| ArmingObstacle::new(Subject::Mission, text)));
            }
            Mode::Offboard if !identity.is_ardupilot() && !situation.set_points_are_recent => {
                obstacles.push(ArmingObstacle::new(Subject::SetPoints, "no set-points"));
            }
            _ => {}
        }
        let failsafes = self.machines.failsafe.obstacles(&situation);
        obstacles.extend(failsafes.map(|text| ArmingObstacle::new(Subject::Failsafe, text)));
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
        // Whoever arms by force, too, would have rotors that stand still.
        let is_forced = force && !self.is_safe();
        if !is_forced && !obstacles.is_empty() {
            return Err(Refusal::later(format!("Arming denied: {}", joined(&obstacles))));
        }
        self.decided.arm();
        self.machines.receiver.arm();
        self.consult(|parts, situation, proposal| {
            parts.landing.arm(situation.time_us);
            parts.smart_return.arm(situation);
            parts.simple.arm(situation.outputs.attitude_rad.z);
            if !situation.home.set_by_user && situation.landed {
                proposal.move_home_here(situation);
            }
            if situation.mode == Mode::Mission {
                parts.mission.arm(situation, proposal);
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
fn rotor_obstacles(faults: [Option<RotorFault>; 4]) -> impl Iterator<Item = ArmingObstacle> {
    let silent = |fault: Option<RotorFault>| matches!(fault, Some(RotorFault::Off | RotorFault::Stuck));
    let numbered = (1..).zip(faults);
    let broken = numbered.filter(move |(_, fault)| silent(*fault));
    broken.map(|(number, _)| ArmingObstacle::new(Subject::Rotor, format!("rotor {number} failed")))
}
