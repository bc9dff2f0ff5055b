//! A TCP server of many clients.
//!
//! Whoever has sent a valid frame keeps its place until the connection ends. Those that only listen, and those that are about to speak,
//! have places of their own, in which the oldest makes room.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::{Duration, Instant};

use super::descriptors::is_one_of_the_last;
use super::error::LinkError;
use super::transport::{Event, Numbers, Transport, is_nothing_yet};
use super::udp::resolve;
use crate::rarely::Rarely;

/// A client that lets this many bytes wait is too slow to be served: a frame more is lost.
const MOST_WAITING: usize = 1 << 18;
/// With more than this many bytes waiting for a client, downloads wait.
const BUSY: usize = 1 << 14;
/// Clients that have sent a valid frame.
pub(super) const MOST_SPEAKERS: usize = 32;
/// Clients that have not. When there are more, the oldest makes room, if it has had [`GRACE`] to speak.
pub(super) const MOST_LISTENERS: usize = 32;
/// A connection has this long to send a valid frame before it may have to make room.
pub(super) const GRACE: Duration = Duration::from_secs(1);
/// A client that takes no byte for this long is gone.
pub(super) const STALL: Duration = Duration::from_secs(60);
/// Connections accepted in one look.
pub(super) const MOST_ACCEPTED: usize = 8;
/// Bytes of one look at one client.
const MOST_READ: usize = 1 << 16;

#[derive(Debug)]
struct Client {
    stream: TcpStream,
    waiting: Vec<u8>,
    opened: Instant,
    /// Whether it has sent a valid frame.
    speaks: bool,
    /// Since when nothing has been written of what is waiting.
    stalled: Option<Instant>,
}

/// A listening socket and its clients.
#[derive(Debug)]
pub struct Tcp {
    listener: TcpListener,
    clients: BTreeMap<u64, Client>,
    numbers: Numbers,
    fresh: Vec<Event>,
    /// Accepted, but the process may open hardly any more files: it waits until another one is closed.
    pending: Option<TcpStream>,
    scarce: Rarely,
    full: Rarely,
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
        Ok(Self {
            listener,
            clients: BTreeMap::new(),
            numbers: Numbers::default(),
            fresh: Vec::new(),
            pending: None,
            scarce: Rarely::default(),
            full: Rarely::default(),
        })
    }

    /// Takes connections in. Those that there is no room for yet wait in the system's queue.
    fn accept(&mut self, now: Instant) {
        for _ in 0..MOST_ACCEPTED {
            let full = self.clients.values().filter(|client| !client.speaks).count() >= MOST_LISTENERS;
            if full && self.replaceable(now).is_none() {
                return;
            }
            let Some(stream) = self.next_stream(now) else { return };
            if full && let Some(oldest) = self.replaceable(now) {
                self.close(oldest);
            }
            if stream.set_nonblocking(true).is_err() {
                continue;
            }
            // Small frames must not wait for one another; without it they are only late.
            let _late = stream.set_nodelay(true);
            let number = self.numbers.next();
            let client = Client { stream, waiting: Vec::new(), opened: now, speaks: false, stalled: None };
            self.clients.insert(number, client);
            self.fresh.push(Event::Opened(number));
        }
    }

    /// The next connection, if there is one and enough descriptors are left for files.
    fn next_stream(&mut self, now: Instant) -> Option<TcpStream> {
        let stream = match self.pending.take() {
            // The copy has the lowest number that is free now.
            Some(stream) => stream.try_clone().unwrap_or(stream),
            // Nobody is there, or there is no descriptor: the next look tries again.
            None => self.listener.accept().ok()?.0,
        };
        if !is_one_of_the_last(&stream) {
            return Some(stream);
        }
        if self.scarce.is_due(now) {
            tracing::warn!("{}: a client has to wait: too many open files", self.description());
        }
        self.pending = Some(stream);
        if let Some(oldest) = self.replaceable(now) {
            self.close(oldest);
        }
        None
    }

    /// The oldest connection that has had time to speak and has not.
    fn replaceable(&self, now: Instant) -> Option<u64> {
        let oldest = self.clients.iter().find(|(_, client)| !client.speaks);
        let patient = |client: &Client| now.saturating_duration_since(client.opened) >= GRACE;
        oldest.filter(|(_, client)| patient(client)).map(|(number, _)| *number)
    }

    fn close(&mut self, number: u64) {
        self.clients.remove(&number);
        self.fresh.push(Event::Closed(number));
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

    /// Whether it has taken nothing for too long.
    fn is_stuck(&mut self, now: Instant) -> bool {
        if self.waiting.is_empty() {
            self.stalled = None;
            return false;
        }
        now.saturating_duration_since(*self.stalled.get_or_insert(now)) >= STALL
    }

    /// Sends what is waiting; `false` when the client is gone.
    fn write(&mut self) -> bool {
        while !self.waiting.is_empty() {
            match self.stream.write(&self.waiting) {
                Ok(0) => return false,
                Ok(length) => {
                    self.waiting.drain(..length);
                    self.stalled = None;
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
    fn poll(&mut self, now: Instant, room: &dyn Fn(u64) -> usize) -> Vec<Event> {
        self.accept(now);
        let mut events = std::mem::take(&mut self.fresh);
        self.clients.retain(|number, client| {
            let bytes = if client.is_stuck(now) { None } else { client.read(room(*number)) };
            let open = bytes.is_some();
            match bytes {
                Some(bytes) if bytes.is_empty() => {}
                Some(bytes) => events.push(Event::Bytes(*number, bytes)),
                None => events.push(Event::Closed(*number)),
            }
            open
        });
        events
    }

    fn confirm(&mut self, peer: u64, now: Instant) -> bool {
        let speakers = self.clients.values().filter(|client| client.speaks).count();
        match self.clients.get_mut(&peer) {
            None => false,
            Some(client) if client.speaks || speakers < MOST_SPEAKERS => {
                client.speaks = true;
                true
            }
            Some(_) => {
                if self.full.is_due(now) {
                    let link = self.description();
                    tracing::warn!("{link}: no room for a client: {MOST_SPEAKERS} are connected");
                }
                self.close(peer);
                false
            }
        }
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

#[cfg(test)]
mod tests {
    use std::io::{ErrorKind, Read};
    use std::net::TcpStream;
    use std::time::{Duration, Instant};

    use super::{Event, GRACE, MOST_ACCEPTED, MOST_LISTENERS, MOST_SPEAKERS, STALL, Tcp, Transport};

    /// A server, and looks at it until nothing more happens, at a time of its own.
    struct Bench {
        tcp: Tcp,
        start: Instant,
        opened: Vec<u64>,
        closed: Vec<u64>,
    }

    impl Bench {
        fn new() -> Self {
            let tcp = Tcp::open(("127.0.0.1", 0), "tcpin:0").expect("a free port");
            Self { tcp, start: Instant::now(), opened: Vec::new(), closed: Vec::new() }
        }

        /// Connections that the system has made: they are in the server's queue.
        fn connect(&self, count: usize) -> Vec<TcpStream> {
            (0..count).map(|_| TcpStream::connect(self.tcp.address()).expect("listening")).collect()
        }

        fn look(&mut self, after: Duration) {
            for _ in 0..MOST_SPEAKERS {
                let before = (self.opened.len(), self.closed.len());
                for event in self.tcp.poll(self.start + after, &|_| usize::MAX) {
                    match event {
                        Event::Opened(number) => self.opened.push(number),
                        Event::Closed(number) => self.closed.push(number),
                        Event::Bytes(..) => {}
                    }
                }
                assert!(self.opened.len() <= before.0 + MOST_ACCEPTED, "accepted without a bound");
                if (self.opened.len(), self.closed.len()) == before {
                    return;
                }
            }
        }
    }

    #[test]
    fn silent_connections_make_room_after_a_second_and_speakers_never() {
        let mut bench = Bench::new();
        let _speakers = bench.connect(3);
        bench.look(Duration::ZERO);
        let speakers = bench.opened.clone();
        assert!(speakers.iter().all(|number| bench.tcp.confirm(*number, bench.start)));
        let _silent = bench.connect(MOST_LISTENERS + 5);
        bench.look(Duration::ZERO);
        assert_eq!(bench.opened.len(), speakers.len() + MOST_LISTENERS, "each has a second to speak");
        assert!(bench.closed.is_empty());
        bench.look(GRACE);
        // The five oldest silent ones made room.
        assert_eq!(bench.opened.len(), speakers.len() + MOST_LISTENERS + 5);
        assert_eq!(bench.closed, bench.opened[3..8]);
        let _more = bench.connect(MOST_LISTENERS);
        bench.look(3 * GRACE);
        assert!(!bench.closed.iter().any(|number| speakers.contains(number)));
    }

    #[test]
    fn one_speaker_too_many_is_turned_away() {
        let mut bench = Bench::new();
        let now = bench.start;
        let mut streams = Vec::new();
        for _ in 0..MOST_SPEAKERS {
            streams.append(&mut bench.connect(1));
            bench.look(Duration::ZERO);
            assert!(bench.tcp.confirm(*bench.opened.last().expect("accepted"), now));
        }
        let mut last = bench.connect(1);
        bench.look(Duration::ZERO);
        let number = *bench.opened.last().expect("accepted");
        assert!(!bench.tcp.confirm(number, now));
        bench.look(Duration::ZERO);
        assert_eq!(bench.closed, [number]);
        assert_eq!(last[0].read(&mut [0]).expect("closed in order"), 0);
        assert!(bench.opened[..MOST_SPEAKERS].iter().all(|number| bench.tcp.confirm(*number, now)));
    }

    /// A client whose machine has gone takes nothing any more.
    #[test]
    fn a_client_that_takes_nothing_for_a_minute_is_closed() {
        let mut bench = Bench::new();
        let mut streams = bench.connect(1);
        bench.look(Duration::ZERO);
        let number = bench.opened[0];
        assert!(bench.tcp.confirm(number, bench.start));
        // Until neither the system nor we take more.
        for _ in 0..1000 {
            bench.tcp.send(number, &[0; 1 << 14]);
            bench.tcp.flush();
        }
        bench.look(Duration::ZERO);
        bench.look(STALL - Duration::from_secs(1));
        assert!(bench.closed.is_empty());
        streams[0].set_nonblocking(true).expect("a socket");
        let mut piece = vec![0; 1 << 20];
        while streams[0].read(&mut piece).map_err(|error| error.kind()) != Err(ErrorKind::WouldBlock) {
            bench.tcp.flush();
        }
        for _ in 0..1000 {
            bench.tcp.send(number, &[0; 1 << 14]);
            bench.tcp.flush();
        }
        bench.look(STALL);
        assert!(bench.closed.is_empty(), "it has taken something");
        bench.look(2 * STALL);
        assert_eq!(bench.closed, [number]);
    }
}
