//! `lmpc-sitl`: a simulated quadrotor that MAVLink clients fly.

use std::io::{Write, stderr};
use std::process::ExitCode;

use clap::Parser;
use sitl::configuration::{Arguments, mistake};

fn main() -> ExitCode {
    let ended = match Arguments::try_parse() {
        Ok(arguments) => sitl::run(arguments),
        Err(error) if error.use_stderr() => Err(mistake::failure(&error)),
        Err(help) => help.exit(),
    };
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // Whoever has closed it reads the exit code.
            let _gone = writeln!(stderr(), "lmpc-sitl: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}
