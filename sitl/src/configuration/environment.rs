//! Environment variables that set nothing.

use std::ffi::{OsStr, OsString};

use quadrotor::nearest_name;

use super::help::command;
use crate::failure::Failure;

/// What the names of our variables begin with.
const PREFIX: &str = "LMPC_SITL_";

/// Refuses a variable that has our prefix and belongs to no flag: whoever has set it expects it to do something.
///
/// # Errors
/// [`Failure::Value`] that names the variable, and the one that was probably meant.
pub fn check(names: impl IntoIterator<Item = OsString>) -> Result<(), Failure> {
    let command = command();
    let known: Vec<&str> =
        command.get_arguments().filter_map(clap::Arg::get_env).filter_map(OsStr::to_str).collect();
    let ours = |name: &OsString| name.as_encoded_bytes().starts_with(PREFIX.as_bytes());
    let unknown = |name: &OsString| !name.to_str().is_some_and(|name| known.contains(&name));
    let Some(name) = names.into_iter().find(|name| ours(name) && unknown(name)) else { return Ok(()) };
    let name = name.to_string_lossy().into_owned();
    let flag = |name: &str| name.strip_prefix(PREFIX).map(str::to_owned).unwrap_or_default();
    let flags: Vec<String> = known.iter().map(|name| flag(name)).collect();
    let remedy = match nearest_name(&flag(&name), flags.iter().map(String::as_str)) {
        Some(meant) => format!("did you mean {PREFIX}{meant}?"),
        None => format!("unset it; {PREFIX}NAME sets the flag of that name, see --help"),
    };
    Err(Failure::Value { name, reason: format!("unknown environment variable; {remedy}") })
}

#[cfg(test)]
mod tests {
    use super::check;

    fn reason(name: &str) -> Option<String> {
        check(["HOME".into(), name.into()]).err().map(|failure| failure.to_string())
    }

    #[test]
    fn variables_of_flags_and_of_others_pass() {
        for name in ["LMPC_SITL_SPEED", "LMPC_SITL_LOG_DIR", "LMPC_SITL", "LMPC_SITLX", "PATH"] {
            assert_eq!(reason(name), None);
        }
    }

    #[test]
    fn others_are_refused_with_what_was_meant() {
        let refused = |name: &str| reason(name).expect(name);
        assert!(refused("LMPC_SITL_SPED").ends_with("did you mean LMPC_SITL_SPEED?"));
        assert!(refused("LMPC_SITL_LOGDIR").ends_with("did you mean LMPC_SITL_LOG_DIR?"));
        assert!(refused("LMPC_SITL_COLOUR").contains("unknown environment variable"));
        assert!(refused("LMPC_SITL_").contains("unknown environment variable"));
    }

    #[cfg(unix)]
    #[test]
    fn a_name_that_is_not_utf_8_is_refused_too() {
        use std::os::unix::ffi::OsStringExt;
        let name = std::ffi::OsString::from_vec(b"LMPC_SITL_\xff".to_vec());
        assert!(check([name]).is_err());
    }
}
