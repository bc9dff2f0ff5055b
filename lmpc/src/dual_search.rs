//! The dual active-set method on any family of constraints.

use nalgebra::SVector;

use crate::active_set::{ActiveSet, Split, Start};
use crate::dense::{dot, subtract_scaled};
use crate::{Outcome, Precision, WarmStart};

/// Constraints n·z ≤ b with unit normals n, of z with at most N elements.
pub(crate) trait Constraints<const N: usize, T> {
    /// Number of unknowns; elements beyond are zero.
    fn unknowns(&self) -> usize;

    /// A number that constraints with other normals do not have. Their bounds may differ.
    fn identity(&self) -> u64;

    /// How many constraints there are.
    fn count(&self) -> usize;

    /// The unit normal of a constraint.
    fn normal(&self, constraint: usize) -> SVector<T, N>;

    /// b of a constraint.
    fn bound(&self, constraint: usize) -> T;

    /// The constraint that z violates most, by more than rounding, among those that are not active.
    fn most_violated(&mut self, z: &SVector<T, N>, active: &[usize]) -> Option<usize>;
}

/// One run of the dual method of Goldfarb and Idnani (1983): the point nearest to z₀ that keeps all constraints.
pub(crate) struct DualSearch<'a, const N: usize, T, C: Constraints<N, T>> {
    constraints: &'a mut C,
    z_0: Start<N, T>,
    pub(crate) z: SVector<T, N>,
    pub(crate) active: &'a mut ActiveSet<N, T>,
    pub(crate) iterations: u32,
    /// The normal that was looked at last.
    split: Split<N, T>,
}

impl<'a, const N: usize, T: Precision, C: Constraints<N, T>> DualSearch<'a, N, T, C> {
    /// A search that begins at the unconstrained optimum, or with the constraints that were active before as far as they
    /// still push instead of pull. `active` may be that of an earlier search.
    pub(crate) fn new<const W: usize>(
        constraints: &'a mut C,
        z_0: Start<N, T>,
        active: &'a mut ActiveSet<N, T>,
        warm_start: &WarmStart<W>,
    ) -> Self {
        active.begin(constraints.identity(), constraints.unknowns());
        let z = match &z_0 {
            Start::Origin => SVector::zeros(),
            Start::At(z) => *z,
        };
        let mut search = Self { constraints, z_0, z, active, iterations: 0, split: Split::of_nothing() };
        if !warm_start.is_empty() {
            search.resume(warm_start);
        }
        search
    }

    fn resume<const W: usize>(&mut self, warm_start: &WarmStart<W>) {
        for constraint in warm_start.constraints() {
            if constraint >= self.constraints.count() {
                continue;
            }
            let bound = self.constraints.bound(constraint);
            if bound.is_finite() && !self.active.keep(constraint, bound) {
                // A repeated constraint depends on itself and is not added again.
                self.active.split(&self.constraints.normal(constraint), &mut self.split);
                let exchange = self.active.exchange(&self.split);
                self.active.add(constraint, &self.split, &exchange, (bound, T::zero()));
            }
        }
        self.active.meet_bounds(0);
        while let Some(column) = self.active.solve_multipliers(&self.z_0) {
            self.active.remove(column);
        }
        self.meet_active();
    }

    pub(crate) fn run(&mut self, iteration_limit: u32) -> Outcome {
        let mut is_exact = true;
        loop {
            if let Some(constraint) = self.constraints.most_violated(&self.z, self.active.constraints()) {
                if let Err(outcome) = self.activate(constraint, iteration_limit) {
                    return outcome;
                }
                is_exact = false;
            } else if is_exact {
                return Outcome::Optimal;
            } else {
                // The steps have led here but for their rounding.
                let stepped_to = self.z;
                self.meet_active();
                is_exact = true;
                let rounding_squared = (self.z - stepped_to).norm_squared();
                if rounding_squared <= T::STEPS * T::STEPS * self.z.norm_squared() {
                    return Outcome::Optimal;
                }
            }
        }
    }

    /// Goes on to where a violated constraint holds with equality.
    fn activate(&mut self, constraint: usize, iteration_limit: u32) -> Result<(), Outcome> {
        let normal = self.constraints.normal(constraint);
        let bound = self.constraints.bound(constraint);
        let mut multiplier = T::zero();
        loop {
            if self.iterations >= iteration_limit {
                return Err(Outcome::IterationLimit);
            }
            self.iterations += 1;
            self.active.split(&normal, &mut self.split);
            let split = &self.split;
            let sinking = self.active.exchange(split);
            // How far until the first active multiplier is used up, and until the constraint is met.
            let leaving = self.first_to_leave(&sinking);
            let until_met = if split.rest_squared > T::zero() {
                let along = dot(normal.as_slice(), self.z.as_slice());
                (along - bound).max(T::zero()) / split.rest_squared
            } else {
                T::INFINITY
            };
            let until_leaving = leaving.map_or(T::INFINITY, |(_, t)| t);
            let t = until_met.min(until_leaving);
            if t == T::INFINITY {
                return Err(Outcome::Infeasible);
            }
            subtract_scaled(self.z.as_mut_slice(), split.rest.as_slice(), t);
            self.active.sink(&sinking, t);
            multiplier += t;
            match leaving {
                Some((column, until)) if until < until_met => self.active.remove(column),
                _ => {
                    self.active.add(constraint, split, &sinking, (bound, multiplier));
                    if self.active.is_full() {
                        // All of z follows from bounds, which may be much smaller than z₀ and its steps.
                        self.meet_active();
                    }
                    return Ok(());
                }
            }
        }
    }

    /// Puts z where the active constraints hold with equality, nearest to z₀: the rounding is that of the bounds and not
    /// of the steps, however far z₀ lies.
    fn meet_active(&mut self) {
        self.z = self.active.nearest(&self.z_0);
    }

    /// The first active multiplier that is used up, and how far that is: the least u/r of all r > 0.
    fn first_to_leave(&self, sinking: &SVector<T, N>) -> Option<(usize, T)> {
        let mut first: Option<(usize, T, T)> = None;
        for (column, (&multiplier, &rate)) in self.active.multipliers().iter().zip(sinking).enumerate() {
            if rate > T::zero() && first.is_none_or(|(_, least, of)| multiplier * of < least * rate) {
                first = Some((column, multiplier, rate));
            }
        }
        // Compilers divide before they look whether there is one, and 0/0 would be signalled.
        first.map(|(column, multiplier, rate)| (column, multiplier / rate.max(T::SMALLEST)))
    }
}
