//! The plans of the vehicle.

use super::state::Vehicle;
use crate::plan::{MissionItem, Plan, PlanFault, PlanKind, Plans, Site, check, command, frame};

impl Vehicle {
    /// Its plans.
    pub fn plans(&self) -> &Plans {
        &self.plans
    }

    /// What the places of plans refer to.
    pub fn site(&self) -> Site {
        Site { identity: self.identity, frame: self.frame, home_m: self.home.position_m }
    }

    /// An item as a download shows it: in ArduPilot's convention the first one of a mission is home.
    pub fn plan_item(&self, kind: PlanKind, index: usize) -> Option<MissionItem> {
        let item = *self.plans.get(kind).items().get(index)?;
        if kind != PlanKind::Mission || index > 0 || !self.identity.is_ardupilot() {
            return Some(item);
        }
        let place = self.frame.to_geodetic(&self.home.position_m);
        Some(MissionItem {
            frame: frame::GLOBAL,
            command: command::NAV_WAYPOINT,
            parameters: [0.0; 4],
            position: [place.latitude_deg, place.longitude_deg, place.altitude_m],
            autocontinue: true,
        })
    }

    /// Replaces a plan.
    ///
    /// # Errors
    /// [`PlanFault`]; the old plan stays then.
    pub fn set_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>) -> Result<(), PlanFault> {
        check::plan(kind, &items, &self.site())?;
        self.plans.set(kind, Plan::new(items));
        Ok(())
    }
}
