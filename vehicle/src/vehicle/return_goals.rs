//! Where a return may go.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::situation::Situation;

/// Where a return may go: home, the rally points and the fence's return point, as far as the fence allows them, the nearest
/// first. North and east, m.
pub fn safe_points_m(situation: &Situation) -> VecDeque<[f64; 2]> {
    let home = situation.home.position_m;
    let is_free = |[x, y]: &[f64; 2]| situation.breach_at(&Vector3::new(*x, *y, home.z)).is_none();
    let rally = situation.rally_points.iter().filter_map(|place| place.horizontal_m);
    let rally: Vec<[f64; 2]> = rally.filter(is_free).collect();
    let by_distance = |points: &mut Vec<[f64; 2]>| {
        points.sort_by(|one, other| distance_m(situation, *one).total_cmp(&distance_m(situation, *other)));
    };
    let others = core::iter::once([home.x, home.y]).chain(situation.zones.return_m).filter(is_free);
    if situation.conduct.return_home.goal.prefers_rally_points() {
        let (mut first, mut then) = (rally, others.collect());
        by_distance(&mut first);
        by_distance(&mut then);
        return first.into_iter().chain(then).collect();
    }
    let mut points: Vec<[f64; 2]> = others.chain(rally).collect();
    by_distance(&mut points);
    points.into()
}

/// Horizontal distance of a place, m.
pub fn distance_m(situation: &Situation, [x, y]: [f64; 2]) -> f64 {
    let here = situation.outputs.position_m;
    libm::hypot(x - here.x, y - here.y)
}
