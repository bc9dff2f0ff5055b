//! What a misspelt name may mean.

use quadrotor::nearest_name;

use super::Entry;
use super::entry::Source;

/// The name that may be meant, dotted for a dotted one. Former names suggest the present one, and the name that a parameter has for
/// another autopilot the one that it has here.
pub(super) fn suggestion(name: &str, entries: &[Entry]) -> Option<&'static str> {
    let upper = name.to_ascii_uppercase();
    let elsewhere = entries.iter().find(|entry| match entry.source {
        Source::Conduct(parameter, _) => {
            parameter.id == upper || parameter.ardupilot.is_some_and(|(id, _)| id == upper)
        }
        _ => false,
    });
    if let Some(entry) = elsewhere {
        return Some(entry.id);
    }
    if name.contains('.') {
        return nearest_name(name, entries.iter().filter_map(Entry::dotted));
    }
    let names = entries.iter().flat_map(|entry| [Some(entry.id), entry.former]);
    let known = nearest_name(&upper, names.flatten())?;
    entries.iter().find(|entry| entry.id == known || entry.former == Some(known)).map(|entry| entry.id)
}
