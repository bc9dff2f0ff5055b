//! N, a and the stabilizing feedback of the shipped loops, chosen by what they cost in flight (`--tune`).

use lmpc::{ClosedLoop, DesignError, DesignSearch, StabilizedMpc, Trial, unknowns};
use quadrotor::{Configuration, HoverLoop, HoverLoops};
use rayon::prelude::*;

use crate::Error;

/// Terms that are tried.
const TERMS: std::ops::RangeInclusive<usize> = 4..=MOST_TERMS;
/// Most of them.
const MOST_TERMS: usize = 9;
/// Bandwidths of the stabilizing feedback that are tried, as shares of the loop's.
const SHARES: [f64; 3] = [0.2, 0.3, 0.45];
/// By how much a may be off.
const SCALE_STEP: f64 = 0.05;
/// Scales that are tried on either side of the shipped one.
const SCALES: i32 = 4;

/// A way to plan.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    terms: usize,
    scale: f64,
    share: f64,
}

impl Candidate {
    /// One step of one of N and a away.
    fn is_beside(&self, other: &Self) -> bool {
        let terms = self.terms.abs_diff(other.terms);
        let scales = ((self.scale - other.scale) / SCALE_STEP).abs().round() as u32;
        self.share == other.share && (terms as u32 + scales) == 1
    }
}

/// Compares designs of the loops of a configuration by their cost on the linear loop under the limits that they have in hover, and
/// writes a table: by how much a candidate costs more than the best one on the worst trial ("excess"), and how much it loses on the
/// worst trial when N is off by one or a by 0.05 ("off by one").
///
/// # Errors
/// [`Error`] when a loop cannot be designed at all.
pub fn tune(configuration: &Configuration) -> Result<String, Error> {
    let loops = HoverLoops::new(configuration)?;
    let mut page = String::new();
    let goal = |size: f64| Trial::step([size].into());
    let vertical = [0.1, 1.0, 5.0, 20.0, -0.1, -1.0, -5.0, -20.0].map(goal);
    page += &of_loop::<3, 1, { unknowns(1, MOST_TERMS) }>("altitude", &loops.altitude, &vertical, 400)?;
    let across = |goal: f64, speed_m_s: f64| {
        let mut trial = both(goal, 0.0);
        trial.state[6 + 1] = speed_m_s;
        trial.increment[6] = speed_m_s * configuration.controllers.position.sample_time_s();
        trial
    };
    let horizontal = [
        both(0.1, 0.0),
        both(1.0, 0.0),
        both(5.0, 0.0),
        both(20.0, 0.0),
        both(4.0, 3.0),
        across(5.0, 3.0),
        across(0.0, 6.0),
    ];
    page += &of_loop::<12, 2, { unknowns(2, MOST_TERMS) }>("position", &loops.position, &horizontal, 400)?;
    let lean = [both(0.05, 0.0), both(0.3, 0.0), both(1.0, 0.0), both(0.4, -0.3), both(2.5, 0.0)];
    page += &of_loop::<6, 2, { unknowns(2, MOST_TERMS) }>("roll and pitch", &loops.lean, &lean, 400)?;
    let turn = [0.05, 0.3, 1.0, 3.0].map(goal);
    page += &of_loop::<3, 1, { unknowns(1, MOST_TERMS) }>("yaw", &loops.turn, &turn, 1200)?;
    Ok(page)
}

/// A step of two outputs.
fn both<const N: usize>(x: f64, y: f64) -> Trial<N, 2, 2> {
    Trial::step([x, y].into())
}

fn of_loop<const N: usize, const P: usize, const E: usize>(
    name: &str,
    hover: &HoverLoop<P>,
    trials: &[Trial<N, P, P>],
    samples: usize,
) -> Result<String, Error> {
    let problem = &hover.problem;
    let settings = problem.settings();
    let limits = problem.limits();
    let slack_cost = problem.slack_cost();
    let closed = ClosedLoop::new(problem.model(), problem.weights(), limits, &hover.upper, slack_cost)?;
    let shipped = Candidate {
        terms: settings.terms as usize,
        scale: settings.scale,
        share: problem.stabilizing_share(),
    };
    let costs_of = |candidate: &Candidate| -> Result<Vec<f64>, DesignError> {
        let design = problem.design(candidate.terms, candidate.scale, candidate.share)?;
        let law = StabilizedMpc::<N, P, P, E>::new(&design, limits, slack_cost)?;
        trials.iter().map(|trial| Ok(closed.fly::<N, P, P, E>(&law, trial, samples)?.total())).collect()
    };
    let scales = (-SCALES..=SCALES).map(|step| shipped.scale + SCALE_STEP * f64::from(step));
    let candidates: Vec<Candidate> = scales
        .filter(|scale| *scale < 0.99)
        .flat_map(|scale| TERMS.map(move |terms| (terms, scale)))
        .flat_map(|(terms, scale)| SHARES.map(|share| Candidate { terms, scale, share }))
        .collect();
    let costs: Vec<Vec<f64>> =
        candidates.par_iter().map(|candidate| costs_of(candidate).unwrap_or_default()).collect();
    let search = DesignSearch::from_costs(candidates, costs);
    Ok(table(name, &search, &shipped))
}

/// The shipped candidate and those that a search would choose, one line each.
fn table(name: &str, search: &DesignSearch<Candidate>, shipped: &Candidate) -> String {
    let is_shipped = |candidate: &Candidate| candidate == shipped;
    let rows = [
        ("shipped", search.candidates().iter().position(is_shipped)),
        ("least excess", search.best()),
        ("most robust", search.most_robust(Candidate::is_beside)),
    ];
    let mut lines = vec![
        name.to_owned(),
        "                 N      a  share  excess  off by one  excess on each trial, %".to_owned(),
    ];
    for (what, index) in rows {
        let Some(index) = index else { continue };
        let candidate = &search.candidates()[index];
        let others = search.candidates().iter().enumerate();
        let off_by_one = others
            .filter(|(_, other)| candidate.is_beside(other))
            .map(|(other, _)| search.loss(index, other))
            .fold(0.0, f64::max);
        let each: Vec<String> = (0..search.trials())
            .map(|trial| format!("{:.2}", percent(search.excess(index, trial))))
            .collect();
        lines.push(format!(
            "  {what:<13} {:>2}  {:.3}   {:.2} {:>6.2} % {:>9.2} %  {}",
            candidate.terms,
            candidate.scale,
            candidate.share,
            percent(search.worst_excess(index)),
            percent(off_by_one),
            each.join("  "),
        ));
    }
    lines.join("\n") + "\n\n"
}

fn percent(share: f64) -> f64 {
    100.0 * share
}
