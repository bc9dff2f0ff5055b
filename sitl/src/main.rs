//! `lmpc-sitl`: a simulated quadrotor that MAVLink clients fly.

use std::io::{Write, stderr};
use std::process::ExitCode;

use clap::FromArgMatches;
use sitl::configuration::{Arguments, environment, help, mistake};
use sitl::fmu::HOST_ARGUMENT;

fn main() -> ExitCode {
    if std::env::args_os().skip(1).eq([HOST_ARGUMENT]) {
        importer::host();
    }
    let read = help::command().try_get_matches().and_then(|matches| Arguments::from_arg_matches(&matches));
    let ended = match read {
        Ok(arguments) => {
            let names = std::env::vars_os().map(|(name, _)| name);
            environment::check(names).and_then(|()| sitl::run(arguments))
        }
        Err(error) if error.use_stderr() => Err(mistake::failure(&error)),
        Err(asked) => help::show(&asked),
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
