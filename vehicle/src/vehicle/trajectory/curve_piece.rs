//! A piece of a curve: a cubic with given directions at its ends, bent so that its curvature there is a given one, too.
//!
//! ```text
//!  p(u) = (2u³ − 3u² + 1) p₀ + (u³ − 2u² + u) m₀ + (3u² − 2u³) p₁ + (u³ − u²) m₁
//!       + (u² − 3u³ + 3u⁴ − u⁵) b₀/2 + (u³ − 2u⁴ + u⁵) b₁/2,   0 ≤ u ≤ 1
//! ```
//!
//! b₀ and b₁ change p″(0) and p″(1), and neither places nor directions at the ends.

use nalgebra::Vector3;

/// Least |p′|, m: shorter, a piece has no direction there.
const LEAST_RATE_M: f64 = 1e-3;
/// Coefficients of a polynomial of fifth degree.
const COEFFICIENTS: usize = 6;

/// A piece of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePiece {
    from_m: Vector3<f64>,
    to_m: Vector3<f64>,
    /// Of 1, u, u² and so on, m.
    coefficients_m: [Vector3<f64>; COEFFICIENTS],
}

/// What a curve does at a place of it, by its length s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// t = p′/|p′|
    pub direction: Vector3<f64>,
    /// κ = dt/ds, 1/m
    pub curvature: Vector3<f64>,
    /// dκ/ds, 1/m²
    pub bend: Vector3<f64>,
}

impl CurvePiece {
    /// The cubic from a place to another one, NED, m, with directions at its ends, m. Long directions would make loops: together they
    /// are at most four times as long as the way.
    pub fn cubic(from_m: Vector3<f64>, to_m: Vector3<f64>, tangents_m: [Vector3<f64>; 2]) -> Self {
        let way_m = to_m - from_m;
        let longest_m = 4.0 * way_m.norm();
        let [from, to] = tangents_m;
        let sum_m = (from + to).norm();
        let share = if sum_m > longest_m { longest_m / sum_m } else { 1.0 };
        let [from, to] = [from * share, to * share];
        let zero = Vector3::zeros();
        let coefficients_m =
            [from_m, from, way_m * 3.0 - from * 2.0 - to, from + to - way_m * 2.0, zero, zero];
        Self { from_m, to_m, coefficients_m }
    }

    /// The same with other curvatures at its ends, 1/m.
    pub fn bent(mut self, curvatures: [Vector3<f64>; 2]) -> Self {
        let [at_from, at_to] = [(0.0, curvatures[0]), (1.0, curvatures[1])].map(|(u, curvature)| {
            let rate_m = self.rate_m(u);
            (curvature - self.at(u).curvature) * (rate_m * rate_m)
        });
        let shares = [[1.0, -3.0, 3.0, -1.0], [0.0, 1.0, -2.0, 1.0]];
        for (coefficient, [from, to]) in self.coefficients_m.iter_mut().skip(2).zip(transposed(&shares)) {
            *coefficient += (at_from * from + at_to * to) * 0.5;
        }
        self
    }

    /// Where it ends, NED, m.
    pub fn end_m(&self) -> Vector3<f64> {
        self.to_m
    }

    /// The place at u, NED, m.
    pub fn position_m(&self, u: f64) -> Vector3<f64> {
        self.derivative_m::<0>(u)
    }

    /// How long it is for each unit of u there, m.
    pub fn rate_m(&self, u: f64) -> f64 {
        self.derivative_m::<1>(u).norm().max(LEAST_RATE_M)
    }

    /// Length between two places that lie near one another, m (Simpson).
    pub fn length_m(&self, from_u: f64, to_u: f64) -> f64 {
        let middle = (from_u + to_u) / 2.0;
        (to_u - from_u) / 6.0 * (self.rate_m(from_u) + 4.0 * self.rate_m(middle) + self.rate_m(to_u))
    }

    /// Parts of it that are about 4 m long, as far as their number is within a range.
    pub fn parts(&self, (least, most): (usize, usize)) -> usize {
        const PART_M: f64 = 4.0;
        const SHARES: u32 = 8;
        let at = |share: u32| f64::from(share) / f64::from(SHARES);
        let length_m: f64 = (0..SHARES).map(|share| self.length_m(at(share), at(share + 1))).sum();
        (libm::ceil(length_m / PART_M) as usize).clamp(least, most)
    }

    /// What it does at u:
    ///
    /// ```text
    /// κ = (p″ − (p″·t) t)/|p′|²,   dκ/ds = (p‴ − (p‴·t) t)/|p′|³ − 3 (p″·t) κ/|p′|² − κ² t
    /// ```
    pub fn at(&self, u: f64) -> CurvePoint {
        let [first, second, third] =
            [self.derivative_m::<1>(u), self.derivative_m::<2>(u), self.derivative_m::<3>(u)];
        let direction = first
            .try_normalize(1e-9)
            .or_else(|| (self.to_m - self.from_m).try_normalize(1e-9))
            .unwrap_or_else(Vector3::x);
        let rate_m = first.norm().max(LEAST_RATE_M);
        let across = |vector: &Vector3<f64>| vector - direction * vector.dot(&direction);
        let curvature = across(&second) / (rate_m * rate_m);
        let bend = across(&third) / (rate_m * rate_m * rate_m)
            - curvature * (3.0 * second.dot(&direction) / (rate_m * rate_m))
            - direction * curvature.norm_squared();
        CurvePoint { direction, curvature, bend }
    }

    /// The derivative of an order by u, m.
    fn derivative_m<const ORDER: usize>(&self, u: f64) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for (power, coefficient) in self.coefficients_m.iter().enumerate().skip(ORDER).rev() {
            let factor: usize = (power + 1 - ORDER..=power).product();
            sum = sum * u + coefficient * factor as f64;
        }
        sum
    }
}

/// Pairs of numbers that stand below one another.
fn transposed<const N: usize>([upper, lower]: &[[f64; N]; 2]) -> [[f64; 2]; N] {
    core::array::from_fn(|column| [upper[column], lower[column]])
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::CurvePiece;

    fn piece() -> CurvePiece {
        let tangents_m = [Vector3::new(20.0, 3.0, -1.0), Vector3::new(5.0, 22.0, 2.0)];
        CurvePiece::cubic(Vector3::new(1.0, 2.0, -3.0), Vector3::new(18.0, 14.0, -5.0), tangents_m)
    }

    /// The oracle are differences of places that lie densely on it.
    #[test]
    fn direction_curvature_and_bend_are_derivatives_by_the_length() {
        const STEP: f64 = 1e-4;
        for piece in [piece(), piece().bent([Vector3::new(-0.002, 0.013, 0.01), Vector3::zeros()])] {
            for part in 1..100 {
                let u = f64::from(part) / 100.0;
                let (before, here, after) = (piece.at(u - STEP), piece.at(u), piece.at(u + STEP));
                let length_m = piece.length_m(u - STEP, u + STEP);
                let way_m = piece.position_m(u + STEP) - piece.position_m(u - STEP);
                assert!((way_m / length_m - here.direction).norm() < 1e-6, "{u}");
                let curvature = (after.direction - before.direction) / length_m;
                assert!((curvature - here.curvature).norm() < 1e-6, "{u}: {curvature} {here:?}");
                let bend = (after.curvature - before.curvature) / length_m;
                assert!((bend - here.bend).norm() < 1e-5, "{u}: {bend} {here:?}");
            }
        }
    }

    #[test]
    fn curvatures_at_the_ends_change_neither_places_nor_directions_there() {
        // Across the directions.
        let curvatures = [Vector3::new(3.0, -20.0, 0.0) * 1e-3, Vector3::new(22.0, -5.0, 0.0) * 1e-3];
        let (cubic, bent) = (piece(), piece().bent(curvatures));
        for (u, curvature) in [(0.0, curvatures[0]), (1.0, curvatures[1])] {
            assert!((cubic.position_m(u) - bent.position_m(u)).norm() < 1e-12, "{u}");
            assert!((cubic.at(u).direction - bent.at(u).direction).norm() < 1e-12, "{u}");
            assert!((bent.at(u).curvature - curvature).norm() < 1e-12, "{u}: {:?}", bent.at(u));
            assert!((cubic.at(u).curvature - curvature).norm() > 1e-3, "{u}: {:?}", cubic.at(u));
        }
    }

    /// A quarter of a circle of 10 m, as near as a cubic comes to it.
    #[test]
    fn its_length_is_that_of_its_way() {
        let k = 4.0 * (2.0_f64.sqrt() - 1.0);
        let tangents_m = [Vector3::y(), -Vector3::x()].map(|tangent| tangent * (10.0 * k));
        let arc = CurvePiece::cubic(Vector3::x() * 10.0, Vector3::y() * 10.0, tangents_m);
        let length_m: f64 =
            (0..16).map(|part| arc.length_m(f64::from(part) / 16.0, f64::from(part + 1) / 16.0)).sum();
        assert!((length_m - 5.0 * core::f64::consts::PI).abs() < 0.01, "{length_m}");
        assert_eq!(arc.end_m(), Vector3::y() * 10.0);
    }
}
