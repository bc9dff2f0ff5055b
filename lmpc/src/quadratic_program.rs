//! A small dense strictly convex quadratic program, solved exactly by a dual active-set method.

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::active_set::ActiveSet;
use crate::bounds::{Bounds, GivenBounds};
use crate::dense::{dot, dot_of_magnitudes, subtract_scaled};
use crate::dual_search::{Constraints, DualSearch};
use crate::{DesignError, validate};

/// How far beyond its bound a constraint counts as met, relative to what its bound is made of and to the terms that its
/// left-hand side adds up. Nothing here compares with a number that has a unit: the solution of a problem in other units is the same.
const FEASIBILITY: f64 = 1e-12;

/// min ½ xᵀHx + fᵀx subject to G x ≤ h, with at most N unknowns, H and G known at design time. Of vectors of
/// N elements those beyond the unknowns are zero.
///
/// The dual method of Goldfarb and Idnani (1983, Mathematical Programming 27) in the coordinates z = Lᵀx,
/// H = L Lᵀ, in which the cost is the distance from the unconstrained optimum. It starts there, adds the
/// most violated constraint in each iteration and keeps all multipliers non-negative, so that it ends
/// with the exact optimum or with a proof that there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadraticProgram<const N: usize> {
    unknowns: usize,
    /// L⁻¹: f in the coordinates of z.
    /// Boxed, so that large programs can be moved and built on small stacks.
    inverse_factor: Box<SMatrix<f64, N, N>>,
    /// Rows of G L⁻ᵀ, scaled to unit length.
    normals: Vec<SVector<f64, N>>,
    /// One over the length before scaling.
    scales: Vec<f64>,
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
pub struct Solution<const N: usize> {
    /// The optimum, if [`Outcome::Optimal`].
    pub x: SVector<f64, N>,
    /// How it ended.
    pub outcome: Outcome,
    /// Constraints added, and removed again.
    pub iterations: u32,
    /// How many constraints hold with equality.
    pub active: usize,
    /// Lagrange multipliers of those, in the order of [`WarmStart::constraints`]; zero beyond.
    pub multipliers: SVector<f64, N>,
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
    /// [`DesignError::Dimension`] (N×N stands for what H may be at most), [`DesignError::NotFinite`], [`DesignError::NotSymmetric`],
    /// [`DesignError::NotPositiveDefinite`].
    pub fn new(h: &DMatrix<f64>, g: &DMatrix<f64>) -> Result<Self, DesignError> {
        let unknowns = h.nrows();
        if unknowns > N {
            return Err(DesignError::Dimension { name: "H", expected: (N, N), actual: h.shape() });
        }
        validate::shape("H", h, (unknowns, unknowns))?;
        validate::shape("G", g, (g.nrows(), unknowns))?;
        validate::positive_definite("H", h)?;
        let factor = h.clone().cholesky().ok_or(DesignError::NotPositiveDefinite { name: "H" })?;
        let inverse = factor
            .l()
            .solve_lower_triangular(&DMatrix::identity(unknowns, unknowns))
            .ok_or(DesignError::NotPositiveDefinite { name: "H" })?;
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
        f: &SVector<f64, N>,
        h: &[f64],
        warm_start: &mut WarmStart<N>,
        iteration_limit: u32,
    ) -> Solution<N> {
        self.solve_with(f, &GivenBounds(h), warm_start, iteration_limit)
    }

    /// As [`QuadraticProgram::solve`], with the bound of each row asked for a few times, and with room for W constraints to
    /// be remembered.
    pub(crate) fn solve_with<const W: usize>(
        &self,
        f: &SVector<f64, N>,
        h: &impl Bounds,
        warm_start: &mut WarmStart<W>,
        iteration_limit: u32,
    ) -> Solution<N> {
        // ½ xᵀHx + fᵀx = ½ ‖z − z₀‖² + const with z₀ = −L⁻¹ f
        let z_0 = self.unconstrained(f);
        let magnitude = z_0.amax();
        if !(magnitude * magnitude).is_finite() || (0..self.constraints()).any(|row| h.bound(row).is_nan()) {
            *warm_start = WarmStart::default();
            return self.solution(&z_0, &ActiveSet::empty(self.unknowns), Outcome::NotFinite, 0);
        }

        let mut rows = Rows { program: self, h };
        let mut search = DualSearch::new(&mut rows, z_0, warm_start);
        let outcome = search.run(iteration_limit);
        if outcome == Outcome::Optimal {
            warm_start.remember(search.active.constraints());
        } else {
            *warm_start = WarmStart::default();
        }
        self.solution(&search.z, &search.active, outcome, search.iterations)
    }

    /// −L⁻¹ f
    fn unconstrained(&self, f: &SVector<f64, N>) -> SVector<f64, N> {
        let n = self.unknowns;
        let mut z = SVector::<f64, N>::zeros();
        for column in 0..n {
            // L⁻¹ is lower triangular.
            let factor = self.inverse_factor.column(column);
            subtract_scaled(&mut z.as_mut_slice()[column..n], &factor.as_slice()[column..n], f[column]);
        }
        z
    }

    fn solution(
        &self,
        z: &SVector<f64, N>,
        active: &ActiveSet<N>,
        outcome: Outcome,
        iterations: u32,
    ) -> Solution<N> {
        // x = L⁻ᵀ z
        let mut x = SVector::<f64, N>::zeros();
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
struct Rows<'a, const N: usize, H: Bounds> {
    program: &'a QuadraticProgram<N>,
    h: &'a H,
}

impl<const N: usize, H: Bounds> Constraints<N> for Rows<'_, N, H> {
    fn unknowns(&self) -> usize {
        self.program.unknowns
    }

    fn count(&self) -> usize {
        self.program.constraints()
    }

    fn normal(&self, constraint: usize) -> SVector<f64, N> {
        self.program.normals[constraint]
    }

    fn bound(&self, constraint: usize) -> f64 {
        self.h.bound(constraint) * self.program.scales[constraint]
    }

    fn most_violated(&mut self, z: &SVector<f64, N>, active: &[usize]) -> Option<usize> {
        let n = self.program.unknowns;
        let z = &z.as_slice()[..n];
        let (mut worst, mut least) = (None, 0.0);
        for (constraint, (normal, scale)) in self.program.normals.iter().zip(&self.program.scales).enumerate()
        {
            let normal = &normal.as_slice()[..n];
            let bound = self.h.bound(constraint) * scale;
            let slack = bound - dot(normal, z);
            if slack < least
                && slack < -FEASIBILITY * (dot_of_magnitudes(normal, z) + self.h.size(constraint) * scale)
                && !active.contains(&constraint)
            {
                (worst, least) = (Some(constraint), slack);
            }
        }
        worst
    }
}
