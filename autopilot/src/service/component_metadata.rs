//! Component metadata: what a ground station needs to show parameters that it does not know.

use mavlink::MessageData;
use mavlink::dialects::common::{COMPONENT_METADATA_DATA, MavMessage};
use quadrotor::ValueRange;
use serde_json::{Map, Value as Json, json};
use vehicle::parameters::{NamedValue, Value};

use super::Service;
use crate::codec::boot_ms;
use crate::codec::checksum::checksum;
use crate::parameters::Parameters;
use crate::stream::{Build, Component, Stream};

/// COMP_METADATA_TYPE_PARAMETER.
const TYPE_PARAMETER: u8 = 1;
const GENERAL_URI: &str = "mftp:///metadata/general.json";
const PARAMETERS_URI: &str = "mftp:///metadata/parameters.json";

const STREAMS: &[Stream] = &[Stream::on_request(COMPONENT_METADATA_DATA::ID, Build::Component(message))];

/// Tells where the general file is. File transfer serves it.
#[derive(Clone, Copy, Debug)]
pub struct ComponentMetadata;

impl Service for ComponentMetadata {
    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }
}

/// COMPONENT_METADATA: where the general file is, and its checksum.
fn message(component: &Component<'_>) -> MavMessage {
    MavMessage::COMPONENT_METADATA(COMPONENT_METADATA_DATA {
        time_boot_ms: boot_ms(component.vehicle.time_us()),
        file_crc: checksum(&general(component.parameters)),
        uri: GENERAL_URI.into(),
    })
}

/// The general file: which others there are.
pub fn general(values: &Parameters) -> Vec<u8> {
    let types = json!([{
        "type": TYPE_PARAMETER,
        "uri": PARAMETERS_URI,
        "fileCrc": checksum(&parameters(values)),
    }]);
    json!({ "version": 1, "metadataTypes": types }).to_string().into_bytes()
}

/// The file about parameters. It stays the same however they are set: clients keep it by its checksum.
pub fn parameters(values: &Parameters) -> Vec<u8> {
    let entries = values.table().entries().iter().zip(values.initial());
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
                put("units", json!(unit));
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
            Json::Object(parameter)
        })
        .collect();
    json!({ "version": 1, "parameters": parameters }).to_string().into_bytes()
}

/// Enough to show a value with three digits.
fn decimal_places(value: f64) -> u32 {
    if value == 0.0 { 3 } else { (2.0 - libm::floor(libm::log10(value.abs()))).clamp(0.0, 9.0) as u32 }
}
