//! Parts of a line, of which a narrow terminal shows the most important ones.

/// Between two segments.
const GAP: &str = "  ";

/// A part of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// What it says.
    pub text: String,
    /// Where there is not room for all, low ranks stay.
    pub rank: u8,
}

impl Segment {
    /// A segment of a rank.
    pub fn new(rank: u8, text: impl Into<String>) -> Self {
        Self { text: text.into(), rank }
    }
}

/// As many segments as fit into a width, those of low rank first, in their order; cut off if not even one fits.
pub fn fit(segments: &[Segment], width: usize) -> String {
    let length = |segment: &Segment| segment.text.chars().count();
    let mut by_rank: Vec<usize> = (0..segments.len()).collect();
    by_rank.sort_by_key(|number| segments.get(*number).map(|segment| segment.rank));
    let mut kept: Vec<usize> = Vec::new();
    let mut used = 0;
    for number in by_rank {
        let Some(segment) = segments.get(number) else { continue };
        let gap = if kept.is_empty() { 0 } else { GAP.len() };
        if kept.is_empty() || used + gap + length(segment) <= width {
            used += gap + length(segment);
            kept.push(number);
        }
    }
    kept.sort_unstable();
    let words: Vec<&str> =
        kept.iter().filter_map(|number| segments.get(*number)).map(|segment| segment.text.as_str()).collect();
    words.join(GAP).chars().take(width).collect()
}

#[cfg(test)]
mod tests {
    use super::{Segment, fit};

    fn segments() -> Vec<Segment> {
        vec![
            Segment::new(1, "  12.3 s"),
            Segment::new(4, "1.0x"),
            Segment::new(0, "armed Hold"),
            Segment::new(2, "N   0.0 E   0.0 up 10.0 m"),
            Segment::new(3, "battery 99 %"),
            Segment::new(5, "1 client"),
        ]
    }

    #[test]
    fn what_matters_least_goes_first_and_the_order_stays() {
        for (width, expected) in [
            (120, "  12.3 s  1.0x  armed Hold  N   0.0 E   0.0 up 10.0 m  battery 99 %  1 client"),
            (69, "  12.3 s  1.0x  armed Hold  N   0.0 E   0.0 up 10.0 m  battery 99 %"),
            (60, "  12.3 s  1.0x  armed Hold  N   0.0 E   0.0 up 10.0 m"),
            (39, "  12.3 s  armed Hold  battery 99 %"),
            (10, "armed Hold"),
            (5, "armed"),
            (0, ""),
        ] {
            assert_eq!(fit(&segments(), width), expected, "{width}");
        }
    }

    #[test]
    fn no_width_is_exceeded() {
        for width in 0..130 {
            assert!(fit(&segments(), width).chars().count() <= width);
        }
    }
}
