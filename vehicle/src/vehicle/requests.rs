//! What may be asked of the vehicle.

use nalgebra::Vector3;

use super::notice::{Refusal, Severity};
use super::proposal::check_distance;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::state::Vehicle;
use super::steering::{Steering, SteeringKind};
use super::sticks::Sticks;
use crate::mode::Mode;

/// Takeoffs end between these heights above home, m.
const TAKEOFF_HEIGHT_M: core::ops::RangeInclusive<f64> = 0.5..=1000.0;

/// Where to go and stay; what is `None` stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Reposition {
    /// North and east, m.
    pub horizontal_m: Option<[f64; 2]>,
    /// Down, m.
    pub down_m: Option<f64>,
    /// Heading, rad.
    pub yaw_rad: Option<f64>,
}

impl Vehicle {
    /// Changes the mode.
    ///
    /// # Errors
    /// [`Refusal`] when the mode cannot be flown now.
    pub fn set_mode(&mut self, mode: Mode) -> Result<(), Refusal> {
        self.may_enter(mode)?;
        let flying = self.steering.kind() != SteeringKind::Idle;
        if mode != Mode::Land {
            self.refuse_without_rotor()?;
        }
        match mode {
            Mode::Takeoff => return self.take_off(None),
            Mode::Mission => return self.start_mission(None),
            Mode::Offboard if !self.identity.is_ardupilot() && !self.set_points_are_recent() => {
                return Err(Refusal::later("Offboard rejected: no recent set-point"));
            }
            Mode::Land | Mode::Return if self.armed && !flying => {
                return Err(Refusal::later(format!(
                    "{} rejected: on the ground",
                    self.identity.mode_name(mode)
                )));
            }
            _ => {}
        }
        // Asked again it goes on as it does.
        self.failsafe.release();
        if mode != self.mode {
            self.enter(mode);
        } else if mode == Mode::Hold {
            self.hold();
        }
        Ok(())
    }

    /// Takes off to a height above home, m, or to that of the parameter; when it is armed, else as soon as it is
    /// (ArduPilot: only when it is).
    ///
    /// # Errors
    /// [`Refusal`] when it flies already or the height is no takeoff's.
    pub fn take_off(&mut self, height_m: Option<f64>) -> Result<(), Refusal> {
        self.refuse_without_rotor()?;
        let height_m = height_m.unwrap_or(self.conduct.takeoff_height_m);
        if !TAKEOFF_HEIGHT_M.contains(&height_m) {
            let (low, high) = (TAKEOFF_HEIGHT_M.start(), TAKEOFF_HEIGHT_M.end());
            return Err(Refusal::denied(format!(
                "Takeoff denied: {height_m:.1} m above home is outside {low} to {high} m"
            )));
        }
        let z = self.home.position_m.z - height_m;
        let [x, y] = [self.outputs.position_m.x, self.outputs.position_m.y];
        self.check_fence("Takeoff", &Vector3::new(x, y, z))?;
        let taking_off = self.mode == Mode::Takeoff && self.steering.kind() != SteeringKind::Idle;
        if taking_off && self.takeoff_z_m.is_some_and(|goal| (goal - z).abs() < 0.01) {
            return Ok(());
        }
        if self.steering.kind() != SteeringKind::Idle {
            return Err(Refusal::later("Takeoff rejected: already flying"));
        }
        if self.identity.is_ardupilot() {
            if !self.armed {
                return Err(Refusal::Failed("Takeoff rejected: not armed".to_owned()));
            }
            if self.mode != Mode::Offboard {
                return Err(Refusal::Failed("Takeoff rejected: not in Guided mode".to_owned()));
            }
        }
        self.enter(Mode::Takeoff);
        self.takeoff_z_m = Some(z);
        Ok(())
    }

    /// Goes somewhere and holds there. In ArduPilot's identity this is its guided mode.
    ///
    /// # Errors
    /// [`Refusal`] on the ground, or too far away.
    pub fn reposition(&mut self, goal: &Reposition) -> Result<(), Refusal> {
        self.refuse_without_rotor()?;
        if self.steering.kind() == SteeringKind::Idle {
            return Err(Refusal::later("Reposition rejected: not flying"));
        }
        self.may_enter(self.holding_mode())?;
        if goal.horizontal_m.is_none() && goal.down_m.is_none() && goal.yaw_rad.is_none() {
            self.failsafe.release();
            self.enter(self.holding_mode());
            self.follow(&PositionSetPoint::HOLD);
            return Ok(());
        }
        // An axis that is not named stays where its reference is.
        let now = match &self.steering {
            Steering::Goal(goal) => goal.position_m,
            _ => self.outputs.setpoint.position_m,
        };
        let [x, y] = goal.horizontal_m.unwrap_or([now.x, now.y]);
        let target = Vector3::new(x, y, goal.down_m.unwrap_or(now.z));
        check_distance(&target)?;
        self.check_fence("Reposition", &target)?;
        self.failsafe.release();
        self.enter(self.holding_mode());
        let yaw = goal.yaw_rad.map_or(YawTarget::Hold, YawTarget::Angle);
        // A heading that is asked for goes before what was looked at.
        self.region = self.region.filter(|_| goal.yaw_rad.is_none());
        self.follow(&PositionSetPoint { axes: target.data.0[0].map(AxisTarget::Position), yaw });
        self.set_points = super::offboard::SetPoints::default();
        Ok(())
    }

    /// The mode in which it stays at a place that a command named.
    fn holding_mode(&self) -> Mode {
        if self.identity.is_ardupilot() { Mode::Offboard } else { Mode::Hold }
    }

    /// Turns to a heading, rad, where it is.
    ///
    /// # Errors
    /// [`Refusal`] on the ground and in modes that turn by themselves.
    pub fn turn_to(&mut self, yaw_rad: f64) -> Result<(), Refusal> {
        if self.mode != self.holding_mode() {
            return Err(Refusal::later(format!(
                "Turn rejected in {} mode",
                self.identity.mode_name(self.mode)
            )));
        }
        self.reposition(&Reposition { yaw_rad: Some(yaw_rad), ..Reposition::default() })
    }

    /// Moves home.
    ///
    /// # Errors
    /// [`Refusal`] too far away.
    pub fn set_home(&mut self, position_m: Vector3<f64>, yaw_rad: Option<f64>) -> Result<(), Refusal> {
        check_distance(&position_m)?;
        let yaw_rad = yaw_rad.unwrap_or(self.outputs.attitude_rad.z);
        self.home = super::home::Home { position_m, yaw_rad, set_by_user: true };
        self.say(Severity::Info, "Home set");
        Ok(())
    }

    /// Takes the pilot's sticks.
    pub fn move_sticks(&mut self, sticks: Sticks) {
        self.sticks = Some((sticks, self.time_us()));
    }
}
