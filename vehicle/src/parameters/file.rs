//! The parameter file: one `NAME VALUE` per line, `#` begins a comment.

use super::{ParameterTable, ParameterValues, SetError, Value};

/// What is wrong with a parameter file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterFileError {
    /// A line is not `NAME VALUE`.
    #[error("line {line}: `{text}` is not a name and a number")]
    Malformed {
        /// Number of the line, from one.
        line: usize,
        /// The line.
        text: String,
    },
    /// A value is refused.
    #[error("line {line}: {source}")]
    Refused {
        /// Number of the line, from one.
        line: usize,
        /// Why.
        source: SetError,
    },
}

/// Sets every parameter of a file's text and returns their identifiers. They are set in turn until none is refused any
/// more, so that values which only fit together may come in any order.
///
/// # Errors
/// [`ParameterFileError`] of the first line that cannot be set; those before and behind it may be set then.
pub fn parse<'a>(
    text: &'a str,
    table: &ParameterTable,
    values: &mut ParameterValues,
) -> Result<Vec<&'a str>, ParameterFileError> {
    let mut waiting = Vec::new();
    for (index, whole) in text.lines().enumerate() {
        let used = whole.split('#').next().unwrap_or_default().trim();
        if used.is_empty() {
            continue;
        }
        let line = index + 1;
        let malformed = || ParameterFileError::Malformed { line, text: whole.to_owned() };
        let mut words = used.split([' ', '\t', ',', '=']).filter(|word| !word.is_empty());
        let (Some(id), Some(value), None) = (words.next(), words.next(), words.next()) else {
            return Err(malformed());
        };
        let value: f64 = value.parse().map_err(|_| malformed())?;
        waiting.push((line, id, value));
    }
    let named = waiting.iter().map(|(_, id, _)| *id).collect();
    loop {
        let before = waiting.len();
        let mut first = None;
        waiting.retain(|(line, id, value)| match table.set_checked(id, *value, values) {
            Ok(_) => false,
            Err(source) => {
                first.get_or_insert(ParameterFileError::Refused { line: *line, source });
                true
            }
        });
        match first {
            None => return Ok(named),
            Some(error) if waiting.len() == before => return Err(error),
            Some(_) => {}
        }
    }
}

/// The text of a file that holds every parameter.
pub fn render(table: &ParameterTable, values: &ParameterValues) -> String {
    let mut text = String::from("# Parameters of lmpc-sitl: name and value\n");
    for (index, entry) in table.entries().iter().enumerate().filter(|(_, entry)| entry.is_kept()) {
        if let Some(value) = table.value(index, values) {
            // The shortest text that reads back as the same float.
            let value = match value {
                Value::Real(value) => value.to_string(),
                Value::Integer(value) => value.to_string(),
            };
            text.push_str(&format!("{} {value}\n", entry.id));
        }
    }
    text
}
