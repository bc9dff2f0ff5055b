//! What the host's standard error stream carries: messages of the logger, and lines that the FMU prints.

use std::collections::VecDeque;
use std::io::Read;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::fmi2::{Message, Status};

/// Begins a message, separates its parts, and stands for the end of a line in it.
const BEGIN: char = '\u{1}';
const PART: char = '\u{2}';
const LINE: char = '\u{3}';
/// A line of the host's own: all that was said before it has been read.
pub(super) const MARK: &str = "\n\u{4}\n";
/// Bytes of the longest line, and lines that wait to be taken.
const LONGEST: usize = 16 << 10;
const MOST: usize = 200;

/// Something that an FMU has said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Said {
    /// Through its logger.
    Message(Message),
    /// On its standard output or error stream.
    Printed(String),
    /// So many lines that were too many.
    Lost(usize),
}

/// The line of a message.
pub(super) fn line_of(message: &Message) -> String {
    let clean = |text: &str| {
        let text = text.replace(['\r', '\n'], &LINE.to_string());
        text.replace([BEGIN, PART], " ")
    };
    let number = match message.status {
        Status::Ok => 0,
        Status::Warning => 1,
        Status::Discard => 2,
        Status::Error => 3,
        Status::Fatal => 4,
        Status::Pending => 5,
        Status::Unknown(number) => number,
    };
    // What was printed before it may not have ended its line.
    format!("\n{BEGIN}{number}{PART}{}{PART}{}\n", clean(&message.category), clean(&message.text))
}

/// What a line says.
fn read_line(line: &str) -> Said {
    let printed = || Said::Printed(line.replace(char::is_control, " "));
    let Some(message) = line.strip_prefix(BEGIN) else { return printed() };
    let mut parts = message.splitn(3, PART);
    let (Some(status), Some(category), Some(text)) = (parts.next(), parts.next(), parts.next()) else {
        return printed();
    };
    let Ok(status) = status.parse::<i32>() else { return printed() };
    let text = text.replace(LINE, "\n").replace(|letter: char| letter.is_control() && letter != '\n', " ");
    Said::Message(Message { status: status.into(), category: category.to_owned(), text })
}

#[derive(Debug, Default)]
struct Waiting {
    said: VecDeque<Said>,
    lost: usize,
    marked: bool,
}

/// A thread that reads what is said, so that it never blocks the host.
#[derive(Debug)]
pub(super) struct Listener {
    waiting: Arc<Mutex<Waiting>>,
    thread: JoinHandle<()>,
}

impl Listener {
    pub(super) fn new(stream: impl Read + Send + 'static) -> Self {
        let waiting = Arc::new(Mutex::new(Waiting::default()));
        let kept = Arc::clone(&waiting);
        let thread = std::thread::spawn(move || listen(stream, &kept));
        Self { waiting, thread }
    }

    /// What has been said since the last call.
    pub(super) fn take(&self) -> Vec<Said> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let lost = std::mem::take(&mut waiting.lost);
        let lost = (lost > 0).then_some(Said::Lost(lost));
        lost.into_iter().chain(waiting.said.drain(..)).collect()
    }

    /// Waits until the host's mark has been read, or the stream has ended.
    pub(super) fn wait_for_mark(&self, longest: Duration) {
        let start = Instant::now();
        let marked =
            || std::mem::take(&mut self.waiting.lock().unwrap_or_else(PoisonError::into_inner).marked);
        while !marked() && !self.thread.is_finished() && start.elapsed() < longest {
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// Waits for the end of the stream: the host is gone. Somebody whom it has started may still have the other end.
    pub(super) fn wait(&self, longest: Duration) {
        let start = Instant::now();
        while !self.thread.is_finished() && start.elapsed() < longest {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

fn listen(mut stream: impl Read, waiting: &Mutex<Waiting>) {
    let mut line = Vec::new();
    let mut bytes = [0; 4096];
    let end = |line: &mut Vec<u8>| {
        let text = String::from_utf8_lossy(line).trim_end().to_owned();
        line.clear();
        if text.is_empty() {
            return;
        }
        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        if text == MARK.trim_matches('\n') {
            waiting.marked = true;
            return;
        }
        if waiting.said.len() >= MOST {
            // The latest are those that tell why it crashed.
            waiting.said.pop_front();
            waiting.lost += 1;
        }
        waiting.said.push_back(read_line(&text));
    };
    loop {
        let count = match stream.read(&mut bytes) {
            Ok(0) => break,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(_) => break,
            Ok(count) => count,
        };
        for byte in bytes.iter().take(count) {
            match byte {
                b'\n' => end(&mut line),
                _ if line.len() < LONGEST => line.push(*byte),
                _ => {}
            }
        }
    }
    end(&mut line);
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Listener, MOST, Message, Said, Status, line_of};

    fn heard(bytes: Vec<u8>) -> Vec<Said> {
        let listener = Listener::new(std::io::Cursor::new(bytes));
        listener.wait(Duration::from_secs(10));
        listener.take()
    }

    #[test]
    fn messages_and_lines_are_told_apart() {
        let message = |status| Message {
            status,
            category: "logAll".to_owned(),
            text: "two\nlines, and a \u{1}".to_owned(),
        };
        let mut bytes = b"printed without end".to_vec();
        bytes.extend(line_of(&message(Status::Error)).bytes());
        bytes.extend(line_of(&message(Status::Unknown(-3))).bytes());
        bytes.extend(b"bytes \xff\x01\n");
        let text = "two\nlines, and a".to_owned();
        let expected = [
            Said::Printed("printed without end".to_owned()),
            Said::Message(Message { text: text.clone(), ..message(Status::Error) }),
            Said::Message(Message { text, ..message(Status::Unknown(-3)) }),
            Said::Printed("bytes \u{fffd} ".to_owned()),
        ];
        assert_eq!(heard(bytes), expected);
    }

    #[test]
    fn a_flood_leaves_its_end() {
        let said = heard((0..1000).flat_map(|number| format!("line {number}\n").into_bytes()).collect());
        assert_eq!(said.first(), Some(&Said::Lost(1000 - MOST)));
        assert_eq!(said.last(), Some(&Said::Printed("line 999".to_owned())));
    }
}
