//! The command line as clap knows it, and the texts around its flags.
//!
//! ```text
//! request    --help [TOPIC] and --generate FORM: a text in place of a flight
//!   topic       the long help, by topics; topics/ has a text for each
//!   generated   completions and manual page
//! ```

mod generated;
mod request;
mod topic;

use std::io::{Write, stdout};

use clap::{Command, CommandFactory, ValueHint};

use super::Arguments;

/// Headings of the groups of flags; what has none stands under "Options".
pub const LINKS: &str = "Links";
/// What flies, and from where.
pub const VEHICLE: &str = "Vehicle";
/// Fleets.
pub const FLEET: &str = "Several vehicles";
/// Time, air, sensors and faults.
pub const SIMULATION: &str = "Simulation";
/// What is written and read.
pub const FILES: &str = "Records, logs and files";
/// Models of others.
pub const FMU: &str = "FMU in place of ours";
/// Hardware and software in the loop.
pub const HIL: &str = "External autopilot";

/// The command line. The names of environment variables follow from those of the flags, and are not listed.
pub fn command() -> Command {
    let command = Arguments::command().disable_help_flag(true).arg(request::generate()).arg(request::help());
    command.after_help(footer()).mut_args(|argument| {
        let names = argument.get_value_names().unwrap_or_default();
        // They are in its name.
        let is_switch = names.first().is_some_and(|name| *name == "true|false");
        let hint = match names.first().map_or("", |name| name.as_str()) {
            "DIR" => ValueHint::DirPath,
            name if name.contains("FILE") => ValueHint::FilePath,
            _ => ValueHint::Unknown,
        };
        let hidden = is_switch || argument.is_hide_possible_values_set();
        argument.hide_env(true).hide_possible_values(hidden).value_hint(hint)
    })
}

/// Behind the short help.
fn footer() -> String {
    format!(
        "Start it without flags, then open QGroundControl, or connect to UDP port 14540.\n\
         Topics for --help TOPIC: {}.",
        topic::names().collect::<Vec<_>>().join(", ")
    )
}

/// Prints what was asked for in place of a flight: a page of the help, a generated text, the version.
pub fn show(asked: &clap::Error) -> ! {
    let Some(text) = request::asked(asked) else { asked.exit() };
    // Whoever has closed the stream has read enough.
    let _closed = stdout().write_all(text.as_bytes()).and_then(|()| stdout().flush());
    std::process::exit(0)
}

#[cfg(test)]
mod tests {
    use super::command;
    use super::topic::{ALL, TOPICS, find};

    fn short(columns: usize) -> String {
        command().term_width(columns).render_help().to_string()
    }

    fn long(columns: usize) -> String {
        let command = command().term_width(columns);
        find(ALL).expect("all").iter().map(|topic| topic.page(&command)).collect()
    }

    #[test]
    fn the_short_help_fits_on_a_screen() {
        let text = short(80);
        assert!(text.lines().count() <= 50, "{} lines:\n{text}", text.lines().count());
        for flag in
            ["--link", "--vehicles", "--speed", "--wind", "--mission", "--record", "--config", "--help"]
        {
            assert!(text.contains(flag), "{flag}");
        }
        for topic in TOPICS {
            assert!(text.contains(topic.name), "{}:\n{text}", topic.name);
        }
    }

    #[test]
    fn no_line_is_wider_than_the_terminal() {
        for topic in TOPICS {
            // What is typed is not wrapped.
            let lines = topic.text.lines().filter(|line| !line.contains("--generate"));
            assert!(lines.clone().all(|line| line.chars().count() <= 80), "{} is for 80 columns", topic.name);
        }
        for columns in [80, 100, 120] {
            for text in [short(columns), long(columns)] {
                let widest = text.lines().map(|line| line.chars().count()).max();
                assert!(widest <= Some(columns), "{columns}: {widest:?}\n{text}");
            }
        }
    }

    #[test]
    fn each_flag_has_a_group_a_short_and_a_plain_description() {
        let text = long(80);
        for argument in command().get_arguments() {
            let Some(name) = argument.get_long() else { continue };
            assert!(text.contains(&format!("--{name}")), "{name} is not in the long help");
            let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
            assert!((8..=60).contains(&help.chars().count()), "{name}: `{help}`");
            assert!(!help.ends_with('.'), "{name}: `{help}`");
            let general =
                ["config", "ready-file", "log", "no-panel", "generate", "help", "version"].contains(&name);
            assert_eq!(argument.get_help_heading().is_none(), general, "{name}");
        }
    }

    #[test]
    fn each_setting_has_the_environment_variable_of_its_name() {
        for argument in command().get_arguments() {
            let Some(name) =
                argument.get_long().filter(|name| !["generate", "help", "version"].contains(name))
            else {
                continue;
            };
            let expected = format!("LMPC_SITL_{}", name.replace('-', "_").to_uppercase());
            assert_eq!(argument.get_env(), Some(expected.as_ref()), "{name}");
        }
    }

    #[test]
    fn every_topic_with_flags_has_an_example_that_is_accepted() {
        for topic in TOPICS.iter().filter(|topic| !topic.flags.is_empty()) {
            let examples: Vec<&str> =
                topic.text.lines().filter(|line| line.trim().starts_with("lmpc-sitl")).collect();
            assert!(!examples.is_empty(), "{}", topic.name);
            for example in examples.iter().filter(|line| !line.contains("--generate")) {
                assert!(command().try_get_matches_from(example.split_whitespace()).is_ok(), "{example}");
            }
        }
    }
}
