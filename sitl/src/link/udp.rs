//! UDP: one socket, many peers.
//!
//! Whoever sends a datagram is a stranger until a valid frame of it is accepted; nothing is sent to strangers, and no peer makes room
//! for one. Frames for a peer share datagrams: most of what sending costs is by the datagram.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::net::{SocketAddr, ToSocketAddrs};
use std::time::{Duration, Instant};

use mio::net::UdpSocket;

use super::error::LinkError;
use super::readiness::{Arrivals, Readiness};
use super::strangers::Strangers;
use super::transport::{Event, Numbers, Transport};
use crate::rarely::Rarely;

/// A peer that has sent no valid frame for this long is forgotten.
pub(super) const EXPIRY: Duration = Duration::from_secs(60);
/// Peers of one socket. The one that has been silent longest makes room for another, if it has been silent for [`PAUSE`].
pub(super) const MOST_PEERS: usize = 32;
/// A silent peer keeps its place for this long, whoever else wants it.
pub(super) const PAUSE: Duration = Duration::from_secs(5);
/// Datagrams and bytes of one look: a flood must not keep the vehicle from flying.
const MOST_DATAGRAMS: usize = 512;
const MOST_BYTES: usize = 1 << 20;
/// The largest MAVLink frame has 280 bytes; some senders put several into a datagram.
const DATAGRAM: usize = 65_536;
/// Bytes of the frames that share a datagram of ours. mavlink-router reads no more of one, MAVSDK 2048 and others all; it fits into the
/// packets of any network.
pub(super) const MOST_SHARED: usize = 4 * 280;

#[derive(Debug)]
struct Peer {
    address: SocketAddr,
    heard: Instant,
    permanent: bool,
    /// Whole frames of the datagram that leaves next.
    waiting: Vec<u8>,
}

impl Peer {
    fn new(address: SocketAddr, heard: Instant, permanent: bool) -> Self {
        Self { address, heard, permanent, waiting: Vec::with_capacity(MOST_SHARED) }
    }

    fn add(&mut self, frame: &[u8], socket: &UdpSocket) {
        if self.waiting.len() + frame.len() > MOST_SHARED {
            self.flush(socket);
        }
        self.waiting.extend_from_slice(frame);
    }

    fn flush(&mut self, socket: &UdpSocket) {
        if !self.waiting.is_empty() {
            // A datagram may be lost, here as anywhere on its way.
            let _lost = socket.send_to(&self.waiting, self.address);
            self.waiting.clear();
        }
    }
}

/// A UDP socket.
#[derive(Debug)]
pub struct Udp {
    socket: UdpSocket,
    arrivals: Arrivals,
    target: Option<SocketAddr>,
    peers: BTreeMap<u64, Peer>,
    strangers: Strangers,
    numbers: Numbers,
    fresh: Vec<Event>,
    buffer: Vec<u8>,
    full: Rarely,
}

impl Udp {
    /// A socket on a local address, with a peer to send to from the start if there is a target.
    pub fn open(
        local: (&str, u16),
        target: Option<(&str, u16)>,
        link: &str,
        readiness: &mut Readiness,
    ) -> Result<Self, LinkError> {
        let failed = |source| LinkError::Socket {
            what: format!("UDP port {}:{}", local.0, local.1),
            link: link.to_owned(),
            source,
        };
        let target = target.map(|(host, port)| resolve(host, port, link)).transpose()?;
        let mut socket = UdpSocket::bind(resolve(local.0, local.1, link)?).map_err(failed)?;
        let mut udp = Self {
            arrivals: readiness.watch(&mut socket),
            socket,
            target,
            peers: BTreeMap::new(),
            strangers: Strangers::default(),
            numbers: Numbers::default(),
            fresh: Vec::new(),
            buffer: vec![0; DATAGRAM],
            full: Rarely::default(),
        };
        if let Some(address) = target {
            let number = udp.numbers.next();
            udp.peers.insert(number, Peer::new(address, Instant::now(), true));
            udp.fresh.push(Event::Opened(number));
        }
        Ok(udp)
    }

    /// The number of a peer or stranger.
    fn number_of(&mut self, address: SocketAddr) -> u64 {
        match self.peers.iter().find(|(_, peer)| peer.address == address) {
            Some((number, _)) => *number,
            None => self.strangers.number_of(address, || self.numbers.next()),
        }
    }

    /// Whether there is room for another peer, made by one that is silent if need be.
    fn make_room(&mut self, address: SocketAddr, now: Instant) -> bool {
        if self.peers.len() < MOST_PEERS {
            return true;
        }
        let silent = |peer: &Peer| !peer.permanent && now.saturating_duration_since(peer.heard) >= PAUSE;
        let silent = self.peers.iter().filter(|(_, peer)| silent(peer));
        let longest = silent.min_by_key(|(_, peer)| peer.heard).map(|(number, _)| *number);
        if let Some(number) = longest {
            self.peers.remove(&number);
            self.fresh.push(Event::Closed(number));
        } else if self.full.is_due(now) {
            tracing::warn!("{}: no room for {address}: {MOST_PEERS} clients are active", self.description());
        }
        longest.is_some()
    }
}

/// The address of a host.
pub fn resolve(host: &str, port: u16, link: &str) -> Result<SocketAddr, LinkError> {
    let unknown = || LinkError::Host { host: host.to_owned(), link: link.to_owned() };
    (host, port).to_socket_addrs().ok().and_then(|mut addresses| addresses.next()).ok_or_else(unknown)
}

impl Transport for Udp {
    fn poll(&mut self, now: Instant, _room: &dyn Fn(u64) -> usize) -> Vec<Event> {
        let mut events = std::mem::take(&mut self.fresh);
        let (mut datagrams, mut bytes_read) = (0, 0);
        // What there is no room for is read as well: it must not keep those of other peers out of the socket.
        while self.arrivals.are_expected() && datagrams < MOST_DATAGRAMS && bytes_read < MOST_BYTES {
            datagrams += 1;
            match self.socket.recv_from(&mut self.buffer) {
                Ok((length, address)) => {
                    bytes_read += length;
                    let number = self.number_of(address);
                    let bytes = self.buffer.get(..length).unwrap_or_default().to_vec();
                    events.push(Event::Bytes(number, bytes));
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => self.arrivals.are_over(),
                Err(error) if error.kind() == ErrorKind::Interrupted => break,
                // Nobody listens at a peer (yet): some systems tell it here.
                Err(_) => {}
            }
        }
        self.peers.retain(|number, peer| {
            let stays = peer.permanent || now.duration_since(peer.heard) < EXPIRY;
            if !stays {
                events.push(Event::Closed(*number));
            }
            stays
        });
        events
    }

    fn confirm(&mut self, peer: u64, now: Instant) -> bool {
        if let Some(peer) = self.peers.get_mut(&peer) {
            peer.heard = now;
            return true;
        }
        let Some(address) = self.strangers.take(peer) else { return false };
        let room = self.make_room(address, now);
        if room {
            self.peers.insert(peer, Peer::new(address, now, false));
        }
        room
    }

    fn may_be_forged(&self, peer: u64) -> bool {
        self.peers.get(&peer).is_some_and(|peer| !peer.permanent) && !self.is_local(peer)
    }

    fn send(&mut self, peer: u64, bytes: &[u8]) {
        if let Some(peer) = self.peers.get_mut(&peer) {
            peer.add(bytes, &self.socket);
        }
    }

    fn flush(&mut self) {
        self.peers.values_mut().for_each(|peer| peer.flush(&self.socket));
    }

    fn is_datagram(&self) -> bool {
        true
    }

    fn is_local(&self, peer: u64) -> bool {
        self.peers.get(&peer).is_some_and(|peer| peer.address.ip().to_canonical().is_loopback())
    }

    fn description(&self) -> String {
        match self.target {
            Some(target) => format!("UDP to {target} from {}", self.address()),
            None => format!("UDP on {}", self.address()),
        }
    }

    fn address(&self) -> String {
        self.socket.local_addr().map_or_else(|_| "?".to_owned(), |address| address.to_string())
    }
}

#[cfg(test)]
mod tests {
    use std::net::UdpSocket;
    use std::time::{Duration, Instant};

    use super::{EXPIRY, Event, MOST_PEERS, MOST_SHARED, PAUSE, Readiness, Transport, Udp};

    struct Bench {
        udp: Udp,
        readiness: Readiness,
        start: Instant,
    }

    impl Bench {
        fn new(target: Option<(&str, u16)>) -> Self {
            let mut readiness = Readiness::default();
            let udp = Udp::open(("127.0.0.1", 0), target, "udpin:0", &mut readiness).expect("a free port");
            Self { udp, readiness, start: Instant::now() }
        }

        fn sender(&self) -> UdpSocket {
            let sender = UdpSocket::bind("127.0.0.1:0").expect("a free port");
            sender.connect(self.udp.address()).expect("an address");
            sender
        }

        /// What happens until the bytes of a sender come: on loopback, at once.
        fn hear(&mut self, sender: &UdpSocket, after: Duration) -> (u64, Vec<Event>) {
            sender.send(b"?").expect("sent");
            let mut others = Vec::new();
            loop {
                self.readiness.look();
                for event in self.udp.poll(self.start + after, &|_| usize::MAX) {
                    match event {
                        Event::Bytes(number, _) => return (number, others),
                        other => others.push(other),
                    }
                }
            }
        }
    }

    fn hears(receiver: &UdpSocket) -> bool {
        receiver.set_nonblocking(true).expect("a socket");
        receiver.recv(&mut [0; 8]).is_ok()
    }

    #[test]
    fn a_sender_is_a_stranger_until_it_is_confirmed() {
        let mut bench = Bench::new(None);
        let sender = bench.sender();
        let (number, events) = bench.hear(&sender, Duration::ZERO);
        assert_eq!(events, []);
        bench.udp.send(number, b"!");
        bench.udp.flush();
        assert!(!hears(&sender), "nothing is sent to strangers");
        assert!(bench.udp.confirm(number, bench.start));
        bench.udp.send(number, b"!");
        assert!(!hears(&sender), "more may follow");
        bench.udp.flush();
        assert!(hears(&sender));
        bench.udp.flush();
        assert!(!hears(&sender), "sent once");
        // Bytes alone do not keep its place.
        assert_eq!(bench.hear(&sender, EXPIRY - PAUSE).0, number);
        assert_eq!(bench.udp.poll(bench.start + EXPIRY, &|_| usize::MAX), [Event::Closed(number)]);
        assert_ne!(bench.hear(&sender, EXPIRY).0, number);
    }

    #[test]
    fn frames_share_datagrams_and_none_is_cut() {
        let receiver = UdpSocket::bind("127.0.0.1:0").expect("a free port");
        receiver.set_read_timeout(Some(Duration::from_secs(5))).expect("a socket");
        let port = receiver.local_addr().expect("an address").port();
        let mut bench = Bench::new(Some(("127.0.0.1", port)));
        // Of any lengths that frames have; the last ones fill a datagram to the byte.
        let lengths = (12..=280).step_by(7).chain([280; 8]);
        let frames: Vec<Vec<u8>> = lengths.zip(0..).map(|(length, number)| vec![number; length]).collect();
        frames.iter().for_each(|frame| bench.udp.send(1, frame));
        bench.udp.flush();
        let mut datagrams = Vec::new();
        while datagrams.iter().map(Vec::len).sum::<usize>() < frames.concat().len() {
            let mut datagram = vec![0; 65_536];
            let length = receiver.recv(&mut datagram).expect("all frames come");
            datagrams.push(datagram[..length].to_vec());
        }
        assert_eq!(datagrams.concat(), frames.concat(), "whole and in their order");
        let mut rest = frames.iter().peekable();
        for datagram in &datagrams {
            let mut whole = 0;
            while whole < datagram.len() {
                whole += rest.next().expect("a frame").len();
            }
            assert_eq!(whole, datagram.len(), "a frame is cut");
            assert!(whole <= MOST_SHARED, "{whole}");
            assert!(
                rest.peek().is_none_or(|next| whole + next.len() > MOST_SHARED),
                "there was room for more"
            );
        }
    }

    #[test]
    fn peers_make_room_for_peers_and_only_when_they_are_silent() {
        let mut bench = Bench::new(Some(("127.0.0.1", 9)));
        let senders: Vec<_> = (0..MOST_PEERS).map(|_| bench.sender()).collect();
        let numbers: Vec<u64> = senders.iter().map(|sender| bench.hear(sender, Duration::ZERO).0).collect();
        let (last, first) = numbers.split_last().expect("many");
        // The target has one of the places.
        assert!(first.iter().all(|number| bench.udp.confirm(*number, bench.start)));
        assert!(!bench.udp.confirm(*last, bench.start), "full of active ones");
        // Strangers come and go.
        for _ in 0..3 {
            bench.hear(&senders[MOST_PEERS - 1], PAUSE / 2);
        }
        assert_eq!(bench.udp.poll(bench.start + PAUSE / 2, &|_| usize::MAX), []);
        let later = bench.start + PAUSE;
        assert!(first[1..].iter().all(|number| bench.udp.confirm(*number, later)));
        let (number, _) = bench.hear(&senders[MOST_PEERS - 1], PAUSE);
        assert!(bench.udp.confirm(number, later));
        assert_eq!(
            bench.udp.poll(later, &|_| usize::MAX),
            [Event::Closed(first[0])],
            "the silent one, and not the target"
        );
    }
}
