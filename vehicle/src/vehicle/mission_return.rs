//! The way home along the places of the mission: on to its landing, or back to where it began (PX4's RTL_TYPE 2 and 4).

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::mission::{Beginning, Mission, PlannedLeg, planned_way};
use super::return_settings::ReturnGoal;
use super::situation::Situation;
use crate::plan::step::Navigate;

/// A way along the mission.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionReturn {
    /// Where it leads, one place after the other, NED, m.
    pub places_m: VecDeque<Vector3<f64>>,
    /// Where it lands in the end, north and east, m.
    pub landing_m: [f64; 2],
}

impl MissionReturn {
    /// The way that the parameter asks for; `None`: it returns straight, as without a mission, or where the fence forbids this way.
    /// `from_mission` says whether the mission was flown until now: else the way begins at the nearest of its places.
    pub fn new(mission: &Mission, from_mission: bool, situation: &Situation) -> Option<Self> {
        let goal = situation.conduct.return_home.goal;
        if !matches!(goal, ReturnGoal::Mission | ReturnGoal::MissionOrBack) {
            return None;
        }
        let home_m = situation.home.position_m;
        let beginning = Beginning {
            home_m,
            from_m: home_m,
            takeoff_height_m: situation.conduct.takeoff_height_m,
            terrain: situation.terrain,
            grounded: true,
        };
        let legs = planned_way(mission.program(), &beginning);
        let lands =
            |leg: &PlannedLeg| matches!(mission.program().navigate(leg.item), Some(Navigate::Land { .. }));
        let current = mission.current();
        // Whichever passes fewer items.
        let is_taken =
            |leg: &PlannedLeg| goal == ReturnGoal::Mission || leg.item.saturating_sub(current) < current;
        let landing = legs.iter().enumerate().find(|(_, leg)| lands(leg));
        let landing = landing.filter(|(_, leg)| is_taken(leg)).map(|(index, _)| index);
        let flown = legs.iter().position(|leg| leg.item >= current).filter(|_| from_mission);
        let way = match landing {
            Some(landing) => on(&legs, flown, landing, situation),
            None => back(legs.into_iter().filter(|leg| !lands(leg)).collect(), flown, situation),
        };
        way.filter(|way| way.is_free(situation))
    }

    /// Whether the fence allows it.
    fn is_free(&self, situation: &Situation) -> bool {
        let Some(fence) = situation.fence() else { return true };
        let mut before_m = situation.outputs.position_m;
        self.places_m.iter().all(|place_m| {
            let from_m = std::mem::replace(&mut before_m, *place_m);
            fence.breach_on_way(&from_m, place_m).is_none()
        })
    }
}

/// On to a landing, from the leg that is flown or the nearest place.
fn on(
    legs: &[PlannedLeg],
    flown: Option<usize>,
    landing: usize,
    situation: &Situation,
) -> Option<MissionReturn> {
    let first = flown.or_else(|| nearest(legs, situation))?.min(landing);
    let mut places_m: VecDeque<_> = legs.get(first..landing)?.iter().map(|leg| leg.place_m).collect();
    let above = legs.get(landing)?.place_m;
    // As high as the place before, or as it is.
    let z_m = places_m.back().map_or(situation.outputs.position_m.z, |place_m| place_m.z);
    places_m.push_back(Vector3::new(above.x, above.y, z_m));
    Some(MissionReturn { places_m, landing_m: [above.x, above.y] })
}

/// Back over the places before, and to home.
fn back(legs: Vec<PlannedLeg>, flown: Option<usize>, situation: &Situation) -> Option<MissionReturn> {
    let last = match flown {
        Some(flown) => flown.saturating_sub(1),
        None => nearest(&legs, situation)?,
    };
    let mut places_m: VecDeque<_> = legs.iter().take(last + 1).rev().map(|leg| leg.place_m).collect();
    let home_m = situation.home.position_m;
    let z_m = places_m.back()?.z;
    places_m.push_back(Vector3::new(home_m.x, home_m.y, z_m));
    Some(MissionReturn { places_m, landing_m: [home_m.x, home_m.y] })
}

/// The leg whose place is nearest.
fn nearest(legs: &[PlannedLeg], situation: &Situation) -> Option<usize> {
    let distance_m = |leg: &PlannedLeg| (leg.place_m - situation.outputs.position_m).norm();
    (0..legs.len()).min_by(|one, other| {
        let [one, other] = [one, other].map(|index| legs.get(*index).map_or(f64::INFINITY, distance_m));
        one.total_cmp(&other)
    })
}
