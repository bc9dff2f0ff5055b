//! What a misspelled name was meant to be.

/// The known name that is most like a given one, if one is: at most a third of its letters, and at least one, may be
/// wrong, missing, additional or exchanged.
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let most = (given.chars().count() / 3).max(1);
    let distances = known.into_iter().map(|name| (strsim::osa_distance(given, name), name));
    distances
        .filter(|(distance, _)| *distance <= most)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_slip_is_recognized_and_something_else_is_not() {
        let known = ["speed", "seed", "set"];
        for (given, meant) in [
            ("speeed", Some("speed")),
            ("sede", Some("seed")),
            ("st", Some("set")),
            ("carrier", None),
            ("", None),
        ] {
            assert_eq!(nearest(given, known), meant, "{given}");
        }
    }
}
