//! Text for fields that are ASCII.

/// A text in ASCII: units, ranges and angles are spelled out (`m/s²` is `m/s^2`, `3°–69°` is `3 to 69 deg`), and `?` stands for what is left.
pub fn ascii(text: &str) -> String {
    const SPELLED: [(&str, &str); 9] = [
        ("°–", "–"),
        ("–", " to "),
        ("°", " deg"),
        ("²", "^2"),
        ("³", "^3"),
        ("·", " "),
        ("Ω", "Ohm"),
        ("µ", "u"),
        ("…", "..."),
    ];
    let spelled = SPELLED.iter().fold(text.to_owned(), |text, (letter, words)| text.replace(letter, words));
    spelled.chars().map(|letter| if letter.is_ascii() { letter } else { '?' }).collect()
}

#[cfg(test)]
mod tests {
    use super::ascii;

    #[test]
    fn units_and_ranges_stay_readable() {
        for (text, expected) in [
            (
                "LIM_TILT_A = -1 rad/s²; allowed 0.1–500 rad/s²",
                "LIM_TILT_A = -1 rad/s^2; allowed 0.1 to 500 rad/s^2",
            ),
            ("0.05–1.2 rad (3°–69°)", "0.05 to 1.2 rad (3 to 69 deg)"),
            ("1e-5 kg·m², 6e-7 N·m·s², 0.1 Ω", "1e-5 kg m^2, 6e-7 N m s^2, 0.1 Ohm"),
            ("Zürich", "Z?rich"),
        ] {
            assert_eq!(ascii(text), expected);
        }
    }
}
