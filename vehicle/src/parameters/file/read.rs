//! Reading parameter files.

use super::ParameterFileError;
use super::line::{self, Line};
use crate::parameters::{ParameterTable, ParameterValues};

/// A parameter that is still to be set.
struct Waiting {
    line: usize,
    id: &'static str,
    value: f64,
}

/// Sets every parameter of a file's text and returns their MAVLink names. Lines are `NAME VALUE`, `NAME,VALUE`, `NAME = VALUE` or
/// QGroundControl's five columns, with any name of a parameter and any name of a value. What belongs to a single run (system id,
/// pace) is left out. The parameters are judged as a whole, so that values which only fit together may come in any order.
///
/// # Errors
/// [`ParameterFileError`] of the first line that cannot be set; those before and behind it may be set then.
pub fn parse(
    text: &str,
    table: &ParameterTable,
    values: &mut ParameterValues,
) -> Result<Vec<&'static str>, ParameterFileError> {
    let mut waiting = Vec::new();
    // Editors on Windows begin a file with a byte order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (line, whole) in (1..).zip(text.lines()) {
        let (name, value) = match line::read(whole) {
            Line::Nothing => continue,
            Line::Setting { name, value } => (name, value),
            Line::Malformed => {
                return Err(ParameterFileError::Malformed { line, text: whole.trim().to_owned() });
            }
        };
        let refused = |source| ParameterFileError::Refused { line, source };
        let entry = table.require(name).map_err(refused)?;
        if entry.is_of_vehicle() {
            let value = table.number(name, value).map_err(refused)?;
            waiting.push(Waiting { line, id: entry.id, value });
        }
    }
    let settings: Vec<_> = waiting.iter().map(|setting| (setting.id, setting.value)).collect();
    table.set_together(&settings, values).map_err(|(place, source)| ParameterFileError::Refused {
        line: waiting.get(place).map_or(0, |setting| setting.line),
        source,
    })?;
    Ok(waiting.iter().map(|setting| setting.id).collect())
}
