//! Searches the state that takes a solver the longest: random restarts, each with a climb along single coordinates.
//!
//! Iterations are climbed, which a run repeats exactly; the states at which there were the most are then timed.

use lmpc::{Controller, ControllerState};
use nalgebra::SVector;
use serde::Serialize;

use crate::Failure;
use crate::clarabel_solver::Clarabels;
use crate::flight::Moment;
use crate::peer::PeerLibrary;
use crate::pick::Pick;
use crate::shipped::{Loops, Shipped};
use crate::solver::Maker;
use crate::stopwatch::Stopwatch;

/// How far beyond what flights see the search looks.
const BEYOND: f64 = 1.5;
/// States that are timed, and how often.
const TIMED: usize = 20;
const TIMES: usize = 9;

/// The worst that was found for a solver on a loop.
#[derive(Serialize)]
pub struct Worst {
    name: &'static str,
    solver: String,
    evaluations: usize,
    most_iterations: u32,
    /// The longest cold solution, the shortest of several times, ns.
    worst_ns: f64,
    /// States at which the solver gave up.
    failures: usize,
}

/// All loops and solvers.
///
/// # Errors
/// When a loop cannot be designed.
pub fn search(peers: &[PeerLibrary], seed: u64, quick: bool) -> Result<Vec<Worst>, Failure> {
    let loops = Loops::new()?;
    let mut all = Vec::new();
    all.extend(of_loop(&loops.position, peers, seed, quick));
    all.extend(of_loop(&loops.altitude, peers, seed, quick));
    all.extend(of_loop(&loops.lean, peers, seed, quick));
    all.extend(of_loop(&loops.turn, peers, seed, quick));
    Ok(all)
}

/// Which coordinates a state has: x, Δx, y − r and v(k−1).
struct Region<const N: usize, const P: usize> {
    measured: SVector<f64, N>,
    increment: SVector<f64, N>,
    error: SVector<f64, P>,
    feedback: SVector<f64, P>,
}

impl<const N: usize, const P: usize> Region<N, P> {
    fn around<const E: usize>(moments: &[Moment<N, P, E>]) -> Self {
        let mut all = Self {
            measured: SVector::zeros(),
            increment: SVector::zeros(),
            error: SVector::zeros(),
            feedback: SVector::zeros(),
        };
        for moment in moments {
            all.measured = all.measured.sup(&moment.measured.abs());
            all.increment = all.increment.sup(&moment.increment.abs());
            all.error = all.error.sup(&moment.error.abs());
            all.feedback = all.feedback.sup(&moment.before.feedback().abs());
        }
        all
    }

    const COORDINATES: usize = 2 * (N + P);

    /// The moment at coordinates between −1 and 1.
    fn at<const E: usize>(&self, coordinates: &[f64]) -> Moment<N, P, E> {
        let scaled = |first: usize, at: usize, size: f64| BEYOND * size * coordinates[first + at];
        let measured = SVector::from_fn(|at, _| scaled(0, at, self.measured[at]));
        let increment = SVector::from_fn(|at, _| scaled(N, at, self.increment[at]));
        let feedback = SVector::from_fn(|at, _| scaled(2 * N + P, at, self.feedback[at]));
        Moment {
            flight: 0,
            measured,
            increment,
            error: SVector::from_fn(|at, _| scaled(2 * N, at, self.error[at])),
            before: ControllerState::new(measured - increment, feedback, SVector::zeros()).keeping(),
            limited: true,
        }
    }
}

fn of_loop<const N: usize, const P: usize, const E: usize>(
    shipped: &Shipped<N, P, E>,
    peers: &[PeerLibrary],
    seed: u64,
    quick: bool,
) -> Vec<Worst> {
    let moments = shipped.flights(true);
    let around = Region::around(&moments);
    let program = shipped.program(&moments[..1]);
    let upper = &shipped.linear.upper;
    let restarts = if quick { 3 } else { 60 };
    let mut found =
        vec![climb("ours", shipped.name, Region::<N, P>::COORDINATES, (seed, restarts), |coordinates| {
            let moment: Moment<N, P, E> = around.at(coordinates);
            let sample = moment.sample(upper);
            let iterations = std::cell::Cell::new(0);
            let work = || {
                let step = shipped.law.step(&mut { moment.before }, &sample);
                iterations.set(step.iterations);
            };
            let timed = timed_least(work);
            (iterations.get(), true, timed)
        })];
    let clarabel = Clarabels { tolerance: None };
    let makers = std::iter::once(&clarabel as &dyn Maker).chain(peers.iter().map(|peer| peer as &dyn Maker));
    for maker in makers {
        let Some(mut solver) = maker.solver(&program) else { continue };
        let name = solver.name().to_owned();
        let mut z = vec![0.0; program.unknowns];
        found.push(climb(
            &name,
            shipped.name,
            Region::<N, P>::COORDINATES,
            (seed, restarts),
            |coordinates| {
                let moment: Moment<N, P, E> = around.at(coordinates);
                let sample = shipped.posed_sample(&moment);
                let solved = solver.solve(&sample, false, &mut z);
                let timed = timed_least(|| {
                    solver.solve(&sample, false, &mut z);
                });
                (solved.iterations, solved.solved, timed)
            },
        ));
    }
    found
}

/// The shortest of a few times, ns.
fn timed_least(mut work: impl FnMut()) -> f64 {
    let watch = Stopwatch::free();
    (0..3).map(|_| watch.time(&mut work)).fold(f64::INFINITY, f64::min)
}

/// Climbs iterations. `evaluate` tells iterations, success, and a time in ns.
fn climb(
    solver: &str,
    name: &'static str,
    coordinates: usize,
    (seed, restarts): (u64, usize),
    mut evaluate: impl FnMut(&[f64]) -> (u32, bool, f64),
) -> Worst {
    let mut pick = Pick::new(seed);
    let mut worst = Worst {
        name,
        solver: solver.to_owned(),
        evaluations: 0,
        most_iterations: 0,
        worst_ns: 0.0,
        failures: 0,
    };
    let mut hardest: Vec<(u32, Vec<f64>)> = Vec::new();
    for _ in 0..restarts {
        let mut at: Vec<f64> = (0..coordinates).map(|_| pick.signed()).collect();
        let mut most = 0;
        for round in 0..3 * coordinates {
            let mut tried = at.clone();
            tried[round % coordinates] = pick.signed();
            let (iterations, solved, _) = evaluate(&tried);
            worst.evaluations += 1;
            worst.failures += usize::from(!solved);
            if iterations >= most {
                (most, at) = (iterations, tried);
            }
        }
        hardest.push((most, at));
    }
    hardest.sort_by_key(|(iterations, _)| std::cmp::Reverse(*iterations));
    worst.most_iterations = hardest.first().map_or(0, |(iterations, _)| *iterations);
    for (_, at) in hardest.iter().take(TIMED) {
        let least_ns = (0..TIMES).map(|_| evaluate(at).2).fold(f64::INFINITY, f64::min);
        worst.worst_ns = worst.worst_ns.max(least_ns);
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::climb;

    /// A hill with its top in a corner: a climb gets near it, and names the time there.
    #[test]
    fn a_climb_finds_the_top() {
        let height = |at: &[f64]| at.iter().map(|x| 1.0 + x).sum::<f64>() * 10.0;
        let worst = climb("hill", "plane", 4, (1, 20), |at| {
            let iterations = height(at) as u32;
            (iterations, iterations < 70, f64::from(iterations) * 5.0)
        });
        assert!(worst.most_iterations > 55, "{}", worst.most_iterations);
        assert_eq!(worst.worst_ns, f64::from(worst.most_iterations) * 5.0);
        assert_eq!(worst.evaluations, 20 * 12);
    }
}
