//! How fast corners are passed, with a look at the legs behind them.
//!
//! The speed of a corner is the largest whose blend comes within the acceptance radius and takes at most half of each leg. Then
//! the legs between two corners must be long enough to change from the speed of one to that of the next.

use nalgebra::Vector3;
use quadrotor::{Limits, PositionReference};

use super::super::trajectory::{Blend, change_distance_m, limits_along};

/// A corner that is passed without stopping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The way around it.
    pub blend: Blend,
    /// Where the next leg ends, NED, m.
    pub after_m: Vector3<f64>,
}

/// A place on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The place, NED, m.
    pub position_m: Vector3<f64>,
    /// Acceptance radius, m.
    pub radius_m: f64,
    /// Whether the vehicle comes to rest there.
    pub rests: bool,
}

/// Where the way begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The place, NED, m.
    pub position_m: Vector3<f64>,
    /// Velocity there, NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Whether that is along the line to the first place; if not, the shaper joins it.
    pub on_line: bool,
}

impl Start {
    /// Where a motion is, and how fast, as soon as its acceleration has been taken back.
    pub fn settled(motion: &PositionReference, limits: &Limits, on_line: bool) -> Self {
        let (v, a) = (motion.velocity_m_s, motion.acceleration_m_s2);
        let t = a.norm() / limits.jerk_horizontal_m_s3.min(limits.jerk_vertical_m_s3);
        Self {
            position_m: motion.position_m + (v + a * (t / 3.0)) * t,
            velocity_m_s: v + a * (t / 2.0),
            on_line,
        }
    }
}

/// The nearest that a blend comes to its corner, as a share of the acceptance radius, and how much nearer than the radius at
/// least, m, as long as that is half of it: the rest is for what the vehicle is off its reference.
const NEAREST: f64 = 0.9;
const MARGIN_M: f64 = 0.15;
/// Largest share of a leg that one of its two corners takes.
const SHARE_OF_LEG: f64 = 0.5;
/// Share of a leg that is counted with to change the speed between two corners: the plan of the next leg must not fail by a hair.
const USED: f64 = 0.98;
/// Share of the limits of speed that the shaper has for each of two horizontal axes.
const EACH_AXIS: f64 = 0.7;
/// A corner that had to be passed slower than this, m/s, is one to stop at.
const SLOWEST_M_S: f64 = 0.2;
/// How often a blend that the fence forbids is halved.
const HALVINGS: usize = 3;
/// Speeds that are tried from the largest one down.
const TRIES: usize = 64;

/// A bend between two legs.
#[derive(Clone, Copy)]
struct Bend<'a> {
    corner_m: Vector3<f64>,
    directions: [Vector3<f64>; 2],
    after_m: Vector3<f64>,
    speed_m_s: f64,
    limits: &'a Limits,
}

impl<'a> Bend<'a> {
    /// The bend between two legs with its largest speed; `None` if one of them has no length or the fence forbids it.
    fn new(
        before: &Vector3<f64>,
        here: &Stop,
        after: &Vector3<f64>,
        limits: &'a Limits,
        is_free: &impl Fn(&Blend) -> bool,
    ) -> Option<Self> {
        let (way_in, way_out) = (here.position_m - before, after - here.position_m);
        let (into, out) = (way_in.try_normalize(1e-3)?, way_out.try_normalize(1e-3)?);
        let cap_m_s = limits_along(&into, limits).speed.min(limits_along(&out, limits).speed);
        let longest_m = SHARE_OF_LEG * way_in.norm().min(way_out.norm());
        let mut nearest_m = (NEAREST * here.radius_m).min(here.radius_m - MARGIN_M).max(0.5 * here.radius_m);
        let mut bend = Self {
            corner_m: here.position_m,
            directions: [into, out],
            after_m: *after,
            speed_m_s: 0.0,
            limits,
        };
        for _ in 0..=HALVINGS {
            bend.speed_m_s = largest(cap_m_s, |speed| {
                let blend = bend.at(speed);
                blend.nearest_m() <= nearest_m && blend.cut_m() <= longest_m
            })?;
            if is_free(&bend.blend()) {
                return Some(bend);
            }
            nearest_m /= 2.0;
        }
        None
    }

    /// Its blend at a speed, m/s.
    fn at(&self, speed_m_s: f64) -> Blend {
        Blend::new(self.corner_m, self.directions, speed_m_s, self.limits)
    }

    fn blend(&self) -> Blend {
        self.at(self.speed_m_s)
    }
}

/// The corner at the first of the places ahead, on a way that begins somewhere; `None` if the vehicle has to stop there. The fence
/// decides which blends are free.
pub fn first_corner(
    start: &Start,
    ahead: &[Stop],
    limits: &Limits,
    is_free: impl Fn(&Blend) -> bool,
) -> Option<Corner> {
    // From the last one back: what is passed must leave room to brake for what comes then.
    let mut next: Option<Bend> = None;
    for index in (0..ahead.len()).rev() {
        let here = &ahead[index];
        let before = if index == 0 { &start.position_m } else { &ahead[index - 1].position_m };
        let bend = match ahead.get(index + 1) {
            Some(after) if !here.rests => Bend::new(before, here, &after.position_m, limits, &is_free),
            _ => None,
        };
        next = bend.and_then(|bend| braking(bend, next.as_ref()));
    }
    let bend = reached(next?, start)?;
    let blend = bend.blend();
    (bend.speed_m_s >= SLOWEST_M_S && is_free(&blend)).then_some(Corner { blend, after_m: bend.after_m })
}

/// A bend that leaves room to brake for the next one, or for a stop.
fn braking<'a>(mut bend: Bend<'a>, next: Option<&Bend>) -> Option<Bend<'a>> {
    let way = bend.after_m - bend.corner_m;
    let axis = limits_along(&bend.directions[1], bend.limits);
    let (then_m_s, then_m) = next.map_or((0.0, 0.0), |next| (next.speed_m_s, next.blend().cut_m()));
    let room_m = USED * way.norm() - then_m;
    bend.speed_m_s = largest(bend.speed_m_s, |speed| {
        speed <= then_m_s || change_distance_m(speed, then_m_s, &axis) + bend.at(speed).cut_m() <= room_m
    })?;
    Some(bend)
}

/// A bend whose speed can be reached from the start.
fn reached<'a>(mut bend: Bend<'a>, start: &Start) -> Option<Bend<'a>> {
    /// What rounding may take, m.
    const ROUNDING_M: f64 = 1e-6;
    let into = bend.directions[0];
    let axis = limits_along(&into, bend.limits);
    let room_m = (bend.corner_m - start.position_m).norm() - ROUNDING_M;
    let from_m_s = start.velocity_m_s.dot(&into).max(0.0);
    let fastest_m_s = if start.on_line { bend.speed_m_s } else { bend.speed_m_s.min(EACH_AXIS * axis.speed) };
    bend.speed_m_s = largest(fastest_m_s, |speed| {
        change_distance_m(from_m_s, speed, &axis) + bend.at(speed).cut_m() <= room_m
    })?;
    Some(bend)
}

/// The largest of the speeds up to one, m/s, at which something holds. What holds need not hold at all lower speeds.
fn largest(fastest_m_s: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    let tried = |index: usize| fastest_m_s * index as f64 / TRIES as f64;
    let found = (1..=TRIES).rev().find(|index| holds(tried(*index)))?;
    if found == TRIES {
        return Some(fastest_m_s);
    }
    let (mut low, mut high) = (tried(found), tried(found + 1));
    for _ in 0..30 {
        let middle = (low + high) / 2.0;
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::Limits;

    use super::{Start, Stop, first_corner};

    fn stop(x: f64, y: f64, rests: bool) -> Stop {
        Stop { position_m: Vector3::new(x, y, -10.0), radius_m: 2.0, rests }
    }

    fn start() -> Start {
        Start { position_m: Vector3::new(0.0, 0.0, -10.0), velocity_m_s: Vector3::zeros(), on_line: true }
    }

    fn speed(ahead: &[Stop]) -> f64 {
        first_corner(&start(), ahead, &Limits::default(), |_| true)
            .map_or(0.0, |corner| corner.blend.velocity_in_m_s.norm())
    }

    #[test]
    fn sharper_corners_and_shorter_legs_are_passed_slower() {
        let straight = speed(&[stop(50.0, 0.0, false), stop(100.0, 0.0, true)]);
        let slight = speed(&[stop(50.0, 0.0, false), stop(100.0, 20.0, true)]);
        let right = speed(&[stop(50.0, 0.0, false), stop(50.0, 50.0, true)]);
        let sharp = speed(&[stop(50.0, 0.0, false), stop(10.0, 10.0, true)]);
        assert!(straight >= slight && slight > right && right > sharp, "{straight} {slight} {right} {sharp}");
        assert!((straight - Limits::default().speed_horizontal_m_s).abs() < 1e-9, "{straight}");
        assert!(right > 4.0, "{right}");
        // There and back again is slower still, and a place to rest at is a stop.
        let back = speed(&[stop(50.0, 0.0, false), stop(0.0, 0.0, true)]);
        assert!(sharp > back && back > 1.0, "{sharp} {back}");
        assert_eq!(speed(&[stop(50.0, 0.0, true), stop(100.0, 0.0, true)]), 0.0);
        // Braking for the end begins before the corner.
        let short = speed(&[stop(50.0, 0.0, false), stop(54.0, 0.0, true)]);
        assert!(short < 4.0 && short > 2.0, "{short}");
        // And so it does for a corner behind the corner.
        let chain = speed(&[stop(50.0, 0.0, false), stop(55.0, 0.0, false), stop(55.0, 50.0, true)]);
        assert!(chain < 0.75 * straight, "{chain}");
    }

    #[test]
    fn what_the_fence_forbids_is_passed_nearer_or_stopped_at() {
        let ahead = [stop(50.0, 0.0, false), stop(50.0, 50.0, true)];
        let within = |most_m: f64| {
            let is_free = |blend: &super::Blend| blend.nearest_m() < most_m;
            first_corner(&start(), &ahead, &Limits::default(), is_free)
        };
        let corner = within(1.0).expect("passed");
        assert!(corner.blend.nearest_m() < 1.0 && corner.blend.velocity_in_m_s.norm() > 2.0, "{corner:?}");
        assert_eq!(within(0.01), None);
    }
}
