//! The file that tells that clients can connect.

use std::path::Path;

use crate::failure::Failure;
use crate::link::Links;

/// Writes it at once: a reader never sees half of it.
///
/// # Errors
/// [`Failure::File`]
pub fn write(path: &Path, links: &Links) -> Result<(), Failure> {
    let content = serde_json::json!({
        "process_id": std::process::id(),
        "addresses": links.addresses(),
        "links": links.descriptions(),
    });
    let beside = path.with_extension("new");
    std::fs::write(&beside, format!("{content}\n"))
        .and_then(|()| std::fs::rename(&beside, path))
        .map_err(|source| Failure::write(path, source))
}
