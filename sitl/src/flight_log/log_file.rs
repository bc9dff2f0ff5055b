//! Bytes on their way to a file that may fail.

use std::io::{self, Write};

use super::ulog;

/// Bytes that wait for a disk that takes none; what comes on top is dropped.
const MOST_WAITING: usize = 1 << 20;

/// A file that is written to when it is told to. When it cannot take more, data wait, then are dropped, and the log says
/// for how long.
#[derive(Debug)]
pub struct LogFile<W> {
    file: W,
    waiting: Vec<u8>,
    written: u64,
    /// Since when data have been dropped, µs.
    dropping_since_us: Option<u64>,
}

impl<W: Write> LogFile<W> {
    /// A file that begins with some bytes.
    pub fn new(file: W, definitions: Vec<u8>) -> Self {
        Self { file, waiting: definitions, written: 0, dropping_since_us: None }
    }

    /// Bytes so far.
    pub fn bytes(&self) -> u64 {
        self.written + self.waiting.len() as u64
    }

    /// Appends whole messages at a time, µs.
    pub fn append(&mut self, time_us: u64, messages: &[u8]) {
        if self.waiting.len() + messages.len() > MOST_WAITING || self.dropping_since_us.is_some() {
            self.dropping_since_us.get_or_insert(time_us);
        } else {
            self.waiting.extend_from_slice(messages);
        }
    }

    /// Writes what is waiting.
    ///
    /// # Errors
    /// What the file says. What is not written waits.
    pub fn flush(&mut self, time_us: u64) -> io::Result<()> {
        self.write()?;
        if let Some(since_us) = self.dropping_since_us.take() {
            ulog::dropout(&mut self.waiting, time_us.saturating_sub(since_us) / 1000);
        }
        ulog::sync(&mut self.waiting);
        self.write()?;
        self.file.flush()
    }

    fn write(&mut self) -> io::Result<()> {
        while !self.waiting.is_empty() {
            match self.file.write(&self.waiting) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(length) => {
                    self.waiting.drain(..length.min(self.waiting.len()));
                    self.written += length as u64;
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, Write};
    use std::sync::{Arc, Mutex};

    use super::LogFile;

    /// A disk that is full after some bytes.
    #[derive(Clone, Default)]
    struct Disk(Arc<Mutex<(Vec<u8>, usize)>>);

    impl Write for Disk {
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
    fn a_full_disk_costs_data_but_no_order_and_the_log_says_so() {
        let disk = Disk::default();
        let room = |room| disk.0.lock().expect("one thread").1 = room;
        let mut file = LogFile::new(disk.clone(), b"begin".to_vec());
        room(3);
        assert!(file.flush(0).is_err());
        file.append(1_000_000, &[7; 1 << 19]);
        file.append(2_000_000, &[8; (1 << 19) - 100]);
        file.append(3_000_000, &[0x55; 200]);
        file.append(4_000_000, &[0x55; 20]);
        assert!(file.flush(4_500_000).is_err());
        room(usize::MAX);
        file.flush(5_500_000).expect("there is room");
        file.append(6_000_000, b"end");
        file.flush(6_000_000).expect("there is room");
        let content = &disk.0.lock().expect("one thread").0;
        assert_eq!(content.len() as u64, file.bytes());
        assert!(content.starts_with(b"begin\x07\x07") && !content.contains(&0x55));
        // Dropped from 3 s to 5.5 s: 2500 ms.
        let dropout = [2, 0, b'O', (2500 & 0xff) as u8, (2500 >> 8) as u8];
        let at = content.windows(5).position(|bytes| bytes == dropout).expect("a dropout");
        assert_eq!(at, 5 + (1 << 20) - 100);
        assert!(content[at..].windows(3).any(|bytes| bytes == b"end"));
    }
}
