//! `--list-parameters`: all parameters with the values that they have at the start.

use std::fmt::Write;

use clap::ValueEnum;
use quadrotor::ValueRange;
use serde_json::{Value as Json, json};
use vehicle::parameters::{Entry, ParameterTable, ParameterValues, Statistics, Value};

use super::{MemberSettings, Settings};

/// The forms of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, ValueEnum)]
pub enum ListFormat {
    /// One line per parameter, for people and grep
    #[default]
    Table,
    /// One object per parameter, for programs
    Json,
}

const HEAD: [&str; 6] = ["NAME", "DOTTED NAME", "VALUE", "UNIT", "RANGE", "DESCRIPTION"];

/// The parameters of every vehicle.
pub fn parameter_list(settings: &Settings, format: ListFormat) -> String {
    match format {
        ListFormat::Table => {
            let several = settings.vehicles.len() > 1;
            let mut text = String::new();
            for (number, own) in settings.vehicles.iter().enumerate() {
                if number > 0 {
                    text.push('\n');
                }
                if several {
                    text.push_str(&format!("System {}\n", own.system_id));
                }
                table(&mut text, &rows(settings, own));
            }
            text
        }
        ListFormat::Json => {
            let objects = settings.vehicles.iter().flat_map(|own| {
                rows(settings, own).into_iter().map(|(entry, value)| object(own.system_id, &entry, value))
            });
            format!("{:#}", Json::Array(objects.collect()))
        }
    }
}

/// The parameters of a vehicle with their values.
fn rows(settings: &Settings, own: &MemberSettings) -> Vec<(Entry, Value)> {
    let values = ParameterValues {
        configuration: own.vehicle.flown_configuration(),
        conduct: own.vehicle.conduct_at_start(),
        system_id: own.system_id,
        speed: settings.speed,
        statistics: Statistics { boots: 1, ..Statistics::default() },
    };
    let table = ParameterTable::new(own.vehicle.identity);
    let value = |index| table.value(index, &values);
    let rows = table.entries().iter().enumerate();
    rows.filter_map(|(index, entry)| Some((*entry, value(index)?))).collect()
}

/// Lines in columns. The last one is not filled up.
fn table(text: &mut String, rows: &[(Entry, Value)]) {
    let mut lines = vec![HEAD.map(str::to_owned)];
    lines.extend(rows.iter().map(|(entry, value)| {
        let description = entry.describe();
        let dotted = entry.dotted().unwrap_or("-").to_owned();
        let range = description.range;
        // A range with a unit has that in a column of its own.
        let (unit, allowed) = match range.unit {
            "" => ("-", entry.allowed()),
            unit => (unit, ValueRange { unit: "", ..range }.to_string()),
        };
        [entry.id.to_owned(), dotted, value.to_string(), unit.to_owned(), allowed, description.text]
    }));
    let mut widths = [0; HEAD.len()];
    for line in &lines {
        for (width, cell) in widths.iter_mut().zip(line) {
            *width = (*width).max(cell.chars().count());
        }
    }
    for line in lines {
        let mut row = String::new();
        for (width, cell) in widths.iter().zip(&line) {
            // Writing to a string succeeds.
            let _written = write!(row, "{cell:width$}  ");
        }
        text.push_str(row.trim_end());
        text.push('\n');
    }
}

fn object(system_id: u8, entry: &Entry, value: Value) -> Json {
    let description = entry.describe();
    let range = description.range;
    let names = description.names.iter().map(|named| json!({ "value": named.value, "name": named.name }));
    json!({
        "system_id": system_id,
        "name": entry.id,
        "dotted_name": entry.dotted(),
        "value": match value {
            // The shortest number that reads back as the same float.
            Value::Real(_) => value.to_string().parse().map_or(Json::Null, |number: f64| json!(number)),
            Value::Integer(number) => json!(number),
        },
        "type": match value {
            Value::Real(_) => "float",
            Value::Integer(_) => "int32",
        },
        "unit": range.unit,
        "min": range.minimum,
        "max": range.maximum,
        "values": names.collect::<Vec<_>>(),
        "needs_restart": description.needs_restart,
        "read_only": description.read_only,
        "group": description.group,
        "description": description.text,
    })
}
