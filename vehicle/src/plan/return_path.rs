//! The way back that a mission has: what follows DO_RETURN_PATH_START.

use nalgebra::{Vector2, Vector3};

use super::command::{DO_LAND_START, DO_RETURN_PATH_START};
use super::{MissionItem, Site};

/// Commands from here on are not flown.
const LAST_FLOWN: u16 = 95;

/// Number of the item at which a way back is joined from a place, NED, m: the end of the nearest of its legs. The landing behind it is
/// no part of it.
pub fn joined(items: &[MissionItem], site: &Site, here_m: &Vector3<f64>) -> Option<usize> {
    let starts = (0..items.len())
        .filter(|index| items.get(*index).is_some_and(|item| item.command == DO_RETURN_PATH_START));
    let legs = starts.flat_map(|start| {
        let is_landing = |index: &usize| items.get(*index).is_some_and(|item| item.command == DO_LAND_START);
        let placed: Vec<(usize, Vector2<f64>)> = (start + 1..items.len())
            .take_while(|index| !is_landing(index))
            .filter_map(|index| {
                let item = items.get(index).filter(|item| item.command <= LAST_FLOWN)?;
                Some((index, site.place(item)?.horizontal_m?.into()))
            })
            .collect();
        let first = placed.first().map(|(index, place)| (*index, *place, *place));
        let others: Vec<_> = placed.windows(2).map(|pair| (pair[1].0, pair[0].1, pair[1].1)).collect();
        first.into_iter().chain(others)
    });
    let here = here_m.xy();
    let mut nearest: Option<(usize, f64)> = None;
    for (index, from, to) in legs {
        let away = distance(&here, &from, &to);
        if nearest.is_none_or(|(_, least)| away < least) {
            nearest = Some((index, away));
        }
    }
    nearest.map(|(index, _)| index)
}

/// Distance from a point to a straight leg.
fn distance(point: &Vector2<f64>, from: &Vector2<f64>, to: &Vector2<f64>) -> f64 {
    let leg = to - from;
    let length2 = leg.norm_squared();
    let share = if length2 > 0.0 { ((point - from).dot(&leg) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (from + leg * share - point).norm()
}
