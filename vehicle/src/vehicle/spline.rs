//! A curve through places: pieces whose directions and curvatures agree at the places. The direction at a place is that from the place
//! before it to the one behind it; the curvature is the mean of what cubic pieces before and behind it would have there.

use nalgebra::Vector3;
use quadrotor::{Limits, PositionReference};

use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::trajectory::{CurvePiece, CurveSpeed, EasedSpeed};

/// How long the directions at the places are, of the way from the place before to the one behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    /// As long: a wide curve, as ArduPilot's spline waypoints have it.
    Wide,
    /// Half as long (Catmull and Rom): between places that lie densely on a smooth curve it stays on that one.
    Close,
}

/// Places on a way that is to be flown along one curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePlaces {
    /// Where the curve begins, NED, m.
    pub from_m: Vector3<f64>,
    /// The places ahead, NED, m.
    pub places_m: Vec<Vector3<f64>>,
}

impl CurvePlaces {
    /// None yet beyond the beginning, NED, m.
    pub fn new(from_m: Vector3<f64>) -> Self {
        Self { from_m, places_m: Vec::new() }
    }

    /// Where it ends so far, NED, m.
    pub fn end_m(&self) -> Vector3<f64> {
        self.places_m.last().copied().unwrap_or(self.from_m)
    }

    /// Whether the way from its end to another place turns back by more than 150 degrees: a curve has no direction there, and would be
    /// flown through at full speed.
    pub fn turns_back(&self, place_m: &Vector3<f64>) -> bool {
        const COSINE: f64 = -0.866;
        let [.., end_m] = self.places_m[..] else { return false };
        let before_m = self.places_m.len().checked_sub(2).and_then(|index| self.places_m.get(index));
        let (comes, goes) = (end_m - before_m.unwrap_or(&self.from_m), place_m - end_m);
        comes.dot(&goes) < COSINE * comes.norm() * goes.norm() && !is_near(&end_m, place_m)
    }

    /// Goes on to a place, unless that is where it ends already. Returns whether it does.
    pub fn push(&mut self, place_m: Vector3<f64>) -> bool {
        let goes_on = !is_near(&self.end_m(), &place_m);
        if goes_on {
            self.places_m.push(place_m);
        }
        goes_on
    }
}

/// Whether two places are too near one another for a curve between them.
pub fn is_near(here_m: &Vector3<f64>, there_m: &Vector3<f64>) -> bool {
    const NEAR_M: f64 = 0.01;
    (there_m - here_m).norm() <= NEAR_M
}

/// Flatter than this, m, a piece has no heading of its own.
const STEEP_M: f64 = 1e-3;

/// How the next piece begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onward {
    /// When, µs.
    pub time_us: u64,
    /// Where, NED, m.
    pub position_m: Vector3<f64>,
    tangent_m: Vector3<f64>,
    /// 1/m
    curvature: Vector3<f64>,
    speed: EasedSpeed,
    /// How far the motion is past its beginning already, m.
    past_m: f64,
}

impl Onward {
    /// On from a motion at a time, µs, if that is fast enough to have a direction and is about even.
    pub fn of(motion: &PositionReference, time_us: u64) -> Option<Self> {
        /// Slower than this, m/s, it has none.
        const SLOWEST_M_S: f64 = 0.2;
        /// What it accelerates by, m/s², ends at once.
        const EVEN_M_S2: f64 = 0.2;
        /// About as long as the pieces of a curve through places that lie densely.
        const TANGENT_M: f64 = 4.0;
        let speed_m_s = motion.velocity_m_s.norm();
        if motion.acceleration_m_s2.norm() > EVEN_M_S2 {
            return None;
        }
        Some(Self {
            time_us,
            position_m: motion.position_m,
            tangent_m: motion.velocity_m_s.try_normalize(SLOWEST_M_S)? * TANGENT_M,
            curvature: Vector3::zeros(),
            speed: EasedSpeed::even(speed_m_s),
            past_m: 0.0,
        })
    }

    /// Its direction, of length one.
    pub fn direction(&self) -> Vector3<f64> {
        self.tangent_m.try_normalize(0.0).unwrap_or_default()
    }
}

/// A piece that is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spline {
    piece: CurvePiece,
    fastest: CurveSpeed,
    speed: EasedSpeed,
    /// How far it is flown, of 1.
    u: f64,
    /// Direction at its end before it was shortened, m.
    onward_m: Vector3<f64>,
    /// Whether another piece follows without a stop.
    goes_on: bool,
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
        let tangents_m = tangents_m(from_m, onward.as_ref(), ahead_m, bend);
        let pieces = pieces(from_m, onward.as_ref(), ahead_m, &tangents_m);
        let piece = *pieces.first()?;
        let past_m = onward.map_or(0.0, |onward| onward.past_m);
        Some(Self {
            piece,
            fastest: CurveSpeed::new(&pieces, limits),
            speed: onward.map_or(EasedSpeed::even(0.0), |onward| onward.speed),
            u: past_m / piece.rate_m(0.0),
            onward_m: *tangents_m.get(1)?,
            goes_on: ahead_m.len() > 1,
        })
    }

    /// Whether it begins no faster than it may be flown.
    pub fn can_be_kept(&self) -> bool {
        self.speed.fits(&self.fastest)
    }

    /// Where it ends, NED, m.
    pub fn end_m(&self) -> Vector3<f64> {
        self.piece.end_m()
    }

    /// Where it begins and where it ends, NED, m.
    pub fn ends_m(&self) -> [Vector3<f64>; 2] {
        [self.piece.position_m(0.0), self.end_m()]
    }

    /// Two places on the line that touches it where the motion is, NED, m.
    pub fn touching_m(&self) -> [Vector3<f64>; 2] {
        let here_m = self.piece.position_m(self.u);
        [here_m, here_m + self.piece.at(self.u).direction]
    }

    /// Heading at its end, rad, if it has one.
    pub fn end_heading_rad(&self) -> Option<f64> {
        heading_rad(&self.piece.at(1.0).direction)
    }

    /// How the next piece begins, if it follows without a stop.
    pub fn onward(&self, time_us: u64) -> Option<Onward> {
        self.goes_on.then_some(Onward {
            time_us,
            position_m: self.piece.end_m(),
            tangent_m: self.onward_m,
            curvature: self.piece.at(1.0).curvature,
            speed: self.speed.onto_next(self.fastest.length_m),
            past_m: (self.u - 1.0).max(0.0) * self.piece.rate_m(1.0),
        })
    }

    /// Moves on by `dt_s`; `None` at its end.
    pub fn step(&mut self, dt_s: f64) -> Option<PositionSetPoint> {
        let ends = if self.goes_on { self.u >= 1.0 } else { self.speed.rests(&self.fastest) };
        if ends {
            return None;
        }
        let moved_m = self.speed.step(&self.fastest, dt_s);
        let middle = self.u + 0.5 * moved_m / self.piece.rate_m(self.u);
        self.u += moved_m / self.piece.rate_m(middle);
        if !self.goes_on {
            self.u = self.u.min(1.0);
        }
        Some(self.set_point())
    }

    /// The motion, as it follows from that along the curve:
    ///
    /// ```text
    /// ṗ = v t,   p̈ = a t + v² κ,   p⃛ = j t + 3 v a κ + v³ dκ/ds
    /// ```
    fn set_point(&self) -> PositionSetPoint {
        let (position_m, point) = (self.piece.position_m(self.u), self.piece.at(self.u));
        let (along, curvature) = (point.direction, point.curvature);
        let [v, a, j] = self.speed.motion();
        let acceleration_m_s2 = along * a + curvature * (v * v);
        let jerk_m_s3 = along * j + curvature * (3.0 * v * a) + point.bend * (v * v * v);
        let axes = core::array::from_fn(|axis| AxisTarget::Track {
            position_m: position_m[axis],
            velocity_m_s: along[axis] * v,
            acceleration_m_s2: acceleration_m_s2[axis],
            jerk_m_s3: jerk_m_s3[axis],
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

/// Places on the curve from a place through the places ahead, NED, m: for each of these those behind the one before it, up to itself.
pub fn curve_places_m(
    from_m: Vector3<f64>,
    ahead_m: &[Vector3<f64>],
    bend: Bend,
) -> impl Iterator<Item = Vec<Vector3<f64>>> {
    /// So many parts has a piece at least, and at most.
    const PARTS: (usize, usize) = (16, 1024);
    let tangents_m = tangents_m(from_m, None, ahead_m, bend);
    pieces(from_m, None, ahead_m, &tangents_m).into_iter().map(move |piece| {
        let parts = piece.parts(PARTS);
        let place_m = |part: usize| match part {
            part if part == parts => piece.end_m(),
            _ => piece.position_m(part as f64 / parts as f64),
        };
        (1..=parts).map(place_m).collect()
    })
}

/// The directions at a place and at the places ahead, m.
fn tangents_m(
    from_m: Vector3<f64>,
    onward: Option<&Onward>,
    ahead_m: &[Vector3<f64>],
    bend: Bend,
) -> Vec<Vector3<f64>> {
    let Some(first_m) = ahead_m.first() else { return Vec::new() };
    let share = match bend {
        Bend::Wide => 1.0,
        Bend::Close => 0.5,
    };
    let mut tangents_m = vec![onward.map_or(first_m - from_m, |onward| onward.tangent_m)];
    let mut before_m = from_m;
    for (index, here_m) in ahead_m.iter().enumerate() {
        // At a stop the direction is that of the way.
        let tangent_m = match ahead_m.get(index + 1) {
            Some(after_m) => (after_m - before_m) * share,
            None => here_m - before_m,
        };
        tangents_m.push(tangent_m);
        before_m = *here_m;
    }
    match bend {
        Bend::Wide => tangents_m,
        Bend::Close => sharpened(&tangents_m),
    }
}

/// Differences of places over a distance h as derivatives, but for their fourth power of h: f′ h ≈ d − δ²d/6.
fn sharpened(differences_m: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut sharp_m = differences_m.to_vec();
    for (sharp_m, three) in sharp_m.iter_mut().skip(1).zip(differences_m.windows(3)) {
        if let [before, here, after] = three {
            *sharp_m -= (before - here * 2.0 + after) / 6.0;
        }
    }
    sharp_m
}

/// All pieces from a place through the places ahead, with directions at them, m.
fn pieces(
    from_m: Vector3<f64>,
    onward: Option<&Onward>,
    ahead_m: &[Vector3<f64>],
    tangents_m: &[Vector3<f64>],
) -> Vec<CurvePiece> {
    let mut before_m = from_m;
    let mut cubics = Vec::with_capacity(ahead_m.len());
    for (here_m, ends_m) in ahead_m.iter().zip(tangents_m.windows(2)) {
        if let [begin_m, end_m] = ends_m {
            cubics.push(CurvePiece::cubic(before_m, *here_m, [*begin_m, *end_m]));
        }
        before_m = *here_m;
    }
    let ends = |piece: &CurvePiece| [0.0, 1.0].map(|u| piece.at(u).curvature);
    let curvatures: Vec<_> = cubics.iter().map(ends).collect();
    let at_end = |index: usize| {
        let own = curvatures.get(index).map(|[_, end]| *end);
        let next = curvatures.get(index + 1).map(|[begin, _]| *begin);
        own.zip(next).map_or(own, |(own, next)| Some((own + next) / 2.0)).unwrap_or_default()
    };
    let first = onward.map(|onward| onward.curvature).or(curvatures.first().map(|[begin, _]| *begin));
    let mut begin = first.unwrap_or_default();
    for (index, piece) in cubics.iter_mut().enumerate() {
        let end = at_end(index);
        *piece = piece.bent([begin, end]);
        begin = end;
    }
    cubics
}

fn heading_rad(along: &Vector3<f64>) -> Option<f64> {
    (along.xy().norm() > STEEP_M).then(|| libm::atan2(along.y, along.x))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::Limits;

    use super::{AxisTarget, Bend, CurvePlaces, EasedSpeed, Onward, Spline, curve_places_m};

    /// Position, velocity, acceleration and jerk after another millisecond.
    fn motion(spline: &mut Spline) -> Option<[Vector3<f64>; 4]> {
        let set_point = spline.step(0.001)?;
        let track = |axis: &AxisTarget, which: usize| match axis {
            AxisTarget::Track { position_m, velocity_m_s, acceleration_m_s2, jerk_m_s3 } => {
                [*position_m, *velocity_m_s, *acceleration_m_s2, *jerk_m_s3][which]
            }
            other => panic!("{other:?}"),
        };
        Some(
            [0, 1, 2, 3].map(|which| Vector3::from(set_point.axes.each_ref().map(|axis| track(axis, which)))),
        )
    }

    /// Position, velocity, acceleration and jerk are derivatives of one another, within the limits, without a stop and through every
    /// place, at which the acceleration does not jump.
    fn is_flown_smoothly(places: &[[f64; 3]]) {
        let limits = Limits::default();
        let places: Vec<_> = places.iter().copied().map(Vector3::from).collect();
        let mut from_m = Vector3::new(0.0, 0.0, -10.0);
        let (mut onward, mut last) = (None, None::<[Vector3<f64>; 4]>);
        let mut fastest: f64 = 0.0;
        for index in 0..places.len() {
            let mut spline = Spline::new(from_m, onward, &places[index..], Bend::Wide, &limits).unwrap();
            while let Some(now) = motion(&mut spline) {
                let [position_m, velocity_m_s, acceleration_m_s2, jerk_m_s3] = now;
                if let Some([before_m, before_m_s, before_m_s2, before_m_s3]) = last {
                    let moved_m = position_m - before_m - (before_m_s + velocity_m_s) * 0.0005;
                    assert!(moved_m.norm() < 1e-5, "{position_m} {moved_m}");
                    let gained_m_s = (before_m_s2 + acceleration_m_s2) * 0.0005;
                    assert!((velocity_m_s - before_m_s - gained_m_s).norm() < 1e-4, "{position_m}");
                    let gained_m_s2 = (before_m_s3 + jerk_m_s3) * 0.0005;
                    assert!((acceleration_m_s2 - before_m_s2 - gained_m_s2).norm() < 2e-3, "{position_m}");
                }
                assert!(jerk_m_s3.norm() <= limits.jerk_horizontal_m_s3, "{position_m} {jerk_m_s3}");
                assert!(velocity_m_s.xy().norm() <= limits.speed_horizontal_m_s + 1e-9);
                let across_m_s2 = acceleration_m_s2.xy().norm();
                assert!(across_m_s2 <= 0.8 * limits.acceleration_horizontal_m_s2, "{position_m}");
                fastest = fastest.max(velocity_m_s.norm());
                last = Some(now);
            }
            let [end_m, end_m_s, ..] = last.unwrap();
            assert!((end_m - places[index]).norm() < 0.01, "{end_m}");
            let rests = index + 1 == places.len();
            assert!(if rests { end_m_s.norm() < 0.2 } else { end_m_s.norm() > 0.5 }, "{index}: {end_m_s}");
            from_m = places[index];
            onward = spline.onward(0);
            assert_eq!(onward.is_none(), rests);
        }
        assert!(fastest > 4.0, "{fastest}");
    }

    #[test]
    fn a_chain_is_flown_smoothly_through_its_places() {
        is_flown_smoothly(&[[30.0, 0.0, -10.0], [40.0, 30.0, -12.0], [0.0, 40.0, -10.0], [-5.0, 5.0, -8.0]]);
    }

    /// A bend of metres at the end of a kilometre.
    #[test]
    fn a_narrow_bend_of_a_long_piece_is_seen() {
        is_flown_smoothly(&[[1000.0, 0.0, -10.0], [1012.0, 9.0, -10.0], [1900.0, 300.0, -10.0]]);
    }

    #[test]
    fn between_the_places_on_a_long_piece_there_are_metres() {
        let (from_m, ahead_m) =
            (Vector3::zeros(), [[900.0, 0.0, 0.0], [900.0, 900.0, 0.0]].map(Vector3::from));
        let ways_m: Vec<_> = curve_places_m(from_m, &ahead_m, Bend::Wide).flatten().collect();
        assert_eq!(ways_m.last(), Some(&ahead_m[1]));
        for pair in ways_m.windows(2) {
            assert!((pair[1] - pair[0]).norm() < 10.0, "{pair:?}");
        }
    }

    #[test]
    fn a_curve_neither_turns_back_nor_stays() {
        let place = |north_m: f64, east_m: f64| Vector3::new(north_m, east_m, -5.0);
        let mut places = CurvePlaces::new(place(0.0, 0.0));
        assert!(!places.turns_back(&place(-9.0, 0.0)), "it begins in any direction");
        assert!(!places.push(place(0.005, 0.0)));
        assert!(places.push(place(10.0, 0.0)));
        assert!(!places.push(place(10.0, 0.005)));
        assert!(!places.turns_back(&place(9.995, 0.0)), "that is the same place");
        for (next_m, turns_back) in [
            ([0.0, 0.0], true),
            ([-20.0, 1.0], true),
            ([0.0, 5.0], true),
            ([0.0, 7.0], false),
            ([10.0, 9.0], false),
        ] {
            assert_eq!(places.turns_back(&place(next_m[0], next_m[1])), turns_back, "{next_m:?}");
        }
        assert_eq!(places.places_m, [place(10.0, 0.0)]);
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
            curvature: Vector3::zeros(),
            speed: EasedSpeed::even(0.0),
            past_m: 0.0,
        });
        for onward in [None, onward] {
            let mut spline = Spline::new(here_m, onward, &[here_m], Bend::Wide, &limits).unwrap();
            let ends = (0..10_000).any(|_| motion(&mut spline).is_none());
            assert!(ends, "{spline:?}");
        }
    }
}
