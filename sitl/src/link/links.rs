//! All links: receiving in turns, sending, and forwarding from one peer to the others.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use autopilot::COMPONENT;
use autopilot::codec::{Frame, Version, id, target_of};
use autopilot::envelope::{Destination, Origin, Outgoing, PeerId};

use super::allowance::Allowance;
use super::echo::Echoes;
use super::endpoint::LinkSpecification;
use super::error::LinkError;
use super::forwarding::Forwarding;
use super::inbox::Inbox;
use super::lost::Lost;
use super::open::open;
use super::peer::Peer;
use super::signing_setup::{SetupRules, SigningSetup};
use super::transport::{Event, Transport};
use super::turns::Turns;
use crate::signing::Signing;

/// Peers of a link that are gone and have left something that is not handled yet; the oldest makes room.
const MOST_DEPARTED: usize = 32;

/// A received frame.
#[derive(Clone, Debug)]
pub struct Received {
    /// Who sent it.
    pub origin: Origin,
    /// The frame.
    pub frame: Frame,
}

/// A piece of work for one peer.
#[derive(Clone, Debug)]
pub struct Turn {
    /// Whose turn it is.
    pub peer: PeerId,
    /// The frame that was received and accepted, and is forwarded already; `None`: there was none among the bytes of this turn.
    pub received: Option<Received>,
}

#[derive(Debug)]
struct Link {
    transport: Box<dyn Transport>,
    peers: BTreeMap<u64, Peer>,
    /// What senders have sent that are no peers yet.
    strangers: Inbox,
}

/// In place of a peer's number: a turn of the strangers.
const STRANGERS: u64 = 0;

/// Links, and the vehicles behind them.
#[derive(Debug)]
pub struct Links {
    /// Our systems.
    systems: Vec<u8>,
    /// Those of their components that speak.
    senders: BTreeSet<(u8, u8)>,
    links: Vec<Link>,
    turns: Turns<PeerId>,
    /// Number of pieces that have come, which says what came first.
    arrivals: u64,
    echoes: Echoes,
    forwarding: Forwarding,
    lost: Lost,
    signing: Signing,
    setup_rules: SetupRules,
    setups: Vec<SigningSetup>,
}

impl Link {
    /// A peer is gone: its own is forgotten once what it has sent is handled. Returns who is forgotten now.
    fn depart(&mut self, number: u64, now: Instant) -> Option<u64> {
        let peer = self.peers.get_mut(&number)?;
        peer.departed = true;
        let idle = peer.inbox.waiting(now).is_none();
        let mut departed = self.peers.iter().filter(|(_, peer)| peer.departed).map(|(number, _)| *number);
        let oldest = departed.next();
        let forgotten =
            if idle { Some(number) } else { oldest.filter(|_| departed.count() >= MOST_DEPARTED) };
        forgotten.inspect(|number| {
            self.peers.remove(number);
        })
    }
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
                Ok(Link {
                    transport: open(&specification.endpoint)?,
                    peers: BTreeMap::new(),
                    strangers: Inbox::default(),
                })
            })
            .collect::<Result<_, LinkError>>()?;
        Ok(Self::of(links, systems))
    }

    fn of(links: Vec<Link>, systems: Vec<u8>) -> Self {
        Self {
            senders: systems.iter().map(|system| (*system, COMPONENT)).collect(),
            systems,
            links,
            turns: Turns::default(),
            arrivals: 0,
            echoes: Echoes::default(),
            forwarding: Forwarding::default(),
            lost: Lost::default(),
            signing: Signing::default(),
            setup_rules: SetupRules::default(),
            setups: Vec::new(),
        }
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
        self.active_peers_by_link().sum()
    }

    /// The same of each link.
    pub fn active_peers_by_link(&self) -> impl Iterator<Item = usize> {
        let active =
            |link: &Link| link.peers.values().filter(|peer| peer.has_spoken() && !peer.departed).count();
        self.links.iter().map(active)
    }

    /// What was lost so far.
    pub fn lost(&self) -> Lost {
        self.lost
    }

    /// Takes what has come into the inboxes of the peers. Of a stream, no more than there is room for is read, so that its
    /// sender has to wait; datagrams are always read, and lost if there is no room, so that they keep nobody else's out.
    pub fn poll(&mut self, now: Instant) {
        for (index, link) in self.links.iter_mut().enumerate() {
            let Link { transport, peers, .. } = link;
            let room = |number| peers.get(&number).map_or(usize::MAX, |peer| peer.inbox.room());
            let events = transport.poll(now, &room);
            let stream = !transport.is_datagram();
            for event in events {
                match event {
                    Event::Opened(number) => {
                        link.peers.insert(number, Peer::default());
                    }
                    Event::Closed(number) => {
                        if let Some(number) = link.depart(number, now) {
                            self.echoes.forget(PeerId { link: index, number });
                        }
                    }
                    Event::Bytes(number, bytes) => {
                        self.arrivals += 1;
                        // A stranger has no place until one of its frames is accepted.
                        let inbox =
                            link.peers.get_mut(&number).map_or(&mut link.strangers, |peer| &mut peer.inbox);
                        if !inbox.put(bytes, number, stream, self.arrivals, now) {
                            self.lost.datagrams += 1;
                        }
                    }
                }
            }
            for peer in link.peers.values_mut() {
                peer.allowance.update(now);
            }
        }
    }

    /// Handles a bounded part of what waits in the inboxes: a frame at most. `None`: nothing waits of those who may have a
    /// turn. What the turn has cost, with all that it led to, is the caller's to charge.
    pub fn take_turn(&mut self, now: Instant, may: impl Fn(PeerId) -> bool) -> Option<Turn> {
        let waiting = self.links.iter().enumerate().flat_map(|(link, own)| {
            let peers = own.peers.iter().map(|(number, peer)| (*number, &peer.inbox));
            peers
                .chain([(STRANGERS, &own.strangers)])
                .filter_map(move |(number, inbox)| Some((PeerId { link, number }, inbox.waiting(now)?)))
        });
        let id = self.turns.next(waiting.filter(|(peer, _)| may(*peer)))?;
        let Link { peers, strangers, .. } = self.links.get_mut(id.link)?;
        let (decoded, left) = match peers.get_mut(&id.number) {
            Some(peer) => {
                let decoded = peer.inbox.decode(now);
                (decoded, peer.departed && peer.inbox.waiting(now).is_none())
            }
            None => (strangers.decode(now), false),
        };
        let received = decoded.and_then(|(number, frame)| {
            let peer = PeerId { link: id.link, number };
            let origin = Origin { peer, system: frame.system(), component: frame.component() };
            let received = Received { origin, frame };
            self.is_accepted(&received, now).then_some(received)
        });
        if let Some(received) = &received {
            self.forward(received, now);
        }
        if left {
            self.links.get_mut(id.link)?.peers.remove(&id.number);
            self.echoes.forget(id);
        }
        Some(Turn { peer: id, received })
    }

    /// A turn has cost this much.
    pub fn charge(&mut self, peer: PeerId, cost: Duration) {
        self.turns.charge(peer, cost);
    }

    /// Whether a frame goes on from here. What is refused teaches nothing about who sent it.
    fn is_accepted(&mut self, received: &Received, now: Instant) -> bool {
        let news = !self.is_own(received) && !self.echoes.has(&received.frame, received.origin.peer, now);
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
            // A key is not remembered.
            return false;
        }
        // One peer has no one to be an echo of.
        if news && self.links.iter().map(|link| link.peers.len()).sum::<usize>() > 1 {
            self.echoes.remember(&received.frame, received.origin.peer, now);
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
        let departed = link.peers.get(&number).is_some_and(|peer| peer.departed);
        if proven && !departed && !link.transport.confirm(number, now) {
            // Nothing else that it has sent takes effect either: not while it is disconnected, and not afterwards.
            if let Some(refused) = link.peers.get_mut(&number) {
                refused.inbox = Inbox::default();
            }
            return false;
        }
        let peer = match link.peers.entry(number) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(_) if !proven => return false,
            Entry::Vacant(new) => {
                let allowance = Allowance::new(link.transport.may_be_forged(number));
                new.insert(Peer::new(allowance, link.strangers.split_off()))
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

    /// Whether a frame is one of ours that has come back.
    fn is_own(&self, received: &Received) -> bool {
        let Origin { system, component, .. } = received.origin;
        self.senders.contains(&(system, component))
    }

    /// Passes a frame on to the peers that lead to its target, unless it is for one of ours alone.
    fn forward(&mut self, received: &Received, now: Instant) {
        let target = target_of(&received.frame);
        if self.systems.contains(&target.system) {
            return;
        }
        let from = received.origin.peer;
        let mut allowed = None;
        for (index, link) in self.links.iter_mut().enumerate() {
            for (number, peer) in &mut link.peers {
                let itself = from == PeerId { link: index, number: *number };
                // What has never spoken cannot be known not to be the sender itself, by another way.
                let wanted = !itself && !peer.departed && peer.has_spoken() && peer.leads_to(target.system);
                if wanted && peer.allowance.spend(received.frame.bytes().len(), false) {
                    if !*allowed.get_or_insert_with(|| self.forwarding.allows(from, now)) {
                        self.lost.forwards += 1;
                        return;
                    }
                    link.transport.forward(*number, received.frame.bytes());
                }
            }
        }
    }

    /// Sends a message of one of our systems and returns it as one of its frames, for a log.
    pub fn send(&mut self, outgoing: &Outgoing, system: u8) -> Option<Frame> {
        let sender = (system, outgoing.component);
        self.senders.insert(sender);
        let essential = matches!(outgoing.to, Destination::Peer(_)) || outgoing.message.id() == id::HEARTBEAT;
        let mut sent = None;
        for (index, link) in self.links.iter_mut().enumerate() {
            for (number, peer) in &mut link.peers {
                let wanted = match outgoing.to {
                    Destination::Everyone => true,
                    Destination::Link(link) => link == index,
                    Destination::Peer(id) => id == PeerId { link: index, number: *number },
                };
                if !wanted || peer.departed {
                    continue;
                }
                // MAVLink 1 has no signatures.
                let version = if self.signing.is_on() { Version::Two } else { peer.version() };
                // Messages beyond number 255 do not exist in MAVLink 1.
                let sequence = peer.sequences.entry(sender).or_default();
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
        let known = link.peers.get(&peer.number).filter(|known| !known.departed)?;
        Some(known.allowance.is_open() && link.transport.has_room(peer.number))
    }

    /// Sends what is waiting.
    pub fn flush(&mut self) {
        for link in &mut self.links {
            link.transport.flush();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::{Arc, Mutex};
    use std::time::{Duration, Instant};

    use mavlink::dialects::ardupilotmega::{
        ATTITUDE_DATA, HEARTBEAT_DATA, MavMessage, RADIO_STATUS_DATA, SETUP_SIGNING_DATA, SYSTEM_TIME_DATA,
    };

    use super::{Link, Links, Lost, Peer, Received};
    use crate::link::inbox::Inbox;
    use crate::link::transport::{Event, Transport};
    use crate::link::{SetupRefusal, SetupRules, SigningSetup};
    use crate::signing::{SecretKey, Signing};
    use autopilot::codec::{COMPONENT, Frame, Message, Version};
    use autopilot::envelope::{Destination, Outgoing, PeerId};

    /// What the clock shows.
    const NOW: u64 = 50;

    type Bytes = Arc<Mutex<Vec<Vec<u8>>>>;

    /// A link whose two ends are lists. An empty piece ends the peer's connection.
    #[derive(Debug)]
    struct Ends {
        inward: Bytes,
        outward: Bytes,
        local: bool,
        /// Whether it has no place for peers.
        full: bool,
    }

    impl Transport for Ends {
        fn poll(&mut self, _now: Instant, _room: &dyn Fn(u64) -> usize) -> Vec<Event> {
            let mut waiting = self.inward.lock().expect("one thread");
            let event =
                |bytes: Vec<u8>| if bytes.is_empty() { Event::Closed(1) } else { Event::Bytes(1, bytes) };
            waiting.drain(..).map(event).collect()
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
            strangers: Inbox::default(),
        };
        let mut links = Links::of(vec![of(&ends[0], true), of(&ends[1], false)], vec![1]);
        links.setup_rules = SetupRules { without_key: true, armed: false };
        links.signing.set_clock(NOW);
        (links, ends)
    }

    /// All frames that have come and are accepted.
    fn receive(links: &mut Links) -> Vec<Received> {
        receive_at(links, Instant::now())
    }

    fn receive_at(links: &mut Links, now: Instant) -> Vec<Received> {
        links.poll(now);
        std::iter::from_fn(|| links.take_turn(now, |_| true)).filter_map(|turn| turn.received).collect()
    }

    fn frame(message: MavMessage, system: u8) -> Frame {
        Frame::encode(&message.into(), Version::Two, 0, (system, 190)).expect("a message of MAVLink 2")
    }

    fn everyone(message: Message) -> Outgoing {
        Outgoing { to: Destination::Everyone, message, component: COMPONENT }
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
            let received = receive(&mut links);
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
                links.send(&everyone(message.clone()), 1);
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
        assert!(receive_at(&mut links, start).is_empty());
        tell(&mut links);
        assert_eq!((drawn(&near), drawn(&far), links.active_peers()), (0, 0, 0));
        // A frame makes a peer: on this machine without a limit.
        let frame = heartbeat(9);
        put(&near, frame.bytes());
        assert_eq!(receive_at(&mut links, start).len(), 1);
        tell(&mut links);
        assert!(drawn(&near) > 30_000);
        let frame = heartbeat(10);
        put(&far, frame.bytes());
        assert_eq!(receive_at(&mut links, start).len(), 1);
        drawn(&near);
        // Forwarded frames count as telemetry.
        put(&near, heartbeat(9).bytes());
        receive_at(&mut links, start);
        assert_eq!(drawn(&far), 0);
        tell(&mut links);
        let most = 10 * frame.bytes().len();
        assert!((most - 21..=most).contains(&drawn(&far)));
        // Whoever keeps talking gets everything, forwarded frames, too.
        for second in 1..=3 {
            put(&far, frame.bytes());
            receive_at(&mut links, start + Duration::from_secs(second));
        }
        put(&near, heartbeat(8).bytes());
        receive_at(&mut links, start + Duration::from_secs(3));
        assert_eq!(drawn(&far), heartbeat(8).bytes().len());
        tell(&mut links);
        assert!(drawn(&far) > 30_000);
        receive_at(&mut links, start + Duration::from_secs(9));
        tell(&mut links);
        assert_eq!(drawn(&far), 0);
    }

    #[test]
    fn who_has_no_place_has_no_effect() {
        let (mut links, [near, _]) = links();
        links.links[0].transport =
            Box::new(Ends { inward: near.0.clone(), outward: near.1.clone(), local: true, full: true });
        near.0.lock().expect("one thread").push(heartbeat(9).bytes().to_vec());
        assert!(receive_at(&mut links, Instant::now()).is_empty(), "nobody could be answered");
        assert_eq!(links.active_peers(), 0);
    }

    /// A connection that is refused ends at the next look. What it had sent must not be taken for the rest of a peer's.
    #[test]
    fn what_a_refused_connection_has_sent_has_no_effect_after_its_end() {
        let (mut links, [near, _]) = connected();
        links.links[0].transport =
            Box::new(Ends { inward: near.0.clone(), outward: near.1.clone(), local: true, full: true });
        put(&near, &[heartbeat(255).bytes(), heartbeat(254).bytes()].concat());
        let now = Instant::now();
        links.poll(now);
        let turn = links.take_turn(now, |_| true).expect("bytes wait");
        assert!(turn.received.is_none(), "refused");
        put(&near, &[]);
        assert!(receive_at(&mut links, now).is_empty(), "nobody could be answered");
        assert!(links.links[0].peers.is_empty());
    }

    #[test]
    fn nothing_is_forwarded_to_who_has_left() {
        let (mut links, [flood, left]) = connected();
        put(&left, heartbeat(255).bytes());
        assert_eq!(receive(&mut links).len(), 1);
        // It is gone, and something of it waits.
        put(&left, heartbeat(255).bytes());
        put(&left, &[]);
        put(&flood, &different(254, 2_000));
        let now = Instant::now();
        links.poll(now);
        let turns = std::iter::from_fn(|| links.take_turn(now, |peer| peer.link == 0));
        assert_eq!(turns.filter(|turn| turn.received.is_some()).count(), 2_000);
        assert_eq!(links.lost(), Lost::default(), "nobody was there to lose a frame");
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
            let received = receive_at(&mut links, Instant::now()).len();
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
        assert_eq!(receive(&mut links).len(), 1);
        assert_eq!(links.active_peers(), 1);
        put(&near, &sign(heartbeat(255), 10));
        assert_eq!(receive(&mut links).len(), 1);
        assert!(far.1.lock().expect("one thread").is_empty(), "who was refused is not forwarded to");
        put(&far, &sign(heartbeat(254), 11));
        put(&far, &sign(heartbeat(254), 11));
        assert_eq!(receive(&mut links).len(), 1);
        assert_eq!(near.1.lock().expect("one thread").len(), 1, "forwarded once, as it came");
        assert_eq!(links.signing().counts().to_string(), "1 unsigned, 1 replayed");

        // Ours: signed, each link under its number, never in MAVLink 1.
        near.1.lock().expect("one thread").clear();
        let message = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        links.send(&everyone(message), 1);
        let sent = [near, far].map(|end| {
            let frame =
                Frame::parse(end.1.lock().expect("one thread").last().expect("sent")).expect("a frame");
            frame.signature().expect("signed")
        });
        assert_eq!(sent.map(|signature| signature.link), [0, 1]);
        assert!(sent[0].timestamp < sent[1].timestamp);
    }

    /// The same with a connected peer on each link.
    fn connected() -> (Links, [(Bytes, Bytes); 2]) {
        let (mut links, ends) = links();
        links.links.iter_mut().for_each(|link| drop(link.peers.insert(1, Peer::default())));
        (links, ends)
    }

    fn put(end: &(Bytes, Bytes), bytes: &[u8]) {
        end.0.lock().expect("one thread").push(bytes.to_vec());
    }

    /// Number of the link of the next frames, each of which costs as much as a redesign.
    fn served(links: &mut Links, turns: usize) -> Vec<usize> {
        let now = Instant::now();
        let served = (0..turns).filter_map(|_| {
            let turn = links.take_turn(now, |_| true)?;
            links.charge(turn.peer, Duration::from_micros(1_500));
            turn.received.map(|received| received.origin.peer.link)
        });
        served.collect()
    }

    /// Frames from a system that are no repetitions of one another.
    fn different(system: u8, count: u64) -> Vec<u8> {
        let message = |time_unix_usec| SYSTEM_TIME_DATA { time_unix_usec, time_boot_ms: 0 };
        (0..count).flat_map(|n| frame(MavMessage::SYSTEM_TIME(message(n)), system).bytes().to_vec()).collect()
    }

    #[test]
    fn a_message_does_not_wait_behind_those_of_another_peer() {
        let (mut links, [flood, quiet]) = connected();
        put(&flood, &different(254, 1_000));
        links.poll(Instant::now());
        assert_eq!(served(&mut links, 3), [0; 3]);
        put(&quiet, heartbeat(255).bytes());
        links.poll(Instant::now());
        assert_eq!(served(&mut links, 2), [1, 0]);
        // Both want more than they get: they get the same.
        put(&quiet, &different(255, 1_000));
        links.poll(Instant::now());
        let served = served(&mut links, 100);
        let share = served.iter().filter(|link| **link == 1).count();
        assert!((49..=51).contains(&share), "{share} of {}", served.len());
        // A peer that may not have a turn now keeps what it has, and no one waits for it.
        let turn = links.take_turn(Instant::now(), |peer| peer.link == 1).expect("more waits");
        assert_eq!(turn.peer.link, 1);
    }

    #[test]
    fn an_inbox_is_bounded_and_what_is_lost_is_counted() {
        let (mut links, [flood, quiet]) = links();
        (0..9).for_each(|_| put(&flood, &different(254, 4_000)));
        put(&quiet, heartbeat(255).bytes());
        links.poll(Instant::now());
        assert_eq!(links.lost(), Lost { datagrams: 7, forwards: 0 });
        assert_eq!(links.lost().to_string(), "dropped 7 datagrams");
        assert_eq!(Lost { datagrams: 1, forwards: 2 }.to_string(), "dropped 1 datagram, 2 forwarded frames");
        let handled = receive(&mut links);
        assert_eq!(handled.iter().filter(|received| received.origin.peer.link == 0).count(), 8_000);
        assert!(handled.iter().any(|received| received.origin.peer.link == 1));
    }

    #[test]
    fn what_a_flood_has_forwarded_is_bounded() {
        let (mut links, [flood, quiet]) = connected();
        put(&quiet, heartbeat(255).bytes());
        assert_eq!(receive(&mut links).len(), 1);
        put(&flood, &different(254, 2_000));
        // The vehicle itself hears all.
        assert_eq!(receive(&mut links).len(), 2_000);
        let forwarded = quiet.1.lock().expect("one thread").len() as u64;
        assert_eq!(links.lost(), Lost { datagrams: 0, forwards: 2_000 - forwarded });
        assert!((100..1_000).contains(&forwarded), "{forwarded}");
    }

    #[test]
    fn what_a_peer_has_sent_before_it_left_is_still_handled() {
        let (mut links, [end, _]) = connected();
        put(&end, &[heartbeat(255).bytes(), heartbeat(254).bytes()].concat());
        put(&end, &[]);
        links.poll(Instant::now());
        let peer = PeerId { link: 0, number: 1 };
        assert_eq!((links.has_room(peer), links.active_peers()), (None, 0), "it has left");
        assert_eq!(receive(&mut links).len(), 2);
        assert!(links.links[0].peers.is_empty(), "and is forgotten");
        // Those who come, say something and go are bounded, too.
        let now = Instant::now();
        let link = &mut links.links[0];
        for number in 0..100 {
            link.peers.entry(number).or_default().inbox.put(vec![0], number, true, 0, now);
            link.depart(number, now);
        }
        assert_eq!(link.peers.len(), super::MOST_DEPARTED);
    }
}
