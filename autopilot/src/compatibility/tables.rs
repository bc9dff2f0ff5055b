//! The tables: one row for everything that one of the originals or this vehicle knows.

use std::collections::{BTreeMap, BTreeSet};

use mavlink::Message as _;
use mavlink::dialects::ardupilotmega::MavMessage;
use vehicle::identity::Identity;
use vehicle::parameters::ParameterTable;
use vehicle::plan;

use super::originals::{ARDUPILOT, Original, PX4};
use crate::codec::{command_name, id};
use crate::service::registry::Registry;

/// Messages that links take themselves, with what for.
const TAKEN_BY_LINKS: [(u32, &str); 3] = [
    (id::HEARTBEAT, "Who is on a link, and whether a ground station is heard"),
    (id::SETUP_SIGNING, "The key of signed links"),
    (id::RADIO_STATUS, "Heard without a signature; changes nothing"),
];

/// Which way a message goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// It is taken.
    pub taken: bool,
    /// It is sent.
    pub sent: bool,
}

/// A message.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MessageRow {
    /// Its number.
    pub id: u32,
    /// Its name.
    pub name: String,
    /// By PX4.
    pub px4: Traffic,
    /// By ArduPilot.
    pub ardupilot: Traffic,
    /// Here.
    pub here: Traffic,
    /// What it is for here.
    pub summary: &'static str,
}

/// How a command can come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Carried {
    /// As COMMAND_LONG or COMMAND_INT.
    pub command: bool,
    /// As an item of a plan.
    pub item: bool,
}

/// A command.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CommandRow {
    /// MAV_CMD.
    pub number: u16,
    /// Its name and number.
    pub name: String,
    /// By PX4.
    pub px4: Carried,
    /// By ArduPilot.
    pub ardupilot: Carried,
    /// Here.
    pub here: Carried,
    /// What it is for here as a command.
    pub summary: &'static str,
}

/// A mode of one of the originals.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModeRow {
    /// Its name there.
    pub name: &'static str,
    /// Its number in HEARTBEAT.
    pub custom_mode: u32,
    /// The mode that it is here, if there is one.
    pub here: Option<&'static str>,
}

/// A parameter that is not of our closed loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterRow {
    /// Its name.
    pub id: &'static str,
    /// Whether it is listed with PX4's conventions.
    pub px4: bool,
    /// Whether it is listed with ArduPilot's conventions.
    pub ardupilot: bool,
    /// What it means here.
    pub text: String,
    /// Which values it can have.
    pub allowed: String,
}

/// All messages, by their numbers.
pub fn messages() -> Vec<MessageRow> {
    let mut rows = BTreeMap::new();
    for (original, of) in [
        (&PX4, (|row| &mut row.px4) as fn(&mut MessageRow) -> &mut Traffic),
        (&ARDUPILOT, |row| &mut row.ardupilot),
    ] {
        for name in original.takes {
            if let Some(row) = named(&mut rows, name) {
                of(row).taken = true;
            }
        }
        for name in original.sends {
            if let Some(row) = named(&mut rows, name) {
                of(row).sent = true;
            }
        }
    }
    let registry = Registry::new();
    let mut claim = |id: u32, summary: &'static str, sent: bool| {
        let row = row_of(&mut rows, id);
        row.here.taken |= !sent;
        row.here.sent |= sent;
        row.summary = summary;
    };
    for (id, summary) in TAKEN_BY_LINKS {
        claim(id, summary, false);
    }
    for service in registry.services() {
        let streams = service.streams().iter().map(|stream| stream.id);
        for id in streams.chain(service.answers().iter().copied()) {
            claim(id, service.summary(), true);
        }
    }
    for service in registry.services() {
        for id in service.messages() {
            claim(*id, service.summary(), false);
        }
    }
    for (id, sent) in [(id::COMMAND_LONG, false), (id::COMMAND_INT, false), (id::COMMAND_ACK, true)] {
        claim(id, "Commands", sent);
    }
    claim(id::STATUSTEXT, "Lines for the pilot", true);
    rows.into_values().collect()
}

fn named<'a>(rows: &'a mut BTreeMap<u32, MessageRow>, name: &str) -> Option<&'a mut MessageRow> {
    Some(row_of(rows, MavMessage::message_id_from_name(name)?))
}

fn row_of(rows: &mut BTreeMap<u32, MessageRow>, id: u32) -> &mut MessageRow {
    rows.entry(id).or_insert_with(|| {
        let name = MavMessage::default_message_from_id(id).map_or("", |message| message.message_name());
        MessageRow { id, name: name.to_owned(), ..MessageRow::default() }
    })
}

/// All commands, by their numbers.
pub fn commands() -> Vec<CommandRow> {
    let numbers = numbers();
    let mut rows: BTreeMap<u16, CommandRow> = BTreeMap::new();
    let mut row = |number: u16, change: &dyn Fn(&mut CommandRow)| {
        let named = || CommandRow { number, name: command_name(number), ..CommandRow::default() };
        change(rows.entry(number).or_insert_with(named));
    };
    let mut of_original = |original: &Original, of: fn(&mut CommandRow) -> &mut Carried| {
        for number in original.commands.iter().filter_map(|name| numbers.get(*name)) {
            row(*number, &|row| of(row).command = true);
        }
        for number in original.items.iter().filter_map(|name| numbers.get(*name)) {
            row(*number, &|row| of(row).item = true);
        }
    };
    of_original(&PX4, |row| &mut row.px4);
    of_original(&ARDUPILOT, |row| &mut row.ardupilot);
    for service in Registry::new().services() {
        for entry in service.commands() {
            row(entry.number, &|row| {
                row.here.command = true;
                row.summary = service.summary();
            });
        }
    }
    for number in plan::command_numbers() {
        row(number, &|row| row.here.item = true);
    }
    rows.into_values().collect()
}

/// Commands of the dialect by their names without MAV_CMD_.
fn numbers() -> BTreeMap<String, u16> {
    let named =
        |number: u16| Some((command_name(number).strip_suffix(&format!(" ({number})"))?.to_owned(), number));
    (0..=u16::MAX).filter_map(named).collect()
}

/// The modes of the original whose conventions are followed, by their numbers.
pub fn modes(identity: Identity) -> Vec<ModeRow> {
    let original = if identity.is_ardupilot() { &ARDUPILOT } else { &PX4 };
    let known: BTreeSet<u32> = original.modes.iter().map(|(_, number)| *number).collect();
    let here = |number: u32| identity.mode(number).map(|mode| identity.mode_name(mode));
    let row = |name: &'static str, custom_mode: u32| ModeRow { name, custom_mode, here: here(custom_mode) };
    let ours = identity.selectable_modes().map(|mode| (identity.mode_name(mode), identity.custom_mode(mode)));
    let others = ours.filter(|(_, number)| !known.contains(number));
    original.modes.iter().copied().chain(others).map(|(name, number)| row(name, number)).collect()
}

/// All parameters but those of the closed loop, by their names.
pub fn parameters() -> Vec<ParameterRow> {
    let mut rows: BTreeMap<&'static str, ParameterRow> = BTreeMap::new();
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let table = ParameterTable::new(identity);
        for entry in table.entries().iter().filter(|entry| entry.dotted().is_none()) {
            let row = rows.entry(entry.id).or_insert_with(|| ParameterRow {
                id: entry.id,
                px4: false,
                ardupilot: false,
                text: entry.describe().text,
                allowed: entry.allowed(),
            });
            row.px4 |= !identity.is_ardupilot();
            row.ardupilot |= identity.is_ardupilot();
        }
    }
    rows.into_values().collect()
}

#[cfg(test)]
mod tests {
    use mavlink::Message as _;
    use mavlink::dialects::ardupilotmega::MavMessage;

    use super::{ARDUPILOT, PX4, numbers};
    use crate::service::registry::Registry;

    /// Otherwise a row would be missing.
    #[test]
    fn the_dialect_has_all_names_of_the_originals() {
        let known = numbers();
        for original in [PX4, ARDUPILOT] {
            for name in original.takes.iter().chain(original.sends) {
                assert!(MavMessage::message_id_from_name(name).is_some(), "{name}");
            }
            for name in original.commands.iter().chain(original.items) {
                assert!(known.contains_key(*name), "{name}");
            }
        }
    }

    #[test]
    fn every_service_says_what_it_is_for() {
        for service in Registry::new().services() {
            let claims = !service.messages().is_empty()
                || !service.commands().is_empty()
                || !service.streams().is_empty()
                || !service.answers().is_empty();
            assert!(!claims || !service.summary().is_empty(), "{service:?} needs a `summary`");
        }
    }
}
