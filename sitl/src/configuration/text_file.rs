//! Text files that people write.

use std::path::Path;

use crate::failure::Failure;

/// What editors on Windows put in front of UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// The beginnings of UTF-16 text.
const UTF_16: [&[u8]; 2] = [b"\xff\xfe", b"\xfe\xff"];

/// The text of a UTF-8 file, without a byte order mark.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] in another encoding.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|source| Failure::read(path, source))?;
    let wrong = |reason: &str| Failure::Content { path: path.to_owned(), reason: reason.to_owned() };
    if UTF_16.iter().any(|mark| bytes.starts_with(mark)) {
        return Err(wrong("the file is UTF-16 text; save it as UTF-8"));
    }
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&bytes);
    let text = std::str::from_utf8(text).map_err(|error| {
        let line = text.iter().take(error.valid_up_to()).filter(|byte| **byte == b'\n').count() + 1;
        wrong(&format!("line {line} is not UTF-8 text; save the file as UTF-8"))
    })?;
    Ok(text.to_owned())
}

/// A mistake in the form of a TOML text: the line that it is in, and what is wrong there.
pub(super) fn toml_mistake(text: &str, error: &toml::de::Error) -> String {
    let start = error.span().map_or(0, |span| span.start);
    let line = text.get(..start).unwrap_or_default().matches('\n').count();
    let content = text.lines().nth(line).unwrap_or_default().trim();
    let reason = error.message().lines().collect::<Vec<_>>().join(" ");
    format!("line {}, `{content}`: {reason}", line + 1)
}

#[cfg(test)]
mod tests {
    use super::read_text;

    #[test]
    fn a_byte_order_mark_is_skipped_and_other_encodings_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("text");
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).expect("written");
            read_text(&path).map_err(|failure| failure.to_string())
        };
        assert_eq!(read(b"\xef\xbb\xbfspeed = 1"), Ok("speed = 1".to_owned()));
        assert_eq!(read("höhe".as_bytes()), Ok("höhe".to_owned()));
        assert!(read(b"\xff\xfes\0").expect_err("UTF-16").contains("UTF-16"));
        assert!(read(b"a\nh\xf6he").expect_err("Latin-1").contains("line 2 is not UTF-8"));
        std::fs::remove_file(&path).expect("removed");
        assert!(read_text(&path).expect_err("none").to_string().contains("cannot read"));
    }
}
