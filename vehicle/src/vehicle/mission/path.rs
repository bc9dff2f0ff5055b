//! How fast corners are passed, with a look at the legs behind them.

use libm::sqrt;
use nalgebra::Vector3;
use quadrotor::Limits;

/// A corner between two legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Where the first leg is left, NED, m.
    pub entry_m: Vector3<f64>,
    /// Velocity there, NED, m/s.
    pub entry_velocity_m_s: Vector3<f64>,
    /// Where the second leg begins, NED, m.
    pub exit_m: Vector3<f64>,
    /// Velocity there, NED, m/s.
    pub exit_velocity_m_s: Vector3<f64>,
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

/// Share of the acceptance radius that a corner is cut by; the rest is for what the vehicle is off its reference.
const CUT: f64 = 0.7;
/// Largest share of a leg that a corner takes.
const SHARE_OF_LEG: f64 = 0.45;
/// Share of the horizontal limits that the shaper has on each of two axes.
const EACH_AXIS: f64 = 0.7;
/// Share of the acceleration that a change of speed along a leg is counted with; the jerk takes the rest.
const CHANGE: f64 = 0.5;
/// A corner that had to be passed slower than this, m/s, is one to stop at.
const SLOWEST_M_S: f64 = 0.3;

/// Geometry of a corner.
struct Bend {
    into: Vector3<f64>,
    out: Vector3<f64>,
    cut_m: f64,
    speed_m_s: f64,
}

/// The corner at the first of the places ahead, on a way that begins at `from_m` with a speed; `None` if the vehicle has to stop
/// there.
pub fn first_corner(
    from_m: &Vector3<f64>,
    speed_m_s: f64,
    ahead: &[Stop],
    limits: &Limits,
) -> Option<Corner> {
    let acceleration = CHANGE * limits.acceleration_horizontal_m_s2.min(limits.acceleration_vertical_m_s2);
    let reachable = |speed: f64, way_m: f64| sqrt(speed * speed + 2.0 * acceleration * way_m.max(0.0));
    // From the last one back: what is passed must leave room to brake for what comes then.
    let mut next: Option<Bend> = None;
    for index in (0..ahead.len()).rev() {
        let here = ahead[index];
        let before = if index == 0 { *from_m } else { ahead[index - 1].position_m };
        let mut bend = match ahead.get(index + 1) {
            Some(after) if !here.rests => bend(&before, &here, &after.position_m, limits),
            _ => None,
        };
        if let (Some(bend), Some(after)) = (&mut bend, ahead.get(index + 1)) {
            let way_m = (after.position_m - here.position_m).norm() - bend.cut_m;
            let (then_m_s, then_cut_m) =
                next.as_ref().map_or((0.0, 0.0), |next| (next.speed_m_s, next.cut_m));
            bend.speed_m_s = bend.speed_m_s.min(reachable(then_m_s, way_m - then_cut_m));
        }
        next = bend;
    }
    let mut bend = next?;
    let place_m = ahead.first()?.position_m;
    let way_m = (place_m - from_m).norm() - bend.cut_m;
    bend.speed_m_s = bend.speed_m_s.min(reachable(speed_m_s, way_m));
    (bend.speed_m_s >= SLOWEST_M_S).then(|| Corner {
        entry_m: place_m - bend.into * bend.cut_m,
        entry_velocity_m_s: bend.into * bend.speed_m_s,
        exit_m: place_m + bend.out * bend.cut_m,
        exit_velocity_m_s: bend.out * bend.speed_m_s,
    })
}

/// The bend between two legs; `None` if one of them has no length.
fn bend(before: &Vector3<f64>, here: &Stop, after: &Vector3<f64>, limits: &Limits) -> Option<Bend> {
    let (way_in, way_out) = (here.position_m - before, after - here.position_m);
    let shortest_m = way_in.norm().min(way_out.norm());
    let (into, out) = (way_in.try_normalize(1e-3)?, way_out.try_normalize(1e-3)?);
    let cut_m = (CUT * here.radius_m).min(SHARE_OF_LEG * shortest_m);
    let fastest = speed_along_m_s(&into, limits).min(speed_along_m_s(&out, limits));
    let speed_m_s = bend_speed_m_s((out - into).norm(), cut_m, EACH_AXIS * fastest, limits);
    Some(Bend { into, out, cut_m, speed_m_s })
}

/// Fastest that a leg in a direction may be flown, m/s.
fn speed_along_m_s(direction: &Vector3<f64>, limits: &Limits) -> f64 {
    let horizontal = direction.xy().norm();
    let vertical = if direction.z < 0.0 { limits.speed_up_m_s } else { limits.speed_down_m_s };
    let by = |share: f64, limit: f64| if share > 1e-9 { limit / share } else { f64::INFINITY };
    by(horizontal, limits.speed_horizontal_m_s).min(by(direction.z.abs(), vertical))
}

/// The largest speed v at which the velocity can be turned within the cut,
///
/// ```text
/// v T(v |Δu|) ≤ 2 cut,   T(Δv) = Δv/a + a/j,  or 2 √(Δv/j) if the acceleration a is not reached
/// ```
///
/// with Δu the change of direction, and a and j the limits that the shaper has on each axis.
fn bend_speed_m_s(change: f64, cut_m: f64, fastest_m_s: f64, limits: &Limits) -> f64 {
    let a = EACH_AXIS * limits.acceleration_horizontal_m_s2.min(limits.acceleration_vertical_m_s2);
    let j = EACH_AXIS * limits.jerk_horizontal_m_s3.min(limits.jerk_vertical_m_s3);
    let time_s = |change_m_s: f64| {
        if change_m_s >= a * a / j { change_m_s / a + a / j } else { 2.0 * sqrt(change_m_s / j) }
    };
    let fits = |speed: f64| speed * time_s(speed * change) <= 2.0 * cut_m;
    if fits(fastest_m_s) {
        return fastest_m_s;
    }
    let (mut low, mut high) = (0.0, fastest_m_s);
    for _ in 0..40 {
        let middle = (low + high) / 2.0;
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::Limits;

    use super::{Stop, first_corner};

    fn stop(x: f64, y: f64, rests: bool) -> Stop {
        Stop { position_m: Vector3::new(x, y, -10.0), radius_m: 2.0, rests }
    }

    fn speed(ahead: &[Stop]) -> f64 {
        let start = Vector3::new(0.0, 0.0, -10.0);
        first_corner(&start, 0.0, ahead, &Limits::default())
            .map_or(0.0, |corner| corner.entry_velocity_m_s.norm())
    }

    #[test]
    fn sharper_corners_and_shorter_legs_are_passed_slower() {
        let straight = speed(&[stop(50.0, 0.0, false), stop(100.0, 0.0, true)]);
        let slight = speed(&[stop(50.0, 0.0, false), stop(100.0, 10.0, true)]);
        let right = speed(&[stop(50.0, 0.0, false), stop(50.0, 50.0, true)]);
        let sharp = speed(&[stop(50.0, 0.0, false), stop(10.0, 10.0, true)]);
        assert!(straight > slight && slight > right && right > sharp, "{straight} {slight} {right} {sharp}");
        assert!(right > 1.0, "{right}");
        // There and back again is slower still, and a place to rest at is a stop.
        let back = speed(&[stop(50.0, 0.0, false), stop(0.0, 0.0, true)]);
        assert!(sharp > back && back > 0.0, "{sharp} {back}");
        assert_eq!(speed(&[stop(50.0, 0.0, true), stop(100.0, 0.0, true)]), 0.0);
        // Braking for the end begins before the corner.
        let short = speed(&[stop(50.0, 0.0, false), stop(54.0, 0.0, true)]);
        assert!(short < 2.6 && short > 1.0, "{short}");
        // And so it does for a corner behind the corner.
        let chain = speed(&[stop(50.0, 0.0, false), stop(55.0, 0.0, false), stop(55.0, 50.0, true)]);
        assert!(chain < straight / 1.5, "{chain}");
    }
}
