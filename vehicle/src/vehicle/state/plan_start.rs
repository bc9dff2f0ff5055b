//! The plans that the vehicle starts with.

use super::super::arming_obstacle::ArmingSubject;
use super::super::autostart::Step;
use super::super::notice::Severity;
use super::Vehicle;
use crate::mode::Mode;
use crate::plan::PlanKind;

impl Vehicle {
    /// Says which plans the vehicle has, and how the mission starts.
    pub(super) fn announce_plans(&mut self) {
        let identity = self.identity();
        let mission = self.plans.plans().get(PlanKind::Mission).items().len();
        // The first item of ArduPilot's missions is home.
        match mission.saturating_sub(usize::from(identity.is_ardupilot())) {
            0 => {}
            count => {
                let then = if self.machines.autostart.is_pending() {
                    "starting when ready".to_owned()
                } else if identity.is_ardupilot() && !self.conduct().auto_allows_arming() {
                    format!("arm, then start it in {} mode", identity.mode_name(Mode::Mission))
                } else {
                    format!("arm in {} mode to start", identity.mode_name(Mode::Mission))
                };
                self.decided
                    .say(Severity::Info, format!("Mission: {count} {}; {then}", plural("item", count)));
            }
        }
        if let zones @ 1.. = self.plans.zones().zones.len() {
            self.decided.say(Severity::Info, format!("Fence: {zones} {}", plural("zone", zones)));
        }
        if let points @ 1.. = self.plans.rally_points().len() {
            self.decided.say(Severity::Info, format!("Rally points: {points}"));
        }
    }

    /// Whether at most the mode itself speaks against arming: whoever asked for the start has chosen it.
    fn could_arm_in_another_mode(&self) -> bool {
        self.arming_obstacles().iter().all(|obstacle| obstacle.subject == ArmingSubject::Mode)
    }

    /// Starts the mission of a vehicle that was told to start by itself.
    pub(super) fn autostart(&mut self) {
        let (time_us, armed) = (self.time_us(), self.is_armed());
        let in_mission_mode = self.mode() == Mode::Mission;
        let done = match self.machines.autostart.step(time_us, armed, in_mission_mode) {
            Step::None => Ok(()),
            Step::EnterMission => self.enter_mission(None),
            Step::Arm if self.could_arm_in_another_mode() => {
                self.arm(true).map(|()| self.machines.consent.give())
            }
            Step::Arm => Ok(()),
        };
        if let Err(refusal) = done {
            self.decided.say(Severity::Warning, refusal.to_string());
        }
    }
}

fn plural(word: &str, count: usize) -> String {
    if count == 1 { word.to_owned() } else { format!("{word}s") }
}
