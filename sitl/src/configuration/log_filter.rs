//! `--log LEVEL`: what is logged.

use std::str::FromStr;

use tracing_subscriber::filter::{LevelFilter, Targets};

/// Parts of the program that log.
const TARGETS: [&str; 3] = ["autopilot", "sitl", "vehicle"];
/// Levels, from nothing to everything.
const LEVELS: [(&str, LevelFilter); 6] = [
    ("off", LevelFilter::OFF),
    ("error", LevelFilter::ERROR),
    ("warn", LevelFilter::WARN),
    ("info", LevelFilter::INFO),
    ("debug", LevelFilter::DEBUG),
    ("trace", LevelFilter::TRACE),
];

/// A level for everything, and levels of single parts of the program.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFilter(Targets);

impl Default for LogFilter {
    fn default() -> Self {
        Self(Targets::new().with_default(LevelFilter::INFO))
    }
}

impl From<LogFilter> for Targets {
    fn from(LogFilter(targets): LogFilter) -> Self {
        targets
    }
}

impl FromStr for LogFilter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut default = LevelFilter::INFO;
        let mut targets = Targets::new();
        for part in text.split(',').map(str::trim) {
            match part.split_once('=') {
                None => default = level(part).ok_or_else(|| wrong(part))?,
                Some((target, name)) => {
                    let level = level(name).filter(|_| is_target(target)).ok_or_else(|| wrong(part))?;
                    targets = targets.with_target(target, level);
                }
            }
        }
        Ok(Self(targets.with_default(default)))
    }
}

fn level(name: &str) -> Option<LevelFilter> {
    LEVELS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, level)| *level)
}

/// Whether it is a part of the program, or a module of one.
fn is_target(target: &str) -> bool {
    TARGETS.contains(&target.split("::").next().unwrap_or_default())
}

fn wrong(part: &str) -> String {
    let levels = LEVELS.map(|(name, _)| name).join(", ");
    let targets = TARGETS.join(", ");
    format!("`{part}` is not a log level; use {levels}, or PART=LEVEL with one of {targets} as PART")
}

#[cfg(test)]
mod tests {
    use tracing_subscriber::filter::{LevelFilter, Targets};

    use super::LogFilter;

    #[test]
    fn levels_and_parts_read_as_they_are_written() {
        let read = |text: &str| Targets::from(text.parse::<LogFilter>().expect(text));
        let all = |level| Targets::new().with_default(level);
        assert_eq!(read("debug"), all(LevelFilter::DEBUG));
        assert_eq!(read("OFF"), all(LevelFilter::OFF));
        // What is not named stays at the default.
        assert_eq!(
            read("sitl::link=trace"),
            Targets::new().with_target("sitl::link", LevelFilter::TRACE).with_default(LevelFilter::INFO)
        );
        assert_eq!(
            read("warn, vehicle=debug"),
            Targets::new().with_target("vehicle", LevelFilter::DEBUG).with_default(LevelFilter::WARN)
        );
    }

    #[test]
    fn what_would_silence_the_log_is_refused_with_the_levels() {
        for wrong in ["", "verbose", "debug[", "info,", "=info", "foo=info", "sitl=loud", "sitl=", "9"] {
            let reason = wrong.parse::<LogFilter>().expect_err(wrong);
            assert!(reason.contains("off, error, warn, info, debug, trace"), "{wrong}: {reason}");
        }
    }
}
