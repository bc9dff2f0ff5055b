//! Which sockets have something to read: one call of the system tells it of all of them, however many vehicles have ports of their own.

use std::io::ErrorKind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use mio::net::UdpSocket;
use mio::{Events, Interest, Poll, Token};

/// Sockets of one look; those beyond it are told of with the next.
const MOST_EVENTS: usize = 1024;

/// Watches sockets.
#[derive(Debug)]
pub struct Readiness {
    /// `None`: the system cannot tell. All sockets are read then, at each look.
    watch: Option<Watch>,
    sockets: Vec<Arrivals>,
}

#[derive(Debug)]
struct Watch {
    poll: Poll,
    events: Events,
}

/// Whether something may have come to a socket since it was read empty.
#[derive(Clone, Debug)]
pub struct Arrivals(Arc<AtomicBool>);

/// Watches nothing yet.
impl Default for Readiness {
    fn default() -> Self {
        let watch = Poll::new().map(|poll| Watch { poll, events: Events::with_capacity(MOST_EVENTS) });
        let watch = watch.inspect_err(|error| tracing::debug!("sockets are read one by one: {error}")).ok();
        Self { watch, sockets: Vec::new() }
    }
}

impl Readiness {
    /// Watches a socket from now on. It may have something to read already.
    pub fn watch(&mut self, socket: &mut UdpSocket) -> Arrivals {
        let arrivals = Arrivals(Arc::new(AtomicBool::new(true)));
        if let Some(Watch { poll, .. }) = &self.watch
            && let Err(error) =
                poll.registry().register(socket, Token(self.sockets.len()), Interest::READABLE)
        {
            tracing::debug!("sockets are read one by one: {error}");
            self.watch = None;
        }
        self.sockets.push(arrivals.clone());
        arrivals
    }

    /// Asks the system, and does not wait.
    pub fn look(&mut self) {
        let told = self.watch.as_mut().map(|Watch { poll, events }| {
            let told = poll.poll(events, Some(Duration::ZERO));
            told.map(|()| events)
        });
        match told {
            Some(Ok(events)) => {
                let ready = events.iter().filter_map(|event| self.sockets.get(event.token().0));
                ready.for_each(Arrivals::expect);
            }
            // With the next look.
            Some(Err(error)) if error.kind() == ErrorKind::Interrupted => {}
            Some(Err(_)) | None => self.sockets.iter().for_each(Arrivals::expect),
        }
    }
}

impl Arrivals {
    /// Whether the socket is to be read.
    pub fn are_expected(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The socket has been read empty: the system tells of what comes from now on.
    pub fn are_over(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    fn expect(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::net::SocketAddr;
    use std::time::{Duration, Instant};

    use mio::net::UdpSocket;

    use super::{Arrivals, Readiness};

    fn socket() -> UdpSocket {
        UdpSocket::bind(SocketAddr::from(([127, 0, 0, 1], 0))).expect("a free port")
    }

    /// Reads a socket empty, and says how many datagrams there were.
    fn drain(socket: &UdpSocket, arrivals: &Arrivals) -> usize {
        let datagrams = std::iter::from_fn(|| socket.recv(&mut [0; 8]).ok()).count();
        arrivals.are_over();
        datagrams
    }

    /// Looks until a socket is to be read.
    fn await_arrival(readiness: &mut Readiness, arrivals: &Arrivals) {
        let start = Instant::now();
        while !arrivals.are_expected() {
            assert!(start.elapsed() < Duration::from_secs(5), "nobody tells of it");
            readiness.look();
        }
    }

    #[test]
    fn a_socket_is_to_be_read_when_something_has_come() {
        let (mut readiness, mut sockets) = (Readiness::default(), [socket(), socket()]);
        // What has come before it is watched is not overlooked.
        let sender = std::net::UdpSocket::bind("127.0.0.1:0").expect("a free port");
        let send = |to: &UdpSocket| sender.send_to(b"!", to.local_addr().expect("an address")).expect("sent");
        send(&sockets[1]);
        let arrivals = sockets.each_mut().map(|socket| readiness.watch(socket));
        assert!(arrivals.iter().all(Arrivals::are_expected));
        assert_eq!(drain(&sockets[0], &arrivals[0]), 0);
        assert_eq!(drain(&sockets[1], &arrivals[1]), 1);
        for (one, other) in [(0, 1), (1, 0), (0, 1)] {
            // What it was told of before, it may tell of once more.
            readiness.look();
            drain(&sockets[0], &arrivals[0]);
            drain(&sockets[1], &arrivals[1]);
            send(&sockets[one]);
            send(&sockets[one]);
            await_arrival(&mut readiness, &arrivals[one]);
            assert!(!arrivals[other].are_expected(), "nothing has come to it");
            assert_eq!(drain(&sockets[one], &arrivals[one]), 2);
            readiness.look();
            assert!(!arrivals[one].are_expected(), "read empty");
        }
    }

    /// It stays to be read until it has been read empty: the system tells of it once only.
    #[test]
    fn what_was_left_is_not_forgotten() {
        let (mut readiness, mut socket) = (Readiness::default(), socket());
        let arrivals = readiness.watch(&mut socket);
        drain(&socket, &arrivals);
        let sender = std::net::UdpSocket::bind("127.0.0.1:0").expect("a free port");
        for _ in 0..2 {
            sender.send_to(b"!", socket.local_addr().expect("an address")).expect("sent");
        }
        await_arrival(&mut readiness, &arrivals);
        assert!(socket.recv(&mut [0; 8]).is_ok());
        readiness.look();
        assert!(arrivals.are_expected());
        assert_eq!(drain(&socket, &arrivals), 1);
    }

    #[test]
    fn where_the_system_cannot_tell_every_socket_is_read() {
        let mut readiness = Readiness { watch: None, sockets: Vec::new() };
        let arrivals = readiness.watch(&mut socket());
        arrivals.are_over();
        readiness.look();
        assert!(arrivals.are_expected());
    }
}
