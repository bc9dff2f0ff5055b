//! A command as a client sends it.

use mavlink::dialects::ardupilotmega::{COMMAND_LONG_DATA, MavCmd};

/// COMMAND_LONG with its seven parameters to a system and a component, sent for the first time.
#[must_use]
pub fn command_long(
    (target_system, target_component): (u8, u8),
    command: MavCmd,
    [param1, param2, param3, param4, param5, param6, param7]: [f32; 7],
) -> COMMAND_LONG_DATA {
    COMMAND_LONG_DATA {
        param1,
        param2,
        param3,
        param4,
        param5,
        param6,
        param7,
        command,
        target_system,
        target_component,
        confirmation: 0,
    }
}
