//! The autopilot's connection.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use autopilot::codec::{Frame, FrameDecoder, Message, Version};

use crate::link::is_nothing_yet;

/// Component of a simulator, as Gazebo's has it.
const COMPONENT: u8 = 200;
/// An autopilot that reads nothing for this long is disconnected.
const STUCK: Duration = Duration::from_secs(2);
/// Bytes of one look.
const MOST_READ: usize = 1 << 16;

/// The connection has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gone;

/// A connected autopilot.
#[derive(Debug)]
pub struct Client {
    stream: TcpStream,
    decoder: FrameDecoder,
    system: u8,
    sequence: u8,
}

impl Client {
    /// A client on an accepted connection.
    pub fn new(stream: TcpStream, system: u8) -> std::io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(STUCK))?;
        Ok(Self { stream, decoder: FrameDecoder::default(), system, sequence: 0 })
    }

    /// Sends messages.
    pub fn send(&mut self, messages: impl IntoIterator<Item = impl Into<Message>>) -> Result<(), Gone> {
        let mut bytes = Vec::new();
        for message in messages {
            let sender = (self.system, COMPONENT);
            if let Some(frame) = Frame::encode(&message.into(), Version::Two, self.sequence, sender) {
                self.sequence = self.sequence.wrapping_add(1);
                bytes.extend_from_slice(frame.bytes());
            }
        }
        self.stream.set_nonblocking(false).map_err(|_| Gone)?;
        self.stream.write_all(&bytes).map_err(|_| Gone)
    }

    /// Received frames; with `wait`, blocks up to that long for the first.
    pub fn receive(&mut self, wait: Option<Duration>) -> Result<Vec<Frame>, Gone> {
        self.stream.set_nonblocking(wait.is_none()).map_err(|_| Gone)?;
        if wait.is_some() {
            self.stream.set_read_timeout(wait).map_err(|_| Gone)?;
        }
        let mut piece = [0; 4096];
        let mut frames = Vec::new();
        let mut length = 0;
        while length < MOST_READ {
            match self.stream.read(&mut piece) {
                Ok(0) => return Err(Gone),
                Ok(read) => {
                    length += read;
                    frames.extend(self.decoder.push(piece.get(..read).unwrap_or_default()));
                    if read < piece.len() {
                        break;
                    }
                }
                // A wait that has ended is told as either, depending on the system.
                Err(error) if is_nothing_yet(&error) || error.kind() == std::io::ErrorKind::TimedOut => break,
                Err(_) => return Err(Gone),
            }
        }
        Ok(frames)
    }

    /// Bytes so far that were not part of a frame.
    pub fn rejected_bytes(&self) -> u64 {
        self.decoder.rejected_bytes()
    }
}
