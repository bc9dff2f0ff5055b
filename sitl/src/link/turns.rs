//! Whose turn it is: fair shares of the time that received messages may take.
//!
//! Fair queueing by virtual time: the cost of a peer's work moves its virtual time on, and the peer whose next turn is expected
//! to end first in that time is next (Demers, Keshav and Shenker 1989; virtual time as in start-time fair queueing, Goyal,
//! Vin and Cheng 1996). A peer that asks for little is served at once, whatever others have waiting, and however many they
//! are.

use std::collections::BTreeMap;
use std::time::Duration;

/// Peers that are apart by less are served in the order of arrival: what is cheap keeps its order among all peers.
const QUANTUM: Duration = Duration::from_micros(100);
/// Peers whose costs are remembered. Of one that is forgotten nothing is known until its next message.
const REMEMBERED: usize = 1_000;

/// Takes turns among peers (of any kind of name) by the time that each has used.
#[derive(Clone, Debug)]
pub struct Turns<P> {
    /// Virtual time: no waiting peer is behind it.
    time: Duration,
    /// Virtual times of the peers that are ahead of it.
    used: BTreeMap<P, Duration>,
    /// What a message of a peer costs, smoothed.
    costs: BTreeMap<P, Duration>,
    /// What a message of anybody has cost lately, smoothed.
    lately: Duration,
}

impl<P> Default for Turns<P> {
    fn default() -> Self {
        let (time, lately) = (Duration::ZERO, Duration::ZERO);
        Self { time, used: BTreeMap::new(), costs: BTreeMap::new(), lately }
    }
}

impl<P: Ord + Copy> Turns<P> {
    /// Who is next among those who have work waiting, each with the number of its arrival.
    pub fn next(&mut self, waiting: impl Iterator<Item = (P, u64)>) -> Option<P> {
        let mut furthest_back: Option<Duration> = None;
        let mut next: Option<(u128, u64, P)> = None;
        for (peer, arrival) in waiting {
            let start = self.used.get(&peer).map_or(self.time, |used| self.time.max(*used));
            furthest_back = Some(furthest_back.map_or(start, |least| least.min(start)));
            // Of who has had no message, what others have cost is expected: many that begin at once must not all go before one
            // that is known to ask for little.
            let end = start + *self.costs.get(&peer).unwrap_or(&self.lately);
            let place = (end.as_nanos() / QUANTUM.as_nanos(), arrival, peer);
            next = Some(next.map_or(place, |first| first.min(place)));
        }
        match furthest_back {
            Some(time) => self.time = time,
            // Nobody waits: nobody has had more than was left by others.
            None => self.used.clear(),
        }
        next.map(|(.., peer)| peer)
    }

    /// A turn has cost this much.
    pub fn charge(&mut self, peer: P, cost: Duration) {
        let time = self.time;
        let used = self.used.entry(peer).or_insert(time);
        *used = (*used).max(time) + cost;
        self.used.retain(|_, used| *used > time);
    }

    /// A message of a peer has cost this much: so will its next one, as far as is known.
    pub fn expect(&mut self, peer: P, cost: Duration) {
        self.costs.entry(peer).and_modify(|usual| *usual = smoothed(*usual, cost)).or_insert(cost);
        self.lately = smoothed(self.lately, cost);
        if self.costs.len() > REMEMBERED {
            self.costs.pop_first();
        }
    }
}

/// A usual cost with one more message, which says little alone: the machine may have interrupted it.
fn smoothed(usual: Duration, cost: Duration) -> Duration {
    (usual * 3 + cost) / 4
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::time::Duration;

    use proptest::prelude::*;

    use super::{QUANTUM, Turns};

    /// A turn that handles a message.
    fn handle<P: Ord + Copy>(turns: &mut Turns<P>, peer: P, cost: Duration) {
        turns.charge(peer, cost);
        turns.expect(peer, cost);
    }

    #[test]
    fn who_has_used_little_is_next_and_what_is_cheap_keeps_its_order() {
        let mut turns = Turns::default();
        handle(&mut turns, 'c', QUANTUM / 100);
        assert_eq!(turns.next(std::iter::empty()), None);
        assert_eq!(turns.next([('a', 2), ('b', 1)].into_iter()), Some('b'));
        handle(&mut turns, 'b', QUANTUM / 10);
        assert_eq!(turns.next([('a', 4), ('b', 3)].into_iter()), Some('b'), "still in the order of arrival");
        handle(&mut turns, 'b', 10 * QUANTUM);
        for _ in 0..9 {
            assert_eq!(turns.next([('a', 9), ('b', 5)].into_iter()), Some('a'), "b has had its share");
            handle(&mut turns, 'a', QUANTUM);
        }
        // Somebody who has been away gets no more than a share of what follows, and at once.
        assert_eq!(turns.next([('a', 9), ('b', 5), ('c', 10)].into_iter()), Some('c'));
        assert_eq!(turns.next(std::iter::empty()), None);
        // All is even again, and a asks for less than b; when a has had its share, b is next.
        assert_eq!(turns.next([('a', 9), ('b', 5)].into_iter()), Some('a'));
        handle(&mut turns, 'a', 20 * QUANTUM);
        assert_eq!(turns.next([('a', 9), ('b', 5)].into_iter()), Some('b'));
    }

    proptest! {
        /// However the costs and the moments when peers wait: of the time that has passed while it waited, a peer has got an
        /// equal share, but for one turn of each.
        #[test]
        fn shares_are_equal(
            costs in prop::collection::vec(1_u64..2_000, 2..8),
            turns in prop::collection::vec(0_u8..=255, 50..400),
        ) {
            let cost = |peer: usize| Duration::from_micros(costs[peer]);
            let longest = Duration::from_micros(costs.iter().copied().max().unwrap_or(0)) + 2 * QUANTUM;
            let mut fair = Turns::default();
            let mut got = BTreeMap::<usize, Duration>::new();
            for (number, waits) in turns.iter().enumerate() {
                // Peers 0 and 1 always wait, the others now and then.
                let waiting = (0..costs.len()).filter(|peer| *peer < 2 || waits >> peer & 1 == 1);
                let arrival = number as u64;
                let next = fair.next(waiting.map(|peer| (peer, arrival))).expect("somebody waits");
                handle(&mut fair, next, cost(next));
                *got.entry(next).or_default() += cost(next);
                let of = |peer: usize| got.get(&peer).copied().unwrap_or_default();
                prop_assert!(of(0).abs_diff(of(1)) <= longest, "{:?} {:?}", of(0), of(1));
                // Who waits now and then gets no more than who always waits.
                for peer in 2..costs.len() {
                    prop_assert!(of(peer) <= of(0) + longest, "{peer}: {:?} {:?}", of(peer), of(0));
                }
            }
        }

        /// However many begin at once, and whatever they ask for: who is known to ask for little waits for one of their turns.
        #[test]
        fn many_that_begin_at_once_are_not_before_one_that_asks_for_little(
            hogs in 1_usize..40,
            rounds in 1_usize..20,
            cost_us in 500_u64..20_000,
            ahead in any::<bool>(),
        ) {
            let (mut fair, quiet, cheap) = (Turns::default(), 1_000, Duration::from_micros(20));
            handle(&mut fair, quiet, cheap);
            let mut turns = 0;
            for _ in 0..rounds {
                // It asks once for each turn of somebody else, before or behind all of the others.
                let arrival = if ahead { 0 } else { 2 };
                while let next = fair.next((0..hogs).map(|hog| (hog, 1)).chain([(quiet, arrival)])).expect("all wait")
                    && next != quiet
                {
                    handle(&mut fair, next, Duration::from_micros(cost_us));
                    turns += 1;
                }
                handle(&mut fair, quiet, cheap);
            }
            prop_assert!(turns <= rounds, "{turns} in {rounds}");
        }

        /// A peer that comes to wait is next, or next after what arrived before it within a quantum each.
        #[test]
        fn nobody_waits_behind_a_queue(hogs in 1_usize..40, before in 1_usize..200, cost_us in 100_u64..3_000) {
            let mut fair = Turns::default();
            let cost = Duration::from_micros(cost_us);
            for _ in 0..before {
                let next = fair.next((0..hogs).map(|hog| (hog, 0))).expect("hogs wait");
                handle(&mut fair, next, cost);
            }
            let mut turns = 0;
            while let Some(hog) = fair.next((0..hogs).map(|hog| (hog, 0)).chain([(1_000, 1)])).filter(|next| *next < 1_000) {
                handle(&mut fair, hog, cost);
                turns += 1;
            }
            prop_assert!(turns <= hogs, "{turns}");
        }
    }
}
