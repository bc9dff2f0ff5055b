//! What an open file is.

use super::message::Nak;
use crate::file_store::{FileError, OpenFile};

/// An open file.
#[derive(Debug)]
pub enum Content {
    /// Made when it was opened.
    Made(Vec<u8>),
    /// In a store.
    Stored(Box<dyn OpenFile>),
}

impl Content {
    /// Bytes of it; more than offsets can tell is not offered.
    pub fn size(&self) -> Result<u32, Nak> {
        let size = match self {
            Self::Made(bytes) => bytes.len() as u64,
            Self::Stored(file) => file.size()?,
        };
        u32::try_from(size).map_err(|_| Nak::Fail)
    }

    /// Reads from an offset on; fewer bytes only at the end.
    pub fn read_at(&mut self, offset: u64, into: &mut [u8]) -> Result<usize, FileError> {
        match self {
            Self::Stored(file) => file.read_at(offset, into),
            Self::Made(bytes) => {
                let start = usize::try_from(offset).unwrap_or(usize::MAX);
                let rest = bytes.get(start..).unwrap_or_default();
                for (byte, given) in into.iter_mut().zip(rest) {
                    *byte = *given;
                }
                Ok(rest.len().min(into.len()))
            }
        }
    }

    /// Writes from an offset on.
    pub fn write_at(&mut self, offset: u64, bytes: &[u8]) -> Result<(), Nak> {
        match self {
            Self::Made(_) => Err(Nak::FileProtected),
            Self::Stored(file) => Ok(file.write_at(offset, bytes)?),
        }
    }
}
