//! Choosing among designs by what they cost in flight.

use alloc::vec::Vec;

/// The costs of some candidates, of any type C, on the same trials.
///
/// A figure of the prediction, such as a condition number, does not tell how well a controller flies under limits. This compares
/// candidates by their cost on flights, usually those of [`ClosedLoop::fly`](crate::ClosedLoop::fly).
///
/// ```
/// use lmpc::DesignSearch;
///
/// // A cost that is flat about 3 and steep below it, on two trials.
/// let search = DesignSearch::new(1..8_u32, |&n| {
///     let off = f64::from(n.abs_diff(3));
///     if n < 3 { vec![1.0 + off, 2.0] } else { vec![1.0 + 0.001 * off, 2.0 + 0.001 * off] }
/// });
/// assert_eq!(search.best(), Some(2)); // n = 3 …
/// let robust = search.most_robust(|one, other| one.abs_diff(*other) == 1);
/// assert_eq!(robust.map(|index| search.candidates()[index]), Some(4)); // … but n = 4 may be off by one.
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DesignSearch<C> {
    candidates: Vec<C>,
    /// By candidate and trial.
    costs: Vec<Vec<f64>>,
    /// The least cost of each trial.
    least: Vec<f64>,
}

impl<C> DesignSearch<C> {
    /// Asks for the cost of every candidate on each trial, in the same order. Costs are positive; infinity, NaN and missing
    /// ones mean that a candidate cannot be designed or does not fly.
    pub fn new(candidates: impl IntoIterator<Item = C>, mut costs_of: impl FnMut(&C) -> Vec<f64>) -> Self {
        let candidates: Vec<C> = candidates.into_iter().collect();
        let costs = candidates.iter().map(&mut costs_of).collect();
        Self::from_costs(candidates, costs)
    }

    /// With costs that are known already, by candidate and trial.
    pub fn from_costs(candidates: Vec<C>, mut costs: Vec<Vec<f64>>) -> Self {
        let trials = costs.iter().map(Vec::len).max().unwrap_or(0);
        costs.resize(candidates.len(), Vec::new());
        for cost in costs.iter_mut().flat_map(|costs| {
            costs.resize(trials, f64::INFINITY);
            costs.iter_mut()
        }) {
            if cost.is_nan() {
                *cost = f64::INFINITY;
            }
        }
        let least = (0..trials)
            .map(|trial| costs.iter().map(|costs| costs[trial]).fold(f64::INFINITY, f64::min))
            .collect();
        Self { candidates, costs, least }
    }

    /// The candidates, in their order.
    pub fn candidates(&self) -> &[C] {
        &self.candidates
    }

    /// How many trials there are.
    pub fn trials(&self) -> usize {
        self.least.len()
    }

    /// What a candidate costs on a trial; infinity when there is none such.
    pub fn cost(&self, candidate: usize, trial: usize) -> f64 {
        self.costs.get(candidate).and_then(|costs| costs.get(trial)).copied().unwrap_or(f64::INFINITY)
    }

    /// By which share a candidate costs more than the best of all candidates on a trial.
    pub fn excess(&self, candidate: usize, trial: usize) -> f64 {
        share(self.cost(candidate, trial), self.least.get(trial).copied().unwrap_or(f64::INFINITY))
    }

    /// The largest [`excess`](Self::excess) of a candidate.
    pub fn worst_excess(&self, candidate: usize) -> f64 {
        (0..self.trials()).map(|trial| self.excess(candidate, trial)).fold(0.0, f64::max)
    }

    /// By which share of its cost one candidate loses, on the trial on which it loses most, when it is replaced by another; 0
    /// when it loses on none.
    pub fn loss(&self, candidate: usize, instead: usize) -> f64 {
        (0..self.trials())
            .map(|trial| share(self.cost(instead, trial), self.cost(candidate, trial)))
            .fold(0.0, f64::max)
    }

    /// The candidate with the least [`worst_excess`](Self::worst_excess).
    pub fn best(&self) -> Option<usize> {
        least_by(self.candidates.len(), |candidate| self.worst_excess(candidate))
    }

    /// The candidate that does best when it may be replaced by any of its neighbours: whose worst excess, or that of its worst
    /// neighbour, is least.
    pub fn most_robust(&self, are_neighbours: impl Fn(&C, &C) -> bool) -> Option<usize> {
        least_by(self.candidates.len(), |candidate| {
            let one = &self.candidates[candidate];
            (0..self.candidates.len())
                .filter(|other| *other == candidate || are_neighbours(one, &self.candidates[*other]))
                .map(|other| self.worst_excess(other))
                .fold(0.0, f64::max)
        })
    }
}

/// cost/least − 1.
fn share(cost: f64, least: f64) -> f64 {
    let share = cost / least - 1.0;
    // 0/0 is no excess, ∞/∞ is as bad as it gets.
    if share.is_nan() { if cost > 0.0 { f64::INFINITY } else { 0.0 } } else { share }
}

/// The first index of the least finite value.
fn least_by(count: usize, value: impl Fn(usize) -> f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for index in 0..count {
        let value = value(index);
        if value.is_finite() && best.is_none_or(|(_, least)| value < least) {
            best = Some((index, value));
        }
    }
    best.map(|(index, _)| index)
}
