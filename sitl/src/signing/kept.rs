//! Timestamps that outlive the program.

use std::collections::BTreeMap;

/// First line of the file.
const FORMAT: &str = "lmpc-sitl signing timestamps 2";
/// First line of older files. They have the latest timestamp of all streams, which is not before that of a forgotten one.
const OLD_FORMAT: &str = "lmpc-sitl signing timestamps 1";

/// Link, system and component of a sender: its timestamps only grow.
pub type Stream = (u8, u8, u8);

/// What must not be forgotten, or frames of before could come again.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Kept {
    /// Nothing that was sent has a later timestamp.
    pub sent: u64,
    /// Nothing that was accepted of a stream that is not listed has a later timestamp.
    pub forgotten: u64,
    /// Nothing that was accepted of a stream has a later timestamp.
    pub streams: BTreeMap<Stream, u64>,
}

impl Kept {
    /// As lines of text.
    pub fn render(&self) -> String {
        let mut text = format!("{FORMAT}\nsent {}\nforgotten {}\n", self.sent, self.forgotten);
        for ((link, system, component), timestamp) in &self.streams {
            text.push_str(&format!("stream {link} {system} {component} {timestamp}\n"));
        }
        text
    }

    /// From lines of text.
    ///
    /// # Errors
    /// The number of the first line that is wrong.
    pub fn parse(text: &str) -> Result<Self, usize> {
        let mut kept = Self::default();
        let mut lines = (1_usize..).zip(text.lines());
        let forgotten = match lines.next() {
            Some((_, FORMAT)) => "forgotten",
            Some((_, OLD_FORMAT)) => "heard",
            _ => return Err(1),
        };
        for (number, line) in lines {
            let mut words = line.split(' ');
            let word = words.next();
            let read = match (word, words.collect::<Vec<_>>().as_slice()) {
                (Some("sent"), [value]) => value.parse().map(|value| kept.sent = value).ok(),
                (Some(word), [value]) if word == forgotten => {
                    value.parse().map(|value| kept.forgotten = value).ok()
                }
                (Some("stream"), [link, system, component, value]) => {
                    let stream = || Some((link.parse().ok()?, system.parse().ok()?, component.parse().ok()?));
                    stream().zip(value.parse().ok()).map(|(stream, value)| {
                        kept.streams.insert(stream, value);
                    })
                }
                _ => None,
            };
            read.ok_or(number)?;
        }
        Ok(kept)
    }
}

#[cfg(test)]
mod tests {
    use super::Kept;

    #[test]
    fn it_reads_as_it_is_written_and_half_of_it_not_at_all() {
        let kept =
            Kept { sent: 7, forgotten: u64::MAX, streams: [((0, 255, 190), 5), ((3, 1, 1), 6)].into() };
        let text = kept.render();
        assert_eq!(Kept::parse(&text).as_ref(), Ok(&kept));
        let old = text.replace("timestamps 2", "timestamps 1").replace("forgotten", "heard");
        assert_eq!(Kept::parse(&old), Ok(kept));
        assert_eq!(Kept::parse(&text.replace("forgotten", "heard")), Err(3));
        assert_eq!(Kept::parse(""), Err(1));
        assert_eq!(Kept::parse(&text.replace("3 1 1", "3 1 256")), Err(5));
        assert_eq!(Kept::parse(text.trim_end_matches("6\n")), Err(5));
    }
}
