//! A log's file: whole messages, and marks of what is missing.

use std::io::{self, Write};

use super::format::LogWriter;
use crate::files::Spool;

/// A file that is written to when it is told to. When it cannot take more, data wait, then are dropped, and the log says
/// for how long.
#[derive(Debug)]
pub struct LogFile<W: Write> {
    spool: Spool<W>,
    /// Since when data have been dropped, µs.
    dropping_since_us: Option<u64>,
    dropped_us: u64,
}

impl<W: Write> LogFile<W> {
    /// A file that begins with some bytes.
    pub fn new(file: W, definitions: &[u8]) -> Self {
        let mut spool = Spool::new(file);
        // An empty spool takes any definitions.
        let _taken = spool.append(definitions);
        Self { spool, dropping_since_us: None, dropped_us: 0 }
    }

    /// Bytes so far.
    pub fn bytes(&self) -> u64 {
        self.spool.bytes()
    }

    /// Simulation time of which data are missing at a time, µs.
    pub fn dropped_us(&self, time_us: u64) -> u64 {
        let since_us = self.dropping_since_us.unwrap_or(time_us);
        self.dropped_us + time_us.saturating_sub(since_us)
    }

    /// Appends whole messages at a time, µs.
    pub fn append(&mut self, time_us: u64, messages: &[u8]) {
        if self.dropping_since_us.is_some() || !self.spool.append(messages) {
            self.dropping_since_us.get_or_insert(time_us);
        }
    }

    /// Writes what is waiting.
    ///
    /// # Errors
    /// What the file says. What is not written waits.
    pub fn flush(&mut self, time_us: u64, writer: &dyn LogWriter) -> io::Result<()> {
        self.spool.flush()?;
        let mut marks = Vec::new();
        let dropped_us = self.dropping_since_us.take().map(|since_us| time_us.saturating_sub(since_us));
        self.dropped_us += dropped_us.unwrap_or(0);
        writer.mark(&mut marks, time_us, dropped_us);
        // The spool has just been emptied.
        let _taken = self.spool.append(&marks);
        self.spool.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::LogFile;
    use crate::files::SmallDisk;
    use crate::flight_log::LogFormat;

    #[test]
    fn a_full_disk_costs_data_but_no_order_and_the_log_says_so() {
        let disk = SmallDisk::default();
        let mut file = LogFile::new(disk.clone(), b"begin");
        let writer = LogFormat::ULog.writer();
        disk.set_room(3);
        assert!(file.flush(0, &*writer).is_err());
        file.append(1_000_000, &[7; 1 << 19]);
        file.append(2_000_000, &[8; (1 << 19) - 100]);
        file.append(3_000_000, &[0x55; 200]);
        file.append(4_000_000, &[0x55; 20]);
        assert!(file.flush(4_500_000, &*writer).is_err());
        assert_eq!(file.dropped_us(4_500_000), 1_500_000);
        disk.set_room(usize::MAX);
        file.flush(5_500_000, &*writer).expect("there is room");
        file.append(6_000_000, b"end");
        file.flush(6_000_000, &*writer).expect("there is room");
        assert_eq!(file.dropped_us(6_000_000), 2_500_000);
        let content = &disk.content();
        assert_eq!(content.len() as u64, file.bytes());
        assert!(content.starts_with(b"begin\x07\x07") && !content.contains(&0x55));
        // Dropped from 3 s to 5.5 s: 2500 ms.
        let dropout = [2, 0, b'O', (2500 & 0xff) as u8, (2500 >> 8) as u8];
        let at = content.windows(5).position(|bytes| bytes == dropout).expect("a dropout");
        assert_eq!(at, 5 + (1 << 20) - 100);
        assert!(content[at..].windows(3).any(|bytes| bytes == b"end"));
    }
}
