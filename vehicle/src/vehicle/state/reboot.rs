//! What a reboot keeps.

use super::super::settings::VehicleSettings;
use super::Vehicle;
use crate::fault::ScheduledFault;
use crate::plan::{Plan, PlanKind};

/// Of the options of missions.
const CLEARS_MISSION: u8 = 1;

impl Vehicle {
    /// What the vehicle boots with again: it was made of `settings`, and keeps its parameters and its plans. Everything else begins
    /// anew, where it began at first: the place, the battery, the mode, and what clients have broken. Faults that are scheduled for
    /// later come when they would have come.
    pub fn settings_of_reboot(&self, settings: &VehicleSettings) -> VehicleSettings {
        let mut configuration = self.kept_configuration();
        configuration.initial = settings.configuration.initial;
        configuration.environment = settings.configuration.environment;
        configuration.reference = settings.configuration.reference;
        let now_us = self.time_us();
        let later = |fault: &ScheduledFault| {
            let time_us = fault.time_us.checked_sub(now_us)?;
            Some(ScheduledFault { time_us, ..*fault })
        };
        let mut plans = self.plans().clone();
        if self.conduct().mission_options & CLEARS_MISSION != 0 {
            plans.set(PlanKind::Mission, Plan::default());
        }
        VehicleSettings {
            configuration,
            conduct: *self.conduct(),
            faults: settings.faults.iter().filter_map(later).collect(),
            plans,
            ..settings.clone()
        }
    }
}
