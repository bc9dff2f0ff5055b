//! What a misspelled name was meant to be.

use alloc::vec;
use alloc::vec::Vec;

/// The known name that is most like a given one, if one is. Names are compared without the parts, between full stops, that both begin
/// or end with. Of the given one's remaining letters at most a third, and at least one, may be wrong, missing, additional or exchanged.
///
/// ```
/// let known = ["airframe.mass", "airframe.drag.y"];
/// assert_eq!(quadrotor::nearest_name("airframe.masss", known), Some("airframe.mass"));
/// assert_eq!(quadrotor::nearest_name("airframe.layout", known), None);
/// ```
pub fn nearest_name<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let rated = known.into_iter().filter_map(|name| {
        let (given, name_left) = without_common_parts(given, name);
        let distance = distance(given, name_left);
        (distance <= (given.chars().count() / 3).max(1)).then_some((distance, name))
    });
    rated.min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}

/// Two names without the parts that both begin with and those that both end with.
fn without_common_parts<'a, 'b>(mut one: &'a str, mut other: &'b str) -> (&'a str, &'b str) {
    while let (Some((first, rest)), Some((same, other_rest))) = (one.split_once('.'), other.split_once('.'))
        && first == same
    {
        (one, other) = (rest, other_rest);
    }
    while let (Some((rest, last)), Some((other_rest, same))) = (one.rsplit_once('.'), other.rsplit_once('.'))
        && last == same
    {
        (one, other) = (rest, other_rest);
    }
    (one, other)
}

/// The fewest letters to replace, remove, insert or exchange with a neighbour, each at most once, that make one word of the other
/// ("optimal string alignment").
fn distance(one: &str, other: &str) -> usize {
    let letters: Vec<char> = other.chars().collect();
    let mut before_last = vec![0; letters.len() + 1];
    let mut last: Vec<usize> = (0..=letters.len()).collect();
    let mut previous = None;
    for (row, letter) in one.chars().enumerate() {
        let mut current = vec![row + 1];
        for (column, other) in letters.iter().enumerate() {
            let replaced = last[column] + usize::from(letter != *other);
            let mut fewest = replaced.min(last[column + 1] + 1).min(current[column] + 1);
            let exchanged = column > 0 && previous == Some(*other) && letters[column - 1] == letter;
            if exchanged {
                fewest = fewest.min(before_last[column - 1] + 1);
            }
            current.push(fewest);
        }
        (before_last, last, previous) = (last, current, Some(letter));
    }
    last[letters.len()]
}

#[cfg(test)]
mod tests {
    use super::{distance, nearest_name};

    #[test]
    fn a_slip_is_recognized_and_something_else_is_not() {
        let known = [
            "speed",
            "seed",
            "set",
            "airframe.mass",
            "airframe.drag.y",
            "reference.position.x",
            "limits.tilt",
        ];
        for (given, meant) in [
            ("speeed", Some("speed")),
            ("sede", Some("seed")),
            ("st", Some("set")),
            ("carrier", None),
            ("", None),
            ("airframe.masss", Some("airframe.mass")),
            ("airframe.layout", None),
            ("airframe.layot", None),
            ("airframe.drag.z", Some("airframe.drag.y")),
            ("airfame.drag.y", Some("airframe.drag.y")),
            ("reference.positon.x", Some("reference.position.x")),
            ("reference.velocity.x", None),
            ("limit.tilt", Some("limits.tilt")),
        ] {
            assert_eq!(nearest_name(given, known), meant, "{given}");
        }
    }

    #[test]
    fn distances_are_those_that_one_counts_by_hand() {
        for (one, other, expected) in [
            ("", "", 0),
            ("", "abc", 3),
            ("abc", "", 3),
            ("kitten", "sitting", 3),
            ("ab", "ba", 1),
            ("abcd", "acbd", 1),
            // Each letter is moved at most once: else it would be two.
            ("ca", "abc", 3),
            ("grün", "grün", 0),
            ("grün", "grun", 1),
        ] {
            assert_eq!(distance(one, other), expected, "{one} {other}");
            assert_eq!(distance(other, one), expected, "{other} {one}");
        }
    }
}
