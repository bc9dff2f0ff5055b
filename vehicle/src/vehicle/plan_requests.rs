//! Replacing the plans of the vehicle.

use super::notice::Severity;
use super::plans::{check_mission_places, check_places};
use super::state::Vehicle;
use crate::plan::{MissionItem, PlanFault, PlanKind, check};

impl Vehicle {
    /// Replaces a plan.
    ///
    /// # Errors
    /// [`PlanFault`]; the old plan stays then.
    pub fn set_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>) -> Result<(), PlanFault> {
        self.take_plan(kind, items, false)
    }

    /// Replaces a plan by one that goes on where the old one is.
    ///
    /// # Errors
    /// [`PlanFault`]; the old plan stays then.
    pub fn amend_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>) -> Result<(), PlanFault> {
        self.take_plan(kind, items, true)
    }

    fn take_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>, amended: bool) -> Result<(), PlanFault> {
        let site = self.site();
        check::plan(kind, &items, &site)?;
        if kind != PlanKind::Fence {
            check_places(&self.situation(), kind, &items)?;
        }
        self.plans.take(kind, items, &site)?;
        if kind == PlanKind::Mission {
            self.mission_has_changed(amended);
        } else if let Err(fault) = check_mission_places(&self.situation()) {
            self.decided.say(Severity::Warning, format!("Mission cannot be flown: {fault}"));
        }
        Ok(())
    }
}
