//! Flags that go with hardly any other: `--replay FILE`, `--view-record FILE` and `--view-page FILE`.

use super::Arguments;
use crate::failure::Failure;

/// Refuses what would be ignored: a replay flies the settings and messages of the record, as fast as possible.
///
/// # Errors
/// [`Failure::Value`] that names the first such setting.
pub fn check_replay(arguments: &Arguments) -> Result<(), Failure> {
    check(arguments, &["replay"], "--replay, which flies the settings of the record")
}

/// Refuses what would be ignored: a recorded flight is shown.
///
/// # Errors
/// [`Failure::Value`] that names the first such setting.
pub fn check_view_record(arguments: &Arguments) -> Result<(), Failure> {
    let fitting = ["view", "view_record", "ready_file"];
    check(arguments, &fitting, "--view-record, which shows a recorded flight")
}

/// Refuses what would be ignored: a page is written, and nothing is served.
///
/// # Errors
/// [`Failure::Value`] that names the first such setting.
pub fn check_view_page(arguments: &Arguments) -> Result<(), Failure> {
    check(arguments, &["view_record", "view_page"], "--view-page, which writes a recorded flight into a file")
}

/// Refuses all settings but some with a flag.
fn check(arguments: &Arguments, fitting: &[&str], flag: &str) -> Result<(), Failure> {
    let mut names = given(arguments).filter(|name| !fitting.contains(name));
    let Some(name) = names.next() else { return Ok(()) };
    let (name, variable) = (name.replace('_', "-"), name.to_uppercase());
    let reason = format!(
        "cannot be used with {flag}; remove the flag, `{name}` in the configuration file, or LMPC_SITL_{variable}"
    );
    Err(Failure::Value { name: format!("--{name}"), reason })
}

/// The settings of [`Arguments`] that are given: the fields that are named, as they are named, but for those that do not count.
/// All have to be named: whoever adds a setting decides whether it goes with these flags.
macro_rules! given {
    ($arguments:ident: $($name:ident)+, but $($other:ident)+) => {{
        let Arguments { $($other: _,)+ $($name,)+ } = $arguments;
        [$((stringify!($name), $name.is_some()),)+].into_iter().filter(|(_, given)| *given).map(|(name, _)| name)
    }};
}

/// All settings that are given but the configuration file and the log.
fn given(arguments: &Arguments) -> impl Iterator<Item = &'static str> {
    given! {
        arguments:
            link instance system_id vehicles ports formation clocks autopilot airframe home speed
            lockstep lockstep_period lockstep_timeout wind gusts sensors noise kalman seed set fault
            parameters list_parameters mission world traffic autostart equipment record record_size
            replay view view_record view_page fmu map fmu_check hil hil_mount tlog log_dir log_start
            log_size log_count ftp_root ftp_write signing_key accept_signing_setup rc_port
            ready_file duration no_panel,
        but config log
    }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::{Arguments, check_replay};

    /// Values that some flags take; the others take `1`.
    const VALUES: &[(&str, &str)] = &[
        ("link", "udpin:0"),
        ("ports", "own"),
        ("formation", "line"),
        ("clocks", "shared"),
        ("autopilot", "px4"),
        ("airframe", "iris"),
        ("home", "0,0,0"),
        ("sensors", "ideal"),
        ("noise", "rtk-gps"),
        ("kalman", "true"),
        ("set", "AF_MASS=1"),
        ("fault", "1:gps=off"),
        ("hil-mount", "x"),
        ("fmu-check", "true"),
        ("log-start", "arm"),
        ("ftp-write", "true"),
        ("accept-signing-setup", "true"),
        ("rc-port", "5501"),
        ("wind", "3"),
        ("list-parameters", "json"),
        ("log", "warn"),
        ("autostart", "true"),
        ("equipment", "own"),
        ("lockstep", "always"),
        ("traffic", "fleet"),
        ("no-panel", "true"),
        ("view", "8088"),
    ];

    #[test]
    fn every_flag_but_three_is_refused_by_its_name() {
        let command = Arguments::command();
        let flags = command.get_arguments().filter_map(|argument| argument.get_long());
        let mut refused = 0;
        for flag in flags.filter(|flag| !matches!(*flag, "replay" | "help" | "version")) {
            let value = VALUES.iter().find(|(name, _)| *name == flag).map_or("1", |(_, value)| value);
            let line = ["lmpc-sitl", "--replay=a.lmpc", &format!("--{flag}={value}")].map(str::to_owned);
            let arguments = Arguments::try_parse_from(line).unwrap_or_else(|error| panic!("{flag}: {error}"));
            let result = check_replay(&arguments).map_err(|failure| failure.to_string());
            if matches!(flag, "config" | "log") {
                assert_eq!(result, Ok(()), "{flag}");
            } else {
                let text = result.expect_err(flag);
                assert!(text.starts_with(&format!("--{flag}: cannot be used with --replay")), "{text}");
                refused += 1;
            }
        }
        assert!(refused >= 37, "{refused}");
    }
}
