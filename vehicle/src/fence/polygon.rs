//! A simple polygon in the plane.

/// Corners, m, in order; the last one is joined to the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    corners: Vec<[f64; 2]>,
}

/// Narrower than this, m, it encloses nothing that a place could be told to be in.
const NARROWEST_M: f64 = 0.1;

/// Why corners are no polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolygonFault {
    /// Fewer than three.
    #[error("a polygon needs at least 3 corners, not {0}")]
    TooFew(usize),
    /// All corners are on one line, or nearly.
    #[error("all corners lie on one line; it must be at least {NARROWEST_M} m wide")]
    Flat,
    /// Two sides cross or touch; sides are counted from zero, and begin at the corner of their number. A person counts from one.
    #[error("sides {} and {} cross; the first is 1", .0 + 1, .1 + 1)]
    Crossing(usize, usize),
}

impl Polygon {
    /// The polygon of some corners.
    ///
    /// # Errors
    /// [`PolygonFault`] when they enclose nothing, or it is not clear what.
    pub fn new(corners: Vec<[f64; 2]>) -> Result<Self, PolygonFault> {
        let count = corners.len();
        if count < 3 {
            return Err(PolygonFault::TooFew(count));
        }
        let polygon = Self { corners };
        if polygon.width_m() < NARROWEST_M {
            return Err(PolygonFault::Flat);
        }
        let sides: Vec<Side> = polygon.sides().collect();
        for (first, one) in sides.iter().enumerate() {
            for (second, other) in sides.iter().enumerate().skip(first + 1) {
                let neighbours = second == first + 1 || (first == 0 && second == count - 1);
                let meet = if neighbours { folded(one, other) } else { crosses(one, other) };
                if meet {
                    return Err(PolygonFault::Crossing(first, second));
                }
            }
        }
        Ok(polygon)
    }

    /// Width across the line from the first corner to the farthest one, m.
    fn width_m(&self) -> f64 {
        let first = self.corners.first().copied().unwrap_or_default();
        let length = |corner: &[f64; 2]| libm::hypot(corner[0] - first[0], corner[1] - first[1]);
        let farthest =
            self.corners.iter().copied().max_by(|one, other| length(one).total_cmp(&length(other)));
        let farthest = farthest.unwrap_or(first);
        let length_m = length(&farthest);
        if length_m == 0.0 {
            return 0.0;
        }
        let aside = self.corners.iter().map(|corner| turn(first, farthest, *corner) / length_m);
        let (least, most) = aside.fold((0.0_f64, 0.0_f64), |(least, most), at| (least.min(at), most.max(at)));
        most - least
    }

    /// Corners in order.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// Whether a point is inside: a ray from it to the east leaves through an odd number of sides.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let mut inside = false;
        for ([ax, ay], [bx, by]) in self.sides() {
            // Half-open in x, so that a corner on the ray counts once.
            if (ax > x) != (bx > x) && y < ay + (by - ay) * (x - ax) / (bx - ax) {
                inside = !inside;
            }
        }
        inside
    }

    /// Distance of a point to the border, m.
    pub fn distance_m(&self, point: [f64; 2]) -> f64 {
        self.sides().map(|side| distance_to(&side, point)).fold(f64::INFINITY, f64::min)
    }

    /// Whether the straight way between two points meets the border.
    pub fn is_met_by(&self, way: &Side) -> bool {
        self.sides().any(|side| crosses(&side, way))
    }

    /// Whether the straight way between two points meets the border or comes as near to it as a margin, m.
    pub(super) fn comes_within(&self, way: &Side, margin_m: f64) -> bool {
        self.sides().any(|side| {
            crosses(&side, way)
                || distance_to(&side, way.0) <= margin_m
                || distance_to(&side, way.1) <= margin_m
                || distance_to(way, side.0) <= margin_m
        })
    }

    /// The parts of a straight way that are inside, as shares of it from one to another, are added.
    pub(super) fn parts_inside(&self, way: &Side, parts: &mut Vec<(f64, f64)>) {
        let along = minus(way.1, way.0);
        let mut shares = vec![0.0, 1.0];
        for (a, b) in self.sides().filter(|side| crosses(side, way)) {
            let (side, offset) = (minus(b, a), minus(a, way.0));
            let area = along[0] * side[1] - along[1] * side[0];
            let share = (offset[0] * side[1] - offset[1] * side[0]) / area;
            // A side that the way lies on has two ends where the next sides cross.
            if share.is_finite() {
                shares.push(share.clamp(0.0, 1.0));
            }
        }
        shares.sort_by(f64::total_cmp);
        let between = shares.iter().zip(shares.iter().skip(1));
        parts.extend(between.map(|(from, to)| (*from, *to)).filter(|(from, to)| {
            let middle = f64::midpoint(*from, *to);
            self.contains([way.0[0] + middle * along[0], way.0[1] + middle * along[1]])
        }));
    }

    /// South-west and north-east corners of what surrounds it, north and east, m.
    pub(super) fn bounds_m(&self) -> [[f64; 2]; 2] {
        let most = |of: fn(f64, f64) -> f64, from: f64| {
            self.corners
                .iter()
                .fold([from; 2], |most, corner| [of(most[0], corner[0]), of(most[1], corner[1])])
        };
        [most(f64::min, f64::INFINITY), most(f64::max, f64::NEG_INFINITY)]
    }

    /// Area, m²: positive when the corners follow one another clockwise, seen from above.
    pub fn signed_area_m2(&self) -> f64 {
        let first = self.corners.first().copied().unwrap_or_default();
        self.sides().map(|(a, b)| turn(first, a, b)).sum::<f64>() / 2.0
    }

    /// Its sides.
    pub fn sides(&self) -> impl Iterator<Item = Side> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(one, other)| (*one, *other))
    }
}

/// From one point to another.
pub type Side = ([f64; 2], [f64; 2]);

/// Twice the area of the triangle, m²: positive when `c` is to the right of the way from `a` to `b`, seen from above.
fn turn([ax, ay]: [f64; 2], [bx, by]: [f64; 2], [cx, cy]: [f64; 2]) -> f64 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// Whether two sides have a point in common.
fn crosses(one: &Side, other: &Side) -> bool {
    let ((a, b), (c, d)) = (*one, *other);
    let apart = |p: f64, q: f64| (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0);
    if apart(turn(a, b, c), turn(a, b, d)) || apart(turn(c, d, a), turn(c, d, b)) {
        return false;
    }
    // On one line they meet where their shadows on both axes do.
    (0..2).all(|axis| {
        let range = |p: [f64; 2], q: [f64; 2]| (p[axis].min(q[axis]), p[axis].max(q[axis]));
        let ((low, high), (start, end)) = (range(a, b), range(c, d));
        low <= end && start <= high
    })
}

/// Whether two neighbouring sides lie on one another, or one of them has no length.
fn folded(one: &Side, other: &Side) -> bool {
    let (shared, far_one, far_other) =
        if one.1 == other.0 { (one.1, one.0, other.1) } else { (one.0, one.1, other.0) };
    let (u, v) = (minus(far_one, shared), minus(far_other, shared));
    let dot = u[0] * v[0] + u[1] * v[1];
    let none = u == [0.0; 2] || v == [0.0; 2];
    none || (turn(shared, far_one, far_other) == 0.0 && dot > 0.0)
}

fn minus([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> [f64; 2] {
    [ax - bx, ay - by]
}

/// Distance of a point to a side, m.
pub fn distance_to((a, b): &Side, point: [f64; 2]) -> f64 {
    let (along, offset) = (minus(*b, *a), minus(point, *a));
    let length_squared = along[0] * along[0] + along[1] * along[1];
    let share = if length_squared > 0.0 {
        ((offset[0] * along[0] + offset[1] * along[1]) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let apart = [offset[0] - share * along[0], offset[1] - share * along[1]];
    libm::sqrt(apart[0] * apart[0] + apart[1] * apart[1])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Polygon, PolygonFault};

    /// Angle that the border turns through as seen from a point, in whole turns: another way to tell inside from outside.
    fn winding_number(polygon: &Polygon, [x, y]: [f64; 2]) -> i32 {
        let angle = |corner: &[f64; 2]| (corner[1] - y).atan2(corner[0] - x);
        let total: f64 = polygon
            .corners()
            .iter()
            .zip(polygon.corners().iter().cycle().skip(1))
            .map(|(one, other)| {
                let difference = angle(other) - angle(one);
                difference - (difference / core::f64::consts::TAU).round() * core::f64::consts::TAU
            })
            .sum();
        (total / core::f64::consts::TAU).round() as i32
    }

    /// A star-shaped polygon, which never crosses itself.
    fn star() -> impl Strategy<Value = Polygon> {
        prop::collection::vec(5.0..100.0, 3..12).prop_map(|radii| {
            let count = radii.len() as f64;
            let corner = |(index, radius): (usize, f64)| {
                let angle = index as f64 * core::f64::consts::TAU / count;
                [radius * angle.cos(), radius * angle.sin()]
            };
            Polygon::new(radii.into_iter().enumerate().map(corner).collect()).expect("does not cross itself")
        })
    }

    proptest! {
        #[test]
        fn inside_is_where_the_border_winds_around(polygon in star(), x in -120.0..120.0, y in -120.0..120.0) {
            prop_assume!(polygon.distance_m([x, y]) > 1e-6);
            prop_assert_eq!(polygon.contains([x, y]), winding_number(&polygon, [x, y]) != 0);
        }

        /// A circle of the distance to the border does not change sides, a way to the other side meets the border.
        #[test]
        fn the_distance_is_that_to_the_other_side(polygon in star(), x in -120.0..120.0, y in -120.0..120.0, angle in 0.0..6.3) {
            let distance: f64 = polygon.distance_m([x, y]);
            let at = |share: f64| [x + share * distance * f64::cos(angle), y + share * distance * f64::sin(angle)];
            prop_assert_eq!(polygon.contains(at(0.999)), polygon.contains([x, y]));
            let far = [x + 500.0 * f64::cos(angle), y + 500.0 * f64::sin(angle)];
            if polygon.contains([x, y]) {
                prop_assert!(polygon.is_met_by(&([x, y], far)));
            }
        }
    }

    #[test]
    fn what_encloses_nothing_is_refused() {
        let square = [[0.0, 0.0], [0.0, 10.0], [10.0, 10.0], [10.0, 0.0]];
        assert!(Polygon::new(square.to_vec()).is_ok());
        assert_eq!(Polygon::new(square[..2].to_vec()), Err(PolygonFault::TooFew(2)));
        let [a, b, c, d] = square;
        assert_eq!(Polygon::new(vec![a, c, b, d]), Err(PolygonFault::Crossing(0, 2)));
        assert_eq!(PolygonFault::Crossing(0, 2).to_string(), "sides 1 and 3 cross; the first is 1");
        assert_eq!(Polygon::new(vec![a, b, b, c]), Err(PolygonFault::Crossing(0, 1)));
        assert_eq!(Polygon::new(vec![a, b, a, c]), Err(PolygonFault::Crossing(0, 1)));
        // On one line, but for the rounding of latitudes and longitudes; a thin wall is none.
        let line = |aside: f64| vec![[0.0, 0.0], [100.0, 100.0], [50.0, 50.0 + aside]];
        assert_eq!(Polygon::new(line(0.0)), Err(PolygonFault::Flat));
        assert_eq!(Polygon::new(line(0.01)), Err(PolygonFault::Flat));
        assert!(Polygon::new(line(0.5)).is_ok());
        let tiny = square.map(|corner| corner.map(|m: f64| m / 1000.0));
        assert_eq!(Polygon::new(tiny.to_vec()), Err(PolygonFault::Flat));
        assert_eq!(Polygon::new(vec![a; 4]), Err(PolygonFault::Flat));
    }
}
