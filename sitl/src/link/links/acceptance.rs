//! Which received frames go on from here, and who becomes a peer by them.

use std::collections::btree_map::Entry;
use std::time::Instant;

use autopilot::codec::{Frame, id, target_of};
use autopilot::envelope::{Origin, PeerId};

use super::{Links, Received};
use crate::link::allowance::Allowance;
use crate::link::inbox::Inbox;
use crate::link::peer::Peer;
use crate::link::signing_setup::SigningSetup;

impl Links {
    /// Whether a frame goes on from here. What is refused teaches nothing about who sent it.
    pub(super) fn is_accepted(&mut self, received: &Received, now: Instant) -> bool {
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
}
