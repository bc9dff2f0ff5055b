//! All links: receiving in turns, sending, and forwarding from one peer to the others.

mod acceptance;
mod sending;

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use autopilot::COMPONENT;
use autopilot::codec::Frame;
use autopilot::envelope::{Origin, PeerId};

use super::echo::Echoes;
use super::endpoint::LinkSpecification;
use super::error::LinkError;
use super::forwarding::Forwarding;
use super::inbox::Inbox;
use super::lost::Lost;
use super::open::open;
use super::peer::Peer;
use super::readiness::Readiness;
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
    /// The latest frame of ours: its buffer is that of the next.
    sent: Option<Frame>,
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
    /// Opens all links, for the vehicles of some system ids. `readiness` must be looked at before each [`Links::poll`].
    ///
    /// # Errors
    /// [`LinkError`] of the first one that cannot be opened.
    pub fn open(
        specifications: &[LinkSpecification],
        systems: Vec<u8>,
        readiness: &mut Readiness,
    ) -> Result<Self, LinkError> {
        let links = specifications
            .iter()
            .map(|specification| {
                Ok(Link {
                    transport: open(&specification.endpoint, readiness)?,
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
            sent: None,
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

    /// Whether nothing waits to be handled. Then nobody has had more than was left by others.
    pub fn are_idle(&mut self, now: Instant) -> bool {
        let is_idle = |inbox: &Inbox| inbox.waiting(now).is_none();
        let idle = self
            .links
            .iter()
            .all(|link| is_idle(&link.strangers) && link.peers.values().all(|peer| is_idle(&peer.inbox)));
        if idle {
            self.turns.next(std::iter::empty());
        }
        idle
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

    /// A turn has cost this much; `message`: it was one that a message was taken in.
    pub fn charge(&mut self, peer: PeerId, cost: Duration, message: bool) {
        self.turns.charge(peer, cost);
        // One that has only decoded a part of a stream tells nothing of what comes.
        if message {
            self.turns.expect(peer, cost);
        }
    }
}

#[cfg(test)]
mod tests;
