//! The work whose instructions `cargo xtask counts` counts: a piece of it is prepared, and then done as often as is asked for. The
//! difference between two numbers of times is what one of them takes, without what prepares it.
//!
//! ```sh
//! counts              # the names of the pieces of work, and how often to do each
//! counts NAME TIMES   # does one
//! ```

mod control_period;
mod fmu_step;
mod simulated_second;
mod vehicle_tick;

use std::process::ExitCode;

/// A piece of work.
struct Work {
    name: &'static str,
    /// How often it is done to be counted.
    times: u32,
    /// Prepares it and does it so often.
    run: fn(u32),
}

const ALL: [Work; 5] = [
    Work { name: "control period", times: 100, run: control_period::run },
    Work { name: "simulated second", times: 10, run: simulated_second::run },
    Work { name: "FMU step", times: 1_000, run: fmu_step::run },
    Work { name: "FMU step and 12 outputs", times: 1_000, run: fmu_step::run_and_read },
    Work { name: "vehicle tick", times: 1_000, run: vehicle_tick::run },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        [] => {
            for work in ALL {
                println!("{}\t{}", work.name, work.times);
            }
            return ExitCode::SUCCESS;
        }
        [name, times] => {
            let known = ALL.into_iter().find(|work| work.name == name);
            if let (Some(work), Ok(times)) = (known, times.parse()) {
                (work.run)(times);
                return ExitCode::SUCCESS;
            }
        }
        _ => {}
    }
    eprintln!("counts: expected nothing, or the name of a work and how often to do it");
    ExitCode::from(2)
}
