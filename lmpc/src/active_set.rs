//! The orthogonal factorisation of the active constraints of a quadratic program.

use nalgebra::SVector;

use crate::Precision;
use crate::dense::{combination, dot, subtract_scaled, turn};

/// Share of a vector's square that must be left after removing the active normals, so that removing them again changes nothing but
/// rounding. With 0.01 a step takes a tenth less time, and degenerate programs come out as if they had no solution.
const LEFT: f64 = 0.25;

/// Active constraint normals v_j (unit vectors) as Q R, Q with orthonormal columns and R upper triangular, of which the inverse is kept,
/// with their multipliers: of `unknowns` ≤ N elements and as many at most, no allocation. Elements beyond the unknowns are zero: loops
/// over all N, whose number the compiler knows, take less time than those over fewer.
///
/// A search may begin with the columns that the last one left. Those that it takes over are what it would get by adding their constraints
/// one by one, bit for bit, so that a result does not depend on what was kept.
#[derive(Clone, Copy)]
pub(crate) struct ActiveSet<const N: usize, T> {
    /// Which normals the columns are of: [`Constraints::identity`](crate::dual_search::Constraints::identity).
    identity: u64,
    /// So many first columns come from adding their constraints one by one, with none removed between them.
    pristine: usize,
    /// Constraint index of each column.
    constraints: [usize; N],
    /// b of each constraint v·z ≤ b.
    bounds: SVector<T, N>,
    /// R⁻ᵀ b: where the constraints hold with equality, along each column of Q.
    met_at: SVector<T, N>,
    multipliers: [T; N],
    count: usize,
    unknowns: usize,
    /// Columns of Q, and of R⁻¹.
    q: [SVector<T, N>; N],
    r_inverse: [SVector<T, N>; N],
}

/// Where a search begins.
pub(crate) enum Start<const N: usize, T> {
    /// Zero, which depends on no normal.
    Origin,
    At(SVector<T, N>),
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

impl<const N: usize, T: Precision> Split<N, T> {
    pub(crate) fn of_nothing() -> Self {
        Self { within: SVector::zeros(), rest: SVector::zeros(), rest_squared: T::zero() }
    }
}

impl<const N: usize, T: Precision> ActiveSet<N, T> {
    pub(crate) fn empty() -> Self {
        Self {
            identity: 0,
            pristine: 0,
            constraints: [0; N],
            bounds: SVector::zeros(),
            met_at: SVector::zeros(),
            multipliers: [T::zero(); N],
            count: 0,
            unknowns: 0,
            q: [SVector::zeros(); N],
            r_inverse: [SVector::zeros(); N],
        }
    }

    /// Empties the set for a search among normals of `unknowns` elements. Columns of the same normals can be [kept](Self::keep).
    pub(crate) fn begin(&mut self, identity: u64, unknowns: usize) {
        if (self.identity, self.unknowns) != (identity, unknowns) {
            (self.identity, self.unknowns, self.pristine) = (identity, unknowns, 0);
        }
        self.count = 0;
    }

    /// Takes over the next column if it is that of `constraint`, with a multiplier of zero. [`ActiveSet::meet_bounds`] is left to do.
    pub(crate) fn keep(&mut self, constraint: usize, bound: T) -> bool {
        let next = self.count;
        let is_kept = next < self.pristine && self.constraints[next] == constraint;
        if is_kept {
            self.bounds[next] = bound;
            self.multipliers[next] = T::zero();
            self.count += 1;
        }
        is_kept
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

    /// Splits a vector into what depends on the active normals and the rest, by Gram and Schmidt's method: twice, which is enough (Kahan),
    /// unless the first time leaves so much that its rounding is small beside it (Daniel, Gragg, Kaufman and Stewart 1976).
    fn split_vector(&self, vector: &SVector<T, N>, split: &mut Split<N, T>) {
        let whole_squared = dot(vector.as_slice(), vector.as_slice());
        split.within = self.along(vector);
        split.rest = *vector;
        self.take_away(&split.within, &mut split.rest);
        split.rest_squared = dot(split.rest.as_slice(), split.rest.as_slice());
        if split.rest_squared < T::of(LEFT) * whole_squared {
            let again = self.along(&split.rest);
            split.within += again;
            self.take_away(&again, &mut split.rest);
            split.rest_squared = dot(split.rest.as_slice(), split.rest.as_slice());
        }
    }

    /// Qᵀ v.
    #[inline]
    fn along(&self, vector: &SVector<T, N>) -> SVector<T, N> {
        let mut along = SVector::<T, N>::zeros();
        for (share, q_j) in along.iter_mut().zip(&self.q[..self.count]) {
            *share = dot(q_j.as_slice(), vector.as_slice());
        }
        along
    }

    /// v ← v − Q shares.
    #[inline]
    fn take_away(&self, shares: &SVector<T, N>, vector: &mut SVector<T, N>) {
        for (q_j, share) in self.q[..self.count].iter().zip(shares) {
            subtract_scaled(vector.as_mut_slice(), q_j.as_slice(), *share);
        }
    }

    /// Splits a normal into what depends on the active ones and the rest.
    pub(crate) fn split(&self, normal: &SVector<T, N>, split: &mut Split<N, T>) {
        self.split_vector(normal, split);
        if split.rest_squared <= T::DEPENDENT * T::DEPENDENT || self.is_full() {
            split.rest.fill(T::zero());
            split.rest_squared = T::zero();
        }
    }

    /// r = R⁻¹ Qᵀ v: by how much the multipliers sink per unit of the multiplier of v.
    pub(crate) fn exchange(&self, split: &Split<N, T>) -> SVector<T, N> {
        combination(&self.r_inverse[..self.count], split.within.as_slice())
    }

    /// Adds a normal of which the exchange is known, with its bound and multiplier, unless it depends on the active ones.
    pub(crate) fn add(
        &mut self,
        constraint: usize,
        split: &Split<N, T>,
        exchange: &SVector<T, N>,
        (bound, multiplier): (T, T),
    ) {
        if split.rest_squared == T::zero() {
            return;
        }
        let (added, before) = (self.count, ..self.count);
        let inverse = T::one() / split.rest_squared.sqrt();
        for (element, rest) in self.q[added].iter_mut().zip(&split.rest) {
            *element = *rest * inverse;
        }
        // The inverse of [R, w; 0, ρ] is [R⁻¹, −R⁻¹w/ρ; 0, 1/ρ].
        for (element, exchange) in self.r_inverse[added].iter_mut().zip(exchange) {
            *element = -*exchange * inverse;
        }
        self.r_inverse[added][added] = inverse;
        self.constraints[added] = constraint;
        self.bounds[added] = bound;
        self.met_at[added] =
            (bound - dot(&split.within.as_slice()[before], &self.met_at.as_slice()[before])) * inverse;
        self.multipliers[added] = multiplier;
        if self.pristine >= added {
            self.pristine = added + 1;
        }
        self.count += 1;
    }

    /// Removes the constraint in column `column`. Of its row of R⁻¹, Givens rotations of the columns leave nothing but the last element, which
    /// goes with the last column; the rows below it move up.
    pub(crate) fn remove(&mut self, column: usize) {
        let count = self.count;
        for j in column..count - 1 {
            let (a, b) = (self.r_inverse[j][column], self.r_inverse[j + 1][column]);
            // Not near zero: a was on the diagonal, or is the length before.
            let length = (a * a + b * b).sqrt();
            let inverse = T::one() / length;
            let (cosine, sine) = (b * inverse, -a * inverse);
            let (before, after) = self.q.split_at_mut(j + 1);
            turn(before[j].as_mut_slice(), after[0].as_mut_slice(), cosine, sine);
            let (before, after) = self.r_inverse.split_at_mut(j + 1);
            let (left, right) = (before[j].as_mut_slice(), after[0].as_mut_slice());
            turn(left, right, cosine, sine);
            right[column] = length;
            left.copy_within(column + 1..j + 2, column);
            left[j + 1] = T::zero();
        }
        let later = column + 1..count;
        self.constraints.copy_within(later.clone(), column);
        self.bounds.as_mut_slice().copy_within(later.clone(), column);
        self.multipliers.copy_within(later, column);
        self.pristine = self.pristine.min(column);
        self.count -= 1;
        self.meet_bounds(column);
    }

    /// R⁻ᵀ b from column `first` on.
    pub(crate) fn meet_bounds(&mut self, first: usize) {
        for i in first..self.count {
            self.met_at[i] = dot(&self.r_inverse[i].as_slice()[..=i], &self.bounds.as_slice()[..=i]);
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
    /// u = R⁻¹ (Qᵀz − R⁻ᵀ b)
    /// ```
    pub(crate) fn solve_multipliers(&mut self, z: &Start<N, T>) -> Option<usize> {
        let u = match z {
            Start::Origin => combination(&self.r_inverse[..self.count], (-self.met_at).as_slice()),
            Start::At(z) => {
                combination(&self.r_inverse[..self.count], (self.along(z) - self.met_at).as_slice())
            }
        };
        self.multipliers[..self.count].copy_from_slice(&u.as_slice()[..self.count]);
        self.multipliers().iter().rposition(|multiplier| *multiplier < T::zero())
    }

    /// The point nearest to z where Vᵀz = b: (I − Q Qᵀ) z + Q R⁻ᵀ b.
    // One copy for all who call: once or twice in a search, and long when unrolled.
    #[inline(never)]
    pub(crate) fn nearest(&self, z: &Start<N, T>) -> SVector<T, N> {
        let mut nearest = SVector::zeros();
        if let Start::At(z) = z
            && !self.is_full()
        {
            let mut split = Split::of_nothing();
            self.split_vector(z, &mut split);
            nearest = split.rest;
        }
        for (q_j, met_at) in self.q[..self.count].iter().zip(&self.met_at) {
            subtract_scaled(nearest.as_mut_slice(), q_j.as_slice(), -*met_at);
        }
        nearest
    }
}
