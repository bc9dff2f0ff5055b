//! The plans of the vehicle.

use nalgebra::Vector3;

use super::notice::Severity;
use super::state::Vehicle;
use crate::plan::{FaultCode, MissionItem, Plan, PlanFault, PlanKind, Plans, Site, check};

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
        Some(self.home_item())
    }

    /// Home as an item of a plan.
    pub fn home_item(&self) -> MissionItem {
        let place = self.frame.to_geodetic(&self.home.position_m);
        MissionItem::home([place.latitude_deg, place.longitude_deg, place.altitude_m])
    }

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
        check::plan(kind, &items, &self.site())?;
        match kind {
            PlanKind::Fence => self.take_fence(&items)?,
            PlanKind::Mission | PlanKind::Rally => self.check_places(kind, &items)?,
        }
        self.plans.set(kind, Plan::new(items));
        if kind == PlanKind::Mission {
            self.mission_has_changed(amended);
        } else if let Err(fault) = self.check_mission_places() {
            self.say(Severity::Warning, format!("Mission cannot be flown: {fault}"));
        }
        Ok(())
    }

    /// Refuses a mission that the fence of now forbids: it may have come after the mission.
    pub(super) fn check_mission_places(&self) -> Result<(), PlanFault> {
        self.check_places(PlanKind::Mission, self.plans.get(PlanKind::Mission).items())
    }

    /// Refuses items whose places the fence forbids, or the straight ways between them.
    fn check_places(&self, kind: PlanKind, items: &[MissionItem]) -> Result<(), PlanFault> {
        let site = self.site();
        let now = self.home.position_m;
        let mut before_m = now;
        // In ArduPilot's convention the first item is home, which is the vehicle's own.
        let first = if kind == PlanKind::Mission { self.first_mission_item() } else { 0 };
        for (index, item) in items.iter().enumerate().skip(first) {
            if kind == PlanKind::Mission && !check::is_flown_to(item) {
                continue;
            }
            let Some(place) = site.place(item) else { continue };
            let Some([x, y]) = place.horizontal_m else { continue };
            let place_m = Vector3::new(x, y, place.down_m.unwrap_or(now.z));
            // Where there are ways, each leads from the last place to the next.
            let way = self
                .fence()
                .filter(|_| kind == PlanKind::Mission)
                .and_then(|fence| fence.breach_between(&before_m, &place_m));
            before_m = place_m;
            if let Some(breach) = self.breach_at(&place_m).or(way) {
                return Err(PlanFault::of_item(index, FaultCode::Denied, breach.to_string()));
            }
        }
        Ok(())
    }
}
