//! A log on its way to a client: whoever writes the log fills the queue, a service empties it.

use std::collections::VecDeque;

/// Bytes of a log that one message carries.
pub const MOST_BYTES: usize = 249;
/// Chunks that wait for the link, beside those that must arrive: half a second of a log.
const MOST_WAITING: usize = 512;

/// A piece of a log.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct LogChunk {
    /// At most [`MOST_BYTES`].
    pub bytes: Vec<u8>,
    /// Where the first entry of the log begins that begins in it.
    pub first_entry: Option<u8>,
    /// Whether the log cannot be read without it.
    pub must_arrive: bool,
}

/// What waits to be sent.
#[derive(Debug, Default)]
pub struct LogQueue {
    stream: Option<u32>,
    streams: u32,
    chunks: VecDeque<LogChunk>,
}

impl LogQueue {
    /// Number of the log that somebody wants to have: each stream is a log of its own.
    pub fn stream(&self) -> Option<u32> {
        self.stream
    }

    /// Whether what is next must arrive: nothing else goes before it.
    pub fn next_must_arrive(&self) -> bool {
        self.next().is_some_and(|chunk| chunk.must_arrive)
    }

    /// What waits, the next first.
    pub fn waiting(&self) -> impl Iterator<Item = &LogChunk> {
        self.chunks.iter()
    }

    /// Whether more data may come.
    pub fn has_room(&self) -> bool {
        self.chunks.len() < MOST_WAITING
    }

    /// Appends a chunk of the present log.
    pub fn push(&mut self, chunk: LogChunk) {
        self.chunks.push_back(chunk);
    }

    /// Asks for a new log.
    pub(crate) fn open(&mut self) {
        self.streams += 1;
        self.stream = Some(self.streams);
        self.chunks.clear();
    }

    /// Nobody wants a log any more.
    pub(crate) fn close(&mut self) {
        self.stream = None;
        self.chunks.clear();
    }

    /// The chunk that is next.
    pub(crate) fn next(&self) -> Option<&LogChunk> {
        self.chunks.front()
    }

    /// The next chunk is done with.
    pub(crate) fn advance(&mut self) {
        self.chunks.pop_front();
    }
}
