//! Parameters at the start: those of the parameter file, then those of the command line.

use std::path::Path;

use vehicle::VehicleSettings;
use vehicle::parameters::{ParameterTable, ParameterValues, Speed, identifier, parse};

use super::text_file::read_text;
use crate::failure::Failure;

/// Sets the parameters of the file, then those that are named as `NAME=VALUE`, and returns the identifiers of all of them.
///
/// # Errors
/// [`Failure`] of a file that cannot be used, or of the first value with which the vehicle cannot fly.
pub(super) fn set_parameters(
    settings: &mut VehicleSettings,
    file: Option<&Path>,
    named: &[String],
) -> Result<Vec<String>, Failure> {
    let text = match file {
        Some(path) if path.exists() => Some((path, read_text(path)?)),
        // It will be written when a parameter changes: better now than in flight is said that it cannot be.
        Some(path)
            if path.parent().is_some_and(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) =>
        {
            return Err(Failure::write(path, std::io::ErrorKind::NotFound.into()));
        }
        _ => None,
    };
    let mut set = Vec::new();
    if text.is_none() && named.is_empty() {
        return Ok(set);
    }
    let table = ParameterTable::new(settings.identity);
    // Pace and system id are no matter of a file.
    let mut values = ParameterValues {
        configuration: settings.flown_configuration(),
        conduct: settings.conduct,
        system_id: 1,
        speed: Speed::Factor(1.0),
    };
    values.check()?;
    if let Some((path, text)) = &text {
        let in_file = parse(text, &table, &mut values)
            .map_err(|source| Failure::Parameters { path: (*path).to_owned(), source })?;
        set.extend(in_file.into_iter().map(str::to_owned));
    }
    for setting in named {
        let wrong = || Failure::Value {
            name: "--set".to_owned(),
            reason: format!("`{setting}` must be NAME=VALUE with a number as VALUE"),
        };
        let (name, value) = setting.split_once('=').ok_or_else(wrong)?;
        let value: f64 = value.trim().parse().map_err(|_| wrong())?;
        let name = name.trim();
        let id = if name.contains('.') { identifier(name) } else { name.to_owned() };
        table.set_checked(&id, value, &mut values)?;
        set.push(id);
    }
    settings.conduct = values.conduct;
    settings.configuration = values.configuration;
    Ok(set)
}
