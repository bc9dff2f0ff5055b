//! Senders of datagrams that have not sent a valid frame yet.

use std::collections::{BTreeMap, VecDeque};
use std::net::SocketAddr;

/// Strangers that are remembered, until their datagrams are judged: as many as one look at the socket brings.
pub(super) const MOST_STRANGERS: usize = 512;

/// Unknown senders of the latest datagrams, by number. The oldest is forgotten; nobody else makes room for them.
#[derive(Debug, Default)]
pub struct Strangers {
    numbers: BTreeMap<SocketAddr, u64>,
    /// In the order in which they came.
    order: VecDeque<(u64, SocketAddr)>,
}

impl Strangers {
    /// The number of a sender; `next` is that of a new one.
    pub fn number_of(&mut self, address: SocketAddr, next: impl FnOnce() -> u64) -> u64 {
        if let Some(number) = self.numbers.get(&address) {
            return *number;
        }
        if self.order.len() >= MOST_STRANGERS
            && let Some((_, oldest)) = self.order.pop_front()
        {
            self.numbers.remove(&oldest);
        }
        let number = next();
        self.numbers.insert(address, number);
        self.order.push_back((number, address));
        number
    }

    /// Forgets a sender and returns its address.
    pub fn take(&mut self, number: u64) -> Option<SocketAddr> {
        let at = self.order.iter().position(|(known, _)| *known == number)?;
        let (_, address) = self.order.remove(at)?;
        self.numbers.remove(&address);
        Some(address)
    }
}

#[cfg(test)]
mod tests {
    use std::net::{Ipv4Addr, SocketAddr};

    use super::{MOST_STRANGERS, Strangers};

    #[test]
    fn a_sender_keeps_its_number_until_so_many_others_have_come() {
        let address = |port| SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let mut strangers = Strangers::default();
        let mut last = 0;
        let mut number_of = |strangers: &mut Strangers, port| {
            strangers.number_of(address(port), || {
                last += 1;
                last
            })
        };
        assert_eq!(number_of(&mut strangers, 1), 1);
        for port in 2..=MOST_STRANGERS as u16 {
            number_of(&mut strangers, port);
        }
        assert_eq!(number_of(&mut strangers, 1), 1);
        assert_eq!(strangers.take(2), Some(address(2)));
        assert_eq!(strangers.take(2), None);
        number_of(&mut strangers, 2);
        number_of(&mut strangers, 10_000);
        assert_eq!(strangers.take(1), None, "the oldest makes room");
        assert_eq!((strangers.order.len(), strangers.numbers.len()), (MOST_STRANGERS, MOST_STRANGERS));
    }
}
