//! Speeds that hold for a while instead of the limits that the parameters set: those of a mission while it is flown, those of a
//! command until the rotors stop. The parameters stay as they are.

use quadrotor::{Configuration, Limits};

use super::notice::Refusal;

/// How limits of speed change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedChange {
    /// DO_CHANGE_SPEED of a mission: SPEED_TYPE, and m/s, −1 (as it is) or −2 (as the parameter has it).
    Mission {
        /// SPEED_TYPE.
        kind: f64,
        /// m/s.
        speed_m_s: f64,
    },
    /// The mission's speeds hold while it is flown.
    InMission(bool),
    /// Another mission, or the same from its beginning, has asked for no speed yet.
    ForgetMission,
    /// With the flight ends what commands have asked for.
    ForgetCommands,
}

/// Limits of speed, m/s: horizontally, up, down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Of the parameters.
    kept_m_s: [f64; 3],
    by_command_m_s: [Option<f64>; 3],
    by_mission_m_s: [Option<f64>; 3],
    /// Whether the mission is flown.
    in_mission: bool,
}

/// Speeds that DO_CHANGE_SPEED has for "as it is" and "as the parameter has it".
const KEEP: f64 = -1.0;
const DEFAULT: f64 = -2.0;

impl Speeds {
    /// The parameters' alone.
    pub fn new(limits: &Limits) -> Self {
        Self { kept_m_s: of(limits), by_command_m_s: [None; 3], by_mission_m_s: [None; 3], in_mission: false }
    }

    /// Limits of the parameters, m/s.
    pub fn kept_m_s(&self) -> [f64; 3] {
        self.kept_m_s
    }

    /// Limits that hold, m/s.
    pub fn in_force(&self) -> [f64; 3] {
        core::array::from_fn(|axis| {
            let by_mission = self.by_mission_m_s[axis].filter(|_| self.in_mission);
            by_mission.or(self.by_command_m_s[axis]).unwrap_or(self.kept_m_s[axis])
        })
    }

    /// The same when parameters have been set: those that have changed hold at once.
    pub fn keeping(mut self, limits: &Limits) -> Self {
        for (axis, limit) in of(limits).into_iter().enumerate() {
            if self.kept_m_s[axis] != limit {
                self.kept_m_s[axis] = limit;
                (self.by_command_m_s[axis], self.by_mission_m_s[axis]) = (None, None);
            }
        }
        self
    }

    /// The same after a change.
    pub fn after(mut self, change: SpeedChange) -> Self {
        match change {
            SpeedChange::Mission { kind, speed_m_s } => {
                if let Some(axis) = axis(kind).filter(|_| speed_m_s != KEEP) {
                    self.by_mission_m_s[axis] = asked(speed_m_s);
                }
            }
            SpeedChange::InMission(in_mission) => self.in_mission = in_mission,
            SpeedChange::ForgetMission => self.by_mission_m_s = [None; 3],
            SpeedChange::ForgetCommands => self.by_command_m_s = [None; 3],
        }
        self
    }

    /// The same after a command: SPEED_TYPE, and m/s, −1 (as it is) or −2 (as the parameter has it). In a mission it goes before
    /// the mission's own, until that changes it again.
    ///
    /// # Errors
    /// [`Refusal::Denied`] of a type that there is not.
    pub fn commanded(mut self, kind: f64, speed_m_s: f64) -> Result<Self, Refusal> {
        let axis = axis(kind).ok_or_else(|| Refusal::denied(format!("No speed of type {kind}")))?;
        if speed_m_s != KEEP {
            self.by_command_m_s[axis] = asked(speed_m_s);
            self.by_mission_m_s[axis] = self.by_mission_m_s[axis].filter(|_| !self.in_mission);
        }
        Ok(self)
    }
}

/// What is asked for; `None` for the parameter's.
fn asked(speed_m_s: f64) -> Option<f64> {
    Some(speed_m_s).filter(|speed| *speed != DEFAULT)
}

fn of(limits: &Limits) -> [f64; 3] {
    [limits.speed_horizontal_m_s, limits.speed_up_m_s, limits.speed_down_m_s]
}

/// A configuration with other limits of speed.
pub fn with_speeds(mut configuration: Configuration, speeds_m_s: [f64; 3]) -> Configuration {
    let limits = &mut configuration.limits;
    [limits.speed_horizontal_m_s, limits.speed_up_m_s, limits.speed_down_m_s] = speeds_m_s;
    configuration
}

/// Place of a SPEED_TYPE: 0 (through the air) and 1 (over the ground) are horizontal, 2 is up, 3 is down.
fn axis(kind: f64) -> Option<usize> {
    [0.0, 1.0, 2.0, 3.0].iter().position(|number| *number == kind).map(|number| number.saturating_sub(1))
}
