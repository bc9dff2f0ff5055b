//! `--mission FILE`.

use std::path::Path;

use autopilot::codec::command_name;
use vehicle::plan::{Plans, Site, file};

use super::text_file::read_text;
use crate::failure::Failure;

/// Reads the plans of a file for a vehicle at a site.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] that names the line or the item, the value and its range.
pub fn read_plans(path: &Path, site: &Site) -> Result<Plans, Failure> {
    let text = read_text(path)?;
    file::parse(&text, site)
        .map_err(|fault| Failure::Content { path: path.to_owned(), reason: fault.described(command_name) })
}
