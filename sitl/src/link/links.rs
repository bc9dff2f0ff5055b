//! All links: receiving, sending, and forwarding from one peer to the others.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::time::Instant;

use autopilot::COMPONENT;
use autopilot::codec::{Frame, Version, id, target_of};
use autopilot::envelope::{Destination, Origin, Outgoing, PeerId};

use super::allowance::Allowance;
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
                        let datagram = link.transport.is_datagram();
                        let frames = match link.peers.get_mut(&number) {
                            Some(peer) => peer.frames(&bytes, datagram, now),
                            // A stranger has no place until one of its frames is accepted.
                            None => Peer::default().frames(&bytes, datagram, now),
                        };
                        take(number, frames);
                    }
                }
            }
            for (number, peer) in &mut link.peers {
                peer.allowance.update(now);
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
        let number = received.origin.peer.number;
        let ours = self.is_for_us(&received.frame);
        if !self.is_from_peer(received, now) {
            return false;
        }
        let Some(link) = self.links.get_mut(received.origin.peer.link) else { return false };
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

    /// Whether an accepted frame is from a peer, or makes its sender one. Peers learn from it.
    fn is_from_peer(&mut self, received: &Received, now: Instant) -> bool {
        let PeerId { link, number } = received.origin.peer;
        let Some(link) = self.links.get_mut(link) else { return false };
        let (frame, has_key) = (&received.frame, self.signing.is_on());
        // What a radio says without a key proves nothing.
        let proven = !has_key || frame.signature().is_some();
        if proven && !link.transport.confirm(number, now) {
            return false;
        }
        let peer = match link.peers.entry(number) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(_) if !proven => return false,
            Entry::Vacant(new) => {
                let allowance = Allowance::new(link.transport.may_be_forged(number));
                new.insert(Peer::new(allowance))
            }
        };
        peer.learn(frame);
        if proven {
            peer.allowance.hear(frame.bytes().len(), has_key, now);
        }
        true
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
        if !known && !secret && self.has_others(origin.peer) {
            self.echoes.remember(&received.frame, origin.peer, now);
        }
        !known
    }

    /// Whether there is a peer beside one.
    fn has_others(&self, one: PeerId) -> bool {
        let number = self.links.iter().map(|link| link.peers.len()).sum::<usize>();
        let link = self.links.get(one.link);
        number > usize::from(link.is_some_and(|link| link.peers.contains_key(&one.number)))
    }

    /// Passes a frame on to the peers that lead to its target, unless it is for one of ours alone.
    fn forward(&mut self, received: &Received) {
        let target = target_of(&received.frame);
        if self.systems.contains(&target.system) {
            return;
        }
        let from = received.origin.peer;
        for (index, link) in self.links.iter_mut().enumerate() {
            for (number, peer) in &mut link.peers {
                let itself = from == PeerId { link: index, number: *number };
                // What has never spoken cannot be known not to be the sender itself, by another way.
                let wanted = !itself && peer.has_spoken() && peer.leads_to(target.system);
                if wanted && peer.allowance.spend(received.frame.bytes().len(), false) {
                    link.transport.send(*number, received.frame.bytes());
                }
            }
        }
    }

    /// Sends a message of one of our systems and returns it as one of its frames, for a log.
    pub fn send(&mut self, outgoing: &Outgoing, system: u8) -> Option<Frame> {
        let sender = (system, COMPONENT);
        let essential = matches!(outgoing.to, Destination::Peer(_)) || outgoing.message.id() == id::HEARTBEAT;
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
                    if !peer.allowance.spend(frame.bytes().len(), essential) {
                        continue;
                    }
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
        let open = link.peers.get(&peer.number)?.allowance.is_open();
        Some(open && link.transport.has_room(peer.number))
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
    use std::time::{Duration, Instant};

    use mavlink::dialects::common::{
        ATTITUDE_DATA, HEARTBEAT_DATA, MavMessage, RADIO_STATUS_DATA, SETUP_SIGNING_DATA,
    };

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
        /// Whether it has no place for peers.
        full: bool,
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

        fn confirm(&mut self, _peer: u64, _now: Instant) -> bool {
            !self.full
        }

        fn may_be_forged(&self, _peer: u64) -> bool {
            !self.local
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
            transport: Box::new(Ends {
                inward: inward.clone(),
                outward: outward.clone(),
                local,
                full: false,
            }),
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

    /// Bytes that have left by one end since the last call.
    fn drawn(end: &(Bytes, Bytes)) -> usize {
        end.1.lock().expect("one thread").drain(..).map(|bytes| bytes.len()).sum()
    }

    /// What is told to everyone, a thousand times: telemetry and heartbeats.
    fn tell(links: &mut Links) {
        let heartbeat = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        let attitude = Message::from(MavMessage::ATTITUDE(ATTITUDE_DATA::default()));
        for message in [heartbeat, attitude] {
            for _ in 0..1000 {
                links.send(&Outgoing { to: Destination::Everyone, message: message.clone() }, 1);
            }
        }
    }

    #[test]
    fn a_stranger_gets_nothing_and_an_address_from_afar_ten_times_what_it_sent() {
        let (mut links, [near, far]) = links();
        let start = Instant::now();
        let put = |end: &(Bytes, Bytes), bytes: &[u8]| end.0.lock().expect("one thread").push(bytes.to_vec());
        for end in [&near, &far] {
            put(end, &[0xfd]);
            put(end, &heartbeat(9).bytes()[..20]);
        }
        assert!(links.receive(start).is_empty());
        tell(&mut links);
        assert_eq!((drawn(&near), drawn(&far), links.active_peers()), (0, 0, 0));
        // A frame makes a peer: on this machine without a limit.
        let frame = heartbeat(9);
        put(&near, frame.bytes());
        assert_eq!(links.receive(start).len(), 1);
        tell(&mut links);
        assert!(drawn(&near) > 30_000);
        let frame = heartbeat(10);
        put(&far, frame.bytes());
        assert_eq!(links.receive(start).len(), 1);
        drawn(&near);
        // Forwarded frames count as telemetry.
        put(&near, heartbeat(9).bytes());
        links.receive(start);
        assert_eq!(drawn(&far), 0);
        tell(&mut links);
        let most = 10 * frame.bytes().len();
        assert!((most - 21..=most).contains(&drawn(&far)));
        // Whoever keeps talking gets everything, forwarded frames, too.
        for second in 1..=3 {
            put(&far, frame.bytes());
            links.receive(start + Duration::from_secs(second));
        }
        put(&near, heartbeat(8).bytes());
        links.receive(start + Duration::from_secs(3));
        assert_eq!(drawn(&far), heartbeat(8).bytes().len());
        tell(&mut links);
        assert!(drawn(&far) > 30_000);
        links.receive(start + Duration::from_secs(9));
        tell(&mut links);
        assert_eq!(drawn(&far), 0);
    }

    #[test]
    fn who_has_no_place_has_no_effect() {
        let (mut links, [near, _]) = links();
        links.links[0].transport =
            Box::new(Ends { inward: near.0.clone(), outward: near.1.clone(), local: true, full: true });
        near.0.lock().expect("one thread").push(heartbeat(9).bytes().to_vec());
        assert!(links.receive(Instant::now()).is_empty(), "nobody could be answered");
        assert_eq!(links.active_peers(), 0);
    }

    /// With a key a radio may speak without one, but does not become a peer by that.
    #[test]
    fn with_a_key_only_signed_frames_make_peers() {
        let (mut links, [near, _]) = links();
        let key = SecretKey::new([7; 32]).expect("a key");
        let mut signing = Signing::new(Some(key.clone()), Default::default());
        signing.set_clock(NOW);
        links.sign_with(signing);
        let mut receive = |frame: Frame| {
            near.0.lock().expect("one thread").push(frame.bytes().to_vec());
            let received = links.receive(Instant::now()).len();
            (received, links.active_peers())
        };
        let radio = || frame(MavMessage::RADIO_STATUS(RADIO_STATUS_DATA::default()), 51);
        assert_eq!(receive(radio()), (0, 0));
        assert_eq!(receive(heartbeat(255)), (0, 0));
        assert_eq!(receive(heartbeat(255).sign(0, NOW, |bytes| key.tag(bytes))), (1, 1));
        assert_eq!(receive(radio()), (1, 1));
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
