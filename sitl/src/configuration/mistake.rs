//! What clap refuses, in one line that names the setting.

use std::error::Error;

use clap::error::{ContextKind, ContextValue};

use crate::failure::Failure;

/// A mistake on the command line or in the environment.
pub fn failure(error: &clap::Error) -> Failure {
    match setting(error) {
        Some(flag) => Failure::Value { name: where_set(&flag), reason: reason(error) },
        None => Failure::Usage(reason(error)),
    }
}

/// What is wrong, without the name of the setting if `setting` knows it.
pub fn reason(error: &clap::Error) -> String {
    if let Some(source) = error.source() {
        return source.to_string();
    }
    if let (Some(given), Some(allowed)) = (text(error, ContextKind::InvalidValue), choices(error)) {
        return format!("must be {allowed}, not `{given}`");
    }
    // The rest is said in lines of which those about the whole usage help nobody.
    let rendered = error.render().to_string();
    let lines = rendered.lines().map(str::trim).filter(|line| !line.is_empty());
    let lines = lines.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    lines.collect::<Vec<_>>().join("; ").trim_start_matches("error: ").to_owned()
}

/// The flag whose value is refused: `--speed` of `--speed <X|max>`.
fn setting(error: &clap::Error) -> Option<String> {
    if error.source().is_none() && choices(error).is_none() {
        return None;
    }
    let shown = text(error, ContextKind::InvalidArg)?;
    shown.split([' ', '[', '=']).next().map(str::to_owned)
}

/// The values that there are, if there is only a choice of them.
fn choices(error: &clap::Error) -> Option<String> {
    let given = text(error, ContextKind::InvalidValue).filter(|given| !given.is_empty());
    match error.get(ContextKind::ValidValue) {
        Some(ContextValue::Strings(choices)) if given.is_some() && !choices.is_empty() => {
            Some(alternatives(choices))
        }
        _ => None,
    }
}

/// `a, b or c`
fn alternatives(choices: &[String]) -> String {
    match choices {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        other => other.concat(),
    }
}

fn text(error: &clap::Error, kind: ContextKind) -> Option<&str> {
    match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text),
        _ => None,
    }
}

/// A flag as its user knows it: what is not on the command line came from the environment.
fn where_set(flag: &str) -> String {
    let on_command_line = std::env::args_os().any(|argument| {
        let rest = argument.as_encoded_bytes().strip_prefix(flag.as_bytes());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(b"="))
    });
    if on_command_line {
        return flag.to_owned();
    }
    format!("LMPC_SITL_{}", flag.trim_start_matches('-').replace('-', "_").to_uppercase())
}
