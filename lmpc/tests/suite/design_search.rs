//! Designs compared by their costs.

use lmpc::{ClosedLoop, DesignSearch, SignalLimit, StabilizedMpc, Trial, unknowns};
use nalgebra::Vector1;

use crate::common::lagged_integrators::Case;

#[test]
fn excess_and_loss_are_shares_of_the_least_cost_on_each_trial() {
    let search =
        DesignSearch::from_costs(vec!['a', 'b', 'c'], vec![vec![1.0, 4.0], vec![2.0, 2.0], vec![1.1, 2.2]]);
    assert_eq!((search.candidates(), search.trials()), (&['a', 'b', 'c'][..], 2));
    assert_eq!([0, 1].map(|trial| search.excess(0, trial)), [0.0, 1.0]);
    assert_eq!([0, 1].map(|index| search.worst_excess(index)), [1.0, 1.0]);
    assert!((search.worst_excess(2) - 0.1).abs() < 1e-12);
    assert_eq!(search.best(), Some(2));
    // Instead of the first the second costs twice as much on the first trial, and less on the other.
    assert_eq!((search.loss(0, 1), search.loss(1, 0)), (1.0, 1.0));
    assert!((search.loss(2, 0) - (4.0 / 2.2 - 1.0)).abs() < 1e-12);
}

#[test]
fn what_cannot_be_designed_is_never_chosen() {
    let search = DesignSearch::from_costs(
        vec![1, 2, 3, 4],
        vec![vec![], vec![f64::NAN, 1.0], vec![3.0, 3.0], vec![1.0]],
    );
    assert_eq!((search.best(), search.most_robust(|_, _| false)), (Some(2), Some(2)));
    assert_eq!(search.most_robust(|one, other| i32::abs(one - other) == 1), None);
    assert_eq!(search.cost(0, 0), f64::INFINITY);
    assert_eq!(search.cost(9, 9), f64::INFINITY);
    assert_eq!(DesignSearch::<u8>::from_costs(vec![], vec![]).best(), None);
}

/// More terms cost no more in flight as long as limits stay away; one term costs a lot.
#[test]
fn a_search_over_flights_prefers_more_terms() {
    let usual =
        Case { sample_time_s: 0.05, lag_s: 0.1, increment_weight: 1.0, slower: 100.0, terms: 5, scale: 0.7 };
    let limits = [SignalLimit::of_inputs(3, 1, SignalLimit::range(1), (0..20).collect()).giving_way_by(1.0)];
    let search = DesignSearch::new([1, 3, 5, 8], |&terms| {
        let design = Case { terms, ..usual.clone() }.design(1);
        let law = StabilizedMpc::<3, 1, 1, { unknowns(1, 8) }>::new(&design, &limits, 1e6).unwrap();
        let closed = ClosedLoop::new(design.model(), design.weights(), &limits, &[50.0, 50.0], 1e6).unwrap();
        let fly = |goal: f64| {
            let trial = Trial::step(Vector1::new(goal));
            closed.fly::<3, 1, 1, 9>(&law, &trial, 400).unwrap().total()
        };
        vec![fly(0.1), fly(1.0)]
    });
    assert_eq!(search.best().map(|index| search.candidates()[index]), Some(8));
    assert!(search.worst_excess(0) > 0.01 && search.worst_excess(2) < 0.01);
    // Without limits in the way, costs grow with the square of the step.
    assert!((search.cost(2, 1) / search.cost(2, 0) - 100.0).abs() < 1e-6);
}
