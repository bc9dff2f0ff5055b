//! What a service may ask of files.

/// The folder of logs in a store.
pub const LOGS: &str = "logs";
/// The file beside ArduPilot's logs that has the number of the latest.
pub const LAST_LOG: &str = "LASTLOG.TXT";

/// Why a file operation failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// There is no such file or folder, or it is nothing that has bytes.
    #[error("not found")]
    NotFound,
    /// There is one already, or it is not empty.
    #[error("exists")]
    Exists,
    /// It may only be read, or not even that.
    #[error("protected")]
    Protected,
    /// More than the quota.
    #[error("no space")]
    NoSpace,
    /// The system says no.
    #[error("failed")]
    Failed,
}

/// An entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Its name.
    pub name: String,
    /// Bytes of a file; `None` for a folder.
    pub size: Option<u64>,
    /// When it was last changed, s since 1970.
    pub modified_unix_s: u64,
}

/// What a file is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// To be read.
    Read,
    /// To be written, and emptied if it is there.
    Create,
    /// To be written; it is made if it is not there.
    Write,
}

/// An open file.
pub trait OpenFile: std::fmt::Debug + Send {
    /// Bytes of it.
    ///
    /// # Errors
    /// [`FileError`]
    fn size(&self) -> Result<u64, FileError>;

    /// Reads from an offset on; fewer bytes only at the end.
    ///
    /// # Errors
    /// [`FileError`]
    fn read_at(&mut self, offset: u64, into: &mut [u8]) -> Result<usize, FileError>;

    /// Writes from an offset on.
    ///
    /// # Errors
    /// [`FileError::NoSpace`] beyond the quota, and others.
    fn write_at(&mut self, offset: u64, bytes: &[u8]) -> Result<(), FileError>;
}

/// Folders and files under relative paths: names between slashes, none of which is empty, `.` or `..`.
pub trait FileStore: std::fmt::Debug + Send {
    /// What is in a folder, by name; the empty path is the root.
    ///
    /// # Errors
    /// [`FileError`]
    fn list(&self, path: &str) -> Result<Vec<Listed>, FileError>;

    /// Opens a file.
    ///
    /// # Errors
    /// [`FileError`]
    fn open(&mut self, path: &str, access: Access) -> Result<Box<dyn OpenFile>, FileError>;

    /// Removes a file.
    ///
    /// # Errors
    /// [`FileError`]
    fn remove_file(&mut self, path: &str) -> Result<(), FileError>;

    /// Makes a folder.
    ///
    /// # Errors
    /// [`FileError`]
    fn create_folder(&mut self, path: &str) -> Result<(), FileError>;

    /// Removes an empty folder.
    ///
    /// # Errors
    /// [`FileError`]
    fn remove_folder(&mut self, path: &str) -> Result<(), FileError>;

    /// Renames; what has the new name already stays.
    ///
    /// # Errors
    /// [`FileError`]
    fn rename(&mut self, from: &str, to: &str) -> Result<(), FileError>;

    /// Cuts a file off, or fills it with zeros.
    ///
    /// # Errors
    /// [`FileError`]
    fn truncate(&mut self, path: &str, size: u64) -> Result<(), FileError>;

    /// Removes all logs of flights that are over.
    ///
    /// # Errors
    /// [`FileError`]
    fn erase_logs(&mut self) -> Result<(), FileError>;
}

/// No files at all.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nothing;

impl FileStore for Nothing {
    fn list(&self, path: &str) -> Result<Vec<Listed>, FileError> {
        if path.is_empty() { Ok(Vec::new()) } else { Err(FileError::NotFound) }
    }

    fn open(&mut self, _path: &str, access: Access) -> Result<Box<dyn OpenFile>, FileError> {
        Err(if access == Access::Read { FileError::NotFound } else { FileError::Protected })
    }

    fn remove_file(&mut self, _path: &str) -> Result<(), FileError> {
        Err(FileError::Protected)
    }

    fn create_folder(&mut self, _path: &str) -> Result<(), FileError> {
        Err(FileError::Protected)
    }

    fn remove_folder(&mut self, _path: &str) -> Result<(), FileError> {
        Err(FileError::Protected)
    }

    fn rename(&mut self, _from: &str, _to: &str) -> Result<(), FileError> {
        Err(FileError::Protected)
    }

    fn truncate(&mut self, _path: &str, _size: u64) -> Result<(), FileError> {
        Err(FileError::Protected)
    }

    fn erase_logs(&mut self) -> Result<(), FileError> {
        Ok(())
    }
}
