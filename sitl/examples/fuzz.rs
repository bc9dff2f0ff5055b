//! Fuzzes what comes over links and out of files for as long as asked:
//!
//! ```text
//! cargo run --release -p sitl --example fuzz -- --seconds 600 --seed 1
//! ```
//!
//! Case n of a target has the seed SEED + n. A case that fails says how it is repeated.

use std::time::{Duration, Instant};

use clap::Parser;
use clap::builder::PossibleValuesParser;

#[path = "../tests/suite/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../tests/suite/common/seal.rs"]
mod seal;

use fuzzing::TARGETS;

/// Changed, cut and random frames into the vehicle and the simulator, forged ones into signing, edited files into their readers.
#[derive(Parser)]
struct Arguments {
    /// Targets, one after the other; all if none is named
    #[arg(value_parser = PossibleValuesParser::new(TARGETS.map(|target| target.name)))]
    targets: Vec<String>,
    /// How long each goes on
    #[arg(long, default_value_t = 60)]
    seconds: u64,
    /// Seed of the first case
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Most cases of each
    #[arg(long, default_value_t = u64::MAX, hide_default_value = true)]
    cases: u64,
}

fn main() {
    let arguments = Arguments::parse();
    let asked =
        |name: &str| arguments.targets.is_empty() || arguments.targets.iter().any(|target| target == name);
    for target in TARGETS.iter().filter(|target| asked(target.name)) {
        let start = Instant::now();
        let end = Duration::from_secs(arguments.seconds);
        let (_, figures) =
            target.run(arguments.seed, |cases| cases < arguments.cases && start.elapsed() < end);
        println!("{figures} in {:.0} s: nothing broke", start.elapsed().as_secs_f64());
    }
}
