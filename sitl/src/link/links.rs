//! All links: receiving, sending, and forwarding from one peer to the others.

use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use super::endpoint::{Endpoint, LinkSpecification};
use super::error::LinkError;
use super::peer::Peer;
use super::tcp::Tcp;
use super::transport::{Event, Transport};
use super::udp::Udp;
use crate::autopilot::COMPONENT;
use crate::codec::{Frame, target_of};
use crate::service::{Destination, Origin, Outgoing, PeerId};

/// A frame that comes back within this time by another way is the same frame.
const ECHO: Duration = Duration::from_millis(500);

/// A received frame.
#[derive(Clone, Debug)]
pub struct Received {
    /// Who sent it.
    pub origin: Origin,
    /// The frame.
    pub frame: Frame,
}

#[derive(Debug)]
struct Link {
    transport: Box<dyn Transport>,
    peers: BTreeMap<u64, Peer>,
}

/// Links, and the vehicles behind them.
#[derive(Debug)]
pub struct Links {
    /// Our systems.
    systems: Vec<u8>,
    links: Vec<Link>,
    recent: VecDeque<(Vec<u8>, PeerId, Instant)>,
}

impl Links {
    /// Opens all links, for the vehicles of some system ids.
    ///
    /// # Errors
    /// [`LinkError`] of the first one that cannot be opened.
    pub fn open(specifications: &[LinkSpecification], systems: Vec<u8>) -> Result<Self, LinkError> {
        let links = specifications
            .iter()
            .map(|specification| {
                Ok(Link { transport: transport(&specification.endpoint)?, peers: BTreeMap::new() })
            })
            .collect::<Result<_, LinkError>>()?;
        Ok(Self { systems, links, recent: VecDeque::new() })
    }

    /// For a person: where each link is.
    pub fn descriptions(&self) -> Vec<String> {
        self.links.iter().map(|link| link.transport.description()).collect()
    }

    /// Local address of each link.
    pub fn addresses(&self) -> Vec<String> {
        self.links.iter().map(|link| link.transport.address()).collect()
    }

    /// Peers that have spoken.
    pub fn active_peers(&self) -> usize {
        self.links.iter().flat_map(|link| link.peers.values()).filter(|peer| peer.has_spoken()).count()
    }

    /// Everything that has come, already forwarded to the peers that it is for.
    pub fn receive(&mut self, now: Instant) -> Vec<Received> {
        let mut received = Vec::new();
        for (index, link) in self.links.iter_mut().enumerate() {
            let mut take = |number: u64, peer: &mut Peer, frames: Vec<Frame>| {
                for frame in frames {
                    peer.learn(&frame);
                    let peer = PeerId { link: index, number };
                    let origin = Origin { peer, system: frame.system(), component: frame.component() };
                    received.push(Received { origin, frame });
                }
            };
            for event in link.transport.poll(now) {
                match event {
                    Event::Opened(number) => {
                        link.peers.insert(number, Peer::default());
                    }
                    Event::Closed(number) => {
                        link.peers.remove(&number);
                    }
                    Event::Bytes(number, bytes) => {
                        let peer = link.peers.entry(number).or_default();
                        let frames = peer.frames(&bytes, link.transport.is_datagram(), now);
                        take(number, peer, frames);
                    }
                }
            }
            for (number, peer) in &mut link.peers {
                let frames = peer.overdue(now);
                take(*number, peer, frames);
            }
        }
        received.retain(|received| self.is_news(received, now));
        for received in &received {
            self.forward(received);
        }
        received
    }

    /// Whether a frame is neither our own nor one that has come already by another way.
    fn is_news(&mut self, received: &Received, now: Instant) -> bool {
        let origin = &received.origin;
        if origin.component == COMPONENT && self.systems.contains(&origin.system) {
            return false;
        }
        while self.recent.front().is_some_and(|(_, _, when)| now.duration_since(*when) > ECHO) {
            self.recent.pop_front();
        }
        let bytes = received.frame.bytes();
        let known = self.recent.iter().any(|(seen, by, _)| *by != origin.peer && seen == bytes);
        // One peer has no one to be an echo of.
        if !known && self.links.iter().map(|link| link.peers.len()).sum::<usize>() > 1 {
            self.recent.push_back((bytes.to_vec(), origin.peer, now));
        }
        !known
    }

    /// Passes a frame on to the peers that lead to its target, unless it is for one of ours alone.
    fn forward(&mut self, received: &Received) {
        let target = target_of(&received.frame);
        if self.systems.contains(&target.system) {
            return;
        }
        let from = received.origin.peer;
        for (index, link) in self.links.iter_mut().enumerate() {
            for (number, peer) in &link.peers {
                let itself = from == PeerId { link: index, number: *number };
                // What has never spoken cannot be known not to be the sender itself, by another way.
                if !itself && peer.has_spoken() && peer.leads_to(target.system) {
                    link.transport.send(*number, received.frame.bytes());
                }
            }
        }
    }

    /// Sends a message of one of our systems and returns it as one of its frames, for a log.
    pub fn send(&mut self, outgoing: &Outgoing, system: u8) -> Option<Frame> {
        let sender = (system, COMPONENT);
        let mut sent = None;
        for (index, link) in self.links.iter_mut().enumerate() {
            for (number, peer) in &mut link.peers {
                let wanted = match outgoing.to {
                    Destination::Everyone => true,
                    Destination::Link(link) => link == index,
                    Destination::Peer(id) => id == PeerId { link: index, number: *number },
                };
                if !wanted {
                    continue;
                }
                // Messages beyond number 255 do not exist in MAVLink 1.
                let version = peer.version();
                let sequence = peer.sequences.entry(system).or_default();
                if let Some(frame) = Frame::encode(&outgoing.message, version, *sequence, sender) {
                    *sequence = sequence.wrapping_add(1);
                    link.transport.send(*number, frame.bytes());
                    sent = Some(frame);
                }
            }
        }
        sent
    }

    /// Sends what is waiting.
    pub fn flush(&mut self) {
        for link in &mut self.links {
            link.transport.flush();
        }
    }
}

fn transport(endpoint: &Endpoint) -> Result<Box<dyn Transport>, LinkError> {
    let text = endpoint.to_string();
    Ok(match endpoint {
        Endpoint::UdpOut { host, port, local_port } => {
            // To this machine from this machine; else from whichever of its addresses leads there.
            let loopback = super::udp::resolve(host, *port, &text)?.ip().is_loopback();
            let local = if loopback { "127.0.0.1" } else { "0.0.0.0" };
            Box::new(Udp::open((local, *local_port), Some((host, *port)), &text)?)
        }
        Endpoint::UdpIn { host, port } => Box::new(Udp::open((host, *port), None, &text)?),
        Endpoint::TcpIn { host, port } => Box::new(Tcp::open((host, *port), &text)?),
        #[cfg(unix)]
        Endpoint::Serial { path, baud } => Box::new(super::serial::Serial::open(path, *baud, &text)?),
        #[cfg(not(unix))]
        Endpoint::Serial { path, .. } => {
            return Err(LinkError::Device {
                path: path.display().to_string(),
                link: text,
                source: std::io::Error::new(
                    std::io::ErrorKind::Unsupported,
                    "serial links need a Unix system",
                ),
            });
        }
    })
}
