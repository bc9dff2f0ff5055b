//! A TCP server of many clients.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::Instant;

use super::error::LinkError;
use super::transport::{Event, Numbers, Transport, is_nothing_yet};
use super::udp::resolve;

/// A client that lets this many bytes wait is too slow to be served: a frame more is lost.
const MOST_WAITING: usize = 1 << 18;
/// With more than this many bytes waiting for a client, downloads wait.
const BUSY: usize = 1 << 14;
/// Clients at the same time.
const MOST_CLIENTS: usize = 32;
/// Bytes of one look at one client.
const MOST_READ: usize = 1 << 16;

#[derive(Debug)]
struct Client {
    stream: TcpStream,
    waiting: Vec<u8>,
}

/// A listening socket and its clients.
#[derive(Debug)]
pub struct Tcp {
    listener: TcpListener,
    clients: BTreeMap<u64, Client>,
    numbers: Numbers,
}

impl Tcp {
    /// Listens.
    pub fn open(local: (&str, u16), link: &str) -> Result<Self, LinkError> {
        let failed = |source| LinkError::Socket {
            what: format!("TCP port {}:{}", local.0, local.1),
            link: link.to_owned(),
            source,
        };
        let listener = TcpListener::bind(resolve(local.0, local.1, link)?).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        Ok(Self { listener, clients: BTreeMap::new(), numbers: Numbers::default() })
    }

    fn accept(&mut self) -> Option<u64> {
        let (stream, _) = self.listener.accept().ok()?;
        // A client that cannot be served is dropped, which closes its connection.
        if self.clients.len() >= MOST_CLIENTS || stream.set_nonblocking(true).is_err() {
            return None;
        }
        // Small frames must not wait for one another; without it they are only late.
        let _late = stream.set_nodelay(true);
        let number = self.numbers.next();
        self.clients.insert(number, Client { stream, waiting: Vec::new() });
        Some(number)
    }
}

impl Client {
    /// Bytes that have come, no more than there is room for; `None` when the client is gone.
    fn read(&mut self, room: usize) -> Option<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut piece = [0; 4096];
        while bytes.len() + piece.len() <= room.min(MOST_READ) {
            match self.stream.read(&mut piece) {
                Ok(0) => return (!bytes.is_empty()).then_some(bytes),
                Ok(length) => bytes.extend_from_slice(piece.get(..length).unwrap_or_default()),
                Err(error) if is_nothing_yet(&error) => break,
                Err(_) => return None,
            }
        }
        Some(bytes)
    }

    /// Sends what is waiting; `false` when the client is gone.
    fn write(&mut self) -> bool {
        while !self.waiting.is_empty() {
            match self.stream.write(&self.waiting) {
                Ok(0) => return false,
                Ok(length) => {
                    self.waiting.drain(..length);
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => return true,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return false,
            }
        }
        true
    }
}

impl Transport for Tcp {
    fn poll(&mut self, _now: Instant, room: &dyn Fn(u64) -> usize) -> Vec<Event> {
        let mut events = Vec::new();
        while let Some(number) = self.accept() {
            events.push(Event::Opened(number));
        }
        self.clients.retain(|number, client| match client.read(room(*number)) {
            Some(bytes) => {
                if !bytes.is_empty() {
                    events.push(Event::Bytes(*number, bytes));
                }
                true
            }
            None => {
                events.push(Event::Closed(*number));
                false
            }
        });
        events
    }

    fn send(&mut self, peer: u64, bytes: &[u8]) {
        if let Some(client) = self.clients.get_mut(&peer) {
            // Whole frames only: half a frame would cost the next one, too.
            if client.waiting.len() + bytes.len() <= MOST_WAITING {
                client.waiting.extend_from_slice(bytes);
            }
        }
    }

    fn forward(&mut self, peer: u64, bytes: &[u8]) {
        if self.clients.get(&peer).is_some_and(|client| client.waiting.len() <= MOST_WAITING / 2) {
            self.send(peer, bytes);
        }
    }

    fn has_room(&self, peer: u64) -> bool {
        self.clients.get(&peer).is_some_and(|client| client.waiting.len() < BUSY)
    }

    fn flush(&mut self) {
        for client in self.clients.values_mut() {
            if !client.write() {
                // The next look finds it closed.
                let _closed = client.stream.shutdown(std::net::Shutdown::Both);
                client.waiting.clear();
            }
        }
    }

    fn is_datagram(&self) -> bool {
        false
    }

    fn is_local(&self, peer: u64) -> bool {
        let address = self.clients.get(&peer).and_then(|client| client.stream.peer_addr().ok());
        address.is_some_and(|address| address.ip().to_canonical().is_loopback())
    }

    fn description(&self) -> String {
        format!("TCP server on {}", self.address())
    }

    fn address(&self) -> String {
        self.listener.local_addr().map_or_else(|_| "?".to_owned(), |address| address.to_string())
    }
}
