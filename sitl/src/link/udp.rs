//! UDP: one socket, many peers.

use std::collections::BTreeMap;
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::{Duration, Instant};

use super::error::LinkError;
use super::transport::{Event, Numbers, Transport, is_nothing_yet};

/// A peer that has been silent for this long is forgotten.
const EXPIRY: Duration = Duration::from_secs(60);
/// Peers of one socket; the one that has been silent longest makes room.
const MOST_PEERS: usize = 32;
/// Datagrams and bytes of one look: a flood must not keep the vehicle from flying.
const MOST_DATAGRAMS: usize = 512;
const MOST_BYTES: usize = 1 << 20;
/// The largest MAVLink frame has 280 bytes; some senders put several into a datagram.
const DATAGRAM: usize = 65_536;

#[derive(Debug)]
struct Peer {
    address: SocketAddr,
    heard: Instant,
    permanent: bool,
}

/// A UDP socket.
#[derive(Debug)]
pub struct Udp {
    socket: UdpSocket,
    target: Option<SocketAddr>,
    peers: BTreeMap<u64, Peer>,
    numbers: Numbers,
    fresh: Vec<Event>,
    buffer: Vec<u8>,
}

impl Udp {
    /// A socket on a local address, with a peer to send to from the start if there is a target.
    pub fn open(local: (&str, u16), target: Option<(&str, u16)>, link: &str) -> Result<Self, LinkError> {
        let failed = |source| LinkError::Socket {
            what: format!("UDP port {}:{}", local.0, local.1),
            link: link.to_owned(),
            source,
        };
        let target = target.map(|(host, port)| resolve(host, port, link)).transpose()?;
        let socket = UdpSocket::bind(resolve(local.0, local.1, link)?).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        let mut udp = Self {
            socket,
            target,
            peers: BTreeMap::new(),
            numbers: Numbers::default(),
            fresh: Vec::new(),
            buffer: vec![0; DATAGRAM],
        };
        if let Some(address) = target {
            udp.number_of(address, Instant::now(), true);
        }
        Ok(udp)
    }

    fn number_of(&mut self, address: SocketAddr, now: Instant, permanent: bool) -> u64 {
        if let Some((number, peer)) = self.peers.iter_mut().find(|(_, peer)| peer.address == address) {
            peer.heard = now;
            return *number;
        }
        if self.peers.len() >= MOST_PEERS {
            let oldest =
                self.peers.iter().filter(|(_, peer)| !peer.permanent).min_by_key(|(_, peer)| peer.heard);
            if let Some(number) = oldest.map(|(number, _)| *number) {
                self.peers.remove(&number);
                self.fresh.push(Event::Closed(number));
            }
        }
        let number = self.numbers.next();
        self.peers.insert(number, Peer { address, heard: now, permanent });
        self.fresh.push(Event::Opened(number));
        number
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
        while datagrams < MOST_DATAGRAMS && bytes_read < MOST_BYTES {
            datagrams += 1;
            match self.socket.recv_from(&mut self.buffer) {
                Ok((length, address)) => {
                    let number = self.number_of(address, now, false);
                    events.append(&mut self.fresh);
                    bytes_read += length;
                    let bytes = self.buffer.get(..length).unwrap_or_default().to_vec();
                    events.push(Event::Bytes(number, bytes));
                }
                Err(error) if is_nothing_yet(&error) => break,
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

    fn send(&mut self, peer: u64, bytes: &[u8]) {
        if let Some(peer) = self.peers.get(&peer) {
            // A datagram may be lost, here as anywhere on its way.
            let _lost = self.socket.send_to(bytes, peer.address);
        }
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
