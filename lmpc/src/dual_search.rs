//! The dual active-set method on any family of constraints.

use nalgebra::SVector;

use crate::active_set::ActiveSet;
use crate::dense::subtract_scaled;
use crate::{Outcome, WarmStart};

/// Constraints n·z ≤ b with unit normals n, of z with at most N elements.
pub(crate) trait Constraints<const N: usize> {
    /// Number of unknowns; elements beyond are zero.
    fn unknowns(&self) -> usize;

    /// How many constraints there are.
    fn count(&self) -> usize;

    /// The unit normal of a constraint.
    fn normal(&self, constraint: usize) -> SVector<f64, N>;

    /// b − n·z of a constraint; negative when violated.
    fn slack(&self, constraint: usize, z: &SVector<f64, N>) -> f64;

    /// The constraint that z violates most, by more than rounding, among those that are not active.
    fn most_violated(&self, z: &SVector<f64, N>, active: &ActiveSet<N>) -> Option<usize>;
}

/// One run of the dual method of Goldfarb and Idnani (1983): the point nearest to z₀ that keeps all constraints.
pub(crate) struct DualSearch<'a, const N: usize, C: Constraints<N>> {
    constraints: &'a C,
    z_0: SVector<f64, N>,
    pub(crate) z: SVector<f64, N>,
    pub(crate) active: ActiveSet<N>,
    pub(crate) iterations: u32,
}

impl<'a, const N: usize, C: Constraints<N>> DualSearch<'a, N, C> {
    /// A search that begins at the unconstrained optimum, or with the constraints that were active before as far as they
    /// still push instead of pull.
    pub(crate) fn new<const W: usize>(
        constraints: &'a C,
        z_0: SVector<f64, N>,
        warm_start: &WarmStart<W>,
    ) -> Self {
        let active = ActiveSet::empty(constraints.unknowns());
        let mut search = Self { constraints, z_0, z: z_0, active, iterations: 0 };
        search.resume(warm_start);
        search
    }

    fn resume<const W: usize>(&mut self, warm_start: &WarmStart<W>) {
        for constraint in warm_start.constraints() {
            // A repeated constraint depends on itself and is not added again.
            if constraint < self.constraints.count()
                && self.constraints.slack(constraint, &self.z_0).is_finite()
            {
                let split = self.active.split(&self.constraints.normal(constraint));
                self.active.add(constraint, &split, 0.0);
            }
        }
        loop {
            let mut excess = SVector::zeros();
            for (j, &constraint) in self.active.constraints().iter().enumerate() {
                excess[j] = -self.constraints.slack(constraint, &self.z_0);
            }
            match self.active.solve_multipliers(&excess) {
                Some(column) => self.active.remove(column),
                None => break,
            }
        }
        self.meet_active();
    }

    pub(crate) fn run(&mut self, iteration_limit: u32) -> Outcome {
        while let Some(constraint) = self.constraints.most_violated(&self.z, &self.active) {
            let normal = self.constraints.normal(constraint);
            let mut multiplier = 0.0;
            loop {
                if self.iterations >= iteration_limit {
                    return Outcome::IterationLimit;
                }
                self.iterations += 1;
                let split = self.active.split(&normal);
                let sinking = self.active.exchange(&split);
                // How far until the first active multiplier is used up, and until the constraint is met.
                let leaving = self.first_to_leave(&sinking);
                let until_met = if split.rest_squared > 0.0 {
                    (-self.constraints.slack(constraint, &self.z)).max(0.0) / split.rest_squared
                } else {
                    f64::INFINITY
                };
                let until_leaving = leaving.map_or(f64::INFINITY, |(_, t)| t);
                let t = until_met.min(until_leaving);
                if t == f64::INFINITY {
                    return Outcome::Infeasible;
                }
                let n = self.constraints.unknowns();
                subtract_scaled(&mut self.z.as_mut_slice()[..n], &split.rest.as_slice()[..n], t);
                self.active.sink(&sinking, t);
                multiplier += t;
                match leaving {
                    Some((column, until)) if until < until_met => self.active.remove(column),
                    _ => {
                        self.active.add(constraint, &split, multiplier);
                        self.meet_active();
                        break;
                    }
                }
            }
        }
        Outcome::Optimal
    }

    /// Puts z where the active constraints hold with equality, nearest to z₀: where the steps have led to but for
    /// rounding, which is that of the bounds and not of the steps, however far z₀ lies.
    fn meet_active(&mut self) {
        let origin = SVector::zeros();
        let mut bounds = SVector::zeros();
        for (j, &constraint) in self.active.constraints().iter().enumerate() {
            bounds[j] = self.constraints.slack(constraint, &origin);
        }
        self.z = self.active.nearest(&self.z_0, &bounds);
    }

    fn first_to_leave(&self, sinking: &SVector<f64, N>) -> Option<(usize, f64)> {
        let mut first: Option<(usize, f64)> = None;
        for (column, &multiplier) in self.active.multipliers().iter().enumerate() {
            if sinking[column] > 0.0 {
                let until = multiplier / sinking[column];
                if first.is_none_or(|(_, earliest)| until < earliest) {
                    first = Some((column, until));
                }
            }
        }
        first
    }
}
