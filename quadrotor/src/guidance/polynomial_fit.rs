//! A polynomial through noisy samples of a motion.
//!
//! It is of up to fifth degree, and is found in the basis of the discrete orthogonal polynomials of its samples (Forsythe 1957):
//!
//! ```text
//! p₋₁ = 0,  p₀ = 1,  p_{k+1}(x) = (x − α_k) p_k(x) − β_k p_{k−1}(x)
//! α_k = Σ x p_k²/S_k,  β_k = S_k/S_{k−1},  S_k = Σ p_k²,  c_k = Σ y p_k/S_k
//! ```
//!
//! The noise σ of the samples makes c_k uncertain by σ²/S_k. A coefficient within twice that is no information: each but c₀ counts
//! as c_k (1 − 4 σ²/(S_k c_k²)), or not at all. So noisy samples have a derivative of low degree, or none.
//!
//! What the terms c_k √S_k add to the samples falls quickly with k where the motion is smooth. Behind a corner it does not: there the
//! highest derivatives are those of the corner, not of the motion that follows it, and are not told.

use nalgebra::SVector;

use crate::guidance::derivative_estimator::CAPACITY;

/// Largest degree.
const DEGREE: usize = 5;
/// The value and the derivatives that are taken of it.
const ORDERS: usize = 5;
/// Variances that a coefficient loses from its square.
const VARIANCES: f64 = 4.0;
/// From this degree on, each term of a smooth motion adds less than this share of what the one before adds, or its square of the
/// one before that: a motion may have no derivative of an order at an instant. Sinusoids of up to 2 rad/s, set every 200 ms, do.
const CONVERGING: usize = 4;
const DECAY: f64 = 0.2;
/// Terms that do not fall may be those of a smooth motion, too, at an instant. Behind a corner a polynomial leaves about as much as its
/// last term adds; so many samples more than it has coefficients, of which it leaves no more than this share of that term, know of none.
const TELLING: usize = 3;
const LEFT_OF_LAST: f64 = 0.04;
/// As long as they reach no further back than this, s: a longer motion that ends is carried on for too long.
const LONGEST_S: f64 = 0.5;

/// A least-squares polynomial, seen at one instant.
pub(crate) struct PolynomialFit<const AXES: usize> {
    pub degree: usize,
    /// Its value and first derivatives. The third and fourth are zero behind a corner.
    pub derivatives: [SVector<f64, AXES>; ORDERS],
    /// Standard deviation of a new sample from its value.
    pub deviation: f64,
    /// Variance of the samples that it leaves.
    pub left: f64,
    /// Whether it knows of no corner.
    pub smooth: bool,
}

/// One polynomial p_k of the basis in a fit.
#[derive(Clone, Copy)]
struct Term<const AXES: usize> {
    /// c_k
    coefficient: SVector<f64, AXES>,
    /// S_k
    size: f64,
    /// p_k and its first derivatives at the instant.
    there: [f64; ORDERS],
}

impl<const AXES: usize> PolynomialFit<AXES> {
    /// Of samples, the newest last, with a noise of at least a variance. `None` with fewer than three of them: there must be one more
    /// than the polynomial has coefficients.
    pub fn new(
        samples: &[(u64, SVector<f64, AXES>)],
        (least_variance, is_rate): (f64, bool),
        time_us: u64,
    ) -> Option<Self> {
        let ([(first_us, _), .., (last_us, _)], 3..) = (samples, samples.len()) else { return None };
        let degree = DEGREE.min(samples.len() - 2);
        let half_s = last_us.saturating_sub(*first_us) as f64 / 2e6;
        // −1 at the first sample, 1 at the last
        let abscissa = |at_us: u64| at_us.saturating_sub(*first_us) as f64 / 1e6 / half_s - 1.0;
        let (terms, left) = Self::terms(samples, degree, abscissa, abscissa(time_us));
        let terms = terms.get(..=degree).unwrap_or(&terms);
        let beyond = samples.len() - 1 - degree;
        let fits = is_rate && beyond >= TELLING && degree > CONVERGING && half_s <= LONGEST_S / 2.0 && {
            let last = terms.last().map_or(0.0, added);
            libm::sqrt(left) <= LEFT_OF_LAST * last
        };
        let left = left / beyond as f64;

        let variance = left.max(least_variance);
        let smooth = fits || is_smooth(terms);
        let (mut derivatives, mut gain) = ([SVector::zeros(); ORDERS], 1.0);
        for (k, Term { coefficient, size, there }) in terms.iter().enumerate() {
            let square = coefficient.norm_squared();
            let noise = if k == 0 { 0.0 } else { VARIANCES * variance / size };
            if square <= noise || (k > CONVERGING && !smooth) {
                continue;
            }
            let certain = coefficient * (1.0 - noise / square);
            for (derivative, p) in derivatives.iter_mut().zip(there) {
                *derivative += certain * *p;
            }
            gain += there[0] * there[0] / size;
        }
        let mut scale = 1.0;
        for (order, derivative) in derivatives.iter_mut().enumerate().skip(1) {
            scale *= half_s;
            let is_told = smooth || order < 3;
            *derivative = if is_told { *derivative / scale } else { SVector::zeros() };
        }
        Some(Self { degree, derivatives, deviation: libm::sqrt(variance * gain), left, smooth })
    }

    /// The terms up to a degree, and the sum of squares that they leave.
    fn terms(
        samples: &[(u64, SVector<f64, AXES>)],
        degree: usize,
        abscissa: impl Fn(u64) -> f64,
        at: f64,
    ) -> ([Term<AXES>; DEGREE + 1], f64) {
        let mut rest: [SVector<f64, AXES>; CAPACITY] = [SVector::zeros(); CAPACITY];
        for (rest, (_, value)) in rest.iter_mut().zip(samples) {
            *rest = *value;
        }
        // p_{k−1} and p_k at the samples, and with their derivatives at the instant.
        let (mut before, mut now) = ([0.0; CAPACITY], [1.0; CAPACITY]);
        let (mut before_there, mut there) = ([0.0; ORDERS], [1.0, 0.0, 0.0, 0.0, 0.0]);
        let mut size_before = 1.0;
        let mut terms = [Term { coefficient: SVector::zeros(), size: 1.0, there }; DEGREE + 1];
        for term in terms.iter_mut().take(degree + 1) {
            let (mut size, mut moment, mut coefficient) = (0.0, 0.0, SVector::zeros());
            for ((p, rest), (at_us, _)) in now.iter().zip(&rest).zip(samples) {
                size += p * p;
                moment += abscissa(*at_us) * p * p;
                coefficient += rest * *p;
            }
            coefficient /= size;
            *term = Term { coefficient, size, there };
            let (alpha, beta) = (moment / size, size / size_before);
            for (((p, before), rest), (at_us, _)) in
                now.iter_mut().zip(&mut before).zip(&mut rest).zip(samples)
            {
                *rest -= coefficient * *p;
                (*p, *before) = ((abscissa(*at_us) - alpha) * *p - beta * *before, *p);
            }
            let ([p, p1, p2, p3, p4], [q, q1, q2, q3, q4]) = (there, before_there);
            before_there = there;
            there = [
                (at - alpha) * p - beta * q,
                p + (at - alpha) * p1 - beta * q1,
                2.0 * p1 + (at - alpha) * p2 - beta * q2,
                3.0 * p2 + (at - alpha) * p3 - beta * q3,
                4.0 * p3 + (at - alpha) * p4 - beta * q4,
            ];
            size_before = size;
        }
        (terms, rest.iter().take(samples.len()).map(SVector::norm_squared).sum())
    }
}

/// What a term adds to the samples, as the root of its sum of squares.
fn added<const AXES: usize>(term: &Term<AXES>) -> f64 {
    libm::sqrt(term.coefficient.norm_squared() * term.size)
}

/// Whether the terms fall as those of a smooth motion do.
fn is_smooth<const AXES: usize>(terms: &[Term<AXES>]) -> bool {
    terms.windows(3).skip(CONVERGING - 2).all(|three| match three {
        [before_that, before, term] => {
            added(term) <= f64::max(DECAY * added(before), DECAY * DECAY * added(before_that))
        }
        _ => true,
    })
}
