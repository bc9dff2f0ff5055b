//! Takeoffs that are asked for.

use nalgebra::Vector3;

use super::super::fence_watch::check_goal;
use super::super::notice::{Refusal, Severity};
use super::super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::super::situation::Situation;
use super::super::steering::SteeringKind;
use super::Vehicle;
use crate::mode::Mode;

/// Takeoffs end between these heights above home, m.
const TAKEOFF_HEIGHT_M: core::ops::RangeInclusive<f64> = 0.5..=1000.0;

impl Vehicle {
    /// Takes off to a height above home, m, or to that of the parameter; when it is armed, else as soon as it is
    /// (ArduPilot: only when it is).
    ///
    /// # Errors
    /// [`Refusal`] when it flies already or the height is no takeoff's.
    pub fn take_off(&mut self, height_m: Option<f64>) -> Result<(), Refusal> {
        let situation = self.situation();
        situation.refuse_without_rotor()?;
        let height_m = height_m.unwrap_or(situation.conduct.takeoff_height_m);
        if !TAKEOFF_HEIGHT_M.contains(&height_m) {
            let (low, high) = (TAKEOFF_HEIGHT_M.start(), TAKEOFF_HEIGHT_M.end());
            return Err(Refusal::denied(format!(
                "Takeoff denied: {height_m:.1} m above home is outside {low} to {high} m"
            )));
        }
        let z = situation.home.position_m.z - height_m;
        let here = situation.outputs.position_m;
        check_goal(&situation, "Takeoff", &Vector3::new(here.x, here.y, z))?;
        let flying = situation.steering.kind() != SteeringKind::Idle;
        let taking_off = situation.mode == Mode::Takeoff && flying;
        let goal_z_m = self.machines.takeoff.goal_z_m();
        if taking_off && goal_z_m.is_some_and(|goal| (goal - z).abs() < 0.01) {
            return Ok(());
        }
        if flying && !situation.identity.is_ardupilot() {
            return self.climb_on(z);
        }
        if flying {
            return Err(Refusal::later("Takeoff rejected: already flying"));
        }
        if situation.identity.is_ardupilot() {
            refuse_unarmed(&situation)?;
            if situation.mode != Mode::Offboard {
                return Err(Refusal::Failed("Takeoff rejected: not in Guided mode".to_owned()));
            }
        }
        self.machines.failsafe.may_take_off(&situation)?;
        self.enter(Mode::Takeoff);
        self.machines.takeoff.aim(z);
        Ok(())
    }

    /// PX4 takes off in the air, too: it climbs to z, m, where it is, and stays at a greater height.
    fn climb_on(&mut self, z_m: f64) -> Result<(), Refusal> {
        self.may_enter(Mode::Takeoff)?;
        let situation = self.situation();
        let here_m = situation.steering.present(situation.outputs).position_m;
        let is_higher = here_m.z < z_m;
        self.machines.failsafe.release();
        self.enter(Mode::Takeoff);
        let goal_m = Vector3::new(here_m.x, here_m.y, z_m.min(here_m.z));
        self.machines.takeoff.aim(goal_m.z);
        self.consult(|_, situation, proposal| {
            if is_higher {
                proposal.say(Severity::Warning, "Already higher than takeoff altitude");
            }
            let axes = goal_m.data.0[0].map(AxisTarget::Position);
            proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
        });
        Ok(())
    }

    /// ArduPilot's takeoff by command in the present mode, to a height above home, m; `by_itself` says that no pilot is to hold the
    /// place meanwhile.
    ///
    /// # Errors
    /// [`Refusal`] unless it is armed and on the ground, and in modes that take off by other means.
    pub fn take_off_in_mode(&mut self, height_m: Option<f64>, by_itself: bool) -> Result<(), Refusal> {
        let situation = self.situation();
        let able = match situation.mode {
            Mode::Position | Mode::ZigZag => true,
            Mode::Altitude | Mode::PositionHold => !by_itself,
            Mode::Offboard | Mode::Takeoff => return self.take_off(height_m),
            _ => false,
        };
        situation.refuse_without_rotor()?;
        refuse_unarmed(&situation)?;
        if !able {
            let name = situation.identity.mode_name(situation.mode);
            return Err(Refusal::Failed(format!("Takeoff rejected in {name} mode")));
        }
        if !situation.landed {
            return Err(Refusal::Failed("Takeoff rejected: already flying".to_owned()));
        }
        self.may_enter(situation.mode)?;
        let z_m = situation.home.position_m.z - height_m.unwrap_or(situation.conduct.takeoff_height_m);
        let here_m = situation.outputs.position_m;
        if z_m >= here_m.z {
            return Err(Refusal::Failed("Takeoff rejected: not above the vehicle".to_owned()));
        }
        check_goal(&situation, "Takeoff", &Vector3::new(here_m.x, here_m.y, z_m))?;
        self.machines.climb.take_off(z_m);
        self.machines.consent.give();
        Ok(())
    }
}

/// ArduPilot takes off only when it is armed.
fn refuse_unarmed(situation: &Situation) -> Result<(), Refusal> {
    if situation.armed { Ok(()) } else { Err(Refusal::Failed("Takeoff rejected: not armed".to_owned())) }
}
