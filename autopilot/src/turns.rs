//! Whose turn it is.

use crate::envelope::PeerId;

/// Serves peers one after the other, so that none keeps the others waiting.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turns(Option<PeerId>);

impl Turns {
    /// The next of the peers that are ready.
    pub fn next(&mut self, ready: impl Iterator<Item = PeerId>) -> Option<PeerId> {
        let (mut first, mut later) = (None, None);
        for peer in ready {
            let least = if self.0.is_none_or(|last| peer > last) { &mut later } else { &mut first };
            *least = Some(least.map_or(peer, |known: PeerId| known.min(peer)));
        }
        self.0 = later.or(first).or(self.0);
        later.or(first)
    }
}

#[cfg(test)]
mod tests {
    use super::{PeerId, Turns};

    #[test]
    fn peers_take_turns() {
        let peer = |number| PeerId { link: 0, number };
        let mut turns = Turns::default();
        let all = [3, 1, 2].map(peer);
        let served: Vec<_> = (0..5).filter_map(|_| turns.next(all.into_iter())).collect();
        assert_eq!(served, [1, 2, 3, 1, 2].map(peer));
        assert_eq!(turns.next([peer(1)].into_iter()), Some(peer(1)));
        assert_eq!(turns.next(std::iter::empty()), None);
        assert_eq!(turns.next(all.into_iter()), Some(peer(2)));
    }
}
