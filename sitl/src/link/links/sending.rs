//! What leaves: our own messages, and frames that are passed on.

use std::time::Instant;

use autopilot::codec::{Encoded, Frame, Version, id, target_of};
use autopilot::envelope::{Destination, Outgoing, PeerId};
use autopilot::speaker::Speaker;

use super::{Links, Received};

impl Links {
    /// Passes a frame on to the peers that lead to its target, unless it is for one of ours alone.
    pub(super) fn forward(&mut self, received: &Received, now: Instant) {
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

    /// Sends a message of one of our systems and returns it as one of its frames, for a log. It is written once for all peers.
    pub fn send(&mut self, outgoing: &Outgoing, system: u8) -> Option<&Frame> {
        let sender = (system, outgoing.component);
        // What is said in place of a component that is not there is not its own: it may come.
        if Speaker::of(outgoing.component).is_some() {
            self.senders.insert(sender);
        }
        let essential = matches!(outgoing.to, Destination::Peer(_)) || outgoing.message.id() == id::HEARTBEAT;
        let mut encoded: Option<Encoded> = None;
        let mut sent = false;
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
                if encoded.as_ref().is_none_or(|encoded| encoded.version() != version) {
                    encoded = Encoded::new(&outgoing.message, version);
                }
                // Messages beyond number 255 do not exist in MAVLink 1.
                let Some(encoded) = &encoded else { continue };
                if !peer.allowance.spend(encoded.frame_length(), essential) {
                    continue;
                }
                let sequence = peer.sequences.entry(sender).or_default();
                let buffer = self.sent.take().map(Frame::into_buffer).unwrap_or_default();
                let frame = self.signing.sign(encoded.frame(*sequence, sender, buffer), index as u8);
                *sequence = sequence.wrapping_add(1);
                link.transport.send(*number, frame.bytes());
                self.sent = Some(frame);
                sent = true;
            }
        }
        self.sent.as_ref().filter(|_| sent)
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
