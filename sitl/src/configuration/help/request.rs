//! Flags that ask for a text in place of a flight: `--help [TOPIC]` and `--generate FORM`.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};

use super::generated::Form;
use super::topic;

/// Asks for the short help, or for that of a topic.
pub fn help() -> Arg {
    Arg::new("help")
        .short('h')
        .long("help")
        .value_name("TOPIC")
        .num_args(0..=1)
        .default_missing_value("")
        .hide_possible_values(true)
        .value_parser(Request {
            text: |command, word| {
                if word.is_empty() {
                    return Ok(command.clone().render_help().to_string());
                }
                let pages = topic::find(word)?.into_iter().map(|topic| topic.page(command));
                Ok(pages.collect::<Vec<_>>().join("\n\n"))
            },
            values: || topic::names().map(PossibleValue::new).collect(),
        })
        .help("Print the short help, or that of a topic")
        .long_help(
            "Print the short help, or that of a topic\n\nThe name of a flag finds its topic; `all` prints all topics.",
        )
}

/// Asks for a text that other programs read.
pub fn generate() -> Arg {
    Arg::new("generate")
        .long("generate")
        .value_name("FORM")
        .hide_possible_values(true)
        .hide_short_help(true)
        .value_parser(Request {
            text: |_, word| Ok(Form::find(word)?.text()),
            values: || Form::ALL.iter().map(|form| PossibleValue::new(form.name())).collect(),
        })
        .help("Print completions or the manual page")
        .long_help(format!("Print completions or the manual page\n\nFORM is {}.", Form::names()))
}

/// The text that was asked for, if an error is none.
pub fn asked(error: &Error) -> Option<&str> {
    match error.get(ContextKind::Custom) {
        Some(ContextValue::String(text)) if error.kind() == ErrorKind::DisplayHelp => Some(text),
        _ => None,
    }
}

/// Ends parsing with a text, so that nothing else on the command line or in the environment can be in the way.
#[derive(Clone)]
struct Request {
    text: fn(&Command, &str) -> Result<String, String>,
    values: fn() -> Vec<PossibleValue>,
}

impl TypedValueParser for Request {
    type Value = String;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<String, Error> {
        let (text, owned) = (self.text, command.clone());
        let parser = StringValueParser::new().try_map(move |word: String| text(&owned, &word));
        let text = parser.parse_ref(command, argument, value)?;
        let mut shown = Error::new(ErrorKind::DisplayHelp).with_cmd(command);
        shown.insert(ContextKind::Custom, ContextValue::String(text));
        Err(shown)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.values)().into_iter()))
    }
}
