//! The checksum that each line of a record ends with.

use crc32fast::Hasher;

/// CRC-32 of all bytes of the file so far: a line that is changed, missing or elsewhere breaks its own and all that follow.
#[derive(Clone, Debug, Default)]
pub struct Checksum(Hasher);

impl Checksum {
    /// The line of some text: the text, a space, eight hexadecimal digits and the end of the line.
    pub fn seal(&mut self, text: &str) -> String {
        self.0.update(text.as_bytes());
        self.0.update(b" ");
        let sealed = format!("{:08x}\n", self.0.clone().finalize());
        self.0.update(sealed.as_bytes());
        format!("{text} {sealed}")
    }

    /// The text of the next line, with its end; `None` if it is not the one that was written.
    pub fn open<'a>(&mut self, line: &'a [u8]) -> Option<&'a str> {
        let text = std::str::from_utf8(line).ok()?.strip_suffix('\n')?;
        let (text, _) = text.rsplit_once(' ')?;
        (self.seal(text).as_bytes() == line).then_some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::Checksum;

    /// Values of Python's `zlib.crc32`.
    #[test]
    fn it_is_the_crc_32_of_all_bytes_before_it() {
        let mut checksum = Checksum::default();
        assert_eq!(checksum.seal("header"), "header 05614fcb\n");
        assert_eq!(checksum.seal("end 1 0"), "end 1 0 221b1d05\n");
    }

    #[test]
    fn what_is_changed_lost_or_moved_is_noticed() {
        let mut checksum = Checksum::default();
        let lines = ["a", "b", "c"].map(|text| checksum.seal(text));
        let texts = |lines: &[&str]| {
            let mut checksum = Checksum::default();
            lines
                .iter()
                .map_while(|line| checksum.open(line.as_bytes()).map(str::to_owned))
                .collect::<Vec<_>>()
        };
        let [a, b, c] = lines.each_ref().map(String::as_str);
        assert_eq!(texts(&[a, b, c]), ["a", "b", "c"]);
        assert_eq!(texts(&[a, c]), ["a"]);
        assert_eq!(texts(&[a, c, b]), ["a"]);
        assert_eq!(texts(&[a, a, b]), ["a"]);
        assert_eq!(texts(&[a, &b.replace('b', "d"), c]), ["a"]);
        assert_eq!(texts(&[a, b.trim_end()]), ["a"]);
    }
}
