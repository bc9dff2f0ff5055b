//! The plans of the vehicle.

use nalgebra::Vector3;

use super::situation::Situation;
use crate::fence::Zones;
use crate::plan::{FaultCode, MissionItem, Plan, PlanFault, PlanKind, Plans, Site, check, zones};

/// The plans, and what the flight needs of them.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownPlans {
    plans: Plans,
    /// Of the fence plan, as they were when it was taken.
    zones: Zones,
}

impl KnownPlans {
    /// Takes plans that have been checked where they came from.
    pub fn new(plans: Plans, site: &Site) -> Self {
        let zones = zones(plans.get(PlanKind::Fence).items(), site).unwrap_or_default();
        Self { plans, zones }
    }

    /// As they were uploaded.
    pub fn plans(&self) -> &Plans {
        &self.plans
    }

    /// The zones of the fence.
    pub fn zones(&self) -> &Zones {
        &self.zones
    }

    /// Replaces a plan.
    ///
    /// # Errors
    /// [`PlanFault`] of a fence; the old one stays then.
    pub fn take(&mut self, kind: PlanKind, items: Vec<MissionItem>, site: &Site) -> Result<(), PlanFault> {
        if kind == PlanKind::Fence {
            self.zones = zones(&items, site)?;
        }
        self.plans.set(kind, Plan::new(items));
        Ok(())
    }
}

/// Number of the first item of a mission that is flown: in ArduPilot's convention the one before it is home.
pub fn first_mission_item(situation: &Situation) -> usize {
    usize::from(situation.identity.is_ardupilot())
}

/// Refuses a mission that the fence of now forbids: it may have come after the mission.
///
/// # Errors
/// As [`check_places`].
pub fn check_mission_places(situation: &Situation) -> Result<(), PlanFault> {
    check_places(situation, PlanKind::Mission, situation.plans.get(PlanKind::Mission).items())
}

/// Refuses items whose places the fence forbids, or the straight ways between them.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn check_places(situation: &Situation, kind: PlanKind, items: &[MissionItem]) -> Result<(), PlanFault> {
    let site = situation.site();
    let now = situation.home.position_m;
    let mut before_m = now;
    // In ArduPilot's convention the first item is home, which is the vehicle's own.
    let first = if kind == PlanKind::Mission { first_mission_item(situation) } else { 0 };
    for (index, item) in items.iter().enumerate().skip(first) {
        if kind == PlanKind::Mission && !check::is_flown_to(item) {
            continue;
        }
        let Some(place) = site.place(item) else { continue };
        let Some([x, y]) = place.horizontal_m else { continue };
        let place_m = Vector3::new(x, y, place.down_m.unwrap_or(now.z));
        // Where there are ways, each leads from the last place to the next.
        let way = situation
            .fence()
            .filter(|_| kind == PlanKind::Mission)
            .and_then(|fence| fence.breach_between(&before_m, &place_m));
        before_m = place_m;
        if let Some(breach) = situation.breach_at(&place_m).or(way) {
            return Err(PlanFault::of_item(index, FaultCode::Denied, breach.to_string()));
        }
    }
    Ok(())
}
