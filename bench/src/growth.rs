//! Cost of the position controller's step against the size of its program, along flights that reach its limits.

use lmpc::{
    Augmented, Controller, Dlqr, SignalLimit, StabilizedMpc, StateSpaceMpc, StateSpaceMpcDesign,
    StateSpaceMpcWeights, unknowns,
};
use quadrotor::{Configuration, HoverLoops, LinearLoop, Simulation};
use recording::{TERMS, TWO};
use serde::Serialize;

use crate::Failure;
use crate::flight::fly;
use crate::median::median;
use crate::stopwatch::Stopwatch;

/// Moves per input that state-space MPC has room for here.
const MOVES: usize = 30;

/// A cost against a size.
#[derive(Serialize)]
pub struct Growth {
    /// "Laguerre terms".
    against: &'static str,
    /// "ns per step".
    unit: &'static str,
    points: Vec<Point>,
}

#[derive(Serialize)]
struct Point {
    size: f64,
    /// Median over what was measured.
    cost: f64,
}

/// Against N, rows, horizon and simulated time.
///
/// # Errors
/// When a loop cannot be designed.
pub fn measure(quick: bool) -> Result<Vec<Growth>, Failure> {
    let linear = LinearLoop::new(&HoverLoops::new(&Configuration::default())?.position)?;
    let terms = |sizes: &[usize]| {
        let sized = |&terms: &usize| Ok((terms as f64, laguerre(&linear, terms, &linear.limits, quick)?));
        sizes.iter().map(sized).collect::<Result<Vec<_>, Failure>>()
    };
    let rows = |shares: &[usize]| {
        let sized = |&share: &usize| {
            let limits = thinned(&linear.limits, share);
            Ok((rows_of(&linear, &limits)?, laguerre(&linear, linear.terms, &limits, quick)?))
        };
        shares.iter().map(sized).collect::<Result<Vec<_>, Failure>>()
    };
    let horizon = |sizes: &[usize]| {
        let sized = |&moves: &usize| Ok((moves as f64, state_space(&linear, moves, quick)?));
        sizes.iter().map(sized).collect::<Result<Vec<_>, Failure>>()
    };
    let flown = |sizes: &[u32]| {
        let sized = |&seconds: &u32| Ok((f64::from(seconds), flight(seconds)?));
        sizes.iter().map(sized).collect::<Result<Vec<_>, Failure>>()
    };
    Ok(vec![
        Growth::of("Laguerre terms per input, position step", "ns", terms(&[2, 3, 4, 5, 6, 7, 8])?),
        Growth::of("rows of limits, position step", "ns", rows(&[1, 2, 3, 4, 6, 8])?),
        Growth::of("moves per input, state-space position step", "ns", horizon(&[5, 10, 15, 20, 25, 30])?),
        Growth::of("simulated seconds, closed loop", "ns", flown(&[1, 3, 10, 30, 100])?),
    ])
}

impl Growth {
    fn of(against: &'static str, unit: &'static str, points: Vec<(f64, f64)>) -> Self {
        let points = points.into_iter().map(|(size, cost)| Point { size, cost }).collect();
        Self { against, unit, points }
    }
}

/// Every so manyth sample of each limit.
fn thinned(limits: &[SignalLimit], share: usize) -> Vec<SignalLimit> {
    let thin = |limit: &SignalLimit| SignalLimit {
        samples: limit.samples.iter().copied().step_by(share).collect(),
        ..limit.clone()
    };
    limits.iter().map(thin).collect()
}

fn rows_of(linear: &LinearLoop, limits: &[SignalLimit]) -> Result<f64, Failure> {
    let design = linear.design(linear.terms, linear.scale)?;
    Ok(StabilizedMpc::<12, 2, 2, TWO>::new(&design, limits, linear.slack_cost)?.rows() as f64)
}

/// The median cold step at limits, ns, with so many terms under some limits.
fn laguerre(linear: &LinearLoop, terms: usize, limits: &[SignalLimit], quick: bool) -> Result<f64, Failure> {
    debug_assert!(terms <= TERMS);
    let design = linear.design(terms, linear.scale)?;
    let law = StabilizedMpc::<12, 2, 2, TWO>::new(&design, limits, linear.slack_cost)?;
    Ok(limited_step::<TWO>(linear, &law, quick))
}

/// The same of state-space MPC with so many moves.
fn state_space(linear: &LinearLoop, moves: usize, quick: bool) -> Result<f64, Failure> {
    let model = Augmented::new(&linear.model);
    let regulator = Dlqr::new(model.a(), model.b(), linear.weights.q(), linear.weights.r(), 1.0)?;
    let weights =
        StateSpaceMpcWeights::of_augmented(&model, &linear.weights, Some(regulator.cost().clone()))?;
    let horizon = linear.prediction_horizon;
    let design = StateSpaceMpcDesign::with_weights(&linear.model, &weights, horizon, moves)?;
    let law = StateSpaceMpc::<12, 2, 2, { unknowns(2, MOVES) }>::new(&design, &linear.plain_limits())?;
    Ok(limited_step::<{ unknowns(2, MOVES) }>(linear, &law, quick))
}

fn limited_step<const E: usize>(
    linear: &LinearLoop,
    law: &impl Controller<12, 2, 2, E, f64, E>,
    quick: bool,
) -> f64 {
    let watch = Stopwatch::calibrated();
    let moments = fly(linear, law, if quick { 2 } else { 8 }, 2);
    let times = moments.iter().filter(|moment| moment.limited).map(|moment| {
        let sample = moment.sample(&linear.upper);
        let timed = |_| {
            let mut state = moment.forgetful();
            watch.time(|| {
                std::hint::black_box(law.step(&mut state, &sample));
            })
        };
        (0..3).map(timed).fold(f64::INFINITY, f64::min)
    });
    median(times.collect())
}

/// ns of a whole flight, the shortest of three.
fn flight(seconds: u32) -> Result<f64, Failure> {
    let inputs = quadrotor::Inputs::default();
    let start = Simulation::new(&Configuration::default(), &inputs)?;
    let mut shortest_ns = f64::INFINITY;
    for _ in 0..3 {
        let mut simulation = start.clone();
        let mut flown = Ok(());
        let watch = Stopwatch::free();
        let taken_ns = watch.time(|| flown = simulation.advance_to(u64::from(seconds) * 1_000_000, &inputs));
        flown?;
        shortest_ns = shortest_ns.min(taken_ns);
    }
    Ok(shortest_ns)
}

#[cfg(test)]
mod tests {
    use lmpc::SignalLimit;

    use super::thinned;

    #[test]
    fn thinned_limits_keep_the_first_sample() {
        let limit = SignalLimit::of_inputs(3, 1, SignalLimit::range(1), (0..10).collect());
        assert_eq!(thinned(&[limit], 4)[0].samples, [0, 4, 8]);
    }
}
