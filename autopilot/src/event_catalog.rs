//! The events that the vehicle sends, with the words that clients show for them: one row each, which is the event on the wire and its
//! entry in the file that clients download.

use serde_json::{Map, Value as Json, json};
use vehicle::identity::Identity;
use vehicle::{Action, ArmingSubject, Cause};

use crate::codec::checksum::checksum;

/// Component of the events, in the highest byte of their identifiers.
const COMPONENT: u32 = 1;
/// Of an identifier the rest is a hash of the name.
const SUB_ID: u32 = 0xff_ffff;
/// Names of the components of a vehicle that checks are about; the place in the list is the bit.
pub const HEALTH_COMPONENTS: [(&str, &str); 13] = [
    ("none", "None"),
    ("absolute_pressure", "Barometer"),
    ("gps", "GPS"),
    ("gyro", "Gyroscope"),
    ("accel", "Accelerometer"),
    ("magnetometer", "Magnetometer"),
    ("attitude_estimate", "Attitude estimate"),
    ("local_position_estimate", "Local position estimate"),
    ("global_position_estimate", "Global position estimate"),
    ("battery", "Battery"),
    ("motors_escs", "Rotors"),
    ("mission", "Mission"),
    ("system", "System"),
];

/// An event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Begins a report: chunk, errors and warnings by component, modes that can be armed in and run.
    ArmingCheckSummary,
    /// Ends it: chunk, present components, errors and warnings.
    HealthSummary,
    /// Something speaks against arming: modes, component.
    ArmingCheck(ArmingSubject),
    /// A failsafe has begun: cause, action.
    FailsafeBegun,
    /// It is over: cause.
    FailsafeCleared,
    /// The rotors may turn.
    Armed,
    /// They may no more.
    Disarmed,
}

/// How important an event is, as the wire has it: for the log and for clients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogLevel {
    /// A failsafe acts.
    Critical = 2,
    /// It cannot be armed.
    Error = 3,
    /// A failsafe warns.
    Warning = 4,
    /// Something has happened.
    Info = 6,
    /// For programs.
    Protocol = 8,
}

impl LogLevel {
    /// Both halves of the field.
    pub fn bits(self) -> u8 {
        (self as u8) << 4 | self as u8
    }
}

/// An argument: its name and type.
type Argument = (&'static str, &'static str);
const MODES: Argument = ("modes", "navigation_mode_group_t");
const COMPONENT_INDEX: Argument = ("health_component_index", "uint8_t");
const CHUNK: Argument = ("chunk_idx", "uint8_t");

impl Event {
    fn all() -> Vec<Self> {
        let mut all = vec![Self::ArmingCheckSummary, Self::HealthSummary];
        all.extend(ArmingSubject::ALL.map(Self::ArmingCheck));
        all.extend([Self::FailsafeBegun, Self::FailsafeCleared, Self::Armed, Self::Disarmed]);
        all
    }

    fn name(self) -> &'static str {
        match self {
            Self::ArmingCheckSummary => "arming_check_summary",
            Self::HealthSummary => "health_summary",
            Self::ArmingCheck(subject) => subject_words(subject).0,
            Self::FailsafeBegun => "failsafe_begun",
            Self::FailsafeCleared => "failsafe_cleared",
            Self::Armed => "armed",
            Self::Disarmed => "disarmed",
        }
    }

    /// What a client shows.
    fn message(self) -> &'static str {
        match self {
            Self::ArmingCheckSummary => "Arming check summary",
            Self::HealthSummary => "Health summary",
            Self::ArmingCheck(subject) => subject_words(subject).1,
            Self::FailsafeBegun => "{1}: {2}",
            Self::FailsafeCleared => "Failsafe cleared: {1}",
            Self::Armed => "Armed",
            Self::Disarmed => "Disarmed",
        }
    }

    fn group(self) -> &'static str {
        match self {
            Self::ArmingCheckSummary | Self::ArmingCheck(_) => "arming_check",
            Self::HealthSummary => "health",
            _ => "default",
        }
    }

    fn arguments(self) -> Vec<Argument> {
        let health = |name| (name, "health_component_t");
        match self {
            Self::ArmingCheckSummary => vec![
                CHUNK,
                health("error"),
                health("warning"),
                ("can_arm", "navigation_mode_group_t"),
                ("can_run", "navigation_mode_group_t"),
            ],
            Self::HealthSummary => vec![CHUNK, health("is_present"), health("error"), health("warning")],
            Self::ArmingCheck(_) => vec![MODES, COMPONENT_INDEX],
            Self::FailsafeBegun => vec![("cause", "failsafe_cause_t"), ("action", "failsafe_action_t")],
            Self::FailsafeCleared => vec![("cause", "failsafe_cause_t")],
            Self::Armed | Self::Disarmed => Vec::new(),
        }
    }

    fn sub_id(self) -> u32 {
        checksum(self.name().as_bytes()) & SUB_ID
    }

    /// Its identifier on the wire.
    pub fn id(self) -> u32 {
        COMPONENT << 24 | self.sub_id()
    }

    fn entry(self) -> Json {
        let arguments =
            self.arguments().into_iter().map(|(name, kind)| json!({ "name": name, "type": kind }));
        let arguments: Vec<Json> = arguments.collect();
        let mut entry = json!({ "name": self.name(), "message": self.message(), "arguments": arguments });
        if matches!(self, Self::ArmingCheckSummary | Self::HealthSummary)
            && let Some(entry) = entry.as_object_mut()
        {
            entry.insert("type".to_owned(), json!("summary"));
        }
        entry
    }
}

/// Name and words of what speaks against arming.
fn subject_words(subject: ArmingSubject) -> (&'static str, &'static str) {
    match subject {
        ArmingSubject::Ground => ("check_ground", "Not on the ground"),
        ArmingSubject::Tilt => ("check_tilt", "Tilted too far to arm"),
        ArmingSubject::Battery => ("check_battery", "Battery too low to arm"),
        ArmingSubject::Gyroscope => ("check_gyroscope", "Gyroscope failed"),
        ArmingSubject::Accelerometer => ("check_accelerometer", "Accelerometer failed"),
        ArmingSubject::Magnetometer => ("check_magnetometer", "Magnetometer failed"),
        ArmingSubject::Barometer => ("check_barometer", "Barometer failed"),
        ArmingSubject::Gps => ("check_gps", "No GPS fix"),
        ArmingSubject::Attitude => ("check_attitude", "No attitude estimate"),
        ArmingSubject::Velocity => ("check_velocity", "No velocity estimate"),
        ArmingSubject::Position => ("check_position", "No position estimate"),
        ArmingSubject::Rotor => ("check_rotor", "Rotor failed"),
        ArmingSubject::Mode => ("check_mode", "The present mode cannot be armed in"),
        ArmingSubject::Mission => ("check_mission", "No mission that can be flown"),
        ArmingSubject::SetPoints => ("check_set_points", "No recent set-points"),
        ArmingSubject::Failsafe => ("check_failsafe", "A failsafe is active"),
        ArmingSubject::Other => ("check_other", "Not ready to arm; see the messages"),
    }
}

/// The component that an obstacle is about, as its place in [`HEALTH_COMPONENTS`].
pub fn health_component(subject: ArmingSubject) -> u8 {
    let name = match subject {
        ArmingSubject::Battery => "battery",
        ArmingSubject::Gyroscope => "gyro",
        ArmingSubject::Accelerometer => "accel",
        ArmingSubject::Magnetometer => "magnetometer",
        ArmingSubject::Barometer => "absolute_pressure",
        ArmingSubject::Gps => "gps",
        ArmingSubject::Attitude | ArmingSubject::Tilt => "attitude_estimate",
        ArmingSubject::Velocity => "local_position_estimate",
        ArmingSubject::Position => "global_position_estimate",
        ArmingSubject::Rotor => "motors_escs",
        ArmingSubject::Mission => "mission",
        ArmingSubject::Failsafe => "system",
        _ => "none",
    };
    HEALTH_COMPONENTS.iter().position(|(known, _)| *known == name).unwrap_or(0) as u8
}

/// The number of a cause in events.
pub fn cause_number(cause: Cause) -> u8 {
    Cause::ALL.iter().position(|known| *known == cause).unwrap_or(0) as u8
}

/// The number of an action in events.
pub fn action_number(action: Action) -> u8 {
    Action::ALL.iter().position(|known| *known == action).unwrap_or(0) as u8
}

/// A type of numbers with names.
fn enumeration(kind: &str, is_bitfield: bool, entries: impl Iterator<Item = (u64, String, String)>) -> Json {
    let entries: Map<String, Json> = entries
        .map(|(value, name, text)| (value.to_string(), json!({ "name": name, "description": text })))
        .collect();
    json!({ "type": kind, "description": "", "is_bitfield": is_bitfield, "entries": entries })
}

/// A text as a name: small letters with underscores.
fn plain(text: &str) -> String {
    text.to_lowercase()
        .chars()
        .map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' })
        .collect()
}

/// The file for clients. Each mode is a group of its own.
pub fn render(identity: Identity) -> Vec<u8> {
    let mut groups: Map<String, Json> = Map::new();
    for event in Event::all() {
        let group = groups.entry(event.group()).or_insert_with(|| json!({ "events": {} }));
        if let Some(events) = group.get_mut("events").and_then(Json::as_object_mut) {
            events.insert(event.sub_id().to_string(), event.entry());
        }
    }
    let modes: Vec<_> = identity.selectable_modes().collect();
    let numbered = || (0_u32..).zip(&modes);
    let mode_entries = numbered().map(|(index, mode)| {
        let name = identity.mode_name(*mode);
        (1_u64 << index, plain(name), name.to_owned())
    });
    let components = (0_u32..).zip(HEALTH_COMPONENTS);
    let components =
        components.map(|(index, (name, text))| (1_u64 << index, name.to_owned(), text.to_owned()));
    let causes = Cause::ALL
        .map(|cause| (u64::from(cause_number(cause)), plain(cause.name()), cause.name().to_owned()));
    let actions = Action::ALL
        .map(|action| (u64::from(action_number(action)), plain(action.doing()), action.doing().to_owned()));
    let enums = json!({
        "navigation_mode_group_t": enumeration("uint32_t", true, mode_entries),
        "health_component_t": enumeration("uint64_t", true, components),
        "failsafe_cause_t": enumeration("uint8_t", false, causes.into_iter()),
        "failsafe_action_t": enumeration("uint8_t", false, actions.into_iter()),
    });
    let mode_groups: Map<String, Json> =
        numbered().map(|(index, mode)| (index.to_string(), json!([identity.custom_mode(*mode)]))).collect();
    let component = json!({
        "namespace": "lmpc",
        "enums": enums,
        "event_groups": groups,
        "supported_protocols": ["health_and_arming_check"],
        "navigation_mode_groups": { "groups": mode_groups },
    });
    let components = json!({ COMPONENT.to_string(): component });
    json!({ "version": 1, "components": components }).to_string().into_bytes()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::Event;

    /// The hash of 24 bits could give two events one identifier.
    #[test]
    fn identifiers_differ() {
        let ids: BTreeSet<u32> = Event::all().into_iter().map(Event::id).collect();
        assert_eq!(ids.len(), Event::all().len());
    }
}
