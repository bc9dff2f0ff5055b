//! A serial device: a real one, or one half of a pseudo-terminal.

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;
use std::time::Instant;

use rustix::fs::{Mode, OFlags, open};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::error::LinkError;
use super::transport::{Event, Transport};

/// The one peer of a serial link.
const PEER: u64 = 1;
/// Frames that have to wait longer than this many bytes are lost.
const MOST_WAITING: usize = 1 << 15;
/// With more than this many bytes waiting, downloads wait.
const BUSY: usize = 1 << 10;
/// Bytes of one look.
const MOST_READ: usize = 1 << 14;

/// An open device.
#[derive(Debug)]
pub struct Serial {
    device: File,
    path: String,
    baud: u32,
    waiting: Vec<u8>,
    opened: bool,
}

impl Serial {
    /// Opens a device, raw, at a speed.
    pub fn open(path: &Path, baud: u32, link: &str) -> Result<Self, LinkError> {
        let failed = |source: rustix::io::Errno| LinkError::Device {
            path: path.display().to_string(),
            link: link.to_owned(),
            source: source.into(),
        };
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let device = open(path, flags, Mode::empty()).map_err(failed)?;
        let mut settings = tcgetattr(&device).map_err(failed)?;
        settings.make_raw();
        settings.set_speed(baud).map_err(failed)?;
        tcsetattr(&device, OptionalActions::Now, &settings).map_err(failed)?;
        Ok(Self {
            device: device.into(),
            path: path.display().to_string(),
            baud,
            waiting: Vec::new(),
            opened: false,
        })
    }
}

impl Transport for Serial {
    fn poll(&mut self, _now: Instant, room: &dyn Fn(u64) -> usize) -> Vec<Event> {
        let mut events = Vec::new();
        if !std::mem::replace(&mut self.opened, true) {
            events.push(Event::Opened(PEER));
        }
        let mut bytes = Vec::new();
        let mut piece = [0; 1024];
        let most = room(PEER).min(MOST_READ);
        while bytes.len() + piece.len() <= most {
            // Nothing yet, or the other half of a pseudo-terminal is not open (yet, or again).
            match self.device.read(&mut piece) {
                Ok(length) if length > 0 => bytes.extend_from_slice(piece.get(..length).unwrap_or_default()),
                _ => break,
            }
        }
        if !bytes.is_empty() {
            events.push(Event::Bytes(PEER, bytes));
        }
        events
    }

    fn send(&mut self, _peer: u64, bytes: &[u8]) {
        if self.waiting.len() + bytes.len() <= MOST_WAITING {
            self.waiting.extend_from_slice(bytes);
        }
    }

    fn forward(&mut self, peer: u64, bytes: &[u8]) {
        if self.waiting.len() <= MOST_WAITING / 2 {
            self.send(peer, bytes);
        }
    }

    fn has_room(&self, _peer: u64) -> bool {
        self.waiting.len() < BUSY
    }

    fn flush(&mut self) {
        while !self.waiting.is_empty() {
            match self.device.write(&self.waiting) {
                Ok(length) if length > 0 => {
                    self.waiting.drain(..length);
                }
                _ => break,
            }
        }
    }

    fn is_datagram(&self) -> bool {
        false
    }

    fn is_local(&self, _peer: u64) -> bool {
        true
    }

    fn description(&self) -> String {
        format!("serial {} at {} baud", self.path, self.baud)
    }

    fn address(&self) -> String {
        self.path.clone()
    }
}
