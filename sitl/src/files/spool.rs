//! Bytes on their way to a file that may refuse them for a while.

use std::io::{self, Write};

/// Bytes that wait for a disk that takes none.
const MOST_WAITING: usize = 1 << 20;
/// So many waiting bytes are written at once, if the file took everything the last time.
const CHUNK: usize = 1 << 16;

/// A buffered file that loses nothing when a write fails: bytes wait, in order, for the next attempt.
///
/// Memory is bounded: a full spool refuses more. Dropping it writes what is waiting, once.
#[derive(Debug)]
pub struct Spool<W: Write> {
    file: W,
    waiting: Vec<u8>,
    written: u64,
    failing: bool,
}

impl<W: Write> Spool<W> {
    /// A spool in front of an empty file.
    pub fn new(file: W) -> Self {
        Self { file, waiting: Vec::new(), written: 0, failing: false }
    }

    /// Bytes accepted so far.
    pub fn bytes(&self) -> u64 {
        self.written + self.waiting.len() as u64
    }

    /// Accepts all of the bytes, or none if there is no room for them. Returns whether it did.
    pub fn append(&mut self, bytes: &[u8]) -> bool {
        if self.waiting.len() + bytes.len() > MOST_WAITING && self.waiting.len() >= CHUNK {
            return false;
        }
        self.waiting.extend_from_slice(bytes);
        if self.waiting.len() >= CHUNK && !self.failing {
            // The next flush tries again and reports.
            self.failing = self.write().is_err();
        }
        true
    }

    /// Writes everything that waits.
    ///
    /// # Errors
    /// The error of the file. What it has not taken keeps waiting.
    pub fn flush(&mut self) -> io::Result<()> {
        let result = self.write().and_then(|()| self.file.flush());
        self.failing = result.is_err();
        result
    }

    fn write(&mut self) -> io::Result<()> {
        let mut taken = 0;
        let result = loop {
            let Some(rest) = self.waiting.get(taken..).filter(|rest| !rest.is_empty()) else { break Ok(()) };
            match self.file.write(rest) {
                Ok(0) => break Err(io::ErrorKind::WriteZero.into()),
                Ok(length) => taken += length.min(rest.len()),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => break Err(error),
            }
        };
        self.waiting.drain(..taken);
        self.written += taken as u64;
        result
    }
}

impl<W: Write> Drop for Spool<W> {
    fn drop(&mut self) {
        // Whoever wanted to know of an error has flushed.
        let _unwritten = self.write();
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::io::{self, Write};
    use std::sync::{Arc, Mutex};

    use super::{MOST_WAITING, Spool};

    /// A disk that is full after some bytes: its content, and its room.
    #[derive(Clone, Debug, Default)]
    pub(crate) struct SmallDisk(Arc<Mutex<(Vec<u8>, usize)>>);

    impl SmallDisk {
        /// Changes how many more bytes it takes.
        pub(crate) fn set_room(&self, room: usize) {
            self.0.lock().expect("one thread").1 = room;
        }

        /// What it has taken.
        pub(crate) fn content(&self) -> Vec<u8> {
            self.0.lock().expect("one thread").0.clone()
        }
    }

    impl Write for SmallDisk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let (content, room) = &mut *self.0.lock().expect("one thread");
            let length = bytes.len().min(*room);
            if length == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            *room -= length;
            content.extend_from_slice(&bytes[..length]);
            Ok(length)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_delays_bytes_and_keeps_their_order() {
        let disk = SmallDisk::default();
        disk.set_room(3);
        let mut spool = Spool::new(disk.clone());
        assert!(spool.append(b"first ") && spool.append(b"second "));
        assert_eq!(spool.flush().expect_err("full").kind(), io::ErrorKind::StorageFull);
        assert!(spool.append(b"third"));
        disk.set_room(usize::MAX);
        spool.flush().expect("room");
        assert_eq!((disk.content(), spool.bytes()), (b"first second third".to_vec(), 18));
    }

    #[test]
    fn memory_is_bounded_and_what_was_accepted_is_written() {
        let disk = SmallDisk::default();
        let mut spool = Spool::new(disk.clone());
        assert!(spool.flush().is_ok());
        let mut accepted = 0;
        while spool.append(&[7; 1000]) {
            accepted += 1000;
            assert!(accepted <= MOST_WAITING, "no bound");
        }
        assert!(accepted > MOST_WAITING - 1000);
        disk.set_room(usize::MAX);
        drop(spool);
        assert_eq!(disk.content().len(), accepted);
    }
}
