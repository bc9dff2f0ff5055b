//! The plans of the vehicle, and what the fence forbids of them.

use nalgebra::Vector3;

use super::mission::{Beginning, PlannedLeg, height_without_m, planned_way};
use super::situation::Situation;
use crate::fence::{Breach, Fence, Zones};
use crate::plan::step::Navigate;
use crate::plan::{
    FaultCode, MissionItem, Place, Plan, PlanFault, PlanKind, Plans, Program, Site, command, compile, zones,
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

    /// Whether the fence moves with home.
    pub fn fence_moves_with_home(&self) -> bool {
        let items = self.plans.get(PlanKind::Fence).items();
        items.iter().any(|item| item.command == command::NAV_FENCE_HOME_CIRCLE_INCLUSION)
    }

    /// Home has moved, and what of the fence lies around it.
    pub fn follow_home(&mut self, site: &Site) {
        let items = self.plans.get(PlanKind::Fence).items();
        match zones(items, site) {
            Ok(zones) => self.zones = zones,
            Err(fault) => tracing::warn!(?fault, "the fence stays where it was"),
        }
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

/// Refuses a mission that the fence of now forbids, as PX4 does. ArduPilot flies it up to the fence, and does there what FENCE_ACTION says.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn check_way(situation: &Situation, program: &Program, from_here: bool) -> Result<(), PlanFault> {
    if situation.identity.is_ardupilot() { Ok(()) } else { keeps_inside(situation, program, from_here) }
}

/// Finds the place of a mission that the fence of now forbids, or the way there: the fence may have come after the mission. It begins
/// at home, or where the vehicle flies now.
///
/// # Errors
/// [`PlanFault`] that names the item.
pub fn keeps_inside(situation: &Situation, program: &Program, from_here: bool) -> Result<(), PlanFault> {
    let Some(fence) = situation.fence().filter(Fence::bounds) else { return Ok(()) };
    let home_m = situation.home.position_m;
    let mut before_m = if from_here && situation.flies() { situation.outputs.position_m } else { home_m };
    let beginning = Beginning {
        home_m,
        from_m: before_m,
        takeoff_height_m: height_without_m(situation),
        terrain: situation.terrain,
        grounded: !situation.flies(),
    };
    for PlannedLeg { item, through_m, place_m } in planned_way(program, &beginning) {
        let way_m = through_m.iter().chain([&place_m]);
        let breach = fence.breach(&place_m).or_else(|| breach_on(&fence, &before_m, way_m));
        before_m = place_m;
        refuse(item, breach)?;
    }
    Ok(())
}

/// What of a fence forbids a way on from a place, straight from each place on it to the next. Where that is forbidden itself, it has to be
/// left anyway.
fn breach_on<'a>(
    fence: &Fence,
    from_m: &'a Vector3<f64>,
    mut way_m: impl Iterator<Item = &'a Vector3<f64>>,
) -> Option<Breach> {
    let begins_within = fence.breach(from_m).is_none();
    let mut before_m = from_m;
    way_m.find_map(|place_m| {
        let at = if begins_within { fence.breach(place_m) } else { None };
        let breach = at.or_else(|| fence.breach_between(before_m, place_m));
        before_m = place_m;
        breach
    })
}

/// As far below the ground, m, a place is on it: heights are rounded on their way.
const GROUND_TOLERANCE_M: f64 = 0.05;

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
        // A landing ends where the ground is, and ArduPilot's takeoff climbs from wherever it begins.
        if matches!(step, Navigate::Land { .. } | Navigate::Takeoff { travels: false, .. }) {
            continue;
        }
        let here_m = situation.outputs.position_m;
        let ground_z_m = situation.terrain.z_m(place.horizontal_m.unwrap_or([here_m.x, here_m.y]));
        let below_m = place.down_m(situation.home.position_m.z).map(|down_m| down_m - ground_z_m);
        if let Some(below_m) = below_m.filter(|below_m| *below_m > GROUND_TOLERANCE_M) {
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
