//! The plans that the vehicle starts with.

use super::super::arming_obstacle::{ArmingSubject, joined};
use super::super::autostart::Step;
use super::super::notice::{Refusal, Severity};
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

    /// Starts the mission of a vehicle that was told to start by itself, or tells what is in the way.
    pub(super) fn autostart(&mut self) {
        let (time_us, armed) = (self.time_us(), self.is_armed());
        let in_mission_mode = self.mode() == Mode::Mission;
        let done = match self.machines.autostart.step(time_us, armed, in_mission_mode) {
            Step::None => Ok(()),
            Step::EnterMission => self.enter_mission(None),
            Step::Arm => self.start_or_wait(),
        };
        if let Err(refusal) = done {
            self.decided.say(Severity::Warning, refusal.to_string());
        }
    }

    /// Arms unless something speaks against it. The mode itself does not: whoever asked for the start has chosen it.
    fn start_or_wait(&mut self) -> Result<(), Refusal> {
        let mut obstacles = self.arming_obstacles();
        obstacles.retain(|obstacle| obstacle.subject != ArmingSubject::Mode);
        if obstacles.is_empty() {
            return self.arm(true).map(|()| self.machines.consent.give());
        }
        let (time_us, reason) = (self.time_us(), joined(&obstacles));
        if self.machines.autostart.waits_for(time_us, &reason) {
            self.decided.say(Severity::Warning, format!("Mission not started: {reason}"));
        }
        Ok(())
    }
}

fn plural(word: &str, count: usize) -> String {
    if count == 1 { word.to_owned() } else { format!("{word}s") }
}
