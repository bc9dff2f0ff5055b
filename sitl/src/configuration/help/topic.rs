//! Topics of the long help: some flags, and what is to be known beside them.

use clap::Command;
use quadrotor::nearest_name;

/// What stands for all topics.
pub const ALL: &str = "all";

/// A topic.
#[derive(Debug, PartialEq, Eq)]
pub struct Topic {
    /// What is asked for.
    pub name: &'static str,
    /// In some words.
    pub summary: &'static str,
    /// Flags, by their long names. Each flag belongs to exactly one topic.
    pub flags: &'static [&'static str],
    /// What stands behind the flags.
    pub text: &'static str,
}

macro_rules! topics {
    ($($name:literal $summary:literal [$($flag:literal),*];)*) => {
        /// All topics, in the order in which they are read. The text of each is in the file of its name.
        pub const TOPICS: &[Topic] = &[$(Topic {
            name: $name,
            summary: $summary,
            flags: &[$($flag),*],
            text: include_str!(concat!("topics/", $name, ".txt")),
        }),*];
    };
}

topics! {
    "links" "how clients connect" ["link", "instance", "system-id"];
    "radio" "a pilot's radio" ["rc-port"];
    "signing" "signed messages" ["signing-key", "accept-signing-setup"];
    "vehicle" "conventions and place" ["autopilot", "home"];
    "airframe" "what flies" ["airframe"];
    "parameters" "parameters at the start" ["parameters", "set", "list-parameters"];
    "mission" "plans at the start" ["mission", "autostart"];
    "fence" "areas to stay in or out of" [];
    "camera" "camera and gimbal" ["equipment"];
    "fleet" "several vehicles" ["vehicles", "ports", "formation", "clocks"];
    "time" "speed, lock-step, duration and seed" ["speed", "lockstep", "lockstep-period", "lockstep-timeout", "duration", "seed"];
    "wind" "wind and gusts" ["wind", "gusts"];
    "sensors" "what the vehicle measures" ["sensors", "noise", "kalman"];
    "obstacles" "the ground, and what stands in the way" ["world"];
    "traffic" "other aircraft" ["traffic"];
    "faults" "what breaks, and when" ["fault"];
    "record" "records and replays" ["record", "record-size", "replay"];
    "log" "flight logs and traffic logs" ["log-dir", "log-start", "log-size", "log-count", "tlog"];
    "files" "files that clients can reach, and file errors" ["ftp-root", "ftp-write"];
    "fmu" "an FMU in place of ours" ["fmu", "map", "fmu-check"];
    "hil" "the plant for an external autopilot" ["hil", "hil-mount"];
    "configuration" "configuration file and environment variables" ["config"];
    "view" "a page in a browser" ["view", "view-record", "view-page"];
    "terminal" "output, completions, manual page" ["log", "no-panel", "ready-file", "generate", "help", "version"];
    "exit-codes" "how the program ends" [];
}

/// The topics that a word asks for: one by its name or that of its flag, or all.
///
/// # Errors
/// One line with the topics that there are, and the one that was probably meant.
pub fn find(word: &str) -> Result<Vec<&'static Topic>, String> {
    if word == ALL {
        return Ok(TOPICS.iter().collect());
    }
    let flag = word.trim_start_matches('-');
    let by_name = TOPICS.iter().find(|topic| topic.name == word);
    if let Some(topic) = by_name.or_else(|| TOPICS.iter().find(|topic| topic.flags.contains(&flag))) {
        return Ok(vec![topic]);
    }
    let flags = TOPICS.iter().flat_map(|topic| topic.flags);
    let meant = nearest_name(flag, names().chain(flags.copied()));
    let meant = meant.map(|meant| format!("; did you mean `{meant}`?")).unwrap_or_default();
    let names: Vec<&str> = names().collect();
    Err(format!("`{word}` is not a topic{meant} (topics: {})", names.join(", ")))
}

/// Names of the topics, with that of all.
pub fn names() -> impl Iterator<Item = &'static str> {
    TOPICS.iter().map(|topic| topic.name).chain([ALL])
}

impl Topic {
    /// The topic as a person reads it, as wide as the command says.
    pub fn page(&self, command: &Command) -> String {
        let options = if self.flags.is_empty() { "" } else { "{options}" };
        let page = self
            .command(command)
            .about(format!("lmpc-sitl, {}: {}", self.name, self.summary))
            .long_about(None::<&str>)
            .help_template(format!("{{about}}\n\n{options}{{after-help}}"))
            .after_help(self.text.trim_end())
            .render_long_help();
        format!("{}\n", page.to_string().trim_end().replace("\n\n\n\n", "\n\n"))
    }

    /// The command with the flags of this topic only.
    pub fn command(&self, command: &Command) -> Command {
        let mut command = command.clone();
        // Adds --version, which has a topic, too.
        command.build();
        command.mut_args(|argument| {
            let has = argument.get_long().is_some_and(|long| self.flags.contains(&long));
            argument.hide(!has)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{TOPICS, find};
    use crate::configuration::help::command;

    #[test]
    fn each_flag_belongs_to_exactly_one_topic() {
        let mut command = command();
        command.build();
        for flag in command.get_arguments().filter_map(clap::Arg::get_long) {
            let count = TOPICS.iter().flat_map(|topic| topic.flags).filter(|named| **named == flag).count();
            assert_eq!(count, 1, "--{flag}: name it in one topic of help/topic.rs");
        }
        for flag in TOPICS.iter().flat_map(|topic| topic.flags) {
            assert!(command.get_arguments().any(|argument| argument.get_long() == Some(flag)), "--{flag}");
        }
    }

    #[test]
    fn a_page_has_the_flags_of_its_topic_and_no_others() {
        let pages = TOPICS.iter().map(|topic| (topic, topic.page(&command().term_width(80))));
        for (topic, page) in pages {
            for flag in TOPICS.iter().flat_map(|topic| topic.flags) {
                // Behind six columns, of which two have room for a short flag.
                let described = page.lines().any(|line| {
                    let flags =
                        line.get(6..).filter(|_| line.starts_with("      -") || line.starts_with("  -"));
                    flags.is_some_and(|flags| flags.split([' ', '[']).next() == Some(&format!("--{flag}")))
                });
                assert_eq!(described, topic.flags.contains(flag), "{} and --{flag}:\n{page}", topic.name);
            }
            assert!(page.contains(topic.text.lines().next().expect("a text")), "{page}");
            assert!(!page.contains("\n\n\n"), "{page:?}");
        }
    }

    #[test]
    fn a_word_finds_its_topic_or_says_what_there_is() {
        let found =
            |word: &str| find(word).map(|topics| topics.iter().map(|topic| topic.name).collect::<Vec<_>>());
        assert_eq!(found("wind"), Ok(vec!["wind"]));
        assert_eq!(found("lockstep-period"), Ok(vec!["time"]));
        assert_eq!(found("--gusts"), Ok(vec!["wind"]));
        assert_eq!(found("log"), Ok(vec!["log"]), "a topic goes before the flag of its name");
        assert_eq!(found("all").map(|all| all.len()), Ok(TOPICS.len()));
        let refused = found("wnid").expect_err("no topic");
        assert!(
            refused.starts_with("`wnid` is not a topic; did you mean `wind`? (topics: links, radio, "),
            "{refused}"
        );
        assert!(found("carburettor").expect_err("no topic").contains("is not a topic (topics: links, "));
    }
}
