//! What a misspelt name may mean.

use super::Entry;
use super::entry::Source;

/// Least similarity of a name that is suggested: one letter in three may differ.
const SIMILAR: f64 = 0.65;

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
    let known = entries.iter().flat_map(|entry| {
        if name.contains('.') {
            return [entry.dotted().map(|dotted| (dotted, dotted)), None];
        }
        [Some((entry.id, entry.id)), entry.former.map(|former| (former, entry.id))]
    });
    let given = if name.contains('.') { name } else { upper.as_str() };
    let rated =
        known.flatten().map(|(known, meant)| (strsim::normalized_damerau_levenshtein(given, known), meant));
    let similar = rated.filter(|(similarity, _)| *similarity >= SIMILAR);
    similar.max_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, meant)| meant)
}
