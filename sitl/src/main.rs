//! `lmpc-sitl`: a simulated quadrotor that MAVLink clients fly.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match sitl::run(sitl::configuration::Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("lmpc-sitl: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}
