//! Speeds that hold for a while instead of the limits that the parameters set: those of a mission while it is flown, those of a
//! command until the rotors stop. The parameters stay as they are.

use quadrotor::{Configuration, ConfigurationError, Limits};

use super::notice::{Refusal, Severity};
use super::state::Vehicle;
use crate::plan::{ChangeSpeed, SpeedKind, SpeedTarget};

/// How limits of speed change.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(dead_code)] // Until the parts have moved.
pub enum SpeedChange {
    /// The mission asks for another one.
    Mission(ChangeSpeed),
    /// The mission's speeds hold while it is flown.
    InMission(bool),
    /// Another mission, or the same from its beginning, has asked for no speed yet.
    ForgetMission,
    /// With the flight ends what commands have asked for.
    ForgetCommands,
}

/// Limits of speed, m/s: horizontally, up, down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Speeds {
    /// Of the parameters.
    kept_m_s: [f64; 3],
    by_command_m_s: [Option<f64>; 3],
    by_mission_m_s: [Option<f64>; 3],
    /// Whether the mission is flown.
    in_mission: bool,
}

impl Speeds {
    /// The parameters' alone.
    pub fn new(limits: &Limits) -> Self {
        Self { kept_m_s: of(limits), by_command_m_s: [None; 3], by_mission_m_s: [None; 3], in_mission: false }
    }

    /// Parameters have been set: those that have changed hold at once.
    fn keep(&mut self, limits: &Limits) {
        for (axis, limit) in of(limits).into_iter().enumerate() {
            if self.kept_m_s[axis] != limit {
                self.kept_m_s[axis] = limit;
                (self.by_command_m_s[axis], self.by_mission_m_s[axis]) = (None, None);
            }
        }
    }

    fn in_force(&self) -> [f64; 3] {
        core::array::from_fn(|axis| {
            let by_mission = self.by_mission_m_s[axis].filter(|_| self.in_mission);
            by_mission.or(self.by_command_m_s[axis]).unwrap_or(self.kept_m_s[axis])
        })
    }
}

fn of(limits: &Limits) -> [f64; 3] {
    [limits.speed_horizontal_m_s, limits.speed_up_m_s, limits.speed_down_m_s]
}

/// A configuration with other limits of speed.
fn with(mut configuration: Configuration, speeds_m_s: [f64; 3]) -> Configuration {
    let limits = &mut configuration.limits;
    [limits.speed_horizontal_m_s, limits.speed_up_m_s, limits.speed_down_m_s] = speeds_m_s;
    configuration
}

/// Index of a kind of speed.
fn axis(kind: SpeedKind) -> usize {
    match kind {
        SpeedKind::Horizontal => 0,
        SpeedKind::Up => 1,
        SpeedKind::Down => 2,
    }
}

/// What a change asks for; `None` if it changes nothing.
fn asked(change: &ChangeSpeed) -> Option<(usize, Option<f64>)> {
    match change.target {
        SpeedTarget::Keep => None,
        SpeedTarget::Default => Some((axis(change.kind), None)),
        SpeedTarget::Limit(limit_m_s) => Some((axis(change.kind), Some(limit_m_s))),
    }
}

impl Vehicle {
    /// The parameters of the closed loop, whatever speeds hold for now.
    pub fn kept_configuration(&self) -> Configuration {
        with(*self.simulation.configuration(), self.speeds.kept_m_s)
    }

    /// Changes the closed loop's parameters. Tunable ones change in flight, without a bump; the others only while it is
    /// disarmed on the ground.
    ///
    /// # Errors
    /// [`ConfigurationError`]; nothing has changed then.
    pub fn reconfigure(&mut self, kept: &Configuration) -> Result<(), ConfigurationError> {
        let mut speeds = self.speeds;
        speeds.keep(&kept.limits);
        self.configure(&with(*kept, speeds.in_force()))?;
        self.speeds = speeds;
        Ok(())
    }

    /// Changes a limit of speed until the rotors stop. In a mission it goes before the mission's own, until that changes it again.
    ///
    /// # Errors
    /// [`Refusal`] of a speed that there is not.
    pub fn change_speed(&mut self, change: &ChangeSpeed) -> Result<(), Refusal> {
        let Some((axis, limit_m_s)) = asked(change) else { return Ok(()) };
        let mut speeds = self.speeds;
        speeds.by_command_m_s[axis] = limit_m_s;
        speeds.by_mission_m_s[axis] = speeds.by_mission_m_s[axis].filter(|_| !speeds.in_mission);
        self.use_speeds(speeds).map_err(|error| Refusal::denied(error.to_string()))
    }

    /// Changes a limit of speed while the mission is flown.
    pub(super) fn change_mission_speed(&mut self, change: &ChangeSpeed) {
        let Some((axis, limit_m_s)) = asked(change) else { return };
        let mut speeds = self.speeds;
        speeds.by_mission_m_s[axis] = limit_m_s;
        self.use_mission_speeds(speeds);
    }

    /// The mission's speeds hold while it is flown.
    pub(super) fn apply_mission_speeds(&mut self, in_mission: bool) {
        self.use_mission_speeds(Speeds { in_mission, ..self.speeds });
    }

    /// Another mission, or the same from its beginning, has asked for no speed yet.
    pub(super) fn forget_mission_speeds(&mut self) {
        self.use_mission_speeds(Speeds { by_mission_m_s: [None; 3], ..self.speeds });
    }

    /// With the flight ends what commands have asked for.
    pub(super) fn forget_command_speeds(&mut self) {
        self.use_mission_speeds(Speeds { by_command_m_s: [None; 3], ..self.speeds });
    }

    fn use_mission_speeds(&mut self, speeds: Speeds) {
        if let Err(error) = self.use_speeds(speeds) {
            self.say(Severity::Warning, format!("Speed not changed: {error}"));
        }
    }

    fn use_speeds(&mut self, speeds: Speeds) -> Result<(), ConfigurationError> {
        let present = *self.simulation.configuration();
        let configuration = with(present, speeds.in_force());
        if configuration.limits != present.limits {
            self.configure(&configuration)?;
            self.replan_leg();
        }
        self.speeds = speeds;
        Ok(())
    }
}
