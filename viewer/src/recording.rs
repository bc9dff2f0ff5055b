//! A flight of the past that the page opens by itself.

use std::path::Path;

use axum::body::Bytes;

/// A file with its name: the page reads ULog, CSV and [`Film`](crate::Film).
#[derive(Clone, Debug)]
pub struct Recording {
    name: String,
    content: Bytes,
}

impl Recording {
    /// A file that is nowhere but here.
    pub fn new(name: String, content: Vec<u8>) -> Self {
        Self { name, content: Bytes::from(content) }
    }

    /// A file.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read(path: &Path) -> std::io::Result<Self> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, content: Bytes::from(std::fs::read(path)?) })
    }

    /// Its name without folders.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its bytes.
    pub fn content(&self) -> Bytes {
        self.content.clone()
    }
}
