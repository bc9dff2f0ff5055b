//! An hour (or as much as is asked for) of vehicles under clients that come and go, over channels that lose messages: in
//! simulation time, without a socket, as fast as the machine can. Ends with figures, and exit code 1 if something that must
//! hold did not.
//!
//! ```sh
//! cargo run --release -p sitl --example soak -- --vehicles 10 --hours 1 --seed 1
//! ```

mod run;

use std::process::ExitCode;

use clap::Parser;

/// Flies vehicles under random clients and checks what must always hold.
#[derive(Parser)]
struct Arguments {
    /// Vehicles
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u8).range(1..=100))]
    vehicles: u8,
    /// Simulated hours of each
    #[arg(long, default_value_t = 1.0)]
    hours: f64,
    /// Seed of everything random
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Share of the messages that is lost, each way
    #[arg(long, default_value_t = 0.02)]
    loss: f64,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if !(0.0..=0.5).contains(&arguments.loss) || !(0.0..=1e4).contains(&arguments.hours) {
        eprintln!("soak: --loss must be within 0 to 0.5, --hours within 0 to 10000");
        return ExitCode::from(2);
    }
    let options = run::Options {
        vehicles: arguments.vehicles,
        end_us: (arguments.hours * 3.6e9) as u64,
        seed: arguments.seed,
        loss: arguments.loss,
    };
    let figures = run::run(&options);
    println!("{figures}");
    if figures.violations.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
