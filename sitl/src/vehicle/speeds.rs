//! Speeds that a mission asks for: they hold while it is flown, and go with it.

use quadrotor::Limits;

use super::super::notice::Severity;
use super::super::state::Vehicle;

/// Kinds of speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Horizontal,
    Up,
    Down,
}

const KINDS: [Kind; 3] = [Kind::Horizontal, Kind::Up, Kind::Down];

/// What the mission asks for, and what there was before, m/s.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Speeds {
    asked_m_s: [Option<f64>; 3],
    before_m_s: [Option<f64>; 3],
}

fn of(limits: &mut Limits, kind: Kind) -> &mut f64 {
    match kind {
        Kind::Horizontal => &mut limits.speed_horizontal_m_s,
        Kind::Up => &mut limits.speed_up_m_s,
        Kind::Down => &mut limits.speed_down_m_s,
    }
}

impl Vehicle {
    /// DO_CHANGE_SPEED: kinds 0 and 1 horizontally, 2 up, 3 down; −1 keeps it, −2 takes it back.
    pub(super) fn change_mission_speed(&mut self, kind: f64, speed_m_s: f64) {
        const KEEP: f64 = -1.0;
        let index = if kind < 2.0 { 0 } else { kind as usize - 1 };
        if speed_m_s == KEEP {
            return;
        }
        self.restore_speeds();
        if let Some(asked) = self.mission.speeds.asked_m_s.get_mut(index) {
            *asked = Some(speed_m_s).filter(|speed| *speed > 0.0);
        }
        self.apply_speeds();
    }

    /// Puts the mission's speeds in force.
    pub(super) fn apply_speeds(&mut self) {
        let mut configuration = *self.simulation.configuration();
        let mut speeds = self.mission.speeds;
        for (index, kind) in KINDS.into_iter().enumerate() {
            let limit = of(&mut configuration.limits, kind);
            if let (Some(asked), None) = (speeds.asked_m_s[index], speeds.before_m_s[index]) {
                speeds.before_m_s[index] = Some(*limit);
                *limit = asked;
            }
        }
        self.set_speeds(&configuration, speeds);
    }

    /// Takes the mission's speeds back, unless somebody has changed them meanwhile.
    pub(super) fn restore_speeds(&mut self) {
        let mut configuration = *self.simulation.configuration();
        let mut speeds = self.mission.speeds;
        for (index, kind) in KINDS.into_iter().enumerate() {
            let limit = of(&mut configuration.limits, kind);
            if let Some(before) =
                speeds.before_m_s[index].take().filter(|_| speeds.asked_m_s[index] == Some(*limit))
            {
                *limit = before;
            }
        }
        self.set_speeds(&configuration, speeds);
    }

    fn set_speeds(&mut self, configuration: &quadrotor::Configuration, speeds: Speeds) {
        if configuration.limits == self.simulation.configuration().limits {
            self.mission.speeds = speeds;
            return;
        }
        match self.reconfigure(configuration) {
            Ok(()) => self.mission.speeds = speeds,
            Err(error) => self.say(Severity::Warning, format!("Mission: speed not changed: {error}")),
        }
    }
}
