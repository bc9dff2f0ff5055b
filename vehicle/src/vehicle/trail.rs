//! The way that was flown since arming, as bread crumbs: a few places that lead back along it.
//!
//! Two cuts keep it short: places that the straight line between their neighbours passes nearby (Ramer, Douglas and Peucker), and
//! loops, whose ends come near each other.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Parameters of the trail.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TrailSettings {
    /// Places are so far apart at least, m; 0: there is no trail.
    pub accuracy_m: f64,
    /// So many places are kept at most; 0: there is no trail.
    pub most_places: u16,
    /// Options of the way back, as the parameter adds them up.
    pub options: u8,
}

/// ArduPilot's.
impl Default for TrailSettings {
    fn default() -> Self {
        Self { accuracy_m: 2.0, most_places: 300, options: 0 }
    }
}

/// How often a place is left, µs.
const PERIOD_US: u64 = 333_000;
/// When no place could be left for so long, µs, the trail is given up.
const FULL_US: u64 = 15_000_000;
/// With less room than this it is cleaned up at once, and with so many new places in any case.
const LEAST_ROOM: usize = 10;
const NEW_PLACES: usize = 50;
/// Shares of the accuracy: how far a place is beside the line that replaces it, and how near two ways come that are one.
const BESIDE: f64 = 0.5;
const NEAR: f64 = 0.99;

/// The trail, from the place of arming on.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Trail {
    places_m: Vec<Vector3<f64>>,
    /// How many of them were there after the last cleaning.
    cleaned: usize,
    /// When the next place is due, and when the last one was left, µs.
    due_us: u64,
    left_us: u64,
    active: bool,
}

impl Trail {
    /// Begins anew at a place, NED, m.
    pub fn begin(&mut self, place_m: Vector3<f64>, time_us: u64) {
        *self = Self { places_m: vec![place_m], cleaned: 1, due_us: time_us, left_us: time_us, active: true };
    }

    /// Whether there is a way back.
    pub fn is_active(&self) -> bool {
        self.active && !self.places_m.is_empty()
    }

    /// Its places, NED, m.
    pub fn places_m(&self) -> &[Vector3<f64>] {
        &self.places_m
    }

    /// Leaves a place behind, if one is due. Returns whether the trail had to be given up.
    pub fn leave(&mut self, place_m: Vector3<f64>, settings: &TrailSettings, time_us: u64) -> bool {
        if !self.active || time_us < self.due_us {
            return false;
        }
        self.due_us = time_us + PERIOD_US;
        let most = usize::from(settings.most_places);
        if most == 0 || settings.accuracy_m <= 0.0 {
            self.active = false;
            return false;
        }
        let near = |last: &Vector3<f64>| (last - place_m).norm() < settings.accuracy_m;
        if self.places_m.last().is_some_and(near) {
            self.left_us = time_us;
            return false;
        }
        if self.places_m.len() + LEAST_ROOM >= most || self.places_m.len() >= self.cleaned + NEW_PLACES {
            self.clean(settings);
        }
        if self.places_m.len() < most {
            self.places_m.push(place_m);
            self.left_us = time_us;
            return false;
        }
        self.active = time_us - self.left_us <= FULL_US;
        !self.active
    }

    /// The place is not known. Returns whether that has lasted too long, and the trail had to be given up.
    pub fn starve(&mut self, time_us: u64) -> bool {
        let gives_up = self.active && time_us > self.left_us + FULL_US;
        self.active &= !gives_up;
        gives_up
    }

    /// Cuts what it can do without.
    pub fn clean(&mut self, settings: &TrailSettings) {
        simplify(&mut self.places_m, BESIDE * settings.accuracy_m);
        prune(&mut self.places_m, NEAR * settings.accuracy_m);
        self.cleaned = self.places_m.len();
    }

    /// Forgets the places from a number on: they are behind the vehicle again.
    pub fn cut(&mut self, count: usize) {
        self.places_m.truncate(count);
        self.cleaned = self.cleaned.min(self.places_m.len());
    }
}

/// Leaves out places that are no farther than a distance, m, beside the line between those that stay.
fn simplify(places_m: &mut Vec<Vector3<f64>>, beside_m: f64) {
    if places_m.len() < 3 {
        return;
    }
    let last = places_m.len() - 1;
    let mut stays = vec![false; places_m.len()];
    (stays[0], stays[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let off = |index: &usize| off_line_m(&places_m[*index], &places_m[from], &places_m[to]);
        let farthest = (from + 1..to).max_by(|one, other| off(one).total_cmp(&off(other)));
        if let Some(index) = farthest.filter(|index| off(index) > beside_m) {
            stays[index] = true;
            open.extend([(from, index), (index, to)]);
        }
    }
    let mut stays = stays.into_iter();
    places_m.retain(|_| stays.next().unwrap_or(true));
}

/// Leaves out loops: where the way comes near an earlier part of itself, it goes on from there.
fn prune(places_m: &mut Vec<Vector3<f64>>, near_m: f64) {
    let mut from = 0;
    while from + 3 < places_m.len() {
        let meets = |to: &usize| {
            let (one, other) =
                nearest([&places_m[from], &places_m[from + 1]], [&places_m[*to], &places_m[*to + 1]]);
            ((one - other).norm() < near_m).then_some((*to, (one + other) / 2.0))
        };
        if let Some((to, meeting_m)) = (from + 2..places_m.len() - 1).rev().find_map(|to| meets(&to)) {
            places_m.splice(from + 1..=to, [meeting_m]);
        }
        from += 1;
    }
}

/// Distance of a place from the line between two others, m.
fn off_line_m(place: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let way = to - from;
    let share = if way.norm_squared() > 0.0 { (place - from).dot(&way) / way.norm_squared() } else { 0.0 };
    (from + way * share.clamp(0.0, 1.0) - place).norm()
}

/// The places of two straight ways that are nearest to each other.
fn nearest(one: [&Vector3<f64>; 2], other: [&Vector3<f64>; 2]) -> (Vector3<f64>, Vector3<f64>) {
    let ([a, b], [c, d]) = (one, other);
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let (uw, vw) = (u.dot(&w), v.dot(&w));
    let determinant = uu * vv - uv * uv;
    // Parallel ways are nearest at one of their ends, too.
    let mut s = if determinant > 1e-9 { ((uv * vw - vv * uw) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = if vv > 0.0 { ((uv * s + vw) / vv).clamp(0.0, 1.0) } else { 0.0 };
    if uu > 0.0 {
        s = ((uv * t - uw) / uu).clamp(0.0, 1.0);
    }
    if vv > 0.0 {
        t = ((uv * s + vw) / vv).clamp(0.0, 1.0);
    }
    (a + u * s, c + v * t)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Trail, TrailSettings};

    fn walk(corners: &[[f64; 2]], settings: &TrailSettings) -> (Trail, bool) {
        let mut trail = Trail::default();
        let at = |[x, y]: [f64; 2]| Vector3::new(x, y, -10.0);
        let (mut time_us, mut given_up) = (0, false);
        trail.begin(at(corners[0]), time_us);
        for ends in corners.windows(2) {
            let way = at(ends[1]) - at(ends[0]);
            let steps = (way.norm() / 1.0).ceil() as usize;
            for step in 1..=steps {
                time_us += 400_000;
                given_up |= trail.leave(at(ends[0]) + way * (step as f64 / steps as f64), settings, time_us);
            }
        }
        (trail, given_up)
    }

    #[test]
    fn straight_ways_keep_their_ends_only() {
        let settings = TrailSettings::default();
        let (mut trail, _) = walk(&[[0.0, 0.0], [60.0, 0.0], [60.0, 40.0]], &settings);
        trail.clean(&settings);
        assert_eq!(trail.places_m().len(), 3, "{:?}", trail.places_m());
        assert!((trail.places_m()[1] - Vector3::new(60.0, 0.0, -10.0)).norm() < 2.0);
    }

    #[test]
    fn a_loop_is_cut_where_it_closes() {
        let settings = TrailSettings::default();
        // Out, once around a square, and across its own way.
        let way = [[0.0, 0.0], [50.0, 0.0], [50.0, 40.0], [20.0, 40.0], [20.0, -30.0]];
        let (mut trail, _) = walk(&way, &settings);
        trail.clean(&settings);
        let places = trail.places_m();
        assert_eq!(places.len(), 3, "{places:?}");
        assert!((places[1] - Vector3::new(20.0, 0.0, -10.0)).norm() < 2.5, "{places:?}");
    }

    /// ArduPilot's SMART_RTL gives up after 15 s without a position.
    #[test]
    fn a_trail_without_places_is_given_up() {
        let (mut trail, _) = walk(&[[0.0, 0.0], [60.0, 0.0]], &TrailSettings::default());
        let left_us = trail.left_us;
        assert!(!trail.starve(left_us + 15_000_000) && trail.is_active());
        assert!(trail.starve(left_us + 15_000_001) && !trail.is_active());
        assert!(!trail.starve(left_us + 16_000_000), "it is told once");
    }

    /// A zigzag that nothing can be cut from fills it up, and after a while it is given up.
    #[test]
    fn a_full_trail_is_given_up() {
        let settings = TrailSettings { most_places: 20, ..TrailSettings::default() };
        let zigzag: Vec<[f64; 2]> =
            (0..40).map(|index| [f64::from(index) * 10.0, f64::from(index % 2) * 30.0]).collect();
        let (trail, given_up) = walk(&zigzag, &settings);
        assert!(given_up && !trail.is_active() && trail.places_m().len() <= 20);
    }
}
