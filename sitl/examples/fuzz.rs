//! Fuzzes the decoder and the vehicle for as long as asked:
//!
//! ```text
//! cargo run --release -p sitl --example fuzz -- --seconds 600 --seed 1
//! ```
//!
//! Case n has the seed SEED + n. A case that fails says how it is repeated.

use std::time::{Duration, Instant};

use clap::Parser;

#[path = "../tests/fuzzing/mod.rs"]
mod fuzzing;

/// Changed, cut and random frames into the vehicle.
#[derive(Parser)]
struct Arguments {
    /// How long to go on
    #[arg(long, default_value_t = 60)]
    seconds: u64,
    /// Seed of the first case
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Most cases
    #[arg(long, default_value_t = u64::MAX)]
    cases: u64,
}

fn main() {
    let arguments = Arguments::parse();
    let (corpus, start) = (fuzzing::corpus(), Instant::now());
    let (mut cases, mut frames) = (0, 0);
    while cases < arguments.cases && start.elapsed() < Duration::from_secs(arguments.seconds) {
        let seed = arguments.seed.wrapping_add(cases);
        frames += fuzzing::case(seed, &corpus);
        if cases % 16 == 0 {
            fuzzing::undisturbed(seed, &corpus);
        }
        cases += 1;
    }
    println!("{cases} cases, {frames} frames in {:.0} s: nothing broke", start.elapsed().as_secs_f64());
}
