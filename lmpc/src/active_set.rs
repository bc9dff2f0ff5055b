//! The orthogonal factorisation of the active constraints of a quadratic program.

use nalgebra::{SMatrix, SVector};

use crate::dense::{dot, subtract_scaled};

/// Below this share of a unit normal that is left after removing the active normals, it depends on them.
const DEPENDENT: f64 = 1e-7;

/// Active constraint normals v_j (unit vectors) as Q R, Q with orthonormal columns and R upper triangular,
/// with their multipliers: of `unknowns` ≤ N elements and as many at most, no allocation.
#[derive(Clone, Debug)]
pub(crate) struct ActiveSet<const N: usize> {
    /// Constraint index of each column.
    constraints: [usize; N],
    /// b of each constraint v·z ≤ b.
    bounds: SVector<f64, N>,
    /// R⁻ᵀ b: where the constraints hold with equality, along each column of Q.
    met_at: SVector<f64, N>,
    multipliers: [f64; N],
    count: usize,
    unknowns: usize,
    q: SMatrix<f64, N, N>,
    r: SMatrix<f64, N, N>,
}

/// A normal against the active ones: v = Q Qᵀv + rest.
pub(crate) struct Split<const N: usize> {
    /// Qᵀ v.
    within: SVector<f64, N>,
    /// v − Q Qᵀ v, zero when v depends on the active normals.
    pub(crate) rest: SVector<f64, N>,
    /// ‖rest‖².
    pub(crate) rest_squared: f64,
}

impl<const N: usize> ActiveSet<N> {
    pub(crate) fn empty(unknowns: usize) -> Self {
        Self {
            constraints: [0; N],
            bounds: SVector::zeros(),
            met_at: SVector::zeros(),
            multipliers: [0.0; N],
            count: 0,
            unknowns,
            q: SMatrix::zeros(),
            r: SMatrix::zeros(),
        }
    }

    pub(crate) fn constraints(&self) -> &[usize] {
        &self.constraints[..self.count]
    }

    /// Whether as many constraints are active as there are unknowns.
    pub(crate) fn is_full(&self) -> bool {
        self.count == self.unknowns
    }

    pub(crate) fn multipliers(&self) -> &[f64] {
        &self.multipliers[..self.count]
    }

    /// Qᵀv and v − Q Qᵀv by Gram and Schmidt's method, twice, which is enough (Kahan).
    fn orthogonal_part(&self, vector: &SVector<f64, N>) -> (SVector<f64, N>, SVector<f64, N>) {
        let n = self.unknowns;
        let mut within = SVector::zeros();
        let mut rest = *vector;
        for _ in 0..2 {
            let along = self.along(&rest);
            let rest = &mut rest.as_mut_slice()[..n];
            for j in 0..self.count {
                within[j] += along[j];
                subtract_scaled(rest, &self.q.column(j).as_slice()[..n], along[j]);
            }
        }
        (within, rest)
    }

    /// Qᵀ v.
    fn along(&self, vector: &SVector<f64, N>) -> SVector<f64, N> {
        let n = self.unknowns;
        let mut along = SVector::zeros();
        for j in 0..self.count {
            along[j] = dot(&self.q.column(j).as_slice()[..n], &vector.as_slice()[..n]);
        }
        along
    }

    /// Splits a normal into what depends on the active ones and the rest.
    pub(crate) fn split(&self, normal: &SVector<f64, N>) -> Split<N> {
        let n = self.unknowns;
        let (within, mut rest) = self.orthogonal_part(normal);
        let mut rest_squared = dot(&rest.as_slice()[..n], &rest.as_slice()[..n]);
        if rest_squared <= DEPENDENT * DEPENDENT || self.is_full() {
            rest.fill(0.0);
            rest_squared = 0.0;
        }
        Split { within, rest, rest_squared }
    }

    /// r = R⁻¹ Qᵀ v: by how much the multipliers sink per unit of the multiplier of v.
    pub(crate) fn exchange(&self, split: &Split<N>) -> SVector<f64, N> {
        self.back_substituted(&split.within)
    }

    /// Adds a normal with its bound and multiplier. `false` when it depends on the active ones.
    pub(crate) fn add(&mut self, constraint: usize, split: &Split<N>, bound: f64, multiplier: f64) -> bool {
        if split.rest_squared == 0.0 {
            return false;
        }
        let length = libm::sqrt(split.rest_squared);
        self.q.set_column(self.count, &(split.rest / length));
        self.r.set_column(self.count, &split.within);
        self.r[(self.count, self.count)] = length;
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
            let moved = self.r.column(j).into_owned();
            self.r.set_column(j - 1, &moved);
            self.constraints[j - 1] = self.constraints[j];
            self.bounds[j - 1] = self.bounds[j];
            self.multipliers[j - 1] = self.multipliers[j];
        }
        self.count -= 1;
        for j in column..self.count {
            let (a, b) = (self.r[(j, j)], self.r[(j + 1, j)]);
            // Not near zero: b was on the diagonal, where dependent normals do not come.
            let length = libm::sqrt(a * a + b * b);
            let (cosine, sine) = (a / length, b / length);
            for k in j..self.count {
                let (upper, lower) = (self.r[(j, k)], self.r[(j + 1, k)]);
                self.r[(j, k)] = cosine * upper + sine * lower;
                self.r[(j + 1, k)] = cosine * lower - sine * upper;
            }
            for k in 0..self.unknowns {
                let (left, right) = (self.q[(k, j)], self.q[(k, j + 1)]);
                self.q[(k, j)] = cosine * left + sine * right;
                self.q[(k, j + 1)] = cosine * right - sine * left;
            }
        }
        self.meet_bounds(column);
    }

    /// R⁻ᵀ b from column `first` on.
    fn meet_bounds(&mut self, first: usize) {
        for i in first..self.count {
            let of_those_before = self.r.column(i);
            let known = dot(&of_those_before.as_slice()[..i], &self.met_at.as_slice()[..i]);
            self.met_at[i] = (self.bounds[i] - known) / self.r[(i, i)];
        }
    }

    /// Moves the multipliers by −t r.
    pub(crate) fn sink(&mut self, by: &SVector<f64, N>, t: f64) {
        for j in 0..self.count {
            self.multipliers[j] = (self.multipliers[j] - t * by[j]).max(0.0);
        }
    }

    /// Sets the multipliers for which all active constraints hold with equality on the way from z: RᵀR u = Vᵀz − b. Returns the
    /// column of the most negative one, if any.
    ///
    /// ```text
    /// R u = Qᵀz − R⁻ᵀ b
    /// ```
    pub(crate) fn solve_multipliers(&mut self, z: &SVector<f64, N>) -> Option<usize> {
        let u = self.back_substituted(&(self.along(z) - self.met_at));
        let mut worst = None;
        for j in 0..self.count {
            self.multipliers[j] = u[j];
            if u[j] < 0.0 && worst.is_none_or(|column: usize| u[j] < u[column]) {
                worst = Some(j);
            }
        }
        worst
    }

    /// The point nearest to z where Vᵀz = b: (I − Q Qᵀ) z + Q R⁻ᵀ b.
    pub(crate) fn nearest(&self, z: &SVector<f64, N>) -> SVector<f64, N> {
        let n = self.unknowns;
        let mut nearest = if self.is_full() { SVector::zeros() } else { self.orthogonal_part(z).1 };
        for j in 0..self.count {
            let q_j = self.q.column(j);
            subtract_scaled(&mut nearest.as_mut_slice()[..n], &q_j.as_slice()[..n], -self.met_at[j]);
        }
        nearest
    }

    /// R⁻¹ y on the active columns.
    fn back_substituted(&self, y: &SVector<f64, N>) -> SVector<f64, N> {
        let mut x = *y;
        for i in (0..self.count).rev() {
            let column = self.r.column(i);
            x[i] /= column[i];
            let solved = x[i];
            subtract_scaled(&mut x.as_mut_slice()[..i], &column.as_slice()[..i], solved);
        }
        x
    }
}
