//! `--fmu-check`: the mapping as it would be used.

use std::fmt::Write;

use super::mapping::{Channel, Mapping};
use super::signals::{ARMED, Group, INPUTS, OUTPUTS};

/// A table of all signals with their variables, then the start values.
pub fn listing(mapping: &Mapping) -> String {
    let mut text = format!("{}: flies as the {}\n", mapping.model_name, mapping.role);
    let mut rows = vec![["signal", "unit", "variable", "its unit", "conversion"].map(str::to_owned)];
    for (title, groups, channels) in
        [("inputs", INPUTS.as_slice(), &mapping.inputs), ("outputs", OUTPUTS.as_slice(), &mapping.outputs)]
    {
        rows.push([format!("[{title}]"), String::new(), String::new(), String::new(), String::new()]);
        for (index, group) in groups.iter().enumerate() {
            for part in 0..group.count() {
                let channel = channels.iter().find(|channel| (channel.group, channel.part) == (index, part));
                let constant = mapping.constants.iter().find(|(constant, constant_part, _)| {
                    title == "outputs" && (*constant, *constant_part) == (index, part)
                });
                rows.push(row(group, part, channel, constant.map(|(_, _, value)| *value)));
            }
        }
        if title == "inputs" {
            let variable = mapping.armed.as_ref().map_or_else(|| "-".to_owned(), |(name, _)| name.clone());
            rows.push([ARMED.to_owned(), "true or false".to_owned(), variable, String::new(), String::new()]);
        }
    }
    write_table(&mut text, &rows);
    for (name, _, value) in &mapping.values {
        let _infallible = writeln!(text, "start  {name} = {value}");
    }
    text
}

fn row(group: &Group, part: usize, channel: Option<&Channel>, constant: Option<f64>) -> [String; 5] {
    let (signal, unit) = (group.signal(part), group.unit.to_owned());
    match (channel, constant) {
        (Some(channel), _) => {
            let conversion = channel.conversion;
            let how = if conversion.is_identity() {
                String::new()
            } else {
                format!("ours = {} * theirs + {}", conversion.scale, conversion.offset)
            };
            let theirs = channel.unit.clone().unwrap_or_else(|| "none: taken as SI".to_owned());
            [signal, unit, channel.variable.0.clone(), theirs, how]
        }
        (None, Some(value)) => [signal, unit, format!("constant {value}"), String::new(), String::new()],
        (None, None) => [signal, unit, "-".to_owned(), String::new(), String::new()],
    }
}

fn write_table(text: &mut String, rows: &[[String; 5]]) {
    let widths: [usize; 5] = std::array::from_fn(|column| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    });
    for row in rows {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        text.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        text.push('\n');
    }
}
