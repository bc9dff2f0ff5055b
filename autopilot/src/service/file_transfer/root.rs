//! The root that clients see: what is made when it is read, and the folders of the store.
//!
//! ```text
//! /@MISSION/mission.dat         the mission, packed, to be read and written; fence and rally points beside it
//! /@PARAM/param.pck             parameters, packed, to be read and written
//! /camera.xml                   the camera definition: which settings the camera has
//! /metadata/general.json        what there is to know of this component
//! /metadata/parameters.json     names, ranges, units of the parameters
//! /metadata/events.json         events, and the modes and components that they are about
//! /plans/mission.waypoints      the mission as a text, and fence and rally points beside it
//! /logs/                        flights, to be read; /APM/LOGS/ and /log/ are the same
//! /files/                       what the user shares
//! /fs/microsd/                  the root itself
//! ```

use vehicle::plan::PlanKind;

use super::message::Nak;
use super::parameter_pack::{self, Extent};
use super::plan_pack;
use super::plan_text;
use crate::context::Context;
use crate::file_store::{FileStore, LOGS, Listed};
use crate::service::equipment::camera_definition;

/// Folders of files that are made, and their files.
const MADE: [(&str, &[&str]); 4] = [
    (plan_pack::FOLDER, plan_pack::NAMES),
    ("@PARAM", &["param.pck"]),
    ("metadata", &["general.json", "parameters.json", "events.json"]),
    ("plans", &["mission.waypoints", "fence.waypoints", "rally.waypoints"]),
];

/// Where ArduPilot's clients look for logs: the same as the folder of the store.
const ARDUPILOT_LOGS: &str = "APM/LOGS";
const ARDUPILOT: &str = "APM";
/// Where PX4's clients look for its card, which is the root here, and for logs on it.
const PX4_CARD: &str = "fs/microsd";
const PX4_CARDS: &str = "fs";
const PX4_LOGS: &str = "log";

/// The path in its plain form. Nothing leads up: a path with `..` is no path.
pub fn plain(path: &str) -> Result<String, Nak> {
    let names: Vec<&str> = path.split('/').filter(|name| !matches!(*name, "" | ".")).collect();
    if names.iter().any(|name| *name == ".." || name.contains('\\') || name.contains('\0')) {
        return Err(Nak::FileNotFound);
    }
    let path = names.join("/");
    let path = below(&path, PX4_CARD).map_or(path.as_str(), |rest| rest.trim_start_matches('/'));
    let logs = below(path, ARDUPILOT_LOGS).or_else(|| below(path, PX4_LOGS));
    Ok(logs.map_or_else(|| path.to_owned(), |rest| format!("{LOGS}{rest}")))
}

/// What follows a folder in a path that is that of it or leads into it.
fn below<'a>(path: &'a str, folder: &str) -> Option<&'a str> {
    path.strip_prefix(folder).filter(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// Whether a path is one of the made files or folders, or the root.
fn is_made(path: &str) -> bool {
    let first = path.split('/').next().unwrap_or_default();
    path.is_empty() || first == camera_definition::NAME || MADE.iter().any(|(folder, _)| *folder == first)
}

/// A plain path that may be written.
pub fn writable(path: &str) -> Result<String, Nak> {
    let path = plain(path)?;
    if is_made(&path) { Err(Nak::FileProtected) } else { Ok(path) }
}

/// The bytes of a file that is made when it is read, if the path is that of one.
pub fn made_file(context: &Context, path: &str) -> Option<Vec<u8>> {
    let name = plain(path).ok()?;
    if let Some(rest) = name.strip_prefix(parameter_pack::PATH) {
        let extent = match rest.strip_prefix('?') {
            Some(options) => Extent::read(options),
            None if rest.is_empty() => Extent::ALL,
            None => return None,
        };
        return Some(parameter_pack::pack(context, extent));
    }
    let name = name.as_str();
    if let Some(kind) = plan_pack::kind_of(name) {
        return Some(plan_pack::pack(context, kind));
    }
    Some(match name {
        camera_definition::NAME => camera_definition::render(),
        "metadata/general.json" => context.parameters.metadata().general.clone(),
        "metadata/parameters.json" => context.parameters.metadata().parameters.clone(),
        "metadata/events.json" => context.parameters.metadata().events.clone(),
        "plans/mission.waypoints" => plan_text::render(&context.vehicle, PlanKind::Mission),
        "plans/fence.waypoints" => plan_text::render(&context.vehicle, PlanKind::Fence),
        "plans/rally.waypoints" => plan_text::render(&context.vehicle, PlanKind::Rally),
        _ => return None,
    })
}

/// The entries of a folder of such files, if the path is that of one.
pub fn made_folder(context: &Context, path: &str) -> Option<Vec<Vec<u8>>> {
    let path = plain(path).ok()?;
    if path == ARDUPILOT {
        return Some(vec![b"DLOGS\0".to_vec()]);
    }
    if path == PX4_CARDS {
        return Some(vec![b"Dmicrosd\0".to_vec()]);
    }
    let (folder, names) = MADE.iter().find(|(folder, _)| *folder == path)?;
    let entry = |name: &&str| {
        let size = made_file(context, &format!("{folder}/{name}")).map_or(0, |bytes| bytes.len());
        format!("F{name}\t{size}\0").into_bytes()
    };
    Some(names.iter().map(entry).collect())
}

/// The entries of a folder of the store; the root has what is made, too.
pub fn list(store: &dyn FileStore, path: &str, room: usize) -> Result<Vec<Vec<u8>>, Nak> {
    let mut made = Vec::new();
    if path.is_empty() {
        made.extend(MADE.iter().map(|(folder, _)| format!("D{folder}\0").into_bytes()));
        let size = camera_definition::render().len();
        made.push(format!("F{}\t{size}\0", camera_definition::NAME).into_bytes());
    }
    Ok(made.into_iter().chain(store.list(path)?.iter().map(|listed| entry(listed, room))).collect())
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
