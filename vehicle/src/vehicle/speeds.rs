//! Speeds that hold for a while instead of the limits that the parameters set: those of a mission while it is flown, those of a
//! command until the rotors stop. The parameters stay as they are.

use quadrotor::{Configuration, Limits};

use super::speed_choice::SpeedChoice;
use crate::plan::{ChangeSpeed, SpeedKind, SpeedTarget};

/// Places of the limits upwards and downwards.
const UP: usize = 1;
const DOWN: usize = 2;
/// The closed loop has no limits of speed below this, m/s.
pub const LEAST_SPEED_M_S: f64 = 0.1;

/// How limits of speed change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedChange {
    /// The mission asks for another one.
    Mission(ChangeSpeed),
    /// The mission's speeds hold while it is flown.
    InMission(bool),
    /// Another mission, or the same from its beginning, has asked for no speed yet.
    ForgetMission,
    /// With the flight ends what commands have asked for.
    ForgetCommands,
    /// The way home has a horizontal speed of its own, m/s, until another command or its end.
    Return(Option<f64>),
    /// A landing may sink with a speed of its own, m/s, until its end.
    Landing(Option<f64>),
    /// Something else is flown.
    Choose(SpeedChoice),
}

/// Limits of speed, m/s: horizontally, up, down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Of the parameters.
    kept_m_s: [f64; 3],
    by_command_m_s: [Option<f64>; 3],
    by_mission_m_s: [Option<f64>; 3],
    /// Of the way home, horizontally.
    by_return_m_s: Option<f64>,
    /// Of a landing, down.
    by_landing_m_s: Option<f64>,
    /// Whether the mission is flown.
    in_mission: bool,
    /// Largest ones in all modes, where they have been set.
    most_m_s: [Option<f64>; 3],
    chosen: SpeedChoice,
}

impl Speeds {
    /// The parameters' alone.
    pub fn new(limits: &Limits) -> Self {
        let (most_m_s, chosen) = ([None; 3], SpeedChoice::default());
        Self {
            most_m_s,
            chosen,
            kept_m_s: of(limits),
            by_command_m_s: [None; 3],
            by_mission_m_s: [None; 3],
            by_return_m_s: None,
            by_landing_m_s: None,
            in_mission: false,
        }
    }

    /// Limits of the parameters, m/s.
    pub fn kept_m_s(&self) -> [f64; 3] {
        self.kept_m_s
    }

    /// Limits that hold, m/s.
    pub fn in_force(&self) -> [f64; 3] {
        core::array::from_fn(|axis| {
            let by_mission = self.by_mission_m_s[axis].filter(|_| self.in_mission);
            let by_return = self.by_return_m_s.filter(|_| axis == 0);
            let limit_m_s =
                by_mission.or(by_return).or(self.by_command_m_s[axis]).unwrap_or(self.kept_m_s[axis]);
            let most_m_s = self.most_m_s[axis].map(|most_m_s| most_m_s.max(LEAST_SPEED_M_S));
            // Who leads may ask for all that there is.
            let limit_m_s = most_m_s.filter(|_| self.chosen.is_led).unwrap_or(limit_m_s);
            let limit_m_s = self.chosen.sticks_m_s.map_or(limit_m_s, |sticks| limit_m_s.max(sticks[axis]));
            let by_takeoff = self.chosen.takeoff_m_s.filter(|_| axis == UP);
            let limit_m_s =
                by_takeoff.map_or(limit_m_s, |takeoff_m_s| limit_m_s.min(takeoff_m_s.max(LEAST_SPEED_M_S)));
            let by_landing = self.by_landing_m_s.filter(|_| axis == DOWN);
            let limit_m_s = by_landing.map_or(limit_m_s, |landing_m_s| limit_m_s.max(landing_m_s));
            most_m_s.map_or(limit_m_s, |most_m_s| limit_m_s.min(most_m_s))
        })
    }

    /// The same within others that hold in all modes, m/s.
    pub fn within(self, most_m_s: [Option<f64>; 3]) -> Self {
        Self { most_m_s, ..self }
    }

    /// What they are chosen for.
    pub fn chosen(&self) -> SpeedChoice {
        self.chosen
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
            SpeedChange::Mission(change) => {
                if let Some((axis, limit_m_s)) = asked(&change) {
                    self.by_mission_m_s[axis] = limit_m_s;
                }
            }
            SpeedChange::InMission(in_mission) => self.in_mission = in_mission,
            SpeedChange::ForgetMission => self.by_mission_m_s = [None; 3],
            SpeedChange::ForgetCommands => self.by_command_m_s = [None; 3],
            SpeedChange::Return(speed_m_s) => self.by_return_m_s = speed_m_s,
            SpeedChange::Landing(speed_m_s) => self.by_landing_m_s = speed_m_s,
            SpeedChange::Choose(chosen) => self.chosen = chosen,
        }
        self
    }

    /// The same after a command. In a mission it goes before the mission's own, until that changes it again.
    pub fn commanded(mut self, change: &ChangeSpeed) -> Self {
        if let Some((axis, limit_m_s)) = asked(change) {
            self.by_command_m_s[axis] = limit_m_s;
            self.by_mission_m_s[axis] = self.by_mission_m_s[axis].filter(|_| !self.in_mission);
            self.by_return_m_s = self.by_return_m_s.filter(|_| axis != 0);
        }
        self
    }
}

/// Place of the limit that changes, and what is asked for: m/s, or `None` for the parameter's. Nothing if it stays as it is.
fn asked(change: &ChangeSpeed) -> Option<(usize, Option<f64>)> {
    let axis = match change.kind {
        SpeedKind::Horizontal => 0,
        SpeedKind::Up => UP,
        SpeedKind::Down => DOWN,
    };
    match change.target {
        SpeedTarget::Keep => None,
        SpeedTarget::Default => Some((axis, None)),
        SpeedTarget::Limit(limit_m_s) => Some((axis, Some(limit_m_s))),
    }
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

#[cfg(test)]
mod tests {
    use quadrotor::Limits;

    use super::{SpeedChange, SpeedChoice, Speeds};
    use crate::plan::{ChangeSpeed, SpeedKind, SpeedTarget};

    /// PX4: automatic flight is never faster than the largest speeds; who leads by sticks or set-points may fly all of them.
    #[test]
    fn the_largest_speeds_bound_all_others() {
        let limits =
            Limits { speed_horizontal_m_s: 8.0, speed_up_m_s: 4.0, speed_down_m_s: 3.0, ..Limits::default() };
        let speeds = Speeds::new(&limits);
        assert_eq!(speeds.in_force(), [8.0, 4.0, 3.0]);
        let bounded = speeds.within([Some(5.0), Some(9.0), Some(0.0)]);
        assert_eq!(bounded.in_force(), [5.0, 4.0, 0.1]);
        let faster = ChangeSpeed { kind: SpeedKind::Horizontal, target: SpeedTarget::Limit(7.0) };
        assert_eq!(bounded.commanded(&faster).in_force()[0], 5.0, "a command is bounded, too");
        let led = SpeedChoice { is_led: true, ..SpeedChoice::default() };
        assert_eq!(bounded.after(SpeedChange::Choose(led)).in_force(), [5.0, 9.0, 0.1]);
        assert_eq!(speeds.after(SpeedChange::Choose(led)).in_force(), [8.0, 4.0, 3.0], "nothing is set");
        let takes_off = SpeedChoice { takeoff_m_s: Some(1.5), ..SpeedChoice::default() };
        assert_eq!(bounded.after(SpeedChange::Choose(takes_off)).in_force(), [5.0, 1.5, 0.1]);
    }

    /// ArduPilot: the speeds of missions do not bound those of the pilot, who leaves room for the others.
    #[test]
    fn a_pilot_may_be_faster_than_a_mission() {
        let limits =
            Limits { speed_horizontal_m_s: 8.0, speed_up_m_s: 4.0, speed_down_m_s: 3.0, ..Limits::default() };
        let piloted = SpeedChoice { sticks_m_s: Some([12.5, 2.5, 5.0]), ..SpeedChoice::default() };
        let speeds = Speeds::new(&limits).after(SpeedChange::Choose(piloted));
        assert_eq!(speeds.in_force(), [12.5, 4.0, 5.0]);
        assert_eq!(speeds.after(SpeedChange::Choose(SpeedChoice::default())).in_force(), [8.0, 4.0, 3.0]);
    }
}
