//! The page of the book.

use std::fmt::Write as _;

use vehicle::identity::Identity;

use super::tables::{self, Carried, Traffic};

const HEAD: &str = "\
<!-- Written by `cargo run -p autopilot --example compatibility`; a test fails if it differs from what the vehicle claims. -->

# What of PX4 and ArduPilot works here

Programs that were written for PX4 or for ArduCopter find here what this vehicle takes and sends, beside what those two do.
The columns *here* are made from the vehicle itself: from what its services claim, from the commands that plans may have, from its modes and its parameters.
The columns *PX4* and *ArduPilot* were read from their sources; what only other vehicle types, hardware in the loop or their own devices need is left out.

What is not taken is never silently dropped where the protocol has an answer for it: see below each table.
";

/// The whole page.
pub fn page() -> String {
    [HEAD.to_owned(), messages(), commands(), modes(), parameters()].join("\n")
}

fn messages() -> String {
    let mut text = String::from(
        "## Messages\n\n\
         A message that is not taken is ignored, as both originals do; with `--link` it is still forwarded to other links.\n\
         `MAV_CMD_REQUEST_MESSAGE` and `MAV_CMD_SET_MESSAGE_INTERVAL` for a message that is not sent here are answered with `MAV_RESULT_UNSUPPORTED`.\n\n\
         | message | PX4 | ArduPilot | here | for |\n| --- | --- | --- | --- | --- |\n",
    );
    for row in tables::messages() {
        let [px4, ardupilot, here] = [row.px4, row.ardupilot, row.here].map(traffic);
        let _ = writeln!(
            text,
            "| `{}` ({}) | {px4} | {ardupilot} | {here} | {} |",
            row.name, row.id, row.summary
        );
    }
    text
}

fn commands() -> String {
    let mut text = String::from(
        "## Commands\n\n\
         *Command* is a `COMMAND_LONG` or a `COMMAND_INT`, *item* an item of a mission, a fence or a list of rally points.\n\
         A command that is not taken here, or that only the original has whose conventions are not followed, is answered with `COMMAND_ACK` and `MAV_RESULT_UNSUPPORTED`; a plan with an item that is not taken with `MISSION_ACK` and `MAV_MISSION_UNSUPPORTED`, and a line that names it.\n\n\
         | command | PX4 | ArduPilot | here | for |\n| --- | --- | --- | --- | --- |\n",
    );
    for row in tables::commands() {
        let [px4, ardupilot, here] = [row.px4, row.ardupilot, row.here].map(carried);
        let _ = writeln!(text, "| `{}` | {px4} | {ardupilot} | {here} | {} |", row.name, row.summary);
    }
    text
}

fn modes() -> String {
    let mut text = String::from(
        "## Modes\n\n\
         A mode that is not there is refused: `MAV_CMD_DO_SET_MODE` is answered with `MAV_RESULT_UNSUPPORTED` and a line that lists those that are.\n",
    );
    for (identity, title) in [(Identity::Px4, "PX4"), (Identity::ArduPilot, "ArduPilot")] {
        let _ = write!(
            text,
            "\n### With `--autopilot {}`\n\n| {title} | number in `HEARTBEAT` | here |\n| --- | --- | --- |\n",
            title.to_lowercase()
        );
        for row in tables::modes(identity) {
            let _ = writeln!(text, "| {} | {} | {} |", row.name, row.custom_mode, row.here.unwrap_or(NO));
        }
    }
    text
}

fn parameters() -> String {
    let mut text = String::from(
        "## Parameters\n\n\
         Parameters with the names, units and numbers of PX4 or ArduPilot, by the conventions that they are listed with.\n\
         The closed loop has [parameters of its own](parameters.md), which have the same names with both.\n\
         All others of the originals are unknown here.\n\n\
         | parameter | `--autopilot px4` | `--autopilot ardupilot` | meaning | allowed |\n| --- | --- | --- | --- | --- |\n",
    );
    for row in tables::parameters() {
        let [px4, ardupilot] = [row.px4, row.ardupilot].map(|listed| if listed { "yes" } else { NO });
        let meaning = row.text.replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {px4} | {ardupilot} | {meaning} | {} |", row.id, row.allowed);
    }
    text
}

/// What stands where there is nothing.
const NO: &str = "–";

fn traffic(traffic: Traffic) -> &'static str {
    match (traffic.taken, traffic.sent) {
        (true, true) => "takes, sends",
        (true, false) => "takes",
        (false, true) => "sends",
        (false, false) => NO,
    }
}

fn carried(carried: Carried) -> &'static str {
    match (carried.command, carried.item) {
        (true, true) => "command, item",
        (true, false) => "command",
        (false, true) => "item",
        (false, false) => NO,
    }
}
