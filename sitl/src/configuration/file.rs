//! The configuration file: each of its settings is read as the flag of its name.

use std::collections::BTreeMap;
use std::path::Path;

use clap::{Arg, Command, CommandFactory, FromArgMatches};
use quadrotor::nearest_name;
use toml::{Spanned, Value};

use super::text_file::read_text;
use super::{Arguments, mistake};
use crate::failure::Failure;

/// Reads a file.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] with the line that is wrong.
pub fn read(path: &Path) -> Result<Arguments, Failure> {
    parse(&read_text(path)?).map_err(|reason| Failure::Content { path: path.to_owned(), reason })
}

fn parse(text: &str) -> Result<Arguments, String> {
    // The message spans lines; a person needs the place and the reason in one.
    let at = |start: usize, reason: &str| {
        let line = text.get(..start).unwrap_or_default().matches('\n').count();
        let content = text.lines().nth(line).unwrap_or_default().trim();
        format!("line {}, `{content}`: {reason}", line + 1)
    };
    let file: BTreeMap<String, Spanned<Value>> = toml::from_str(text).map_err(|error| {
        let reason = error.message().lines().collect::<Vec<_>>().join(" ");
        at(error.span().map_or(0, |span| span.start), &reason)
    })?;
    // The environment has its own turn.
    let mut command = Arguments::command().mut_args(|argument: Arg| argument.env(None));
    file.iter().try_fold(Arguments::default(), |settings, (name, value)| {
        let read = setting(&mut command, name, value.get_ref());
        read.map(|setting| settings.or(setting)).map_err(|reason| at(value.span().start, &reason))
    })
}

/// The arguments with one setting.
fn setting(command: &mut Command, name: &str, value: &Value) -> Result<Arguments, String> {
    if !is_setting(command, name) {
        let settings =
            command.get_arguments().filter_map(Arg::get_long).filter(|flag| is_setting(command, flag));
        return Err(match nearest_name(name, settings) {
            Some(meant) => format!("unknown setting `{name}`; did you mean `{meant}`?"),
            None => format!("unknown setting `{name}`; settings have the names of the flags, see --help"),
        });
    }
    let several = match value {
        Value::Array(several) => several.as_slice(),
        one => core::slice::from_ref(one),
    };
    let flag = |value: &Value| {
        let value = match value {
            Value::String(text) => text.clone(),
            Value::Integer(_) | Value::Float(_) | Value::Boolean(_) => value.to_string(),
            other => {
                return Err(format!(
                    "a setting is a string, a number, true or false, or an array of them, not a {}",
                    other.type_str()
                ));
            }
        };
        Ok(format!("--{name}={value}"))
    };
    let flags = several.iter().map(flag).collect::<Result<Vec<_>, _>>()?;
    let flags = std::iter::once(command.get_name().to_owned()).chain(flags);
    let matches = command.try_get_matches_from_mut(flags.collect::<Vec<_>>());
    matches.and_then(|matches| Arguments::from_arg_matches(&matches)).map_err(|error| mistake::reason(&error))
}

/// Whether it is a flag that a file may set.
fn is_setting(command: &Command, name: &str) -> bool {
    !["config", "help", "version"].contains(&name)
        && command.get_arguments().any(|argument| argument.get_long() == Some(name))
}

#[cfg(test)]
mod tests {
    use super::{Arguments, parse};
    use vehicle::parameters::Speed;

    #[test]
    fn numbers_and_lists_read_as_a_person_writes_them() {
        let text = "speed = 5\nwind = \"4,270\"\ngusts = 1.5\nlink = \"tcpin:5760\"\nset = [\"FRAME_MASS=1\", \"FRAME_DRAG_X=0.1\"]\n\
                    kalman = true\nseed = 7\nlog-dir = \"logs\"\n";
        let read = parse(text).expect("a file");
        let expected = Arguments {
            speed: Some(Speed::Factor(5.0)),
            wind: Some("4,270".parse().expect("wind")),
            gusts: Some(1.5),
            link: Some(vec!["tcpin:5760".parse().expect("a link")]),
            set: Some(vec!["FRAME_MASS=1".to_owned(), "FRAME_DRAG_X=0.1".to_owned()]),
            kalman: Some(true),
            seed: Some(7),
            log_dir: Some("logs".into()),
            ..Arguments::default()
        };
        assert_eq!(read, expected);
        assert_eq!(parse("speed = \"max\"").expect("a file").speed, Some(Speed::Max));
        assert_eq!(parse("# nothing\n").expect("a file"), Arguments::default());
    }

    #[test]
    fn a_wrong_setting_is_named_with_its_line_value_and_range() {
        for (text, expected) in [
            ("\nsystem-id = 0", "line 2, `system-id = 0`: `0` is not a whole number from 1 to 250"),
            ("vehicles = 0", "line 1, `vehicles = 0`: `0` is not a whole number from 1 to 250"),
            ("instance = 300", "line 1, `instance = 300`: `300` is not a whole number from 0 to 200"),
            ("gusts = 99", "line 1, `gusts = 99`: `99` is not a number from 0 to 10"),
            ("duration = nan", "line 1, `duration = nan`: `nan` is not a number from 0 to 1000000000"),
            ("log-count = 0.5", "`0.5` is not a whole number from 1 to 10000"),
            ("ports = \"mine\"", "line 1, `ports = \"mine\"`: must be own or shared, not `mine`"),
            ("speeed = 1", "line 1, `speeed = 1`: unknown setting `speeed`; did you mean `speed`?"),
            ("config = \"other.toml\"", "unknown setting `config`"),
            (
                "[propeller]\nmass = 1",
                "line 1, `[propeller]`: unknown setting `propeller`; settings have the names of the flags",
            ),
            ("[airframe]\nmass = 1", "line 1, `[airframe]`: a setting is a string, a number"),
            ("speed = { x = 1 }", "or an array of them, not a table"),
            ("speed = [1, 2]", "--speed"),
            ("speed = = 3", "line 1, `speed = = 3`: "),
            ("a\n", "line 1, `a`: "),
        ] {
            let reason = parse(text).expect_err(text);
            assert!(reason.contains(expected) && !reason.contains('\n'), "{text}: {reason}");
        }
    }
}
