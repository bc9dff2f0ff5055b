//! `.tlog`: each frame behind its time, as ground stations write them.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use autopilot::codec::Frame;

use crate::failure::Failure;

/// How often it reaches the disk, µs of its own time, and by the wall clock.
const FLUSH_US: u64 = 1_000_000;
const FLUSH: Duration = Duration::from_secs(1);

/// A log of all traffic. When its file is full it becomes `NAME.1.tlog`, `NAME.2.tlog` and so on, and a new one begins;
/// of these the oldest are removed.
#[derive(Debug)]
pub struct TrafficLog {
    path: PathBuf,
    file: BufWriter<File>,
    bytes: u64,
    most_bytes: u64,
    most_files: usize,
    full: u64,
    flushed_us: u64,
    flushed: Option<Instant>,
}

impl TrafficLog {
    /// Begins a log: its file, how large that may get, and how many there may be.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn create(path: &Path, most_bytes: u64, most_files: usize) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|source| Failure::write(path, source))?;
        Ok(Self {
            path: path.to_owned(),
            file: BufWriter::new(file),
            bytes: 0,
            most_bytes,
            most_files,
            full: 0,
            flushed_us: 0,
            flushed: None,
        })
    }

    /// Logs a frame: microseconds since 1970, most significant byte first, then the frame.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn frame(&mut self, unix_us: u64, frame: &Frame) -> Result<(), Failure> {
        let stamp = unix_us.to_be_bytes();
        let length = (stamp.len() + frame.bytes().len()) as u64;
        if self.bytes > 0 && self.bytes + length > self.most_bytes {
            self.rotate()?;
        }
        self.bytes += length;
        let due = unix_us >= self.flushed_us + FLUSH_US;
        let written = self
            .file
            .write_all(&stamp)
            .and_then(|()| self.file.write_all(frame.bytes()))
            .and_then(|()| if due { self.file.flush() } else { Ok(()) });
        self.flushed_us = if due { unix_us } else { self.flushed_us };
        written.map_err(|source| Failure::write(&self.path, source))
    }

    /// Flushes if the wall clock says so: simulation time may be slow.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn keep_up(&mut self, now: Instant) -> Result<(), Failure> {
        let flushed = *self.flushed.get_or_insert(now);
        if now.saturating_duration_since(flushed) < FLUSH {
            return Ok(());
        }
        self.flushed = Some(now);
        self.file.flush().map_err(|source| Failure::write(&self.path, source))
    }

    /// Name of the file that was the `number`th to be full.
    fn numbered(&self, number: u64) -> PathBuf {
        let extension =
            self.path.extension().map_or_else(String::new, |text| text.to_string_lossy().into_owned());
        self.path.with_extension(format!("{number}.{extension}").trim_end_matches('.'))
    }

    fn rotate(&mut self) -> Result<(), Failure> {
        self.full += 1;
        let surplus = self.full.checked_sub(self.most_files as u64);
        let renamed = self.file.flush().and_then(|()| std::fs::rename(&self.path, self.numbered(self.full)));
        let begun = renamed.and_then(|()| File::create(&self.path));
        self.file = BufWriter::new(begun.map_err(|source| Failure::write(&self.path, source))?);
        self.bytes = 0;
        if let Some(number) = surplus {
            // The first is number 1, and one file is being written. Somebody else may have removed it.
            let _gone = std::fs::remove_file(self.numbered(number + 1));
        }
        Ok(())
    }

    /// Ends the log.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(mut self) -> Result<(), Failure> {
        self.file.flush().map_err(|source| Failure::write(&self.path, source))
    }
}

#[cfg(test)]
mod tests {
    use mavlink::dialects::common::{HEARTBEAT_DATA, MavMessage};

    use super::TrafficLog;
    use autopilot::codec::{Frame, Version};

    #[test]
    fn full_files_make_room_and_no_frame_is_split_or_lost_among_those_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("traffic.tlog");
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()).into();
        let frame = |number| Frame::encode(&message, Version::Two, number, (1, 1)).expect("a frame");
        let length = 8 + frame(0).bytes().len();
        let mut log = TrafficLog::create(&path, 10 * length as u64 + 3, 3).expect("a file");
        for number in 0..55 {
            log.frame(u64::from(number), &frame(number)).expect("written");
        }
        log.finish().expect("written");
        let mut names: Vec<_> = std::fs::read_dir(folder.path())
            .expect("a folder")
            .map(|entry| entry.expect("one").file_name())
            .collect();
        names.sort();
        assert_eq!(names, ["traffic.4.tlog", "traffic.5.tlog", "traffic.tlog"]);
        let mut kept = Vec::new();
        for name in names {
            let bytes = std::fs::read(folder.path().join(name)).expect("readable");
            for record in bytes.chunks(length) {
                kept.push(Frame::parse(&record[8..]).expect("a whole frame").sequence());
            }
        }
        assert_eq!(kept, (30..55).collect::<Vec<u8>>());
    }
}
