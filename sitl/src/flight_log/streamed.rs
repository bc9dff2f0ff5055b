//! The log that a client gets while it is written (LOGGING_START): always ULog, whatever is written to files.

use autopilot::Autopilot;
use autopilot::log_queue::{LogChunk, LogQueue, MOST_BYTES};

use super::LogSource;
use super::format::LogWriter;
use super::settings::GRID_US;
use super::ulog::{ULogWriter, entry_length};

/// Bytes of ULog's header, which is no entry.
const HEADER: usize = 16;

/// Fills the queue of the autopilot while somebody wants a log.
#[derive(Debug, Default)]
pub struct StreamedLog {
    current: Option<Current>,
}

/// One log.
#[derive(Debug)]
struct Current {
    stream: u32,
    writer: ULogWriter,
    pieces: Pieces,
    /// Since when data have been dropped because the link is slow, µs.
    dropping_since_us: Option<u64>,
    entries: Vec<u8>,
}

impl StreamedLog {
    /// Takes a tick of the vehicle in.
    pub fn tick(&mut self, autopilot: &mut Autopilot) {
        let Some(stream) = autopilot.log_queue().stream() else {
            self.current = None;
            return;
        };
        if self.current.as_ref().is_none_or(|current| current.stream != stream) {
            self.current = Some(Current::begin(stream, autopilot));
        }
        let time_us = autopilot.vehicle().time_us();
        if let Some(current) = self.current.as_mut().filter(|_| time_us.is_multiple_of(GRID_US)) {
            current.sample(autopilot, time_us);
        }
    }
}

impl Current {
    /// Definitions and parameters, which must arrive.
    fn begin(stream: u32, autopilot: &mut Autopilot) -> Self {
        let parameters: Vec<_> = autopilot.parameters().map(|(_, value)| value).collect();
        let mut writer = ULogWriter::new();
        let definitions = writer.begin(autopilot, &parameters);
        let mut pieces = Pieces { must_arrive: true, ..Pieces::default() };
        let queue = autopilot.log_queue_mut();
        let (header, entries) = definitions.split_at(HEADER.min(definitions.len()));
        pieces.append(header, queue);
        pieces.append_all(entries, queue);
        pieces.finish(queue);
        Self { stream, writer, pieces: Pieces::default(), dropping_since_us: None, entries: Vec::new() }
    }

    fn sample(&mut self, autopilot: &mut Autopilot, time_us: u64) {
        self.entries.clear();
        let queue = autopilot.log_queue();
        // Without the definitions nothing else can be read.
        if queue.next_must_arrive() {
            return;
        }
        if !queue.has_room() {
            self.dropping_since_us.get_or_insert(time_us);
            return;
        }
        if let Some(since_us) = self.dropping_since_us.take() {
            self.writer.mark(&mut self.entries, time_us, Some(time_us - since_us));
        }
        self.writer.sample(&mut self.entries, &LogSource::of(autopilot));
        self.pieces.append_all(&self.entries, autopilot.log_queue_mut());
    }
}

/// Cuts a log into chunks.
#[derive(Debug, Default)]
struct Pieces {
    open: LogChunk,
    must_arrive: bool,
}

impl Pieces {
    /// Appends whole entries.
    fn append_all(&mut self, mut entries: &[u8], queue: &mut LogQueue) {
        while let Some((entry, rest)) =
            entry_length(entries).and_then(|length| entries.split_at_checked(length))
        {
            self.append(entry, queue);
            entries = rest;
        }
    }

    /// Appends one entry.
    fn append(&mut self, entry: &[u8], queue: &mut LogQueue) {
        // A chunk of 249 bytes has no place that does not fit.
        let begins = u8::try_from(self.open.bytes.len()).ok();
        self.open.first_entry = self.open.first_entry.or(begins);
        let mut rest = entry;
        while !rest.is_empty() {
            let (fitting, behind) = rest.split_at(rest.len().min(MOST_BYTES - self.open.bytes.len()));
            self.open.bytes.extend(fitting);
            rest = behind;
            if self.open.bytes.len() == MOST_BYTES {
                self.finish(queue);
            }
        }
    }

    /// The open chunk is complete.
    fn finish(&mut self, queue: &mut LogQueue) {
        let chunk = std::mem::take(&mut self.open);
        if !chunk.bytes.is_empty() {
            queue.push(LogChunk { must_arrive: self.must_arrive, ..chunk });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LogQueue, MOST_BYTES, Pieces};

    /// An entry of the format with so many bytes.
    fn entry(length: usize) -> Vec<u8> {
        let mut entry = vec![7; length];
        entry[..3].copy_from_slice(&[(length - 3) as u8, ((length - 3) >> 8) as u8, b'D']);
        entry
    }

    #[test]
    fn chunks_are_full_and_say_where_an_entry_begins() {
        let mut queue = LogQueue::default();
        let mut pieces = Pieces::default();
        let lengths = [100, 149, 600, 10];
        let entries: Vec<u8> = lengths.iter().flat_map(|length| entry(*length)).collect();
        pieces.append_all(&entries, &mut queue);
        pieces.finish(&mut queue);
        let chunks: Vec<_> = queue.waiting().collect();
        // 100 and 149 bytes fill the first; the third entry fills two, and ends in the fourth, in which the last one begins.
        let shown: Vec<_> = chunks.iter().map(|chunk| (chunk.bytes.len(), chunk.first_entry)).collect();
        assert_eq!(
            shown,
            [(MOST_BYTES, Some(0)), (MOST_BYTES, Some(0)), (MOST_BYTES, None), (112, Some(102))]
        );
        assert_eq!(chunks.iter().flat_map(|chunk| chunk.bytes.clone()).collect::<Vec<u8>>(), entries);
    }
}
