//! PX4's events interface, read as a client reads it: numbers from the wire, words from the metadata.

use crate::common;
use crate::common::Bench;
use crate::common::failsafe_bench::{lose_ground_station, set};
use crate::common::ftp_client::Client;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use serde_json::Value as Json;
use vehicle::identity::Identity;

/// An event with its words.
#[derive(Debug)]
struct Told {
    group: String,
    kind: String,
    message: String,
    values: Vec<u64>,
    sequence: u16,
}

fn metadata(identity: Identity) -> Json {
    let mut client = Client { bench: Bench::new(identity), sequence: 0 };
    let general = client.read("/metadata/general.json").expect("there");
    let general: Json = serde_json::from_slice(&general).expect("JSON");
    let types = general["metadataTypes"].as_array().expect("files").clone();
    // COMP_METADATA_TYPE_EVENTS
    let events = types.iter().find(|file| file["type"] == 4);
    assert_eq!(events.is_some(), !identity.is_ardupilot());
    let bytes = client.read("/metadata/events.json").expect("there");
    if let Some(events) = events {
        assert_eq!(events["uri"], "mftp:///metadata/events.json");
        assert_eq!(events["fileCrc"], u64::from(common::ftp_client::crc32(&bytes)));
    }
    serde_json::from_slice(&bytes).expect("JSON")
}

/// As the library of the events interface reads one: the component in the highest byte, the entry by the rest, arguments one behind
/// the other by the sizes of their types.
fn parse(metadata: &Json, event: &EVENT_DATA) -> Told {
    let component = &metadata["components"][(event.id >> 24).to_string()];
    let sub_id = (event.id & 0xff_ffff).to_string();
    let groups = component["event_groups"].as_object().expect("groups");
    let (group, entry) = groups
        .iter()
        .find_map(|(group, events)| events["events"].get(&sub_id).map(|entry| (group, entry)))
        .expect("every event is described");
    let mut message = entry["message"].as_str().expect("words").to_owned();
    let (mut offset, mut values) = (0, Vec::new());
    for (number, argument) in (1..).zip(entry["arguments"].as_array().expect("a list")) {
        let kind = argument["type"].as_str().expect("a type");
        let enumeration = component["enums"].get(kind);
        let base = enumeration.map_or(kind, |enumeration| enumeration["type"].as_str().expect("a type"));
        let size = match base {
            "uint8_t" => 1,
            "uint32_t" => 4,
            "uint64_t" => 8,
            other => panic!("{other}"),
        };
        let bytes = &event.arguments[offset..offset + size];
        let value = bytes.iter().rev().fold(0_u64, |value, byte| value << 8 | u64::from(*byte));
        offset += size;
        values.push(value);
        let name = enumeration.and_then(|enumeration| enumeration["entries"].get(value.to_string()));
        let word =
            name.map_or(value.to_string(), |entry| entry["description"].as_str().expect("words").to_owned());
        message = message.replace(&format!("{{{number}}}"), &word);
    }
    assert!(event.arguments[offset..].iter().all(|byte| *byte == 0));
    let kind = entry.get("type").and_then(Json::as_str).unwrap_or_default().to_owned();
    Told { group: group.clone(), kind, message, values, sequence: event.sequence }
}

fn heard(bench: &Bench, metadata: &Json) -> Vec<Told> {
    let event = |message: &Message| match message {
        Message::Typed(MavMessage::EVENT(event)) => Some(parse(metadata, event)),
        _ => None,
    };
    bench.heard.iter().filter_map(event).collect()
}

fn messages(told: &[Told]) -> Vec<&str> {
    told.iter().map(|event| event.message.as_str()).collect()
}

/// The order that clients expect: a summary of arming, what speaks against it, a summary of health. Every mode is a group.
#[test]
fn what_speaks_against_arming_is_reported_with_its_component_and_modes() {
    let metadata = metadata(Identity::Px4);
    let component = &metadata["components"]["1"];
    assert_eq!(component["supported_protocols"], serde_json::json!(["health_and_arming_check"]));
    assert_eq!(component["enums"]["health_component_t"]["entries"]["1"]["name"], "none");
    let groups = component["navigation_mode_groups"]["groups"].as_object().expect("groups");
    let all = (1_u64 << groups.len()) - 1;
    let hold = groups.iter().find(|(_, modes)| modes[0] == 0x0304_0000).expect("PX4's hold mode").0;
    let mut bench = Bench::new(Identity::Px4);
    bench.fly(1.0);
    let told = heard(&bench, &metadata);
    assert_eq!(messages(&told), ["Arming check summary", "Health summary"]);
    let [summary, health] = told.as_slice() else { panic!("{told:?}") };
    assert_eq!((summary.group.as_str(), summary.kind.as_str()), ("arming_check", "summary"));
    assert_eq!((health.group.as_str(), health.kind.as_str()), ("health", "summary"));
    // Chunk, errors, warnings, modes that can be armed in, and run.
    assert_eq!(summary.values, [0, 0, 0, all, all]);
    assert_eq!(summary.values[3] >> hold.parse::<u32>().expect("an index") & 1, 1);
    assert_eq!(health.values[2], 0);
    // Without GPS it cannot be armed in any mode; nothing is told twice.
    bench.heard.clear();
    common::failsafe_bench::inject(&mut bench, FailureUnit::FAILURE_UNIT_SENSOR_GPS);
    bench.fly(2.0);
    let told = heard(&bench, &metadata);
    let [summary, check, health] = told.as_slice() else { panic!("{told:?}") };
    assert_eq!(
        (check.message.as_str(), check.group.as_str(), check.kind.as_str()),
        ("No GPS fix", "arming_check", "")
    );
    assert_eq!(summary.values[3], 0);
    assert_eq!(check.values[0], all);
    // The index of the component is its bit in both summaries.
    let bit = 1 << check.values[1];
    assert_eq!((summary.values[1], health.values[2]), (bit, bit));
    let name = &component["enums"]["health_component_t"]["entries"][bit.to_string()]["name"];
    assert_eq!(name, "gps");
    // A mission mode without a mission is an obstacle of that mode alone.
    let mut bench = Bench::new(Identity::Px4);
    common::failsafe_bench::inject(&mut bench, FailureUnit::FAILURE_UNIT_SYSTEM_MOTOR);
    bench.heard.clear();
    bench.fly(1.0);
    assert_eq!(messages(&heard(&bench, &metadata))[1], "Rotor failed");
}

#[test]
fn arming_and_failsafes_are_events() {
    let metadata = metadata(Identity::Px4);
    let mut bench = Bench::hovering(Identity::Px4);
    set(&mut bench, "NAV_DLL_ACT", 2.0);
    bench.heard.clear();
    lose_ground_station(&mut bench);
    bench.fly(0.1);
    assert_eq!(messages(&heard(&bench, &metadata)), ["Ground station lost: returning"]);
    bench.heard.clear();
    bench.autopilot.hear_ground_station(true);
    bench.fly(2.0);
    assert_eq!(messages(&heard(&bench, &metadata)), ["Failsafe cleared: Ground station lost"]);
    let mut bench = Bench::new(Identity::Px4);
    bench.fly(1.0);
    bench.heard.clear();
    let parameters = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, parameters), 0);
    bench.fly(0.1);
    assert_eq!(messages(&heard(&bench, &metadata)), ["Armed"]);
}

/// Who has missed an event asks for it; what is forgotten is named with the oldest that is not.
#[test]
fn missed_events_are_sent_again() {
    let metadata = metadata(Identity::Px4);
    let mut bench = Bench::new(Identity::Px4);
    let request = |first_sequence, last_sequence| {
        MavMessage::REQUEST_EVENT(REQUEST_EVENT_DATA {
            first_sequence,
            last_sequence,
            target_system: 1,
            target_component: 1,
        })
    };
    bench.fly(7.0);
    let sequences: Vec<_> = bench
        .heard
        .iter()
        .filter_map(|message| match message {
            Message::Typed(MavMessage::CURRENT_EVENT_SEQUENCE(now)) => Some(now.sequence),
            _ => None,
        })
        .collect();
    assert!((2..=3).contains(&sequences.len()), "every three seconds: {sequences:?}");
    let known = heard(&bench, &metadata);
    assert_eq!(sequences.last().copied(), known.last().map(|event| event.sequence));
    bench.heard.clear();
    bench.send(request(1, 2));
    let again = heard(&bench, &metadata);
    assert_eq!(messages(&again), messages(&known));
    bench.heard.clear();
    bench.send(request(60_000, 9));
    let errors: Vec<_> = bench
        .heard
        .iter()
        .filter_map(|message| match message {
            Message::Typed(MavMessage::RESPONSE_EVENT_ERROR(error)) => Some(error.clone()),
            _ => None,
        })
        .collect();
    assert_eq!((errors[0].sequence, errors[0].sequence_oldest_available), (60_000, 1));
    assert!(errors.len() < 70, "one for all that is older than the memory: {}", errors.len());
    // ArduPilot has no such interface.
    let mut bench = Bench::new(Identity::ArduPilot);
    bench.send(request(1, 2));
    bench.fly(4.0);
    let events = bench.heard.iter().filter(|message| {
        matches!(
            message,
            Message::Typed(
                MavMessage::EVENT(_)
                    | MavMessage::CURRENT_EVENT_SEQUENCE(_)
                    | MavMessage::RESPONSE_EVENT_ERROR(_)
            )
        )
    });
    assert_eq!(events.count(), 0);
    let _metadata = self::metadata(Identity::ArduPilot);
}
