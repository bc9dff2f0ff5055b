//! A thousand random flights of every controller: what none of the papers has.
//!
//! ```text
//! circumstances (seeded: start, mass, gusts, noise) ─┐
//! pilot ─► configuration ────────────────────────────┴─► trial ─► robustness[]
//! ```

mod circumstances;
mod gusts;
mod trial;

use quadrotor::Configuration;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::flights::{Mission, Pilot};
use crate::progress::Progress;

pub use circumstances::{DRAG_N_S_M, DURATION_S, NOISE, START, WIND_M_S};
use trial::{Trial, fly};

/// Flights of each controller.
pub const FLIGHTS: u32 = 1000;
/// Distance from the goal, m, within which a vehicle has arrived when it stays there for the last 2 s.
pub const ARRIVED_M: f64 = 0.5;

/// One controller under all circumstances; every controller meets the same ones.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RobustnessResult {
    /// Who flew.
    pub controller: String,
    /// "shaped", the cascade's default; "step", the raw goal with the governor; or "step without governor".
    pub mission: &'static str,
    /// Flights.
    pub flights: u32,
    /// Flights that stayed within 0.5 m of the goal during the last 2 of their 20 s.
    pub arrived: u32,
    /// Largest distance from the goal during the last 2 s, of all flights, m; null when a vehicle was lost to infinity.
    pub worst_m: Option<f64>,
    /// Median over the flights of the largest distance from the goal during the last 2 s, m.
    pub median_m: f64,
    /// 95th percentile of the same, m; null as above.
    pub p95_m: Option<f64>,
    /// Flights that exceeded, 3 s after the start or later, the limit of tilt, of horizontal speed, of climb or of
    /// sink rate by more than 1 %.
    pub violations: u32,
    /// Those of them that exceeded the limit of tilt.
    pub tilt_violations: u32,
    /// Those of them that exceeded a limit of speed.
    pub speed_violations: u32,
    /// Largest distance of each flight during its last 2 s, m, in ascending order, for the figure.
    #[serde(skip)]
    pub distances_m: Vec<f64>,
}

/// How the goal is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asking {
    /// Through the jerk-limited shaper, with the governor behind it.
    Shaped,
    /// As a raw step.
    Raw(Mission),
}

impl Asking {
    fn name(self) -> &'static str {
        match self {
            Self::Shaped => "shaped",
            Self::Raw(mission) => mission.name(),
        }
    }

    fn configuration(self, pilot: &Pilot) -> Configuration {
        match self {
            Self::Shaped => {
                let mut configuration = pilot.configuration(Mission::Step);
                configuration.reference.shaping = true;
                configuration
            }
            Self::Raw(mission) => pilot.configuration(mission),
        }
    }
}

/// All controllers under `flights` circumstances, on all cores. Each flight has its own generator, so that the
/// number of threads does not matter.
pub fn robustness(flights: u32, progress: &Progress) -> Vec<RobustnessResult> {
    entries()
        .into_iter()
        .map(|(asking, pilot)| {
            let configuration = asking.configuration(&pilot);
            summary(pilot.name, asking, &trials(&configuration, flights, progress))
        })
        .collect()
}

/// Shaped random flights of one configuration.
pub fn shaped_flights(name: &str, configuration: &Configuration, flights: u32) -> RobustnessResult {
    let mut configuration = *configuration;
    configuration.reference.shaping = true;
    summary(name.to_owned(), Asking::Shaped, &trials(&configuration, flights, &Progress::hidden()))
}

fn trials(configuration: &Configuration, flights: u32, progress: &Progress) -> Vec<Trial> {
    (0..flights)
        .into_par_iter()
        .map(|index| {
            let trial = fly(configuration, index);
            progress.advance();
            trial
        })
        .collect()
}

/// How often [`robustness`] reports progress.
pub fn robustness_parts(flights: u32) -> u64 {
    entries().len() as u64 * u64::from(flights)
}

fn entries() -> Vec<(Asking, Pilot)> {
    let askings = [Asking::Shaped, Asking::Raw(Mission::BareStep)];
    askings
        .into_iter()
        .flat_map(|asking| {
            [
                Pilot::default_lmpc(),
                Pilot::paper(5, crate::flights::PAPER_SCALE),
                Pilot::state_space(25),
                Pilot::regulator(),
            ]
            .map(|pilot| (asking, pilot))
        })
        .collect()
}

fn summary(controller: String, asking: Asking, trials: &[Trial]) -> RobustnessResult {
    let count = |holds: fn(&Trial) -> bool| trials.iter().filter(|trial| holds(trial)).count() as u32;
    let mut distances_m: Vec<f64> = trials.iter().map(|trial| trial.distance_m).collect();
    distances_m.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let index = (share * distances_m.len() as f64) as usize;
        distances_m.get(index.min(distances_m.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
    };
    RobustnessResult {
        controller,
        mission: asking.name(),
        flights: trials.len() as u32,
        arrived: count(|trial| trial.distance_m < ARRIVED_M),
        worst_m: Some(quantile(1.0)).filter(|distance| distance.is_finite()),
        median_m: quantile(0.5),
        p95_m: Some(quantile(0.95)).filter(|distance| distance.is_finite()),
        violations: count(|trial| trial.tilt_exceeded || trial.speed_exceeded),
        tilt_violations: count(|trial| trial.tilt_exceeded),
        speed_violations: count(|trial| trial.speed_exceeded),
        distances_m,
    }
}

#[cfg(test)]
mod tests {
    use super::{FLIGHTS, robustness, robustness_parts};
    use crate::flights::Pilot;
    use crate::progress::Progress;

    /// The same numbers on one thread and on three, and nobody is lost in the defaults' own mission but by the paper's recipe, which
    /// knows no limits.
    #[test]
    fn threads_do_not_matter() {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| robustness(6, &Progress::hidden()))
        };
        let (one, three) = (on(1), on(3));
        assert_eq!(one, three);
        assert_eq!(robustness_parts(FLIGHTS), one.len() as u64 * u64::from(FLIGHTS));
        let recipe = Pilot::paper(5, crate::flights::PAPER_SCALE).name;
        for result in one.iter().filter(|result| result.mission == "shaped" && result.controller != recipe) {
            assert_eq!(result.arrived, result.flights, "{result:?}");
        }
    }
}
