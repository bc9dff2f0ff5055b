//! A zip archive whose bytes depend on its entries alone.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// The entry that importers look for first.
pub const MODEL_DESCRIPTION: &str = "modelDescription.xml";

/// Entries by path.
#[derive(Default)]
pub struct Archive {
    entries: BTreeMap<String, Entry>,
}

struct Entry {
    bytes: Vec<u8>,
    executable: bool,
}

impl Archive {
    /// Adds a file.
    pub fn add(&mut self, path: &str, bytes: Vec<u8>) {
        self.entries.insert(path.to_owned(), Entry { bytes, executable: false });
    }

    /// Adds a library.
    pub fn add_binary(&mut self, path: &str, bytes: Vec<u8>) {
        self.entries.insert(path.to_owned(), Entry { bytes, executable: true });
    }

    /// Paths, contents, and whether they are libraries.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &[u8], bool)> {
        self.entries.iter().map(|(path, entry)| (path.as_str(), entry.bytes.as_slice(), entry.executable))
    }

    /// Whether there is an entry below this folder.
    pub fn has_folder(&self, folder: &str) -> bool {
        let below = format!("{folder}/");
        self.entries.keys().any(|path| path.starts_with(&below))
    }

    /// The archive: the description first, the rest by path, all of the same fixed time.
    pub fn into_bytes(self) -> Result<Vec<u8>, ZipError> {
        let mut entries: Vec<_> = self.entries.into_iter().collect();
        entries.sort_by_key(|(path, _)| path != MODEL_DESCRIPTION);
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for (path, entry) in entries {
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Deflated)
                .compression_level(Some(9))
                .last_modified_time(DateTime::default())
                .unix_permissions(if entry.executable { 0o755 } else { 0o644 });
            writer.start_file(path, options)?;
            writer.write_all(&entry.bytes)?;
        }
        Ok(writer.finish()?.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read};

    use zip::ZipArchive;

    use super::Archive;

    fn archive(order: &[&str]) -> Vec<u8> {
        let mut archive = Archive::default();
        for path in order {
            archive.add(path, path.as_bytes().to_vec());
        }
        archive.into_bytes().expect("writes to memory")
    }

    #[test]
    fn bytes_do_not_depend_on_the_order_of_adding() {
        let bytes = archive(&["b", "modelDescription.xml", "a"]);
        assert_eq!(bytes, archive(&["a", "b", "modelDescription.xml"]));

        let mut read = ZipArchive::new(Cursor::new(bytes)).expect("is an archive");
        let names: Vec<_> = read.file_names().map(|name| name.expect("is text").into_owned()).collect();
        assert_eq!(names, ["modelDescription.xml", "a", "b"]);
        let mut text = String::new();
        read.by_name("a").expect("is there").read_to_string(&mut text).expect("is text");
        assert_eq!(text, "a");
    }
}
