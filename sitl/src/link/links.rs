//! All links: receiving, sending, and forwarding from one peer to the others.

use std::collections::BTreeMap;
use std::time::Instant;

use autopilot::COMPONENT;
use autopilot::codec::{Frame, Version, id, target_of};
use autopilot::envelope::{Destination, Origin, Outgoing, PeerId};

use super::echo::Echoes;
use super::endpoint::{Endpoint, LinkSpecification};
use super::error::LinkError;
use super::peer::Peer;
use super::signing_setup::{SetupRules, SigningSetup};
use super::tcp::Tcp;
use super::transport::{Event, Transport};
use super::udp::Udp;
use crate::signing::Signing;

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
    echoes: Echoes,
    signing: Signing,
    setup_rules: SetupRules,
    setups: Vec<SigningSetup>,
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
        Ok(Self {
            systems,
            links,
            echoes: Echoes::default(),
            signing: Signing::default(),
            setup_rules: SetupRules::default(),
            setups: Vec::new(),
        })
    }

    /// Signs and verifies from now on.
    pub fn sign_with(&mut self, signing: Signing) {
        self.signing = signing;
    }

    /// What is signed with; its clock is the caller's to advance.
    pub fn signing(&mut self) -> &mut Signing {
        &mut self.signing
    }

    /// Sets who may change the key from now on.
    pub fn set_setup_rules(&mut self, rules: SetupRules) {
        self.setup_rules = rules;
    }

    /// Attempts to change the key since the last call. They are acted upon already, and neither forwarded nor returned
    /// as received: the key goes nowhere.
    pub fn take_setups(&mut self) -> Vec<SigningSetup> {
        std::mem::take(&mut self.setups)
    }

    /// Each link's address, for people.
    pub fn descriptions(&self) -> Vec<String> {
        self.links.iter().map(|link| link.transport.description()).collect()
    }

    /// Local address of each link.
    pub fn addresses(&self) -> Vec<String> {
        self.links.iter().map(|link| link.transport.address()).collect()
    }

    /// Number of peers that have sent something.
    pub fn active_peers(&self) -> usize {
        self.links.iter().flat_map(|link| link.peers.values()).filter(|peer| peer.has_spoken()).count()
    }

    /// Frames that were received and accepted; they are already forwarded to the peers they are for.
    pub fn receive(&mut self, now: Instant) -> Vec<Received> {
        let mut received = self.poll(now);
        received.retain(|received| self.is_accepted(received, now));
        for received in &received {
            self.forward(received);
        }
        received
    }

    fn poll(&mut self, now: Instant) -> Vec<Received> {
        let mut received = Vec::new();
        for (index, link) in self.links.iter_mut().enumerate() {
            let mut take = |number: u64, frames: Vec<Frame>| {
                for frame in frames {
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
                        take(number, frames);
                    }
                }
            }
            for (number, peer) in &mut link.peers {
                let frames = peer.overdue(now);
                take(*number, frames);
            }
        }
        received
    }

    /// Whether a frame goes on from here. What is refused teaches nothing about who sent it.
    fn is_accepted(&mut self, received: &Received, now: Instant) -> bool {
        let news = self.is_news(received, now);
        if if news { self.signing.verify(&received.frame).is_err() } else { self.signing.is_on() } {
            return false;
        }
        let PeerId { link, number } = received.origin.peer;
        let ours = self.is_for_us(&received.frame);
        let Some(link) = self.links.get_mut(link) else { return false };
        if let Some(peer) = link.peers.get_mut(&number) {
            peer.learn(&received.frame);
        }
        if received.frame.message_id() == id::SETUP_SIGNING {
            if news && ours {
                let local = link.transport.is_local(number);
                let (rules, signing) = (self.setup_rules, &mut self.signing);
                let setup = SigningSetup::carry_out(&received.frame, local, rules, signing);
                // A flood of refused ones says nothing new.
                if setup.is_change() || self.setups.last() != Some(&setup) {
                    self.setups.push(setup);
                }
            }
            return false;
        }
        news
    }

    fn is_for_us(&self, frame: &Frame) -> bool {
        let target = target_of(frame);
        self.systems.iter().any(|system| target.is_autopilot(*system))
    }

    /// Whether a frame is neither our own nor one that has come already by another way.
    fn is_news(&mut self, received: &Received, now: Instant) -> bool {
        let origin = &received.origin;
        if origin.component == COMPONENT && self.systems.contains(&origin.system) {
            return false;
        }
        let known = self.echoes.has(&received.frame, origin.peer, now);
        // One peer has no one to be an echo of, and a key is not remembered.
        let secret = received.frame.message_id() == id::SETUP_SIGNING;
        if !known && !secret && self.links.iter().map(|link| link.peers.len()).sum::<usize>() > 1 {
            self.echoes.remember(&received.frame, origin.peer, now);
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
                // MAVLink 1 has no signatures.
                let version = if self.signing.is_on() { Version::Two } else { peer.version() };
                // Messages beyond number 255 do not exist in MAVLink 1.
                let sequence = peer.sequences.entry(system).or_default();
                if let Some(frame) = Frame::encode(&outgoing.message, version, *sequence, sender) {
                    let frame = self.signing.sign(frame, index as u8);
                    *sequence = sequence.wrapping_add(1);
                    link.transport.send(*number, frame.bytes());
                    sent = Some(frame);
                }
            }
        }
        sent
    }

    /// Whether a peer takes more than the telemetry without losing it; `None`: it is gone.
    pub fn has_room(&self, peer: PeerId) -> Option<bool> {
        let link = self.links.get(peer.link)?;
        link.peers.contains_key(&peer.number).then(|| link.transport.has_room(peer.number))
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::{Arc, Mutex};
    use std::time::Instant;

    use mavlink::dialects::common::{HEARTBEAT_DATA, MavMessage, SETUP_SIGNING_DATA};

    use super::{Echoes, Link, Links};
    use crate::link::transport::{Event, Transport};
    use crate::link::{SetupRefusal, SetupRules, SigningSetup};
    use crate::signing::{SecretKey, Signing};
    use autopilot::codec::{Frame, Message, Version};
    use autopilot::envelope::{Destination, Outgoing};

    /// What the clock shows.
    const NOW: u64 = 50;

    type Bytes = Arc<Mutex<Vec<Vec<u8>>>>;

    /// A link whose two ends are lists.
    #[derive(Debug)]
    struct Ends {
        inward: Bytes,
        outward: Bytes,
        local: bool,
    }

    impl Transport for Ends {
        fn poll(&mut self, _now: Instant) -> Vec<Event> {
            let mut waiting = self.inward.lock().expect("one thread");
            waiting.drain(..).map(|bytes| Event::Bytes(1, bytes)).collect()
        }

        fn send(&mut self, _peer: u64, bytes: &[u8]) {
            self.outward.lock().expect("one thread").push(bytes.to_vec());
        }

        fn is_datagram(&self) -> bool {
            true
        }

        fn is_local(&self, _peer: u64) -> bool {
            self.local
        }

        fn description(&self) -> String {
            String::new()
        }

        fn address(&self) -> String {
            String::new()
        }
    }

    /// A vehicle with one link to this machine and one from afar, and their ends.
    fn links() -> (Links, [(Bytes, Bytes); 2]) {
        let ends: [(Bytes, Bytes); 2] = Default::default();
        let of = |(inward, outward): &(Bytes, Bytes), local| Link {
            transport: Box::new(Ends { inward: inward.clone(), outward: outward.clone(), local }),
            peers: BTreeMap::new(),
        };
        let links = vec![of(&ends[0], true), of(&ends[1], false)];
        let setup_rules = SetupRules { without_key: true, armed: false };
        let mut signing = Signing::default();
        signing.set_clock(NOW);
        let (echoes, setups) = (Echoes::default(), Vec::new());
        (Links { systems: vec![1], links, echoes, signing, setup_rules, setups }, ends)
    }

    fn frame(message: MavMessage, system: u8) -> Frame {
        Frame::encode(&message.into(), Version::Two, 0, (system, 190)).expect("a message of MAVLink 2")
    }

    fn heartbeat(system: u8) -> Frame {
        frame(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()), system)
    }

    fn setup(key: u8, target_system: u8) -> Frame {
        let setup = SETUP_SIGNING_DATA {
            initial_timestamp: NOW,
            target_system,
            target_component: 1,
            secret_key: [key; 32],
        };
        frame(MavMessage::SETUP_SIGNING(setup), 255)
    }

    #[test]
    fn a_key_comes_from_this_machine_only_and_goes_nowhere() {
        let (mut links, [near, far]) = links();
        let mut receive = |end: &(Bytes, Bytes), frame: &Frame| {
            end.0.lock().expect("one thread").push(frame.bytes().to_vec());
            let received = links.receive(Instant::now());
            (received.len(), links.take_setups(), links.signing().is_on())
        };
        // Both ends have spoken: what one sends is forwarded to the other.
        assert_eq!(receive(&near, &heartbeat(255)).0, 1);
        assert_eq!(receive(&far, &heartbeat(254)).0, 1);
        let forwarded = near.1.lock().expect("one thread").len();
        assert_eq!(forwarded, 1);

        assert_eq!(
            receive(&far, &setup(7, 1)),
            (0, vec![SigningSetup::Refused(255, 190, SetupRefusal::NotLocal)], false)
        );
        // For another vehicle it is not passed on, either.
        assert_eq!(receive(&near, &setup(7, 2)), (0, vec![], false));
        assert_eq!(receive(&near, &setup(7, 1)), (0, vec![SigningSetup::Set(255, 190)], true));
        assert_eq!(far.1.lock().expect("one thread").len(), 0, "the key was passed on");
        assert_eq!(near.1.lock().expect("one thread").len(), forwarded, "the key was passed on");

        // From now on a key can only be changed by who knows it.
        assert_eq!(receive(&near, &setup(0, 1)), (0, vec![], true));
        let key = SecretKey::new([7; 32]).expect("a key");
        let removal = setup(0, 1).sign(0, 60, |bytes| key.tag(bytes));
        assert_eq!(receive(&near, &removal), (0, vec![SigningSetup::Removed(255, 190)], false));
        assert!(!format!("{links:?}").contains("7, 7, 7, 7"), "the key is remembered in the open");
    }

    #[test]
    fn what_is_refused_reaches_nobody_and_teaches_nothing() {
        let (mut links, [near, far]) = links();
        let key = SecretKey::new([7; 32]).expect("a key");
        links.sign_with(Signing::new(Some(key.clone()), Default::default()));
        let put = |end: &(Bytes, Bytes), frame: &Frame| {
            end.0.lock().expect("one thread").push(frame.bytes().to_vec());
        };
        let sign = |frame: Frame, timestamp| frame.sign(0, timestamp, |bytes| key.tag(bytes));
        put(&near, &sign(heartbeat(255), 9));
        put(&far, &heartbeat(254));
        assert_eq!(links.receive(Instant::now()).len(), 1);
        assert_eq!(links.active_peers(), 1);
        put(&near, &sign(heartbeat(255), 10));
        assert_eq!(links.receive(Instant::now()).len(), 1);
        assert!(far.1.lock().expect("one thread").is_empty(), "who was refused is not forwarded to");
        put(&far, &sign(heartbeat(254), 11));
        put(&far, &sign(heartbeat(254), 11));
        assert_eq!(links.receive(Instant::now()).len(), 1);
        assert_eq!(near.1.lock().expect("one thread").len(), 1, "forwarded once, as it came");
        assert_eq!(links.signing().counts().to_string(), "1 unsigned, 1 replayed");

        // Ours: signed, each link under its number, never in MAVLink 1.
        near.1.lock().expect("one thread").clear();
        let message = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        links.send(&Outgoing { to: Destination::Everyone, message }, 1);
        let sent = [near, far].map(|end| {
            let frame =
                Frame::parse(end.1.lock().expect("one thread").last().expect("sent")).expect("a frame");
            frame.signature().expect("signed")
        });
        assert_eq!(sent.map(|signature| signature.link), [0, 1]);
        assert!(sent[0].timestamp < sent[1].timestamp);
    }
}
