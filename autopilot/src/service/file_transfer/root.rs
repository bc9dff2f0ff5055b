//! The root that clients see: what is made when it is read, and the folders of the store.
//!
//! ```text
//! /@MISSION/mission.dat         the mission, packed, to be read and written; fence and rally points beside it
//! /@PARAM/param.pck             parameters, packed
//! /metadata/general.json        what there is to know of this component
//! /metadata/parameters.json     names, ranges, units of the parameters
//! /plans/mission.waypoints      the mission as a text, and fence and rally points beside it
//! /logs/                        flights, to be read
//! /files/                       what the user shares
//! ```

use vehicle::plan::PlanKind;

use super::message::Nak;
use super::parameter_pack;
use super::plan_pack;
use super::plan_text;
use super::sessions::Content;
use crate::context::Context;
use crate::file_store::{Access, Listed};
use crate::service::component_metadata;

/// Folders of files that are made, and their files.
const MADE: [(&str, &[&str]); 4] = [
    (plan_pack::FOLDER, plan_pack::NAMES),
    ("@PARAM", &["param.pck"]),
    ("metadata", &["general.json", "parameters.json"]),
    ("plans", &["mission.waypoints", "fence.waypoints", "rally.waypoints"]),
];

/// The path in its plain form. Nothing leads up: a path with `..` is no path.
pub fn plain(path: &str) -> Result<String, Nak> {
    let names: Vec<&str> = path.split('/').filter(|name| !matches!(*name, "" | ".")).collect();
    if names.iter().any(|name| *name == ".." || name.contains('\\') || name.contains('\0')) {
        return Err(Nak::FileNotFound);
    }
    Ok(names.join("/"))
}

/// Whether a path is one of the made files or folders, or the root.
fn is_made(path: &str) -> bool {
    let first = path.split('/').next().unwrap_or_default();
    path.is_empty() || MADE.iter().any(|(folder, _)| *folder == first)
}

/// A plain path that may be written.
pub fn writable(path: &str) -> Result<String, Nak> {
    let path = plain(path)?;
    if is_made(&path) { Err(Nak::FileProtected) } else { Ok(path) }
}

/// Opens a file.
pub fn open(context: &mut Context, path: &str, access: Access) -> Result<Content, Nak> {
    if access != Access::Read {
        if let Some(kind) = plan_pack::kind_of(&plain(path)?) {
            return Ok(Content::Received(kind, Vec::new()));
        }
        let path = writable(path)?;
        return Ok(Content::Stored(context.files.open(&path, access)?));
    }
    // ArduPilot's clients put options behind a question mark.
    let name = plain(path)?;
    let name = name
        .strip_prefix("@PARAM/param.pck")
        .filter(|rest| rest.starts_with('?'))
        .map_or(name.as_str(), |_| "@PARAM/param.pck");
    if let Some(kind) = plan_pack::kind_of(name) {
        return Ok(Content::Made(plan_pack::pack(context, kind)));
    }
    let made = match name {
        "@PARAM/param.pck" => parameter_pack::pack(context),
        "metadata/general.json" => component_metadata::general(&context.parameters),
        "metadata/parameters.json" => component_metadata::parameters(&context.parameters),
        "plans/mission.waypoints" => plan_text::render(&context.vehicle, PlanKind::Mission),
        "plans/fence.waypoints" => plan_text::render(&context.vehicle, PlanKind::Fence),
        "plans/rally.waypoints" => plan_text::render(&context.vehicle, PlanKind::Rally),
        other => return Ok(Content::Stored(context.files.open(other, Access::Read)?)),
    };
    Ok(Content::Made(made))
}

/// What is in a folder, from an entry on, as far as one message holds.
pub fn list(context: &mut Context, path: &str, from: u32, room: usize) -> Result<Vec<u8>, Nak> {
    let path = plain(path)?;
    let entries: Vec<Vec<u8>> = match MADE.iter().find(|(folder, _)| *folder == path) {
        Some((folder, names)) => {
            let mut entries = Vec::new();
            for name in *names {
                let size = open(context, &format!("{folder}/{name}"), Access::Read)?.size()?;
                entries.push(format!("F{name}\t{size}\0").into_bytes());
            }
            entries
        }
        None => {
            let made = if path.is_empty() { &MADE[..] } else { &[] };
            let made = made.iter().map(|(folder, _)| format!("D{folder}\0").into_bytes());
            made.chain(context.files.list(&path)?.iter().map(|listed| entry(listed, room))).collect()
        }
    };
    let rest = entries.get(from as usize..).unwrap_or_default();
    if rest.is_empty() {
        return Err(Nak::EndOfFile);
    }
    let mut data = Vec::new();
    for entry in rest {
        if data.len() + entry.len() > room {
            break;
        }
        data.extend_from_slice(entry);
    }
    Ok(data)
}

/// One entry. What does not fit, or would be taken for more than one, is skipped but counted.
fn entry(listed: &Listed, room: usize) -> Vec<u8> {
    let text = match listed.size {
        Some(size) => format!("F{}\t{size}\0", listed.name),
        None => format!("D{}\0", listed.name),
    };
    let plain = !listed.name.chars().any(char::is_control);
    if plain && text.len() <= room { text.into_bytes() } else { b"S\0".to_vec() }
}
