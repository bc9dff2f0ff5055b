//! The orthogonal factorisation of the active constraints of a quadratic program.

use nalgebra::SVector;

use crate::Precision;
use crate::dense::{dot, subtract_scaled};

/// Share of a vector's square that must be left after removing the active normals, so that removing them again changes nothing but
/// rounding.
const LEFT: f64 = 0.25;

/// Active constraint normals v_j (unit vectors) as Q R, Q with orthonormal columns and R upper triangular,
/// with their multipliers: of `unknowns` ≤ N elements and as many at most, no allocation. Elements beyond the unknowns are zero: loops
/// over all N, whose number the compiler knows, take less time than those over fewer.
#[derive(Clone, Debug)]
pub(crate) struct ActiveSet<const N: usize, T> {
    /// Constraint index of each column.
    constraints: [usize; N],
    /// b of each constraint v·z ≤ b.
    bounds: SVector<T, N>,
    /// R⁻ᵀ b: where the constraints hold with equality, along each column of Q.
    met_at: SVector<T, N>,
    multipliers: [T; N],
    count: usize,
    unknowns: usize,
    /// Columns of Q, and of R.
    q: [SVector<T, N>; N],
    r: [SVector<T, N>; N],
}

/// A normal against the active ones: v = Q Qᵀv + rest.
pub(crate) struct Split<const N: usize, T> {
    /// Qᵀ v.
    within: SVector<T, N>,
    /// v − Q Qᵀ v, zero when v depends on the active normals.
    pub(crate) rest: SVector<T, N>,
    /// ‖rest‖².
    pub(crate) rest_squared: T,
}

impl<const N: usize, T: Precision> ActiveSet<N, T> {
    pub(crate) fn empty(unknowns: usize) -> Self {
        Self {
            constraints: [0; N],
            bounds: SVector::zeros(),
            met_at: SVector::zeros(),
            multipliers: [T::zero(); N],
            count: 0,
            unknowns,
            q: [SVector::zeros(); N],
            r: [SVector::zeros(); N],
        }
    }

    pub(crate) fn constraints(&self) -> &[usize] {
        &self.constraints[..self.count]
    }

    /// Whether as many constraints are active as there are unknowns.
    pub(crate) fn is_full(&self) -> bool {
        self.count == self.unknowns
    }

    pub(crate) fn multipliers(&self) -> &[T] {
        &self.multipliers[..self.count]
    }

    /// Qᵀv, v − Q Qᵀv and ‖v − Q Qᵀv‖² by Gram and Schmidt's method: twice, which is enough (Kahan), unless the first time leaves so
    /// much that its rounding is small beside it (Daniel, Gragg, Kaufman and Stewart 1976).
    fn orthogonal_part(&self, vector: &SVector<T, N>) -> (SVector<T, N>, SVector<T, N>, T) {
        let mut within = SVector::<T, N>::zeros();
        let mut rest = *vector;
        let whole_squared = dot(rest.as_slice(), rest.as_slice());
        let mut rest_squared = whole_squared;
        // Of nothing no part is taken away.
        let times = if self.count == 0 || whole_squared == T::zero() { 0 } else { 2 };
        for _ in 0..times {
            let along = self.along(&rest);
            within += along;
            for (q_j, share) in self.q[..self.count].iter().zip(&along) {
                subtract_scaled(rest.as_mut_slice(), q_j.as_slice(), *share);
            }
            rest_squared = dot(rest.as_slice(), rest.as_slice());
            if rest_squared >= T::of(LEFT) * whole_squared {
                break;
            }
        }
        (within, rest, rest_squared)
    }

    /// Qᵀ v.
    fn along(&self, vector: &SVector<T, N>) -> SVector<T, N> {
        let mut along = SVector::<T, N>::zeros();
        for (share, q_j) in along.iter_mut().zip(&self.q[..self.count]) {
            *share = dot(q_j.as_slice(), vector.as_slice());
        }
        along
    }

    /// Splits a normal into what depends on the active ones and the rest.
    pub(crate) fn split(&self, normal: &SVector<T, N>) -> Split<N, T> {
        let (within, mut rest, mut rest_squared) = self.orthogonal_part(normal);
        if rest_squared <= T::DEPENDENT * T::DEPENDENT || self.is_full() {
            rest.fill(T::zero());
            rest_squared = T::zero();
        }
        Split { within, rest, rest_squared }
    }

    /// r = R⁻¹ Qᵀ v: by how much the multipliers sink per unit of the multiplier of v.
    pub(crate) fn exchange(&self, split: &Split<N, T>) -> SVector<T, N> {
        self.back_substituted(&split.within)
    }

    /// Adds a normal with its bound and multiplier. `false` when it depends on the active ones.
    pub(crate) fn add(&mut self, constraint: usize, split: &Split<N, T>, bound: T, multiplier: T) -> bool {
        if split.rest_squared == T::zero() {
            return false;
        }
        let length = split.rest_squared.sqrt();
        self.q[self.count] = split.rest / length;
        self.r[self.count] = split.within;
        self.r[self.count][self.count] = length;
        self.constraints[self.count] = constraint;
        self.bounds[self.count] = bound;
        self.multipliers[self.count] = multiplier;
        self.count += 1;
        self.meet_bounds(self.count - 1);
        true
    }

    /// Removes the constraint in column `column` and restores the triangle by Givens rotations.
    pub(crate) fn remove(&mut self, column: usize) {
        for j in column + 1..self.count {
            self.r[j - 1] = self.r[j];
            self.constraints[j - 1] = self.constraints[j];
            self.bounds[j - 1] = self.bounds[j];
            self.multipliers[j - 1] = self.multipliers[j];
        }
        self.count -= 1;
        for j in column..self.count {
            let (a, b) = (self.r[j][j], self.r[j][j + 1]);
            // Not near zero: b was on the diagonal, where dependent normals do not come.
            let length = (a * a + b * b).sqrt();
            let (cosine, sine) = (a / length, b / length);
            for r_k in &mut self.r[j..self.count] {
                let (upper, lower) = (r_k[j], r_k[j + 1]);
                r_k[j] = cosine * upper + sine * lower;
                r_k[j + 1] = cosine * lower - sine * upper;
            }
            let (left, right) = (self.q[j], self.q[j + 1]);
            self.q[j] = left * cosine + right * sine;
            self.q[j + 1] = right * cosine - left * sine;
        }
        self.meet_bounds(column);
    }

    /// R⁻ᵀ b from column `first` on.
    fn meet_bounds(&mut self, first: usize) {
        for i in first..self.count {
            let of_those_before = &self.r[i];
            let known = dot(&of_those_before.as_slice()[..i], &self.met_at.as_slice()[..i]);
            self.met_at[i] = (self.bounds[i] - known) / of_those_before[i];
        }
    }

    /// Moves the multipliers by −t r.
    pub(crate) fn sink(&mut self, by: &SVector<T, N>, t: T) {
        for j in 0..self.count {
            self.multipliers[j] = (self.multipliers[j] - t * by[j]).max(T::zero());
        }
    }

    /// Sets the multipliers for which all active constraints hold with equality on the way from z: RᵀR u = Vᵀz − b. Returns the
    /// last column with a negative one, if any: what has become active last is the first to be released.
    ///
    /// ```text
    /// R u = Qᵀz − R⁻ᵀ b
    /// ```
    pub(crate) fn solve_multipliers(&mut self, z: &SVector<T, N>) -> Option<usize> {
        let u = self.back_substituted(&(self.along(z) - self.met_at));
        self.multipliers[..self.count].copy_from_slice(&u.as_slice()[..self.count]);
        self.multipliers().iter().rposition(|multiplier| *multiplier < T::zero())
    }

    /// The point nearest to z where Vᵀz = b: (I − Q Qᵀ) z + Q R⁻ᵀ b.
    pub(crate) fn nearest(&self, z: &SVector<T, N>) -> SVector<T, N> {
        let mut nearest = if self.is_full() { SVector::zeros() } else { self.orthogonal_part(z).1 };
        for (q_j, met_at) in self.q[..self.count].iter().zip(&self.met_at) {
            subtract_scaled(nearest.as_mut_slice(), q_j.as_slice(), -*met_at);
        }
        nearest
    }

    /// R⁻¹ y on the active columns.
    fn back_substituted(&self, y: &SVector<T, N>) -> SVector<T, N> {
        let mut x = *y;
        for i in (0..self.count).rev() {
            let column = &self.r[i];
            x[i] /= column[i];
            let solved = x[i];
            subtract_scaled(&mut x.as_mut_slice()[..i], &column.as_slice()[..i], solved);
        }
        x
    }
}
