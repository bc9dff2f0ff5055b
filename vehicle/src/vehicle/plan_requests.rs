//! Replacing the plans of the vehicle.

use super::notice::Severity;
use super::plans::{check_rally_points, check_way};
use super::state::Vehicle;
use crate::plan::{MissionItem, PlanFault, PlanKind, Site, check, compile};

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
        match kind {
            PlanKind::Mission => return self.take_mission(items, &site, amended),
            PlanKind::Fence => self.plans.take_fence(items, &site)?,
            PlanKind::Rally => {
                let points = compile::rally_points(&items, &site);
                check_rally_points(&self.situation(), &points)?;
                self.plans.take_rally_points(items, points);
            }
        }
        if let Err(fault) = check_way(&self.situation(), self.machines.mission.program()) {
            self.decided.say(Severity::Warning, format!("Mission cannot be flown: {fault}"));
        }
        Ok(())
    }

    fn take_mission(&mut self, items: Vec<MissionItem>, site: &Site, amended: bool) -> Result<(), PlanFault> {
        let program = compile::mission(&items, site);
        check_way(&self.situation(), &program)?;
        self.plans.take_mission(items);
        self.consult(|parts, situation, proposal| {
            parts.mission.replace(situation, proposal, program, amended);
        });
        Ok(())
    }
}
