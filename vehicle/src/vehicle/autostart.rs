//! Starting the mission without a pilot.

/// How often the obstacles to arming are looked at, µs.
const PERIOD_US: u64 = 100_000;

/// Whether the mission is still to be started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Autostart {
    stage: Stage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Stage {
    /// Not asked for, or done.
    #[default]
    Idle,
    /// The mode of missions is still to be entered.
    Begin,
    /// Arms as soon as nothing speaks against it.
    Arm,
}

/// What is to be done now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Nothing.
    None,
    /// Enter the mode of missions.
    EnterMission,
    /// Arm, if nothing speaks against it.
    Arm,
}

impl Autostart {
    /// Asked for or not.
    pub fn new(asked: bool) -> Self {
        Self { stage: if asked { Stage::Begin } else { Stage::Idle } }
    }

    /// Whether the mission is still to be started.
    pub fn is_pending(self) -> bool {
        self.stage != Stage::Idle
    }

    /// One tick of a vehicle that is armed or not, and in the mode of missions or not. A pilot who arms or chooses another mode takes
    /// over.
    pub fn step(&mut self, time_us: u64, armed: bool, in_mission_mode: bool) -> Step {
        match self.stage {
            Stage::Idle => Step::None,
            Stage::Begin => {
                self.stage = Stage::Arm;
                Step::EnterMission
            }
            Stage::Arm if armed || !in_mission_mode => {
                self.stage = Stage::Idle;
                Step::None
            }
            Stage::Arm if time_us.is_multiple_of(PERIOD_US) => Step::Arm,
            Stage::Arm => Step::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Autostart, PERIOD_US, Step};

    #[test]
    fn it_enters_the_mode_then_arms_until_it_is_armed() {
        let mut autostart = Autostart::new(true);
        assert_eq!(autostart.step(0, false, false), Step::EnterMission);
        assert_eq!(autostart.step(PERIOD_US / 2, false, true), Step::None);
        assert_eq!(autostart.step(PERIOD_US, false, true), Step::Arm);
        assert_eq!(autostart.step(2 * PERIOD_US, false, true), Step::Arm);
        assert_eq!(autostart.step(3 * PERIOD_US, true, true), Step::None);
        assert!(!autostart.is_pending());
    }

    #[test]
    fn a_pilot_takes_over() {
        let mut autostart = Autostart::new(true);
        autostart.step(0, false, false);
        assert_eq!(autostart.step(PERIOD_US, false, false), Step::None);
        assert!(!autostart.is_pending());
        assert_eq!(Autostart::new(false).step(PERIOD_US, false, true), Step::None);
    }
}
