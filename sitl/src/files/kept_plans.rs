//! The file that a vehicle's plans are kept in, beside that of its parameters.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use vehicle::identity::Identity;
use vehicle::plan::{Plans, Site};

use crate::failure::Failure;

/// What the file holds.
#[derive(Debug, Serialize, Deserialize)]
struct Content {
    /// Whose conventions the items follow.
    identity: Identity,
    plans: Plans,
}

/// The file of the plans beside that of the parameters: `a.params` and `a.params.plans`.
pub fn plans_beside(parameters: &Path) -> PathBuf {
    let mut name: OsString = parameters.as_os_str().to_owned();
    name.push(".plans");
    name.into()
}

/// The text of the file.
pub fn render_plans(identity: Identity, plans: &Plans) -> String {
    let content = Content { identity, plans: plans.clone() };
    // It has no map whose keys are no texts, which is all that JSON could refuse.
    serde_json::to_string_pretty(&content).unwrap_or_default()
}

/// Reads the plans that a vehicle at a site has kept beside its parameters; none if there is no file, or if they were made for another
/// autopilot.
///
/// # Errors
/// [`Failure`] of a file that cannot be read, or whose plans cannot be taken.
pub fn kept_plans(parameters: &Path, site: &Site) -> Result<Option<Plans>, Failure> {
    let path = plans_beside(parameters);
    if !path.exists() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(&path).map_err(|source| Failure::read(&path, source))?;
    let remedy = |reason: String| Failure::Content {
        path: path.clone(),
        reason: format!("{reason}; remove the file to begin without plans"),
    };
    let content: Content = serde_json::from_str(&text).map_err(|error| remedy(error.to_string()))?;
    if content.identity != site.identity {
        return Ok(None);
    }
    content.plans.check(site).map_err(|fault| remedy(fault.located(site.identity)))?;
    Ok(Some(content.plans))
}
