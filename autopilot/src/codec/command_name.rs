//! Names of commands.

use mavlink::dialects::ardupilotmega::MavCmd;
use num_traits::FromPrimitive;

/// Prefix that all names have in the dialect.
const PREFIX: &str = "MAV_CMD_";

/// Commands that are newer than the dialect.
const NEWER: &[(u16, &str)] = &[(5005, "NAV_FENCE_HOME_CIRCLE_INCLUSION")];

/// A command for people: its name in the dialect and its number, `SET_CAMERA_MODE (530)`; without a name `command 530`.
pub fn command_name(number: u16) -> String {
    match MavCmd::from_u16(number) {
        Some(command) => {
            let name = format!("{command:?}");
            format!("{} ({number})", name.strip_prefix(PREFIX).unwrap_or(&name))
        }
        None => match NEWER.iter().find(|(newer, _)| *newer == number) {
            Some((_, name)) => format!("{name} ({number})"),
            None => format!("command {number}"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::command_name;

    #[test]
    fn commands_have_the_names_of_the_dialect() {
        assert_eq!(command_name(16), "NAV_WAYPOINT (16)");
        assert_eq!(command_name(530), "SET_CAMERA_MODE (530)");
        assert_eq!(command_name(5005), "NAV_FENCE_HOME_CIRCLE_INCLUSION (5005)");
        assert_eq!(command_name(64_000), "command 64000");
    }
}
