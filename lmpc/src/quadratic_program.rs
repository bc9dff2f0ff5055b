//! A small dense strictly convex quadratic program, solved exactly by a dual active-set method.

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::active_set::{ActiveSet, Start};
use crate::bounds::{Bounds, GivenBounds};
use crate::dense::{dot, dot_of_magnitudes, subtract_scaled};
use crate::dual_search::{Constraints, DualSearch};
use crate::precision::converted;
use crate::{DesignError, Precision, validate};

/// min ½ xᵀHx + fᵀx subject to G x ≤ h, with at most N unknowns, H and G known at design time. Of vectors of
/// N elements those beyond the unknowns are zero.
///
/// The dual method of Goldfarb and Idnani (1983, Mathematical Programming 27) in the coordinates z = Lᵀx,
/// H = L Lᵀ, in which the cost is the distance from the unconstrained optimum. It starts there, adds the
/// most violated constraint in each iteration and keeps all multipliers non-negative, so that it ends
/// with the exact optimum or with a proof that there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct QuadraticProgram<const N: usize, T = f64> {
    unknowns: usize,
    /// L⁻¹: f in the coordinates of z.
    /// Boxed, so that large programs can be moved and built on small stacks.
    inverse_factor: Box<SMatrix<T, N, N>>,
    /// Rows of G L⁻ᵀ, scaled to unit length.
    normals: Vec<SVector<T, N>>,
    /// One over the length before scaling.
    scales: Vec<T>,
}

/// How a solution ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outcome {
    /// The exact optimum.
    Optimal,
    /// No point meets all constraints.
    Infeasible,
    /// The iteration limit came first; the point met is neither optimal nor feasible.
    IterationLimit,
    /// f or h contains a value that is not finite, or so large that the arithmetic overflows.
    NotFinite,
}

/// A solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution<const N: usize, T = f64> {
    /// The optimum, if [`Outcome::Optimal`].
    pub x: SVector<T, N>,
    /// How it ended.
    pub outcome: Outcome,
    /// Constraints added, and removed again.
    pub iterations: u32,
    /// How many constraints hold with equality.
    pub active: usize,
    /// Lagrange multipliers of those, in the order of [`WarmStart::constraints`]; zero beyond.
    pub multipliers: SVector<T, N>,
}

/// The constraints that were active in the last solution, as far as there is room: where the next one starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WarmStart<const N: usize> {
    #[serde(with = "indices")]
    constraints: [u32; N],
    count: u32,
}

impl<const N: usize> Default for WarmStart<N> {
    fn default() -> Self {
        Self { constraints: [0; N], count: 0 }
    }
}

impl<const N: usize> WarmStart<N> {
    /// Indices of the constraints, rows of G.
    pub fn constraints(&self) -> impl Iterator<Item = usize> + '_ {
        self.constraints.iter().take(self.count as usize).map(|&constraint| constraint as usize)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(crate) fn remember(&mut self, constraints: &[usize]) {
        self.count = 0;
        for (slot, constraint) in self.constraints.iter_mut().zip(constraints) {
            *slot = u32::try_from(*constraint).unwrap_or(u32::MAX);
            self.count += 1;
        }
    }
}

/// Arrays of any length, which serde's derive does not take.
mod indices {
    use nalgebra::SVector;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer, const N: usize>(values: &[u32; N], to: S) -> Result<S::Ok, S::Error> {
        SVector::<u32, N>::from_column_slice(values).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>, const N: usize>(from: D) -> Result<[u32; N], D::Error> {
        let vector = SVector::<u32, N>::deserialize(from)?;
        Ok(core::array::from_fn(|index| vector[index]))
    }
}

impl<const N: usize> QuadraticProgram<N> {
    /// For a positive definite H, n×n with n ≤ N, and any number of constraint rows G, M×n.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] (N×N stands for what H may be at most), [`DesignError::ElementNotFinite`], [`DesignError::NotSymmetric`],
    /// [`DesignError::NotPositiveDefinite`].
    pub fn new(h: &DMatrix<f64>, g: &DMatrix<f64>) -> Result<Self, DesignError> {
        let unknowns = h.nrows();
        if unknowns > N {
            return Err(DesignError::Dimension { name: "H", expected: (N, N), actual: h.shape() });
        }
        validate::shape("H", h, (unknowns, unknowns))?;
        validate::shape("G", g, (g.nrows(), unknowns))?;
        validate::symmetric("H", h)?;
        let inverse = validate::inverse_factor("H", h)?;
        let mut inverse_factor: Box<SMatrix<f64, N, N>> = Box::new(SMatrix::zeros());
        inverse_factor.view_mut((0, 0), (unknowns, unknowns)).copy_from(&inverse);

        let (mut normals, mut scales) = (Vec::new(), Vec::new());
        for row in 0..g.nrows() {
            // (G L⁻ᵀ)ᵀ = L⁻¹ Gᵀ
            let mut normal = SVector::<f64, N>::zeros();
            normal.rows_mut(0, unknowns).copy_from(&(&inverse * g.row(row).transpose()));
            // Squares of tiny or huge elements leave the range of a double: those of the shares do not.
            let largest = normal.amax();
            let length = if largest > 0.0 { largest * normal.unscale(largest).norm() } else { 0.0 };
            // A row of zeros stays one: 0 ≤ h either holds or shows that there is no solution.
            let scale = if length > 0.0 { 1.0 / length } else { 1.0 };
            normals.push(normal * scale);
            scales.push(scale);
        }
        Ok(Self { unknowns, inverse_factor, normals, scales })
    }
}

impl<const N: usize, T: Precision> QuadraticProgram<N, T> {
    /// The same program in another precision.
    pub fn to_precision<U: Precision>(&self) -> QuadraticProgram<N, U> {
        QuadraticProgram {
            unknowns: self.unknowns,
            inverse_factor: Box::new(converted(&self.inverse_factor)),
            normals: self.normals.iter().map(converted).collect(),
            scales: self.scales.iter().map(|scale| U::of(scale.to_f64())).collect(),
        }
    }

    /// Number of unknowns n.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Number of constraints M.
    pub fn constraints(&self) -> usize {
        self.normals.len()
    }

    /// Solves for one f and h (M values; further ones are ignored, missing ones are no bound), starting
    /// from the active set of the last solution and remembering this one's. Allocates nothing.
    ///
    /// `iteration_limit` bounds the work: each iteration costs O(N (N + M)).
    pub fn solve(
        &self,
        f: &SVector<T, N>,
        h: &[T],
        warm_start: &mut WarmStart<N>,
        iteration_limit: u32,
    ) -> Solution<N, T> {
        self.solve_with(f, &GivenBounds(h), warm_start, iteration_limit)
    }

    /// As [`QuadraticProgram::solve`], with the bound of each row asked for a few times, and with room for W constraints to
    /// be remembered.
    pub(crate) fn solve_with<const W: usize>(
        &self,
        f: &SVector<T, N>,
        h: &impl Bounds<T>,
        warm_start: &mut WarmStart<W>,
        iteration_limit: u32,
    ) -> Solution<N, T> {
        // ½ xᵀHx + fᵀx = ½ ‖z − z₀‖² + const with z₀ = −L⁻¹ f
        let z_0 = self.unconstrained(f);
        let magnitude = z_0.amax();
        if !(magnitude * magnitude).is_finite() || (0..self.constraints()).any(|row| h.bound(row).is_nan()) {
            *warm_start = WarmStart::default();
            return self.solution(&z_0, &ActiveSet::empty(), Outcome::NotFinite, 0);
        }

        let mut rows = Rows { program: self, h };
        let mut active = ActiveSet::empty();
        let mut search = DualSearch::new(&mut rows, Start::At(z_0), &mut active, warm_start);
        let outcome = search.run(iteration_limit);
        if outcome == Outcome::Optimal {
            warm_start.remember(search.active.constraints());
        } else {
            *warm_start = WarmStart::default();
        }
        self.solution(&search.z, search.active, outcome, search.iterations)
    }

    /// −L⁻¹ f
    fn unconstrained(&self, f: &SVector<T, N>) -> SVector<T, N> {
        let n = self.unknowns;
        let mut z = SVector::<T, N>::zeros();
        for column in 0..n {
            // L⁻¹ is lower triangular.
            let factor = self.inverse_factor.column(column);
            subtract_scaled(&mut z.as_mut_slice()[column..n], &factor.as_slice()[column..n], f[column]);
        }
        z
    }

    fn solution(
        &self,
        z: &SVector<T, N>,
        active: &ActiveSet<N, T>,
        outcome: Outcome,
        iterations: u32,
    ) -> Solution<N, T> {
        // x = L⁻ᵀ z
        let mut x = SVector::<T, N>::zeros();
        for (column, value) in x.iter_mut().take(self.unknowns).enumerate() {
            *value = dot(
                &self.inverse_factor.column(column).as_slice()[column..self.unknowns],
                &z.as_slice()[column..self.unknowns],
            );
        }
        let outcome = if x.iter().all(|value| value.is_finite()) { outcome } else { Outcome::NotFinite };
        // The normals were scaled to unit length, which scaled their multipliers the other way.
        let mut multipliers = SVector::zeros();
        for (j, (&constraint, &u)) in active.constraints().iter().zip(active.multipliers()).enumerate() {
            multipliers[j] = u * self.scales[constraint];
        }
        Solution { x, outcome, iterations, active: active.constraints().len(), multipliers }
    }
}

/// The constraints of a program with its right-hand side.
struct Rows<'a, const N: usize, T, H> {
    program: &'a QuadraticProgram<N, T>,
    h: &'a H,
}

impl<const N: usize, T: Precision, H: Bounds<T>> Constraints<N, T> for Rows<'_, N, T, H> {
    fn unknowns(&self) -> usize {
        self.program.unknowns
    }

    /// Each search begins with an empty set.
    fn identity(&self) -> u64 {
        0
    }

    fn count(&self) -> usize {
        self.program.constraints()
    }

    fn normal(&self, constraint: usize) -> SVector<T, N> {
        self.program.normals[constraint]
    }

    fn bound(&self, constraint: usize) -> T {
        self.h.bound(constraint) * self.program.scales[constraint]
    }

    fn most_violated(&mut self, z: &SVector<T, N>, active: &[usize]) -> Option<usize> {
        let n = self.program.unknowns;
        let z = &z.as_slice()[..n];
        let (mut worst, mut least) = (None, T::zero());
        for (constraint, (normal, scale)) in self.program.normals.iter().zip(&self.program.scales).enumerate()
        {
            let normal = &normal.as_slice()[..n];
            let bound = self.h.bound(constraint) * *scale;
            let slack = bound - dot(normal, z);
            if slack < least
                && slack < -T::CONSTRAINT * (dot_of_magnitudes(normal, z) + self.h.size(constraint) * *scale)
                && !active.contains(&constraint)
            {
                (worst, least) = (Some(constraint), slack);
            }
        }
        worst
    }
}
