//! The ready file: it exists when clients can connect.

use std::io::ErrorKind;
use std::path::Path;

use crate::failure::Failure;
use crate::files::{Readers, replace};
use crate::fleet::Fleet;
use crate::link::Links;

/// Removes the file of an earlier run, so that nobody takes it for this one's.
///
/// # Errors
/// [`Failure::File`]
pub fn forget(path: &Path) -> Result<(), Failure> {
    match std::fs::remove_file(path) {
        Err(source) if source.kind() != ErrorKind::NotFound => Err(Failure::write(path, source)),
        _ => Ok(()),
    }
}

/// Writes the file in one step: a reader never sees half of it.
///
/// # Errors
/// [`Failure::File`]
pub fn write(path: &Path, fleet: &Fleet, view: Option<&str>) -> Result<(), Failure> {
    let of_all = |list: fn(&Links) -> Vec<String>| fleet.hubs().iter().flat_map(list).collect::<Vec<_>>();
    let vehicles = fleet.members().iter().map(|member| {
        let list = |list: fn(&Links) -> Vec<String>| fleet.hubs().get(member.hub()).map(list);
        serde_json::json!({
            "system_id": member.autopilot().system_id(),
            "radio": member.radio_address().map(|address| address.to_string()),
            "addresses": list(Links::addresses),
            "links": list(Links::descriptions),
        })
    });
    let content = serde_json::json!({
        "process_id": std::process::id(),
        "addresses": of_all(Links::addresses),
        "links": of_all(Links::descriptions),
        "vehicles": vehicles.collect::<Vec<_>>(),
        "view": view,
    });
    // Whoever reads the address of the page with its token may fly.
    write_content(path, &content, if view.is_some() { Readers::Owner } else { Readers::All })
}

/// The same for the simulator of an external autopilot.
///
/// # Errors
/// [`Failure::File`]
pub fn write_address(path: &Path, address: &str) -> Result<(), Failure> {
    let content = serde_json::json!({
        "process_id": std::process::id(),
        "addresses": [address],
        "links": [format!("simulator of an external autopilot on TCP {address}")],
        "vehicles": [],
    });
    write_content(path, &content, Readers::All)
}

/// The same for the page of a recorded flight.
///
/// # Errors
/// [`Failure::File`]
pub fn write_view(path: &Path, view: &str) -> Result<(), Failure> {
    let content = serde_json::json!({ "process_id": std::process::id(), "view": view });
    write_content(path, &content, Readers::Owner)
}

fn write_content(path: &Path, content: &serde_json::Value, readers: Readers) -> Result<(), Failure> {
    replace(path, format!("{content}\n").as_bytes(), readers).map_err(|source| Failure::write(path, source))
}
