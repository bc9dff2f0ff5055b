//! The search for a way, in slices.

use nalgebra::Vector3;

use super::super::{Fence, Inclusions, Zones};
use super::corners::{Corner, around, inside};
use super::graph::Graph;
use super::ground::Ground;

/// So far off the areas a way leads, m: where that leaves none, the next.
const CLEARANCES_M: [f64; 2] = [2.0, 0.5];

/// The search for the shortest way between two places around a fence.
///
/// It begins with the straight way. Areas that the shortest way leads through join in, with their corners, until it leads through
/// none: far areas cost nothing, and all of them that matter are looked at. The work can be done in slices, so that a fence of
/// hundreds of areas does not hold a flight up; how it is sliced changes nothing about the way.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteSearch {
    fence: OwnFence,
    ends: [[f64; 2]; 2],
    /// Number of the clearance that is kept.
    clearance: usize,
    ground: Ground,
    /// Whether each obstacle has joined in, and those that are about to.
    joined: Vec<bool>,
    joining: Vec<usize>,
    /// Corners that no obstacle covers that has joined in.
    corners: Vec<Corner>,
    graph: Graph,
}

/// How far a search is.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Not done.
    Searching,
    /// The places to fly to after the start, north and east, m, the goal last.
    Found(Vec<[f64; 2]>),
    /// There is no way.
    None,
}

/// What a search needs of a fence, for as long as it takes.
#[derive(Clone, Debug, PartialEq)]
struct OwnFence {
    zones: Zones,
    inclusions: Inclusions,
    home_m: Vector3<f64>,
    radius_m: f64,
}

impl OwnFence {
    fn fence(&self) -> Fence<'_> {
        let Self { zones, inclusions, home_m, radius_m } = self;
        Fence {
            zones: Some(zones),
            inclusions: *inclusions,
            home_m: *home_m,
            radius_m: *radius_m,
            height_m: 0.0,
        }
    }
}

impl RouteSearch {
    /// Around a fence, from start to goal, north and east, m.
    ///
    /// An area to stay out of that holds the start does not count for the first straight way, nor does it count that this way begins
    /// outside of all areas to stay in: it has to be left, and they have to be entered, anyway.
    pub fn new(fence: &Fence, start: [f64; 2], goal: [f64; 2]) -> Self {
        let zones = fence.zones.cloned().unwrap_or_default();
        let own =
            OwnFence { zones, inclusions: fence.inclusions, home_m: fence.home_m, radius_m: fence.radius_m };
        let ends = [start, goal];
        let ground = Ground::new(&own.fence(), start, goal, CLEARANCES_M[0]);
        let joined = vec![false; ground.obstacles.len()];
        let corners = inside(&ground, CLEARANCES_M[0]);
        let graph = Graph::new(ends, &corners);
        Self { fence: own, ends, clearance: 0, ground, joined, joining: Vec::new(), corners, graph }
    }

    /// Whether the way is around this fence, as far as it matters.
    pub fn is_around(&self, fence: &Fence) -> bool {
        let OwnFence { zones, inclusions, home_m, radius_m } = &self.fence;
        let same = match fence.zones {
            Some(others) => zones.zones == others.zones,
            None => zones.zones.is_empty(),
        };
        same && *inclusions == fence.inclusions
            && *radius_m == fence.radius_m
            && (*radius_m == 0.0 || *home_m == fence.home_m)
    }

    /// Goes on by about `work` sides looked at: less than 10 ns each.
    pub fn advance(&mut self, mut work: u64) -> Progress {
        while work > 0 {
            if let Some(number) = self.joining.pop() {
                self.join(number, &mut work);
                if self.joining.is_empty() {
                    self.graph = Graph::new(self.ends, &self.corners);
                }
                continue;
            }
            let obstacles = self.ground.obstacles.iter().zip(&self.joined);
            let obstacles: Vec<_> =
                obstacles.filter(|(_, joined)| **joined).map(|(obstacle, _)| obstacle).collect();
            match self.graph.advance(&self.ground, &obstacles, &mut work) {
                None => return Progress::Searching,
                Some(Some(way)) => {
                    self.joining = self.obstacles_in(&way, &mut work);
                    if self.joining.is_empty() {
                        return Progress::Found(way);
                    }
                }
                Some(None) => {
                    self.joining = self.obstacles_apart();
                    if self.joining.is_empty() && !self.come_nearer() {
                        return Progress::None;
                    }
                }
            }
        }
        Progress::Searching
    }

    /// Lets an obstacle join in, with its corners.
    fn join(&mut self, number: usize, work: &mut u64) {
        let (Some(obstacle), Some(joined), Some(clearance_m)) = (
            self.ground.obstacles.get(number),
            self.joined.get_mut(number),
            CLEARANCES_M.get(self.clearance),
        ) else {
            return;
        };
        *joined = true;
        let [start, _] = self.ends;
        let covers = |corner: &Corner| (corner.place, corner.place);
        self.corners.retain(|corner| !obstacle.blocks(&covers(corner), start, work));
        let others = || self.ground.obstacles.iter().zip(&self.joined).filter(|(_, joined)| **joined);
        let free = around(&obstacle.shape, *clearance_m).into_iter().filter(|corner| {
            let place = covers(corner);
            !others().any(|(other, _)| other.blocks(&place, start, work))
                && self.ground.stays_inside(&place, work)
        });
        let free: Vec<Corner> = free.collect();
        self.corners.extend(free);
    }

    /// The obstacles that are in a way and have not joined in.
    fn obstacles_in(&self, way: &[[f64; 2]], work: &mut u64) -> Vec<usize> {
        let [start, _] = self.ends;
        let mut blocks = |number: &usize| {
            let mut legs = core::iter::once(&start).chain(way).zip(way);
            self.ground
                .obstacles
                .get(*number)
                .is_some_and(|obstacle| legs.any(|(from, to)| obstacle.blocks(&(*from, *to), start, work)))
        };
        self.obstacles_apart().into_iter().filter(|number| blocks(number)).collect()
    }

    /// The obstacles that have not joined in.
    fn obstacles_apart(&self) -> Vec<usize> {
        self.joined.iter().enumerate().filter(|(_, joined)| !**joined).map(|(number, _)| number).collect()
    }

    /// Keeps less clearance; whether that is possible.
    fn come_nearer(&mut self) -> bool {
        self.clearance += 1;
        let Some(clearance_m) = CLEARANCES_M.get(self.clearance) else { return false };
        let [start, goal] = self.ends;
        self.ground = Ground::new(&self.fence.fence(), start, goal, *clearance_m);
        self.joined.fill(false);
        self.corners = inside(&self.ground, *clearance_m);
        self.graph = Graph::new(self.ends, &self.corners);
        true
    }
}
