//! The control step: ours and peers, sample by sample along the same flights.

use lmpc::{Controller, Status};
use nalgebra::DVector;
use serde::Serialize;

use crate::Failure;
use crate::clarabel_solver::Clarabels;
use crate::flight::Moment;
use crate::median::median;
use crate::peer::PeerLibrary;
use crate::pick::Pick;
use crate::program::{PosedSample, Program};
use crate::reference;
use crate::shipped::{Loops, Shipped};
use crate::solver::Maker;
use crate::stopwatch::Stopwatch;

/// Median time of a sample from which a solver is timed once instead of several times.
const SLOW_NS: f64 = 300_000.0;
/// The flight that each solver goes through untimed before it is timed: else its first samples would tell what the solver before it has
/// left in the caches, and peers, which are set up just before, would not have to read their programs into them.
const FIRST: usize = 0;

/// A loop's model and samples, for solvers of other forms of the same task.
#[derive(Serialize)]
pub struct Task {
    program: Program,
    /// A, B, C of x⁺ = A x + B u, row by row, with their sizes.
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
    states: usize,
    inputs: usize,
    sample_time_s: f64,
    /// Q on \[Δx; y − r\], R on Δu, and the regulator's cost of \[Δx; y − r\].
    q: Vec<f64>,
    r: Vec<f64>,
    terminal: Vec<f64>,
    limits: Vec<TaskLimit>,
    moments: Vec<TaskMoment>,
}

#[derive(Serialize)]
struct TaskLimit {
    /// directions · C and directions · D, row by row.
    of_state: Vec<f64>,
    of_input: Vec<f64>,
    upper: Vec<f64>,
    samples: Vec<usize>,
}

#[derive(Serialize)]
struct TaskMoment {
    flight: usize,
    measured: Vec<f64>,
    /// x(k) − x of the goal as it is seen.
    deviation: Vec<f64>,
    error: Vec<f64>,
    input: Vec<f64>,
    limited: bool,
    /// Δu(k) of ours.
    increment: Vec<f64>,
}

/// The figures of a loop.
#[derive(Serialize)]
pub struct LoopFigures {
    name: &'static str,
    unknowns: usize,
    rows: usize,
    samples: usize,
    limited: Vec<bool>,
    /// Samples at which the reference found its solution.
    judged: usize,
    entries: Vec<Entry>,
}

/// The figures of a solver on a loop.
#[derive(Serialize)]
struct Entry {
    solver: String,
    warm: bool,
    /// The shortest time of each sample over all passes, ns.
    times_ns: Vec<f64>,
    failures: usize,
    most_iterations: u32,
    /// Largest (cost − reference) / (1 + reference).
    cost_gap: Option<f64>,
    /// Largest excess over a row of length 1.
    violation: Option<f64>,
    /// Largest |Δu − Δu of the reference| / (1 + |Δu of the reference|).
    move_error: f64,
    memory_bytes: Option<usize>,
}

/// What goes to solvers in Python.
///
/// # Errors
/// When a loop cannot be designed.
pub fn programs(quick: bool) -> Result<Vec<Task>, Failure> {
    let loops = Loops::new()?;
    Ok(vec![
        task(&loops.position, quick),
        task(&loops.altitude, quick),
        task(&loops.lean, quick),
        task(&loops.turn, quick),
    ])
}

fn task<const N: usize, const P: usize, const E: usize>(shipped: &Shipped<N, P, E>, quick: bool) -> Task {
    let (linear, moments) = (&shipped.linear, shipped.flights(quick));
    let by_rows = |matrix: &nalgebra::DMatrix<f64>| matrix.transpose().as_slice().to_vec();
    let mut bounds = linear.upper.iter().copied();
    let limits = linear.limits.iter().map(|limit| TaskLimit {
        of_state: by_rows(&(&limit.directions * &limit.state)),
        of_input: by_rows(&(&limit.directions * &limit.input)),
        upper: bounds.by_ref().take(limit.directions.nrows()).collect(),
        samples: limit.samples.clone(),
    });
    let terminal = linear.design(linear.terms, linear.scale).map(|design| by_rows(design.dlqr().cost()));
    Task {
        limits: limits.collect(),
        a: by_rows(linear.model.a()),
        b: by_rows(linear.model.b()),
        c: by_rows(linear.model.c()),
        states: N,
        inputs: P,
        sample_time_s: linear.sample_time_s,
        q: by_rows(linear.weights.q()),
        r: by_rows(linear.weights.r()),
        terminal: terminal.unwrap_or_default(),
        moments: moments.iter().map(|moment| told(shipped, moment)).collect(),
        program: shipped.program(&moments),
    }
}

fn told<const N: usize, const P: usize, const E: usize>(
    shipped: &Shipped<N, P, E>,
    moment: &Moment<N, P, E>,
) -> TaskMoment {
    let sample = moment.sample(&shipped.linear.upper);
    TaskMoment {
        flight: moment.flight,
        measured: moment.measured.as_slice().to_vec(),
        deviation: sample.deviation.as_slice().to_vec(),
        error: moment.error.as_slice().to_vec(),
        input: moment.before.applied().as_slice().to_vec(),
        limited: moment.limited,
        increment: shipped.law.step(&mut moment.forgetful(), &sample).increment.as_slice().to_vec(),
    }
}

/// Times ours and peers on all loops, and if asked compares their solutions with the reference.
///
/// # Errors
/// When a loop cannot be designed or has no reference.
pub fn measure(
    peers: &[PeerLibrary],
    seed: u64,
    quick: bool,
    judge: bool,
) -> Result<Vec<LoopFigures>, Failure> {
    let loops = Loops::new()?;
    let mut order = Pick::new(seed);
    Ok(vec![
        figures(&loops.position, peers, &mut order, (quick, judge))?,
        figures(&loops.altitude, peers, &mut order, (quick, judge))?,
        figures(&loops.lean, peers, &mut order, (quick, judge))?,
        figures(&loops.turn, peers, &mut order, (quick, judge))?,
    ])
}

fn figures<const N: usize, const P: usize, const E: usize>(
    shipped: &Shipped<N, P, E>,
    peers: &[PeerLibrary],
    order: &mut Pick,
    (quick, judge): (bool, bool),
) -> Result<LoopFigures, Failure> {
    let moments = shipped.flights(quick);
    let program = shipped.program(&moments);
    let reference = if judge { reference::solutions(&program)? } else { vec![None; moments.len()] };
    let clarabel = Clarabels { tolerance: None };
    let mut makers: Vec<Option<&dyn Maker>> = vec![None, Some(&clarabel)];
    makers.extend(peers.iter().map(|peer| Some(peer as &dyn Maker)));
    let mut entries: Vec<(Option<&dyn Maker>, Entry)> = Vec::new();
    for maker in makers {
        for warm in [false, true] {
            let entry = match maker {
                None => Some(ours(shipped, &moments, &reference, warm)),
                Some(maker) => judged(shipped, &moments, &program, &reference, maker, warm),
            };
            entries.extend(entry.map(|entry| (maker, entry)));
        }
    }
    let watch = Stopwatch::calibrated();
    for _ in 0..if quick { 3 } else { 7 } {
        order.shuffle(&mut entries);
        for (maker, entry) in &mut entries {
            // What takes so long is not disturbed by much less.
            let known_ns = median(entry.times_ns.clone());
            if known_ns.is_finite() && known_ns > SLOW_NS {
                continue;
            }
            match maker {
                None => time_ours(&watch, shipped, &moments, entry),
                Some(maker) => time_peer(&watch, &program, *maker, entry),
            }
        }
    }
    Ok(LoopFigures {
        name: shipped.name,
        unknowns: program.unknowns,
        rows: program.rows,
        samples: moments.len(),
        limited: moments.iter().map(|moment| moment.limited).collect(),
        judged: reference.iter().flatten().count(),
        entries: entries.into_iter().map(|(_, entry)| entry).collect(),
    })
}

/// Relative error of a first move.
fn move_error(found: &[f64], expected: &[f64]) -> f64 {
    let difference: f64 = found.iter().zip(expected).map(|(a, b)| (a - b).powi(2)).sum();
    let size: f64 = expected.iter().map(|value| value * value).sum();
    difference.sqrt() / (1.0 + size.sqrt())
}

/// Ours, untimed: what it decides, against the reference.
fn ours<const N: usize, const P: usize, const E: usize>(
    shipped: &Shipped<N, P, E>,
    moments: &[Moment<N, P, E>],
    reference: &[Option<Vec<f64>>],
    warm: bool,
) -> Entry {
    let held = allocation_counter::measure(|| std::mem::forget(shipped.law.clone())).bytes_current;
    let mut entry = Entry::new("ours", warm, moments.len());
    entry.memory_bytes = Some(size_of_val(&shipped.law) + usize::try_from(held).unwrap_or_default());
    for (moment, z) in moments.iter().zip(reference) {
        let sample = moment.sample(&shipped.linear.upper);
        let mut state = if warm { moment.before } else { moment.forgetful() };
        let step = shipped.law.step(&mut state, &sample);
        entry.failures += usize::from(!matches!(step.status, Status::Optimal | Status::Relaxed));
        entry.most_iterations = entry.most_iterations.max(step.iterations);
        if let Some(z) = z {
            let expected = shipped.posed.increment(&sample, &DVector::from_column_slice(z));
            entry.move_error =
                entry.move_error.max(move_error(step.increment.as_slice(), expected.as_slice()));
        }
    }
    entry
}

fn time_ours<const N: usize, const P: usize, const E: usize>(
    watch: &Stopwatch,
    shipped: &Shipped<N, P, E>,
    moments: &[Moment<N, P, E>],
    entry: &mut Entry,
) {
    let warm = entry.warm;
    let time = |moment: &Moment<N, P, E>| {
        let sample = std::hint::black_box(moment.sample(&shipped.linear.upper));
        // Copied here, as the memory of a peer is where it was.
        let mut state = if warm { moment.before } else { moment.forgetful() };
        // Once, as peers: more in a row would find all of it in the cache.
        watch.time(|| {
            std::hint::black_box(shipped.law.step(&mut state, &sample));
        })
    };
    for moment in moments.iter().take_while(|moment| moment.flight == FIRST) {
        time(moment);
    }
    for (moment, best_ns) in moments.iter().zip(&mut entry.times_ns) {
        *best_ns = best_ns.min(time(moment));
    }
}

/// A peer, untimed: its solutions, against the reference. `None` if it refuses the program.
fn judged<const N: usize, const P: usize, const E: usize>(
    shipped: &Shipped<N, P, E>,
    moments: &[Moment<N, P, E>],
    program: &Program,
    reference: &[Option<Vec<f64>>],
    maker: &dyn Maker,
    warm: bool,
) -> Option<Entry> {
    let mut solver = maker.solver(program)?;
    let mut entry = Entry::new(solver.name(), warm, moments.len());
    entry.memory_bytes = solver.memory();
    let (mut cost_gap, mut violation) = (0.0_f64, 0.0_f64);
    let mut z = vec![0.0; program.unknowns];
    let mut last_flight = None;
    for ((moment, sample), reference) in moments.iter().zip(&program.samples).zip(reference) {
        let solved = solver.solve(sample, warm && last_flight == Some(sample.flight), &mut z);
        last_flight = Some(sample.flight);
        entry.most_iterations = entry.most_iterations.max(solved.iterations);
        entry.failures += usize::from(!solved.solved);
        let (true, Some(best)) = (solved.solved, reference) else { continue };
        let least = program.cost(sample, best);
        cost_gap = cost_gap.max((program.cost(sample, &z) - least) / (1.0 + least));
        violation = violation.max(program.violation(sample, &z));
        let told = moment.sample(&shipped.linear.upper);
        let of = |z: &[f64]| shipped.posed.increment(&told, &DVector::from_column_slice(z));
        entry.move_error = entry.move_error.max(move_error(of(&z).as_slice(), of(best).as_slice()));
    }
    (entry.cost_gap, entry.violation) = (Some(cost_gap), Some(violation));
    Some(entry)
}

fn time_peer(watch: &Stopwatch, program: &Program, maker: &dyn Maker, entry: &mut Entry) {
    let Some(mut solver) = maker.solver(program) else { return };
    let mut z = vec![0.0; program.unknowns];
    let mut last_flight = None;
    let warm_starts = entry.warm;
    let mut time = |sample: &PosedSample, begins: bool| {
        let warm = warm_starts && !begins && last_flight == Some(sample.flight);
        last_flight = Some(sample.flight);
        watch.time(|| {
            solver.solve(std::hint::black_box(sample), warm, &mut z);
        })
    };
    for (number, sample) in program.samples.iter().take_while(|sample| sample.flight == FIRST).enumerate() {
        time(sample, number == 0);
    }
    for (number, (sample, best_ns)) in program.samples.iter().zip(&mut entry.times_ns).enumerate() {
        *best_ns = best_ns.min(time(sample, number == 0));
    }
}

impl Entry {
    fn new(solver: &str, warm: bool, samples: usize) -> Self {
        Self {
            solver: solver.to_owned(),
            warm,
            times_ns: vec![f64::INFINITY; samples],
            failures: 0,
            most_iterations: 0,
            cost_gap: None,
            violation: None,
            move_error: 0.0,
            memory_bytes: None,
        }
    }
}
