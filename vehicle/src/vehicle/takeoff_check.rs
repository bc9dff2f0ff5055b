//! ArduPilot's check of the rotors before a takeoff: their idling speed, as its simulated motor controllers tell it, must be within
//! TKOFF_RPM_MIN and TKOFF_RPM_MAX.

use serde::{Deserialize, Serialize};

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use crate::mode::Mode;

/// A throttle above this share of its way wants to take off.
const WANTS_UP: f64 = 0.5;
/// So long, µs, passes between two reports.
const TOLD_US: u64 = 5_000_000;

/// Parameters of the check, 1/min; 0: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct TakeoffCheckSettings {
    /// Least speed (TKOFF_RPM_MIN).
    pub least: u16,
    /// Largest speed (TKOFF_RPM_MAX).
    pub most: u16,
    /// Speed of the idling rotors (SIM_ESC_ARM_RPM).
    pub idling: u16,
}

impl TakeoffCheckSettings {
    fn fails(&self) -> bool {
        self.least > 0 && self.idling < self.least || self.most > 0 && self.idling > self.most
    }
}

/// What has been told of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct TakeoffCheck {
    told_us: Option<u64>,
}

impl TakeoffCheck {
    /// Whether the vehicle must stay on the ground; says so to a pilot who wants to take off.
    pub fn blocks(&mut self, situation: &Situation, proposal: &mut Proposal) -> bool {
        let blocked = situation.identity.is_ardupilot()
            && situation.landed
            && situation.mode != Mode::Throw
            && situation.conduct.takeoff_check.fails();
        if !blocked {
            self.told_us = None;
            return false;
        }
        let pulls = situation.pilot.sticks.is_some_and(|sticks| sticks.throttle() > WANTS_UP);
        let wants = pulls || matches!(situation.mode, Mode::Takeoff | Mode::Mission);
        let fresh = self.told_us.is_none_or(|told_us| situation.time_us >= told_us + TOLD_US);
        if wants && fresh {
            self.told_us = Some(situation.time_us);
            proposal.say(Severity::Critical, "Takeoff blocked: ESC RPM out of range");
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::{TakeoffCheck, TakeoffCheckSettings};
    use crate::identity::Identity;
    use crate::vehicle::scene::{Scene, said};
    use crate::vehicle::sticks::Sticks;

    #[test]
    fn rotors_that_idle_too_slowly_or_too_fast_stay_on_the_ground() {
        for (least, most, idling, blocked) in
            [(0, 0, 0, false), (1000, 0, 500, true), (1, 3, 500, true), (100, 1000, 500, false)]
        {
            let mut scene = Scene::on_the_ground();
            scene.identity = Identity::ArduPilot;
            scene.conduct.takeoff_check = TakeoffCheckSettings { least, most, idling };
            let mut check = TakeoffCheck::default();
            let mut found = false;
            scene.pilot.sticks = Some(Sticks { up: 0.4, ..Sticks::default() });
            let requests = scene.show(|situation, proposal| found = check.blocks(situation, proposal));
            assert_eq!(found, blocked, "{least} {most}");
            assert_eq!(said(&requests) == ["Takeoff blocked: ESC RPM out of range"], blocked);
        }
    }
}
