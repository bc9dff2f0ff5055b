//! The plans of the vehicle.

use nalgebra::Vector3;

use super::notice::Severity;
use super::situation::Situation;
use super::state::Vehicle;
use crate::fence::Breach;
use crate::plan::step::Navigate;
use crate::plan::{
    FaultCode, MissionItem, Place, Plan, PlanFault, PlanKind, Plans, Program, Site, check, compile,
};

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
        let site = self.site();
        check::plan(kind, &items, &site)?;
        match kind {
            PlanKind::Fence => self.take_fence(&items)?,
            PlanKind::Mission => {
                let program = compile::mission(&items, &site);
                check_way(&self.situation(), &program)?;
                self.plans.set(kind, Plan::new(items));
                self.consult(|parts, situation, proposal| {
                    parts.mission.replace(situation, proposal, program, amended);
                });
                return Ok(());
            }
            PlanKind::Rally => {
                let points = compile::rally_points(&items, &site);
                check_rally_points(&self.situation(), &points)?;
                self.rally_points = points;
            }
        }
        self.plans.set(kind, Plan::new(items));
        if let Err(fault) = self.check_mission_places() {
            self.say(Severity::Warning, format!("Mission cannot be flown: {fault}"));
        }
        Ok(())
    }

    /// Refuses a mission that the fence of now forbids: it may have come after the mission.
    pub(super) fn check_mission_places(&self) -> Result<(), PlanFault> {
        check_way(&self.situation(), self.mission.program())
    }
}

/// Refuses steps whose places the fence forbids, or the straight ways between them.
///
/// # Errors
/// [`PlanFault`] that names the step.
pub fn check_way(situation: &Situation, program: &Program) -> Result<(), PlanFault> {
    let mut before_m = situation.home.position_m;
    // In ArduPilot's convention the first item is home, which is the vehicle's own.
    for index in program.first()..program.len() {
        let step = program.navigate(index);
        let place = step.as_ref().and_then(Navigate::place);
        let Some(place_m) = place.and_then(|place| place_to_check_m(situation, place)) else { continue };
        let way = || situation.fence().and_then(|fence| fence.breach_between(&before_m, &place_m));
        let breach = situation.breach_at(&place_m).or_else(way);
        before_m = place_m;
        refuse(index, breach)?;
    }
    Ok(())
}

/// Refuses rally points that the fence forbids.
///
/// # Errors
/// [`PlanFault`] that names the point.
pub fn check_rally_points(situation: &Situation, points: &[Place]) -> Result<(), PlanFault> {
    for (index, place) in points.iter().enumerate() {
        let Some(place_m) = place_to_check_m(situation, place) else { continue };
        refuse(index, situation.breach_at(&place_m))?;
    }
    Ok(())
}

/// A place, NED, m, at the height of home if it names none; `None` if it is wherever the vehicle is then.
fn place_to_check_m(situation: &Situation, place: &Place) -> Option<Vector3<f64>> {
    let home_z_m = situation.home.position_m.z;
    let [x, y] = place.horizontal_m?;
    Some(Vector3::new(x, y, place.down_m(home_z_m).unwrap_or(home_z_m)))
}

fn refuse(index: usize, breach: Option<Breach>) -> Result<(), PlanFault> {
    match breach {
        Some(breach) => Err(PlanFault::of_item(index, FaultCode::Denied, breach.to_string())),
        None => Ok(()),
    }
}
