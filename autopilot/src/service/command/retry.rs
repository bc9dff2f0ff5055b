//! Commands that were carried out lately: a repeated one is answered again, not carried out again.

use mavlink::dialects::ardupilotmega::{MavCmd, MavResult};

use crate::codec::{Command, CommandKind};
use crate::envelope::Origin;

/// Commands that are remembered.
const REMEMBERED: usize = 32;
/// For this long, µs of simulation time.
const REMEMBERED_US: u64 = 10_000_000;

/// It changes nothing of the flight.
const SET_MESSAGE_INTERVAL: u16 = MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL as u16;

#[derive(Clone, Debug)]
struct Done {
    sender: (u8, u8),
    command: Command,
    sequence: u8,
    time_us: u64,
    result: MavResult,
}

/// The memory.
#[derive(Clone, Debug, Default)]
pub struct Retries(Vec<Done>);

impl Retries {
    /// The answer to give again, if this is a retry (its sender says so) or a duplicate (the same frame once more). Behind another
    /// command, whoever sent it, it is no retry: what it had asked for may be undone.
    pub fn answer(
        &self,
        origin: &Origin,
        command: &Command,
        sequence: u8,
        time_us: u64,
    ) -> Option<MavResult> {
        let repeats = matches!(command.kind, CommandKind::Long { confirmation } if confirmation > 0);
        let mut overtaken = false;
        for done in self.0.iter().rev() {
            if !same(&done.command, command) {
                overtaken |= done.command.number != SET_MESSAGE_INTERVAL;
                continue;
            }
            let own = done.sender == (origin.system, origin.component)
                && time_us.saturating_sub(done.time_us) < REMEMBERED_US;
            if own && (repeats && !overtaken || done.sequence == sequence) {
                return Some(done.result);
            }
        }
        None
    }

    /// Remembers what was answered.
    pub fn remember(
        &mut self,
        origin: &Origin,
        command: &Command,
        sequence: u8,
        time_us: u64,
        result: MavResult,
    ) {
        if self.0.len() >= REMEMBERED {
            self.0.remove(0);
        }
        let sender = (origin.system, origin.component);
        self.0.push(Done { sender, command: *command, sequence, time_us, result });
    }
}

/// The same but for the confirmation. NaN is the same as NaN here.
fn same(one: &Command, other: &Command) -> bool {
    let numbers = |command: &Command| {
        let [a, b, c, d] = command.parameters;
        [a, b, c, d, command.x, command.y, command.z].map(f64::to_bits)
    };
    let kind = match (one.kind, other.kind) {
        (CommandKind::Long { .. }, CommandKind::Long { .. }) => true,
        (one, other) => one == other,
    };
    let asked = (one.number, one.component) == (other.number, other.component);
    kind && asked && numbers(one) == numbers(other)
}
