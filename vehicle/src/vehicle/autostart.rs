//! Starting the mission without a pilot.

/// How often the obstacles to arming are looked at, µs.
const PERIOD_US: u64 = 100_000;

/// What keeps the vehicle from starting is told again after so long, µs.
const TOLD_US: u64 = 5_000_000;
/// Instruments need so long, µs, to find their place: they are waited for without a word.
const PATIENCE_US: u64 = 3_000_000;

/// Whether the mission is still to be started.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Autostart {
    stage: Stage,
    /// What was told last to be in the way, and when, µs.
    told: Option<(String, u64)>,
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
        Self { stage: if asked { Stage::Begin } else { Stage::Idle }, told: None }
    }

    /// Whether the mission is still to be started.
    pub fn is_pending(&self) -> bool {
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

    /// Takes in what is in the way at a time, µs; returns whether to tell it: when it has changed, and again after a while.
    pub fn waits_for(&mut self, time_us: u64, reason: &str) -> bool {
        let known =
            self.told.as_ref().is_some_and(|(told, at_us)| told == reason && time_us < at_us + TOLD_US);
        if known || time_us < PATIENCE_US {
            return false;
        }
        self.told = Some((reason.to_owned(), time_us));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::{Autostart, PATIENCE_US, PERIOD_US, Step, TOLD_US};

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

    #[test]
    fn what_is_in_the_way_is_told_when_it_changes_and_again_after_a_while() {
        let mut autostart = Autostart::new(true);
        let mut told = |time_us, reason| autostart.waits_for(time_us, reason);
        assert!(!told(0, "no GPS"), "it may come");
        assert!(told(PATIENCE_US, "no GPS"));
        assert!(!told(PATIENCE_US + PERIOD_US, "no GPS"));
        assert!(told(PATIENCE_US + 2 * PERIOD_US, "battery"));
        assert!(!told(PATIENCE_US + 2 * PERIOD_US + TOLD_US - 1, "battery"));
        assert!(told(PATIENCE_US + 2 * PERIOD_US + TOLD_US, "battery"));
    }
}
