//! Parameters at the start: those of the parameter file, then those of the command line.

use std::path::Path;

use quadrotor::StabilityWarning;
use vehicle::parameters::{ParameterTable, ParameterValues, SetError, Speed, Statistics, parse};
use vehicle::{Notice, Severity, VehicleSettings};

use super::text_file::read_text;
use crate::failure::Failure;

/// What setting parameters has led to.
#[derive(Debug, Default)]
pub(super) struct ChosenParameters {
    /// Their MAVLink names.
    pub(super) names: Vec<&'static str>,
    /// What to tell the user about the vehicle that has them.
    pub(super) warnings: Vec<Notice>,
}

/// Sets the parameters of the file, then those that are named as `NAME=VALUE`.
///
/// # Errors
/// [`Failure`] of a file that cannot be used, or of the first value with which the vehicle cannot fly.
pub(super) fn set_parameters(
    settings: &mut VehicleSettings,
    file: Option<&Path>,
    named: &[String],
) -> Result<ChosenParameters, Failure> {
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
    let mut chosen = ChosenParameters::default();
    if text.is_none() && named.is_empty() {
        return Ok(chosen);
    }
    let table = ParameterTable::new(settings.identity);
    // Pace and system id are no matter of a file.
    let mut values = ParameterValues {
        configuration: settings.flown_configuration(),
        conduct: settings.conduct,
        system_id: 1,
        speed: Speed::Factor(1.0),
        statistics: Statistics::default(),
    };
    values.check()?;
    if let Some((path, text)) = &text {
        chosen.names = parse(text, &table, &mut values)
            .map_err(|source| Failure::Parameters { path: (*path).to_owned(), source })?;
    }
    let mut settings_by_name = Vec::new();
    for setting in named {
        let (name, value) =
            setting.split_once('=').ok_or_else(|| wrong(format!("expected NAME=VALUE, got `{setting}`")))?;
        let name = name.trim();
        let entry = table.require(name).map_err(unknown)?;
        if let Some(flag) = entry.flag() {
            return Err(wrong(format!("{name} has a flag of its own: {flag}")));
        }
        settings_by_name.push((name, table.number(name, value)?));
        chosen.names.push(entry.id);
    }
    table.set_together(&settings_by_name, &mut values).map_err(|(_, error)| error)?;
    let warning =
        |warning: &StabilityWarning| Notice { severity: Severity::Warning, text: warning.to_string() };
    chosen.warnings = values.check()?.stability().warnings().iter().map(warning).collect();
    settings.conduct = values.conduct;
    settings.configuration = values.configuration;
    Ok(chosen)
}

fn wrong(reason: String) -> Failure {
    Failure::Value { name: "--set".to_owned(), reason }
}

/// Where nothing similar is known, the list helps.
fn unknown(error: SetError) -> Failure {
    match error {
        SetError::Unknown { similar: None, .. } => {
            wrong(format!("{error}; --list-parameters shows them all"))
        }
        other => Failure::Set(other),
    }
}
