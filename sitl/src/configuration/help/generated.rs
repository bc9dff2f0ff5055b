//! Texts that other programs read: completions of shells, the manual page.

use std::io;

use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, italic, roman};
use quadrotor::nearest_name;

use super::command;
use super::topic::TOPICS;

/// What the program does, in paragraphs.
const DESCRIPTION: &[&str] = &[
    "Simulates a quadrotor that MAVLink clients fly as they fly one with PX4 or ArduPilot: ground stations, MAVSDK, MAVProxy, pymavlink.",
    "Without options it flies PX4's conventions in real time, for ground stations on UDP port 14550 and programs on UDP port 14540. Ctrl-C ends it.",
    "Each option can also be set by an environment variable or in a configuration file: see CONFIGURATION. The sections below are the topics of --help.",
];

/// What can be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The manual page, for man(1).
    Manual,
    /// Completions.
    Completions(Shell),
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Manual,
        Self::Completions(Shell::Bash),
        Self::Completions(Shell::Zsh),
        Self::Completions(Shell::Fish),
        Self::Completions(Shell::PowerShell),
    ];

    /// What is asked for.
    pub fn name(self) -> &'static str {
        match self {
            Self::Manual => "man",
            Self::Completions(Shell::Bash) => "complete-bash",
            Self::Completions(Shell::Zsh) => "complete-zsh",
            Self::Completions(Shell::Fish) => "complete-fish",
            Self::Completions(_) => "complete-powershell",
        }
    }

    /// All names, for a person.
    pub fn names() -> String {
        let names = Self::ALL.map(Self::name);
        let [first @ .., last] = names.as_slice() else { return String::new() };
        format!("{} or {last}", first.join(", "))
    }

    /// The form of a name.
    ///
    /// # Errors
    /// One line with the forms that there are.
    pub fn find(name: &str) -> Result<Self, String> {
        if let Some(form) = Self::ALL.into_iter().find(|form| form.name() == name) {
            return Ok(form);
        }
        let meant = nearest_name(name, Self::ALL.iter().map(|form| form.name()));
        let meant = meant.map(|meant| format!("; did you mean {meant}?")).unwrap_or_default();
        Err(format!("must be {}, not `{name}`{meant}", Self::names()))
    }

    /// The text.
    pub fn text(self) -> String {
        let mut text = Vec::new();
        // Writing into memory does not fail.
        let _written = match self {
            Self::Manual => manual(command(), &mut text),
            Self::Completions(shell) => {
                let mut command = command();
                let name = command.get_name().to_owned();
                clap_complete::generate(shell, &mut command, name, &mut text);
                Ok(())
            }
        };
        String::from_utf8_lossy(&text).into_owned()
    }
}

/// The manual page: a section for each topic, with its flags and what is to be known beside them.
fn manual(command: Command, page: &mut Vec<u8>) -> io::Result<()> {
    let head = Man::new(command.clone());
    head.render_title(page)?;
    head.render_name_section(page)?;
    let mut text = Roff::new();
    text.control("SH", ["SYNOPSIS"]);
    // The name that is typed stands for itself; all flags at once say nothing.
    text.text([bold("lmpc-sitl"), roman(" ["), italic("OPTION"), roman("]...")]);
    text.control("SH", ["DESCRIPTION"]);
    for paragraph in DESCRIPTION {
        text.control("PP", []).text([roman(*paragraph)]);
    }
    text.to_writer(page)?;
    for topic in TOPICS {
        // What the short help leaves out would have no description here.
        let flags = topic
            .command(&command)
            .mut_args(|argument| argument.help_heading(topic.name).hide_short_help(false));
        Man::new(flags).render_options_section(page)?;
        let mut text = Roff::new();
        if topic.flags.is_empty() {
            text.control("SH", [topic.name.to_uppercase().as_str()]);
        }
        text.control("PP", []).control("nf", []);
        for line in topic.text.lines() {
            text.text([roman(line)]);
        }
        text.control("fi", []).to_writer(page)?;
    }
    head.render_version_section(page)
}

#[cfg(test)]
mod tests {
    use super::{Form, command};
    use crate::configuration::help::topic::TOPICS;

    #[test]
    fn every_form_has_every_flag() {
        for form in Form::ALL {
            let text = form.text();
            for flag in command().get_arguments().filter_map(clap::Arg::get_long) {
                // Roff writes a hyphen that is one as \-.
                let written = [format!("--{flag}"), format!("\\-\\-{}", flag.replace('-', "\\-"))];
                let fish = format!("-l {flag}");
                let has = written.iter().chain([&fish]).any(|written| text.contains(written.as_str()));
                assert!(has, "{}: --{flag}", form.name());
            }
        }
    }

    #[test]
    fn the_manual_page_has_one_section_for_each_topic_and_describes_each_flag() {
        let page = Form::Manual.text();
        for topic in TOPICS {
            let heading = format!(".SH {}", topic.name.to_uppercase());
            assert_eq!(page.lines().filter(|line| **line == heading).count(), 1, "{heading}");
        }
        for argument in command().get_arguments() {
            let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
            // Up to what roff writes in other ways.
            let words = help.split(['-', '`', '\'', '.']).next().unwrap_or_default();
            assert!(page.contains(words), "{:?}: {words}", argument.get_long());
        }
    }

    #[test]
    fn the_manual_page_says_in_short_how_to_start() {
        let page = Form::Manual.text();
        let (_, synopsis) = page.split_once(".SH SYNOPSIS\n").expect("a synopsis");
        assert!(synopsis.lines().nth(1) == Some(".SH DESCRIPTION"), "{synopsis}");
        assert!(page.lines().all(|line| line != "true"), "a switch needs no list of values");
    }

    #[test]
    fn a_form_that_is_not_there_is_refused() {
        let refused = Form::find("complete-bsh").expect_err("no form");
        assert_eq!(
            refused,
            "must be man, complete-bash, complete-zsh, complete-fish or complete-powershell, not `complete-bsh`; \
             did you mean complete-bash?"
        );
    }
}
