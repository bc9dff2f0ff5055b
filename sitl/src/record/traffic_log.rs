//! `.tlog`: each frame behind its time, as ground stations write them.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use autopilot::codec::Frame;

use crate::failure::Failure;
use crate::files::{FileLock, Notice, Spool, Upkeep};

/// How often frames reach the disk by their own time, µs; by the wall clock they do when [`TrafficLog::flush`] is called.
const FLUSH_US: u64 = 1_000_000;

/// A log of all traffic. When its file is full it becomes `NAME.1.tlog`, `NAME.2.tlog` and so on, and a new one begins;
/// of these the oldest are removed.
#[derive(Debug)]
pub struct TrafficLog {
    path: PathBuf,
    spool: Spool<File>,
    upkeep: Upkeep,
    most_bytes: u64,
    most_files: usize,
    full: u64,
    flushed_us: u64,
    /// Why the next file could not be begun: the present one goes on until the next flush.
    stuck: Option<io::Error>,
    /// Frames that there was no room for.
    lost: u64,
    _lock: Option<FileLock>,
}

impl TrafficLog {
    /// Begins a log: its file, how large that may get, and how many there may be.
    ///
    /// # Errors
    /// [`Failure::File`], or [`Failure::Content`] when another process writes the file.
    pub fn create(path: &Path, most_bytes: u64, most_files: usize) -> Result<Self, Failure> {
        let lock = FileLock::claim(path)?;
        let file = File::create(path).map_err(|source| Failure::write(path, source))?;
        Ok(Self {
            path: path.to_owned(),
            spool: Spool::new(file),
            upkeep: Upkeep::new("Traffic log", path),
            most_bytes,
            most_files,
            full: 0,
            flushed_us: 0,
            stuck: None,
            lost: 0,
            _lock: lock,
        })
    }

    /// Logs a frame: microseconds since 1970, most significant byte first, then the frame.
    pub fn frame(&mut self, unix_us: u64, frame: &Frame) {
        let entry = [&unix_us.to_be_bytes(), frame.bytes()].concat();
        let full = self.spool.bytes() > 0 && self.spool.bytes() + entry.len() as u64 > self.most_bytes;
        if full && self.stuck.is_none() && !self.upkeep.is_failing() {
            self.stuck = self.rotate().err();
        }
        if !self.spool.append(&entry) {
            self.lost += 1;
        }
        // Simulated seconds may be shorter than those of the wall clock.
        if unix_us >= self.flushed_us.saturating_add(FLUSH_US) && !self.upkeep.is_failing() {
            self.flushed_us = unix_us;
            // The next flush by the wall clock tries again and reports.
            let _told_then = self.spool.flush();
        }
    }

    /// Writes what waits. Returns what to announce.
    pub fn flush(&mut self) -> Option<Notice> {
        let written = self.spool.flush();
        self.upkeep.judge(self.stuck.take().map_or(written, Err))
    }

    /// Name of the file that was the `number`th to be full.
    fn numbered(&self, number: u64) -> PathBuf {
        let extension =
            self.path.extension().map_or_else(String::new, |text| text.to_string_lossy().into_owned());
        self.path.with_extension(format!("{number}.{extension}").trim_end_matches('.'))
    }

    fn rotate(&mut self) -> io::Result<()> {
        self.spool.flush()?;
        std::fs::rename(&self.path, self.numbered(self.full + 1))?;
        self.full += 1;
        self.spool = Spool::new(File::create(&self.path)?);
        if let Some(number) = self.full.checked_sub(self.most_files as u64) {
            // The first is number 1, and one file is being written. Somebody else may have removed it.
            let _gone = std::fs::remove_file(self.numbered(number + 1));
        }
        Ok(())
    }

    /// Ends the log. Returns what is missing from it, if anything is.
    pub fn finish(mut self) -> Option<String> {
        let _told_below = self.flush();
        match self.lost {
            0 => self.upkeep.is_failing().then(|| self.upkeep.lacks("ends early")),
            lost => Some(self.upkeep.lacks(&format!("lacks {lost} messages"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage};

    use super::TrafficLog;
    use autopilot::codec::{Frame, Version};

    #[test]
    fn frames_reach_the_disk_after_a_second_of_their_own_time() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("traffic.tlog");
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()).into();
        let frame = Frame::encode(&message, Version::Two, 0, (1, 1)).expect("a frame");
        let mut log = TrafficLog::create(&path, 1 << 20, 2).expect("a file");
        let start_us = 1_700_000_000_000_000;
        for (after_us, on_disk) in
            [(0, 1), (500_000, 1), (999_999, 1), (1_000_000, 4), (1_400_000, 4), (2_000_000, 6)]
        {
            log.frame(start_us + after_us, &frame);
            let length = std::fs::metadata(&path).expect("a file").len();
            assert_eq!(length, on_disk * (8 + frame.bytes().len() as u64), "after {after_us} µs");
        }
        assert_eq!(log.finish(), None);
    }

    #[test]
    fn full_files_make_room_and_no_frame_is_split_or_lost_among_those_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("traffic.tlog");
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()).into();
        let frame = |number| Frame::encode(&message, Version::Two, number, (1, 1)).expect("a frame");
        let length = 8 + frame(0).bytes().len();
        let mut log = TrafficLog::create(&path, 10 * length as u64 + 3, 3).expect("a file");
        for number in 0..55 {
            log.frame(u64::from(number), &frame(number));
        }
        assert_eq!(log.finish(), None);
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
