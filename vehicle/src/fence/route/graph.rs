//! The shortest way over corners.

use super::corners::Corner;
use super::ground::{Ground, Obstacle};

/// Places of the two ends among the corners.
const START: usize = 0;
const GOAL: usize = 1;

/// A* from the first corner to the second over straight ways that are free. It can be interrupted between any two of them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Graph {
    corners: Vec<Corner>,
    /// Distance of each corner to the goal, m.
    left_m: Vec<f64>,
    /// Length of the shortest way known to each corner, m, and the corner before it.
    lengths_m: Vec<f64>,
    before: Vec<usize>,
    /// Corners whose shortest way is not certain yet.
    open: Vec<usize>,
    /// The corner that ways are tried from, and how many of the open ones have been tried.
    trying: Option<(usize, usize)>,
}

impl Graph {
    /// Over the two ends of a way and some corners.
    pub fn new([start, goal]: [[f64; 2]; 2], corners: &[Corner]) -> Self {
        let ends = [start, goal].map(Corner::alone);
        let corners: Vec<Corner> = ends.into_iter().chain(corners.iter().copied()).collect();
        let left_m = corners.iter().map(|corner| distance_m(corner.place, goal)).collect();
        let mut lengths_m = vec![f64::INFINITY; corners.len()];
        if let Some(length_m) = lengths_m.get_mut(START) {
            *length_m = 0.0;
        }
        let (before, open) = (vec![START; corners.len()], (0..corners.len()).collect());
        Self { corners, left_m, lengths_m, before, open, trying: None }
    }

    /// Goes on while there is `work`. `None`: not done; the way over all corners to the goal, the start not among them; or that
    /// there is none.
    pub fn advance(
        &mut self,
        ground: &Ground,
        obstacles: &[&Obstacle],
        work: &mut u64,
    ) -> Option<Option<Vec<[f64; 2]>>> {
        while *work > 0 {
            let Some((node, tried)) = self.trying else {
                let Some((node, length_m)) = self.nearest(work) else { return Some(None) };
                if length_m.is_infinite() {
                    return Some(None);
                }
                if node == GOAL {
                    return Some(Some(self.way()));
                }
                self.trying = Some((node, 0));
                continue;
            };
            let Some(other) = self.open.get(tried).copied() else {
                self.trying = None;
                continue;
            };
            self.trying = Some((node, tried + 1));
            self.try_way(ground, obstacles, (node, other), work);
        }
        None
    }

    /// Takes the open corner over which the goal is nearest, if all that is in between were free.
    fn nearest(&mut self, work: &mut u64) -> Option<(usize, f64)> {
        *work = work.saturating_sub(self.open.len() as u64 / 4);
        let of = |values: &[f64], node: usize| values.get(node).copied().unwrap_or(f64::INFINITY);
        let whole_m = |node: &usize| of(&self.lengths_m, *node) + of(&self.left_m, *node);
        let places = self.open.iter().map(whole_m).enumerate();
        let (place, _) = places.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let node = self.open.swap_remove(place);
        Some((node, *self.lengths_m.get(node)?))
    }

    fn try_way(
        &mut self,
        ground: &Ground,
        obstacles: &[&Obstacle],
        (from, to): (usize, usize),
        work: &mut u64,
    ) -> Option<()> {
        *work = work.saturating_sub(1);
        let (one, other) = (*self.corners.get(from)?, *self.corners.get(to)?);
        let through_m = self.lengths_m.get(from)? + distance_m(one.place, other.place);
        if through_m >= *self.lengths_m.get(to)? {
            return None;
        }
        if !(one.is_touched_from(other.place) && other.is_touched_from(one.place)) {
            return None;
        }
        let way = (one.place, other.place);
        let [start, _] = ground.ends();
        let blocked = obstacles.iter().any(|obstacle| obstacle.blocks(&way, start, work));
        if blocked || !ground.stays_inside(&way, work) {
            return None;
        }
        *self.lengths_m.get_mut(to)? = through_m;
        *self.before.get_mut(to)? = from;
        Some(())
    }

    fn way(&self) -> Vec<[f64; 2]> {
        let mut node = GOAL;
        let mut way = Vec::new();
        while node != START {
            way.extend(self.corners.get(node).map(|corner| corner.place));
            node = self.before.get(node).copied().unwrap_or(START);
        }
        way.reverse();
        way
    }
}

fn distance_m([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    libm::sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
}
