//! N, a, the stabilizing feedback and the samples at which limits hold of the shipped loops, chosen by what they cost in flight (`--tune`).

use std::f64::consts::TAU;
use std::iter;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::SeedableRng;
use lmpc::{ClosedLoop, DesignError, DesignSearch, SignalLimit, StabilizedMpc, Trial, TrialCost, unknowns};
use quadrotor::{Configuration, HoverLoop, HoverLoops};
use rand_distr::{Distribution, StandardUniform};
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

/// What being off by one of them may cost, as a share.
const MOST_LOSS: f64 = 0.01;
/// States of the position: x and its derivatives, then y and its.
const POSITION_STATES: usize = 12;
/// Steps of the position that begin anyhow: how many, the farthest goal, m, the highest speed, m/s, and their seed.
const STARTS: usize = 300;
const FARTHEST_M: f64 = 20.0;
const FASTEST_M_S: f64 = 7.5;
const SEED: u64 = 2015;

/// At which samples ahead limits hold, beside those that are shipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Placement {
    Shipped,
    /// Every other one of them, and the first and last.
    Sparser,
    /// And those half-way between two of them.
    Denser,
    /// Those after the first, half as far ahead.
    Sooner,
    /// Those after the first, half as far again.
    Later,
}

impl Placement {
    const OTHERS: [Self; 4] = [Self::Sparser, Self::Denser, Self::Sooner, Self::Later];

    fn name(self) -> &'static str {
        match self {
            Self::Shipped => "shipped",
            Self::Sparser => "sparser",
            Self::Denser => "denser",
            Self::Sooner => "sooner",
            Self::Later => "later",
        }
    }

    /// Samples in place of shipped ones, which rise.
    fn of(self, shipped: &[usize]) -> Vec<usize> {
        let (Some(first), Some(last)) = (shipped.first().copied(), shipped.last().copied()) else {
            return Vec::new();
        };
        let moved = |halves: usize| shipped.iter().map(move |sample| first + (sample - first) * halves / 2);
        let mut samples: Vec<usize> = match self {
            Self::Shipped => shipped.to_vec(),
            Self::Sparser => shipped.iter().copied().step_by(2).chain([last]).collect(),
            Self::Denser => {
                let between = shipped.windows(2).map(|pair| usize::midpoint(pair[0], pair[1]));
                shipped.iter().copied().chain(between).collect()
            }
            Self::Sooner => moved(1).collect(),
            Self::Later => moved(3).collect(),
        };
        samples.sort_unstable();
        samples.dedup();
        samples
    }

    fn place(self, limits: &[SignalLimit]) -> Vec<SignalLimit> {
        limits.iter().map(|limit| SignalLimit { samples: self.of(&limit.samples), ..limit.clone() }).collect()
    }
}

/// A way to plan.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    terms: usize,
    scale: f64,
    share: f64,
    placement: Placement,
}

impl Candidate {
    /// One step of one of N and a away. Limits that hold elsewhere are tried with the shipped ones alone, whose neighbours stand for theirs.
    fn is_beside(&self, other: &Self) -> bool {
        let terms = self.terms.abs_diff(other.terms);
        let scales = ((self.scale - other.scale) / SCALE_STEP).abs().round() as u32;
        self.share == other.share && (terms as u32 + scales) == 1
    }
}

/// Compares designs of the loops of a configuration by their cost on the linear loop under the limits that they have in hover, and
/// writes tables: by how much a candidate costs more than the best one on the worst trial ("excess"), how much it loses on the
/// worst trial when N is off by one or a by 0.05 ("off by one"), and both on each trial for the shipped one, beside what its stages and its
/// violations of limits cost.
///
/// # Errors
/// [`Error`] when a loop cannot be designed at all.
pub fn tune(configuration: &Configuration) -> Result<String, Error> {
    let mut page: String = compared_loops(configuration, |_, _| true)?.iter().map(Compared::table).collect();
    let loops = HoverLoops::new(configuration)?;
    let period_s = configuration.controllers.position.sample_time_s();
    let starts = of_position(&loops.position, random_starts(period_s), Candidate::is_beside)?;
    page += &starts.losses();
    Ok(page)
}

/// Each loop on its steps, with those candidates that are tried beside the shipped one, which comes first.
fn compared_loops(
    configuration: &Configuration,
    is_tried: impl Fn(&Candidate, &Candidate) -> bool,
) -> Result<[Compared; 4], Error> {
    let loops = HoverLoops::new(configuration)?;
    let vertical = [0.1, 1.0, 5.0, 20.0, -0.1, -1.0, -5.0, -20.0].map(one).into();
    let period_s = configuration.controllers.position.sample_time_s();
    let horizontal = vec![
        both(0.1, 0.0),
        both(1.0, 0.0),
        both(5.0, 0.0),
        both(20.0, 0.0),
        both(4.0, 3.0),
        both(5.0, 5.0),
        moving(5.0, [0.0, 3.0], period_s),
        moving(0.0, [0.0, 6.0], period_s),
    ];
    let lean = vec![both(0.05, 0.0), both(0.3, 0.0), both(1.0, 0.0), both(0.4, -0.3), both(2.5, 0.0)];
    let turn = [0.05, 0.3, 1.0, 3.0].map(one).into();
    Ok([
        of_loop::<3, 1, { unknowns(1, MOST_TERMS) }>("altitude", &loops.altitude, vertical, 400, &is_tried)?,
        of_position(&loops.position, horizontal, &is_tried)?,
        of_loop::<6, 2, { unknowns(2, MOST_TERMS) }>("roll and pitch", &loops.lean, lean, 400, &is_tried)?,
        of_loop::<3, 1, { unknowns(1, MOST_TERMS) }>("yaw", &loops.turn, turn, 1200, &is_tried)?,
    ])
}

/// A trial and what it is called.
type Named<const N: usize, const P: usize> = (String, Trial<N, P, P>);

/// A step of one output.
fn one(goal: f64) -> Named<3, 1> {
    (format!("{goal}"), Trial::step([goal].into()))
}

/// A step of two outputs.
fn both<const N: usize>(x: f64, y: f64) -> Named<N, 2> {
    let name = if y == 0.0 { format!("{x}") } else { format!("{x}, {y}") };
    (name, Trial::step([x, y].into()))
}

/// A step of the position north, m, that begins with a speed north and east, m/s, under a controller with this sample time, s.
fn moving(goal: f64, speed_m_s: [f64; 2], period_s: f64) -> Named<POSITION_STATES, 2> {
    let (_, mut trial) = both::<POSITION_STATES>(goal, 0.0);
    for (axis, speed_m_s) in speed_m_s.into_iter().enumerate() {
        let position = axis * POSITION_STATES / 2;
        trial.state[position + 1] = speed_m_s;
        trial.increment[position] = speed_m_s * period_s;
    }
    let [north, east] = speed_m_s;
    (format!("{goal:.1} at {north:.1}, {east:.1} m/s"), trial)
}

/// Steps of the position that begin with any speed below the limit: what no list was chosen for.
fn random_starts(period_s: f64) -> Vec<Named<POSITION_STATES, 2>> {
    let mut generator = ChaCha8Rng::seed_from_u64(SEED);
    let mut share = || -> f64 { StandardUniform.sample(&mut generator) };
    let start = |_| {
        let goal = FARTHEST_M * share() * share();
        let (speed_m_s, (sine, cosine)) = (FASTEST_M_S * share(), (TAU * share()).sin_cos());
        moving(goal, [speed_m_s * cosine, speed_m_s * sine], period_s)
    };
    (0..STARTS).map(start).collect()
}

fn of_position(
    hover: &HoverLoop<2>,
    trials: Vec<Named<POSITION_STATES, 2>>,
    is_tried: impl Fn(&Candidate, &Candidate) -> bool,
) -> Result<Compared, Error> {
    of_loop::<POSITION_STATES, 2, { unknowns(2, MOST_TERMS) }>("position", hover, trials, 400, is_tried)
}

fn of_loop<const N: usize, const P: usize, const E: usize>(
    name: &'static str,
    hover: &HoverLoop<P>,
    trials: Vec<Named<N, P>>,
    samples: usize,
    is_tried: impl Fn(&Candidate, &Candidate) -> bool,
) -> Result<Compared, Error> {
    let problem = &hover.problem;
    let settings = problem.settings();
    let limits = problem.limits();
    let slack_cost = problem.slack_cost();
    let closed = ClosedLoop::new(problem.model(), problem.weights(), limits, &hover.upper, slack_cost)?;
    let shipped = Candidate {
        terms: settings.terms as usize,
        scale: settings.scale,
        share: problem.stabilizing_share(),
        placement: Placement::Shipped,
    };
    let costs_of = |candidate: &Candidate| -> Result<Vec<TrialCost>, DesignError> {
        let design = problem.design(candidate.terms, candidate.scale, candidate.share)?;
        // Limits that hold elsewhere are those of the plan alone: what a flight violates is counted where it flies.
        let law = StabilizedMpc::<N, P, P, E>::new(&design, &candidate.placement.place(limits), slack_cost)?;
        trials.iter().map(|(_, trial)| closed.fly::<N, P, P, E>(&law, trial, samples)).collect()
    };
    let scales = (-SCALES..=SCALES).map(|step| shipped.scale + SCALE_STEP * f64::from(step));
    let others = scales
        .filter(|scale| *scale < 0.99)
        .flat_map(|scale| TERMS.map(move |terms| (terms, scale)))
        .flat_map(|(terms, scale)| SHARES.map(|share| Candidate { terms, scale, share, ..shipped }))
        .chain(Placement::OTHERS.map(|placement| Candidate { placement, ..shipped }))
        .filter(|other| *other != shipped && is_tried(&shipped, other));
    let candidates: Vec<Candidate> = iter::once(shipped).chain(others).collect();
    let costs: Vec<Vec<TrialCost>> =
        candidates.par_iter().map(|candidate| costs_of(candidate).unwrap_or_default()).collect();
    let totals = costs.iter().map(|costs| costs.iter().map(TrialCost::total).collect()).collect();
    let of_shipped = costs.into_iter().next().unwrap_or_default();
    let names = trials.into_iter().map(|(name, _)| name);
    Ok(Compared {
        name,
        trials: names.zip(of_shipped).collect(),
        search: DesignSearch::from_costs(candidates, totals),
    })
}

/// Candidates of a loop, the shipped one first.
struct Compared {
    name: &'static str,
    /// Each trial, and what it costs the shipped candidate.
    trials: Vec<(String, TrialCost)>,
    search: DesignSearch<Candidate>,
}

impl Compared {
    /// By which share a candidate loses on a trial when N is off by one or a by [`SCALE_STEP`], at worst.
    fn off_by_one(&self, index: usize, trial: usize) -> f64 {
        let candidates = self.search.candidates();
        let beside = (0..candidates.len()).filter(|other| candidates[index].is_beside(&candidates[*other]));
        let own = self.search.cost(index, trial);
        beside.map(|other| self.search.cost(other, trial) / own - 1.0).fold(0.0, f64::max)
    }

    /// That on each trial.
    fn each_off_by_one(&self, index: usize) -> impl Iterator<Item = f64> {
        (0..self.trials.len()).map(move |trial| self.off_by_one(index, trial))
    }

    /// The shipped candidate and those that a search would choose, one line each, and each trial of the shipped one.
    fn table(&self) -> String {
        let mut lines = vec![
            self.name.to_owned(),
            "                 N      a  share  limits  excess  off by one".to_owned(),
        ];
        let rows = [
            ("shipped", Some(0)),
            ("least excess", self.search.best()),
            ("most robust", self.search.most_robust(Candidate::is_beside)),
        ];
        for (what, index) in rows {
            let Some(index) = index else { continue };
            let candidate = &self.search.candidates()[index];
            lines.push(format!(
                "  {what:<13} {:>2}  {:.3}   {:.2} {:>7} {:>6.2} % {:>9.2} %",
                candidate.terms,
                candidate.scale,
                candidate.share,
                candidate.placement.name(),
                percent(self.search.worst_excess(index)),
                percent(self.each_off_by_one(index).fold(0.0, f64::max)),
            ));
        }
        lines.push(self.placements());
        lines.push("  step, shipped                stages   violations  excess  off by one".to_owned());
        for (trial, (name, cost)) in self.trials.iter().enumerate() {
            lines.push(format!(
                "  {name:<22} {:>12.3} {:>12.4} {:>6.2} % {:>9.2} %",
                cost.stage_cost,
                cost.violation_cost,
                percent(self.search.excess(0, trial)),
                percent(self.off_by_one(0, trial)),
            ));
        }
        lines.join("\n") + "\n\n"
    }

    /// By how much the shipped candidate costs more on its worst trial with limits placed otherwise, and by how much at best less.
    fn placements(&self) -> String {
        let each = Placement::OTHERS.iter().filter_map(|placement| {
            let candidates = self.search.candidates();
            let shipped = candidates.first()?;
            let wanted = Candidate { placement: *placement, ..*shipped };
            let index = candidates.iter().position(|other| *other == wanted)?;
            let more = (0..self.trials.len())
                .map(|trial| self.search.cost(index, trial) / self.search.cost(0, trial) - 1.0);
            let [least, most] = more.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], more| {
                [least.min(more), most.max(more)]
            });
            Some(format!("{} {:+.2} to {:+.2} %", placement.name(), percent(least), percent(most)))
        });
        format!("  limits placed otherwise cost: {}", each.collect::<Vec<_>>().join(", "))
    }

    /// On how many trials the shipped candidate loses more than [`MOST_LOSS`] when it is off by one, and how much at worst.
    fn losses(&self) -> String {
        let count = self.each_off_by_one(0).filter(|loss| *loss > MOST_LOSS).count();
        let worst = self.each_off_by_one(0).fold(0.0, f64::max);
        format!(
            "{}, {} random starts: {count} lose more than {} % when off by one, {:.2} % at worst; the shipped design costs at most {:.2} % \
             more than its neighbours\n",
            self.name,
            self.trials.len(),
            percent(MOST_LOSS),
            percent(worst),
            percent(self.search.worst_excess(0)),
        )
    }
}

fn percent(share: f64) -> f64 {
    100.0 * share
}

#[cfg(test)]
mod tests {
    use lmpc::TrialCost;
    use quadrotor::Configuration;

    use super::{Candidate, Compared, MOST_LOSS, Placement, compared_loops};
    use crate::constrained_step::axis::Axis;

    /// Each step of the report is one of those on which designs are compared.
    fn assert_has_the_steps_of_the_report(all: &[Compared; 4]) {
        for axis in Axis::all().expect("loops") {
            let compared = all.iter().find(|compared| compared.name.starts_with(axis.name)).expect("a loop");
            for step in &axis.steps {
                let parts: Vec<String> = match step.goal[..] {
                    [goal, 0.0] => vec![goal.to_string()],
                    _ => step.goal.iter().map(ToString::to_string).collect(),
                };
                let name = parts.join(", ");
                assert!(compared.trials.iter().any(|(trial, _)| *trial == name), "{}", step.problem);
            }
        }
    }

    /// The placements keep the first sample, and no sample counts twice.
    #[test]
    fn limits_are_placed_otherwise() {
        let shipped = [1, 2, 4, 8, 20];
        for (placement, samples) in [
            (Placement::Shipped, vec![1, 2, 4, 8, 20]),
            (Placement::Sparser, vec![1, 4, 20]),
            (Placement::Denser, vec![1, 2, 3, 4, 6, 8, 14, 20]),
            (Placement::Sooner, vec![1, 2, 4, 10]),
            (Placement::Later, vec![1, 2, 5, 11, 29]),
        ] {
            assert_eq!(placement.of(&shipped), samples, "{placement:?}");
            assert!(placement.of(&[]).is_empty() && placement.of(&[3]) == [3]);
        }
    }

    /// What ships loses at most 1 % on every step when N is off by one or a by 0.05, and so on those of the report. Plans of the position
    /// break no limit in a gap between its samples, and hardly the speed that they are planned with before the first of them: violations stay
    /// below five thousandths of the cost.
    #[test]
    fn the_shipped_designs_may_be_off_by_one() {
        let all = compared_loops(&Configuration::default(), Candidate::is_beside).expect("loops");
        assert_has_the_steps_of_the_report(&all);
        for compared in &all {
            assert!(compared.search.candidates().len() >= 4, "{}", compared.name);
            assert!(!compared.trials.is_empty(), "{}: the shipped design fails", compared.name);
            for (trial, (name, cost)) in compared.trials.iter().enumerate() {
                let loss = compared.off_by_one(0, trial);
                assert!(loss <= MOST_LOSS, "{}, {name}: {loss}", compared.name);
                let violations = cost.violation_cost / TrialCost::total(cost);
                assert!(violations < 5e-3 || compared.name != "position", "{name}: {violations}");
            }
        }
    }
}
