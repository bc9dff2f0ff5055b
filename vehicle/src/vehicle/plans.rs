//! The plans of the vehicle, and what the fence forbids of them.

use nalgebra::Vector3;

use super::ground_way::{GroundWay, leads_along_ground};
use super::situation::Situation;
use super::spline::{Bend, curve_places_m};
use crate::fence::{Breach, Fence, Zones};
use crate::plan::step::Navigate;
use crate::plan::{
    FaultCode, MissionItem, Place, Plan, PlanFault, PlanKind, Plans, Program, Site, compile, zones,
};
use crate::world::FARTHEST_M;

/// The plans as they were uploaded, and what the flight needs of fence and rally points. The steps of the mission are the
/// mission's own.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownPlans {
    plans: Plans,
    /// Of the fence plan, as they were when it was taken.
    zones: Zones,
    rally_points: Vec<Place>,
    /// How often one of them has been replaced.
    revision: u32,
}

impl KnownPlans {
    /// Takes plans that have been checked where they came from.
    pub fn new(plans: Plans, site: &Site) -> Self {
        let zones = zones(plans.get(PlanKind::Fence).items(), site).unwrap_or_default();
        let rally_points = compile::rally_points(plans.get(PlanKind::Rally).items(), site);
        Self { plans, zones, rally_points, revision: 0 }
    }

    /// As they were uploaded.
    pub fn plans(&self) -> &Plans {
        &self.plans
    }

    /// A number that changes with each plan that is replaced.
    pub fn revision(&self) -> u32 {
        self.revision
    }

    fn set(&mut self, kind: PlanKind, items: Vec<MissionItem>) {
        self.plans.set(kind, Plan::new(items));
        self.revision = self.revision.wrapping_add(1);
    }

    /// The zones of the fence.
    pub fn zones(&self) -> &Zones {
        &self.zones
    }

    /// The rally points.
    pub fn rally_points(&self) -> &[Place] {
        &self.rally_points
    }

    /// Replaces the fence.
    ///
    /// # Errors
    /// [`PlanFault`]; the old one stays then.
    pub fn take_fence(&mut self, items: Vec<MissionItem>, site: &Site) -> Result<(), PlanFault> {
        self.zones = zones(&items, site)?;
        self.set(PlanKind::Fence, items);
        Ok(())
    }

    /// Replaces the rally points.
    pub fn take_rally_points(&mut self, items: Vec<MissionItem>, points: Vec<Place>) {
        self.rally_points = points;
        self.set(PlanKind::Rally, items);
    }

    /// Replaces the items of the mission.
    pub fn take_mission(&mut self, items: Vec<MissionItem>) {
        self.set(PlanKind::Mission, items);
    }
}

/// Refuses a mission whose places the fence of now forbids, or the ways between them: the fence may have come after the mission.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn check_way(situation: &Situation, program: &Program) -> Result<(), PlanFault> {
    let Some(fence) = situation.fence().filter(Fence::bounds) else { return Ok(()) };
    let mut before_m = situation.home.position_m;
    for (index, way_m) in planned_ways_m(situation, program) {
        let Some(place_m) = way_m.last().copied() else { continue };
        let breach = fence.breach(&place_m).or_else(|| breach_on(&fence, &before_m, &way_m));
        before_m = place_m;
        refuse(index, breach)?;
    }
    Ok(())
}

/// What of a fence forbids a way on from a place. Where that is forbidden itself, it has to be left anyway.
fn breach_on(fence: &Fence, from_m: &Vector3<f64>, way_m: &[Vector3<f64>]) -> Option<Breach> {
    let begins_within = fence.breach(from_m).is_none();
    let mut before_m = from_m;
    way_m.iter().find_map(|place_m| {
        let at = if begins_within { fence.breach(place_m) } else { None };
        let breach = at.or_else(|| fence.breach_between(before_m, place_m));
        before_m = place_m;
        breach
    })
}

/// The number of each step that leads to a place, and the places on the way there, the last one at its end, NED, m: what lies between
/// them is straight, or nearly so.
fn planned_ways_m(situation: &Situation, program: &Program) -> Vec<(usize, Vec<Vector3<f64>>)> {
    let mut ways_m = Vec::new();
    let mut before_m = situation.home.position_m;
    let mut index = program.first();
    while index < program.len() {
        let curve_m = spline_places_m(situation, program, index);
        let mut next = index + curve_m.len();
        for (piece, way_m) in curve_places_m(before_m, &curve_m, Bend::Wide).enumerate() {
            ways_m.push((index + piece, way_m));
        }
        if curve_m.is_empty() {
            next = index + 1;
            let step = program.navigate(index);
            let place = step.as_ref().and_then(Navigate::place);
            if let Some((step, place_m)) = step.zip(place.and_then(|place| place_m(situation, place))) {
                let way_m = if leads_along_ground(&step, situation.terrain) {
                    GroundWay::new(before_m, place_m).places_m(&before_m, situation.terrain).collect()
                } else {
                    vec![place_m]
                };
                ways_m.push((index, way_m));
            }
        }
        before_m = ways_m.last().and_then(|(_, way_m)| way_m.last()).copied().unwrap_or(before_m);
        index = next;
    }
    ways_m
}

/// The places of the spline waypoints that follow one another from a step on, NED, m, up to the first at which the vehicle rests.
fn spline_places_m(situation: &Situation, program: &Program, first: usize) -> Vec<Vector3<f64>> {
    let mut places_m = Vec::new();
    for index in first..program.len() {
        let Some(Navigate::Spline { place, hold_s }) = program.navigate(index) else { break };
        let Some(place_m) = place_m(situation, &place) else { break };
        places_m.push(place_m);
        if hold_s > 0.0 || !program.continues_after(index) {
            break;
        }
    }
    places_m
}

/// Refuses a mission that cannot be flown to its end: places that are too far away, or below the ground.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn check_reach(situation: &Situation, program: &Program) -> Result<(), PlanFault> {
    for index in program.first()..program.len() {
        let Some(step) = program.navigate(index) else { continue };
        let Some(place) = step.place() else { continue };
        if let Some([north, east]) = place.horizontal_m {
            let distance_m = libm::hypot(north, east);
            if distance_m > FARTHEST_M {
                let reason = format!(
                    "the place is {:.0} km away; allowed up to {:.0} km: move it, or start the vehicle nearer to it",
                    distance_m / 1e3,
                    FARTHEST_M / 1e3
                );
                let parameter = if north.abs() > east.abs() { 5 } else { 6 };
                return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(parameter), reason));
            }
        }
        // A landing ends where the ground is.
        let here_m = situation.outputs.position_m;
        let ground_z_m = situation.terrain.z_m(place.horizontal_m.unwrap_or([here_m.x, here_m.y]));
        let below_m = place.down_m(situation.home.position_m.z).map(|down_m| down_m - ground_z_m);
        let below_m = below_m.filter(|below_m| *below_m > 0.0);
        if let Some(below_m) = below_m.filter(|_| !matches!(step, Navigate::Land { .. })) {
            let reason = format!("the place is {below_m:.1} m below the ground: raise it");
            return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(7), reason));
        }
    }
    Ok(())
}

/// Refuses rally points that the fence forbids.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn check_rally_points(situation: &Situation, points: &[Place]) -> Result<(), PlanFault> {
    for (index, place) in points.iter().enumerate() {
        let Some(place_m) = place_m(situation, place) else { continue };
        refuse(index, situation.breach_at(&place_m))?;
    }
    Ok(())
}

/// A place, NED, m, at the height of home if it names none; `None` if it is wherever the vehicle is then.
fn place_m(situation: &Situation, place: &Place) -> Option<Vector3<f64>> {
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
