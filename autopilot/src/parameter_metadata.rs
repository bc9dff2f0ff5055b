//! Files that describe the parameters and events to ground stations, as component metadata.

use quadrotor::ValueRange;
use serde_json::{Map, Value as Json, json};
use vehicle::identity::Identity;
use vehicle::parameters::{NamedValue, ParameterTable, Value};

use crate::codec::ascii::ascii;
use crate::codec::checksum::checksum;
use crate::event_catalog;

/// COMP_METADATA_TYPE_PARAMETER.
const TYPE_PARAMETER: u8 = 1;
/// COMP_METADATA_TYPE_EVENTS.
const TYPE_EVENTS: u8 = 4;
const EVENTS_URI: &str = "mftp:///metadata/events.json";
const PARAMETERS_URI: &str = "mftp:///metadata/parameters.json";

/// The files. They stay the same however parameters are set: clients keep them by their checksums.
#[derive(Clone, Debug)]
pub struct ParameterMetadata {
    /// Tells which other files there are.
    pub general: Vec<u8>,
    /// Its checksum.
    pub general_checksum: u32,
    /// Describes the parameters.
    pub parameters: Vec<u8>,
    /// Describes the events.
    pub events: Vec<u8>,
}

impl ParameterMetadata {
    /// The files about parameters with these values at the start.
    pub fn new(identity: Identity, table: &ParameterTable, initial: &[Value]) -> Self {
        let parameters = describe(table, initial);
        let events = event_catalog::render(identity);
        let file = |kind: u8, uri: &str, bytes: &[u8]| json!({ "type": kind, "uri": uri, "fileCrc": checksum(bytes) });
        let mut types = vec![file(TYPE_PARAMETER, PARAMETERS_URI, &parameters)];
        // ArduPilot has none.
        if !identity.is_ardupilot() {
            types.push(file(TYPE_EVENTS, EVENTS_URI, &events));
        }
        let general = json!({ "version": 1, "metadataTypes": types }).to_string().into_bytes();
        Self { general_checksum: checksum(&general), general, parameters, events }
    }
}

/// The file about parameters.
fn describe(table: &ParameterTable, initial: &[Value]) -> Vec<u8> {
    let entries = table.entries().iter().zip(initial);
    let parameters: Vec<Json> = entries
        .map(|(entry, initial)| {
            let description = entry.describe();
            let ValueRange { minimum, maximum, unit } = description.range;
            let mut parameter = Map::new();
            let mut put = |key: &str, value: Json| parameter.insert(key.to_owned(), value);
            put("name", json!(entry.id));
            put("shortDesc", json!(description.text));
            put("group", json!(description.group));
            match initial {
                Value::Real(value) => {
                    put("type", json!("Float"));
                    // The shortest text that reads back as the same float.
                    put("default", json!(value.to_string().parse::<f64>().unwrap_or_default()));
                    put("min", json!(minimum));
                    put("max", json!(maximum));
                    put("decimalPlaces", json!(decimal_places(f64::from(*value))));
                }
                Value::Integer(value) => {
                    put("type", json!("Int32"));
                    put("default", json!(value));
                    put("min", json!(minimum as i64));
                    put("max", json!(maximum as i64));
                }
            }
            if !unit.is_empty() {
                put("units", json!(ascii(unit)));
            }
            if let Some(dotted) = entry.dotted() {
                put("longDesc", json!(format!("Dotted name: {dotted}.")));
            }
            if description.read_only {
                put("readOnly", json!(true));
            }
            if description.needs_restart {
                put("rebootRequired", json!(true));
            }
            if !description.names.is_empty() {
                let name =
                    |named: &NamedValue| json!({ "value": named.value, "description": named.to_string() });
                put("values", description.names.iter().map(name).collect());
            }
            if !description.bits.is_empty() {
                let bit = |(index, text): (u32, &&str)| json!({ "index": index, "description": text });
                put("bitmask", (0..).zip(description.bits).map(bit).collect());
            }
            Json::Object(parameter)
        })
        .collect();
    json!({ "version": 1, "parameters": parameters }).to_string().into_bytes()
}

/// Enough to show a value with three digits.
fn decimal_places(value: f64) -> u32 {
    if value == 0.0 { 3 } else { (2.0 - libm::floor(libm::log10(value.abs()))).clamp(0.0, 9.0) as u32 }
}
