//! A curve through places: cubic pieces whose directions agree at the places. The direction at a place is that from the place before it
//! to the one behind it.
//!
//! ```text
//!  p(u) = (2u³ − 3u² + 1) p₀ + (u³ − 2u² + u) m₀ + (3u² − 2u³) p₁ + (u³ − u²) m₁,   0 ≤ u ≤ 1
//!  v² κ ≤ a share of the acceleration;   v changes by another share of it
//! ```

use nalgebra::Vector3;
use quadrotor::Limits;

use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};

/// How long the directions at the places are, of the way from the place before to the one behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    /// As long: a wide curve, as ArduPilot's spline waypoints have it.
    Wide,
    /// Half as long (Catmull and Rom): between places that lie densely on a smooth curve it stays on that one.
    Close,
}

/// Parts of a piece at which its speed is planned.
const PARTS: usize = 32;
/// Share of the horizontal acceleration that turns the velocity, and of that which changes its size.
const CENTRIPETAL: f64 = 0.4;
const TANGENTIAL: f64 = 0.2;
/// Never slower than this, m/s: it would not arrive.
const SLOWEST_M_S: f64 = 0.05;
/// Flatter than this, m, a piece has no heading of its own.
const STEEP_M: f64 = 1e-3;

/// A piece of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    from_m: Vector3<f64>,
    to_m: Vector3<f64>,
    from_tangent_m: Vector3<f64>,
    to_tangent_m: Vector3<f64>,
}

/// How the next piece begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onward {
    /// When, µs.
    pub time_us: u64,
    /// Where, NED, m.
    pub position_m: Vector3<f64>,
    tangent_m: Vector3<f64>,
    speed_m_s: f64,
    /// How far the motion is past its beginning already, m.
    past_m: f64,
}

/// A piece that is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spline {
    piece: Piece,
    /// Fastest at each part's beginning, and at the end, m/s.
    fastest_m_s: [f64; PARTS + 1],
    /// How far it is flown, of 1.
    u: f64,
    speed_m_s: f64,
    /// Direction at its end before it was shortened, m.
    onward_m: Vector3<f64>,
    /// Whether another piece follows without a stop.
    goes_on: bool,
}

impl Piece {
    /// Long directions at its ends would make loops: together they are at most four times as long as the way.
    fn new(from_m: Vector3<f64>, to_m: Vector3<f64>, tangents_m: [Vector3<f64>; 2]) -> Self {
        let longest_m = 4.0 * (to_m - from_m).norm();
        let [from, to] = tangents_m;
        let sum_m = (from + to).norm();
        let share = if sum_m > longest_m { longest_m / sum_m } else { 1.0 };
        Self { from_m, to_m, from_tangent_m: from * share, to_tangent_m: to * share }
    }

    fn position_m(&self, u: f64) -> Vector3<f64> {
        let (u2, u3) = (u * u, u * u * u);
        self.from_m * (2.0 * u3 - 3.0 * u2 + 1.0)
            + self.from_tangent_m * (u3 - 2.0 * u2 + u)
            + self.to_m * (3.0 * u2 - 2.0 * u3)
            + self.to_tangent_m * (u3 - u2)
    }

    /// First and second derivative by u.
    fn derivatives_m(&self, u: f64) -> [Vector3<f64>; 2] {
        let way = self.from_m - self.to_m;
        let (from, to) = (self.from_tangent_m, self.to_tangent_m);
        let first = way * (6.0 * u * u - 6.0 * u)
            + from * (3.0 * u * u - 4.0 * u + 1.0)
            + to * (3.0 * u * u - 2.0 * u);
        let second = way * (12.0 * u - 6.0) + from * (6.0 * u - 4.0) + to * (6.0 * u - 2.0);
        [first, second]
    }

    /// How long it is for each unit of u, m.
    fn rate_m(&self, u: f64) -> f64 {
        self.derivatives_m(u)[0].norm().max(1e-3)
    }

    /// Direction and curvature, 1/m: κ = (p″ − (p″·t) t) / |p′|².
    fn direction(&self, u: f64) -> [Vector3<f64>; 2] {
        let [first, second] = self.derivatives_m(u);
        let along = first
            .try_normalize(1e-9)
            .or_else(|| (self.to_m - self.from_m).try_normalize(1e-9))
            .unwrap_or_else(Vector3::x);
        let curvature = (second - along * second.dot(&along)) / first.norm_squared().max(1e-6);
        [along, curvature]
    }

    /// The fastest that the limits allow at a place of it, m/s.
    fn fastest_m_s(&self, u: f64, limits: &Limits) -> f64 {
        let [along, curvature] = self.direction(u);
        let within = |limit: f64, share: f64| if share > 1e-6 { limit / share } else { f64::INFINITY };
        let vertical = if along.z > 0.0 { limits.speed_down_m_s } else { limits.speed_up_m_s };
        let sideways_m_s2 = CENTRIPETAL * limits.acceleration_horizontal_m_s2;
        within(limits.speed_horizontal_m_s, along.xy().norm())
            .min(within(vertical, along.z.abs()))
            .min(libm::sqrt(within(sideways_m_s2, curvature.norm())))
    }

    /// The fastest at each part's beginning, and at its end, that leaves room to brake to a speed at its end, m/s.
    fn plan(&self, end_m_s: f64, limits: &Limits) -> [f64; PARTS + 1] {
        let at = |part: usize| part as f64 / PARTS as f64;
        let mut fastest = core::array::from_fn(|part| self.fastest_m_s(at(part), limits));
        let braking_m_s2 = TANGENTIAL * limits.acceleration_horizontal_m_s2;
        let mut next_m_s = end_m_s;
        for (part, speed) in fastest.iter_mut().enumerate().rev() {
            let length_m = (self.position_m(at(part + 1).min(1.0)) - self.position_m(at(part))).norm();
            *speed = speed.min(libm::sqrt(next_m_s * next_m_s + 2.0 * braking_m_s2 * length_m));
            next_m_s = *speed;
        }
        fastest
    }
}

/// The places of a curve.
struct Nodes {
    nodes_m: Vec<Vector3<f64>>,
    /// How long directions are between two neighbours.
    share: f64,
}

impl Nodes {
    fn new(from_m: Vector3<f64>, ahead_m: &[Vector3<f64>], bend: Bend) -> Self {
        let share = match bend {
            Bend::Wide => 1.0,
            Bend::Close => 0.5,
        };
        let mut nodes_m = vec![from_m];
        nodes_m.extend(ahead_m);
        Self { nodes_m, share }
    }

    /// The direction at a place. At a stop it is that of the way.
    fn tangent_m(&self, index: usize) -> Vector3<f64> {
        let [before, here, after] = [index.checked_sub(1), Some(index), Some(index + 1)]
            .map(|index| self.nodes_m.get(index?).copied());
        let here = here.unwrap_or_default();
        let length = if before.is_some() && after.is_some() { self.share } else { 1.0 };
        (after.unwrap_or(here) - before.unwrap_or(here)) * length
    }

    /// A piece; the first of all begins with this direction.
    fn piece(&self, index: usize, begins_m: Vector3<f64>) -> Option<Piece> {
        let from_tangent_m = if index == 0 { begins_m } else { self.tangent_m(index) };
        let tangents_m = [from_tangent_m, self.tangent_m(index + 1)];
        Some(Piece::new(*self.nodes_m.get(index)?, *self.nodes_m.get(index + 1)?, tangents_m))
    }
}

/// Places along a curve that begins and ends at rest, for each of its pieces: behind its beginning, up to its end, NED, m.
pub fn curve_m(from_m: Vector3<f64>, ahead_m: &[Vector3<f64>]) -> Vec<Vec<Vector3<f64>>> {
    let nodes = Nodes::new(from_m, ahead_m, Bend::Wide);
    let pieces = (0..ahead_m.len()).filter_map(|index| nodes.piece(index, nodes.tangent_m(0)));
    let along = |piece: Piece| (1..=PARTS).map(|part| piece.position_m(part as f64 / PARTS as f64)).collect();
    pieces.map(along).collect()
}

impl Spline {
    /// The piece from a place to the first of the places ahead; what is behind that is flown through without a stop, up to the last of
    /// them. Onward from a piece it begins with the motion at its end, else at rest. `None` without a place ahead.
    pub fn new(
        from_m: Vector3<f64>,
        onward: Option<Onward>,
        ahead_m: &[Vector3<f64>],
        bend: Bend,
        limits: &Limits,
    ) -> Option<Self> {
        let nodes = Nodes::new(from_m, ahead_m, bend);
        let begins_m = onward.map_or(nodes.tangent_m(0), |onward| onward.tangent_m);
        // From the last piece back: each must leave room to brake for the next.
        let mut fastest_m_s = [0.0; PARTS + 1];
        let mut end_m_s = 0.0;
        for index in (0..ahead_m.len()).rev() {
            fastest_m_s = nodes.piece(index, begins_m)?.plan(end_m_s, limits);
            [end_m_s, ..] = fastest_m_s;
        }
        let piece = nodes.piece(0, begins_m)?;
        let past_m = onward.map_or(0.0, |onward| onward.past_m);
        Some(Self {
            piece,
            fastest_m_s,
            u: past_m / piece.rate_m(0.0),
            speed_m_s: onward.map_or(0.0, |onward| onward.speed_m_s),
            onward_m: nodes.tangent_m(1),
            goes_on: ahead_m.len() > 1,
        })
    }

    /// Where it ends, NED, m.
    pub fn end_m(&self) -> Vector3<f64> {
        self.piece.to_m
    }

    /// Heading at its end, rad, if it has one.
    pub fn end_heading_rad(&self) -> Option<f64> {
        heading_rad(&self.piece.direction(1.0)[0])
    }

    /// How the next piece begins, if it follows without a stop.
    pub fn onward(&self, time_us: u64) -> Option<Onward> {
        self.goes_on.then_some(Onward {
            time_us,
            position_m: self.piece.to_m,
            tangent_m: self.onward_m,
            speed_m_s: self.speed_m_s,
            past_m: (self.u - 1.0).max(0.0) * self.piece.rate_m(1.0),
        })
    }

    /// Moves on by `dt_s`; `None` at its end.
    pub fn step(&mut self, limits: &Limits, dt_s: f64) -> Option<PositionSetPoint> {
        if self.u >= 1.0 {
            return None;
        }
        let change_m_s = TANGENTIAL * limits.acceleration_horizontal_m_s2 * dt_s;
        let wanted = self.fastest_now_m_s().max(SLOWEST_M_S);
        // The plan can be kept; where a part's end is nearer than planned it brakes a little harder.
        let speed = wanted.min(self.speed_m_s + change_m_s);
        let acceleration_m_s2 = ((speed - self.speed_m_s) / dt_s).max(-2.0 * change_m_s / dt_s);
        self.speed_m_s = speed;
        let middle = self.u + 0.5 * dt_s * speed / self.piece.rate_m(self.u);
        self.u += dt_s * speed / self.piece.rate_m(middle);
        if !self.goes_on {
            self.u = self.u.min(1.0);
        }
        Some(self.set_point(acceleration_m_s2))
    }

    fn fastest_now_m_s(&self) -> f64 {
        let place = self.u * PARTS as f64;
        let part = (place as usize).min(PARTS - 1);
        let (Some(here), Some(next)) = (self.fastest_m_s.get(part), self.fastest_m_s.get(part + 1)) else {
            return 0.0;
        };
        // Speeds under a constant deceleration: their squares are even.
        libm::sqrt(here * here + (next * next - here * here) * (place - part as f64).clamp(0.0, 1.0))
    }

    fn set_point(&self, tangential_m_s2: f64) -> PositionSetPoint {
        let [along, curvature] = self.piece.direction(self.u);
        let (position_m, v) = (self.piece.position_m(self.u), self.speed_m_s);
        let acceleration_m_s2 = along * tangential_m_s2 + curvature * (v * v);
        let axes = core::array::from_fn(|axis| AxisTarget::Track {
            position_m: position_m[axis],
            velocity_m_s: along[axis] * v,
            acceleration_m_s2: acceleration_m_s2[axis],
        });
        // ψ̇ = (t_x κ_y − t_y κ_x) v / |t_xy|²
        let yaw = match heading_rad(&along) {
            Some(heading_rad) => {
                let turn = along.x * curvature.y - along.y * curvature.x;
                YawTarget::Track(heading_rad, turn * v / along.xy().norm_squared())
            }
            None => YawTarget::Hold,
        };
        PositionSetPoint { axes, yaw }
    }
}

fn heading_rad(along: &Vector3<f64>) -> Option<f64> {
    (along.xy().norm() > STEEP_M).then(|| libm::atan2(along.y, along.x))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::Limits;

    use super::{AxisTarget, Bend, Onward, Spline};

    fn motion(spline: &mut Spline, limits: &Limits) -> Option<[Vector3<f64>; 3]> {
        let set_point = spline.step(limits, 0.001)?;
        let track = |axis: &AxisTarget, which: usize| match axis {
            AxisTarget::Track { position_m, velocity_m_s, acceleration_m_s2 } => {
                [*position_m, *velocity_m_s, *acceleration_m_s2][which]
            }
            other => panic!("{other:?}"),
        };
        Some([0, 1, 2].map(|which| Vector3::from(set_point.axes.each_ref().map(|axis| track(axis, which)))))
    }

    /// Position, velocity and acceleration are derivatives of one another, within the limits, without a stop and through every place.
    #[test]
    fn a_chain_is_flown_smoothly_through_its_places() {
        let limits = Limits::default();
        let places = [[30.0, 0.0, -10.0], [40.0, 30.0, -12.0], [0.0, 40.0, -10.0], [-5.0, 5.0, -8.0]];
        let places = places.map(Vector3::from);
        let mut from_m = Vector3::new(0.0, 0.0, -10.0);
        let (mut onward, mut last) = (None, None::<[Vector3<f64>; 3]>);
        let mut fastest: f64 = 0.0;
        for index in 0..places.len() {
            let mut spline = Spline::new(from_m, onward, &places[index..], Bend::Wide, &limits).unwrap();
            while let Some([position_m, velocity_m_s, acceleration_m_s2]) = motion(&mut spline, &limits) {
                if let Some([before_m, before_m_s, _]) = last {
                    let moved_m = position_m - before_m;
                    assert!((moved_m - (before_m_s + velocity_m_s) * 0.0005).norm() < 2e-3, "{position_m}");
                    assert!(
                        (velocity_m_s - before_m_s).norm() < 0.02,
                        "{position_m} {velocity_m_s} {before_m_s}"
                    );
                }
                assert!(velocity_m_s.xy().norm() <= limits.speed_horizontal_m_s + 1e-9);
                assert!(
                    acceleration_m_s2.xy().norm() <= 0.8 * limits.acceleration_horizontal_m_s2,
                    "{position_m}"
                );
                fastest = fastest.max(velocity_m_s.norm());
                last = Some([position_m, velocity_m_s, acceleration_m_s2]);
            }
            let [end_m, end_m_s, _] = last.unwrap();
            assert!((end_m - places[index]).norm() < 0.01, "{end_m}");
            let rests = index + 1 == places.len();
            assert!(if rests { end_m_s.norm() < 0.2 } else { end_m_s.norm() > 1.0 }, "{index}: {end_m_s}");
            from_m = places[index];
            onward = spline.onward(0);
            assert_eq!(onward.is_none(), rests);
        }
        assert!(fastest > 4.0, "{fastest}");
    }

    #[test]
    fn nowhere_is_no_curve_and_here_is_a_short_one() {
        let limits = Limits::default();
        let here_m = Vector3::new(1.0, 2.0, -3.0);
        assert_eq!(Spline::new(here_m, None, &[], Bend::Wide, &limits), None);
        let onward = Some(Onward {
            time_us: 0,
            position_m: here_m,
            tangent_m: Vector3::x(),
            speed_m_s: 0.0,
            past_m: 0.0,
        });
        for onward in [None, onward] {
            let mut spline = Spline::new(here_m, onward, &[here_m], Bend::Wide, &limits).unwrap();
            let ends = (0..10_000).any(|_| motion(&mut spline, &limits).is_none());
            assert!(ends, "{spline:?}");
        }
    }
}
