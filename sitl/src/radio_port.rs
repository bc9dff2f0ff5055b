//! The pilot's radio by UDP, as ArduPilot's simulation receives it: 8 or 16 pulses of 16 bits, µs, the lowest byte first.

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};

use vehicle::Pulses;

use crate::failure::Failure;
use crate::link::LinkError;

/// Datagrams of one look: a flood must not keep the vehicle from flying.
const MOST_DATAGRAMS: usize = 64;
/// Bytes of a pulse.
const PULSE: usize = 2;
/// Numbers of pulses that a datagram may have.
const COUNTS: [usize; 2] = [8, 16];
/// More than any of them has.
const DATAGRAM: usize = 64;

/// A port that hears a radio of this machine.
#[derive(Debug)]
pub struct RadioPort {
    socket: UdpSocket,
    latest: Option<Pulses>,
}

impl RadioPort {
    /// Opens a port; 0 is any that is free.
    ///
    /// # Errors
    /// [`Failure::Link`] for a port that is taken.
    pub fn open(port: u16) -> Result<Self, Failure> {
        let failed = |source| LinkError::Socket {
            what: format!("UDP port 127.0.0.1:{port}"),
            link: format!("--rc-port {port}"),
            source,
        };
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, port)).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        Ok(Self { socket, latest: None })
    }

    /// Where it is.
    pub fn address(&self) -> Option<SocketAddr> {
        self.socket.local_addr().ok()
    }

    /// What the radio sends now, if that has changed.
    pub fn news(&mut self) -> Option<Pulses> {
        let mut buffer = [0; DATAGRAM];
        let mut heard = None;
        for _ in 0..MOST_DATAGRAMS {
            let Ok(length) = self.socket.recv(&mut buffer) else { break };
            heard = buffer.get(..length).and_then(pulses).or(heard);
        }
        let heard = heard.filter(|pulses| self.latest.as_ref() != Some(pulses))?;
        self.latest = Some(heard);
        Some(heard)
    }
}

/// The pulses of a datagram; `None`: it is none of a radio.
fn pulses(datagram: &[u8]) -> Option<Pulses> {
    if !COUNTS.iter().any(|count| count * PULSE == datagram.len()) {
        return None;
    }
    let mut pulses = Pulses::default();
    for (pulse, bytes) in pulses.iter_mut().zip(datagram.chunks_exact(PULSE)) {
        *pulse = bytes.try_into().map(u16::from_le_bytes).ok()?;
    }
    Some(pulses)
}

#[cfg(test)]
mod tests {
    use std::net::UdpSocket;
    use std::time::{Duration, Instant};

    use super::{RadioPort, pulses};

    #[test]
    fn a_datagram_has_eight_or_sixteen_pulses() {
        let datagram = |count: u16| (0..count).flat_map(|n| (1000 + n).to_le_bytes()).collect::<Vec<_>>();
        for count in [8, 16] {
            let read = pulses(&datagram(count)).expect("a radio");
            assert_eq!((read[0], read[7]), (1000, 1007));
            assert_eq!(read[15], if count == 16 { 1015 } else { 0 });
        }
        for wrong in [vec![], datagram(7), datagram(17), vec![0; 15]] {
            assert_eq!(pulses(&wrong), None);
        }
    }

    #[test]
    fn what_has_not_changed_is_no_news() {
        let mut port = RadioPort::open(0).expect("a port");
        let radio = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        let to = port.address().expect("an address");
        let mut hear = |pulse: u16| {
            let datagram: Vec<u8> = [pulse; 8].iter().flat_map(|pulse| pulse.to_le_bytes()).collect();
            radio.send_to(&datagram, to).expect("it is there");
            let end = Instant::now() + Duration::from_millis(500);
            while Instant::now() < end {
                if let Some(news) = port.news() {
                    return Some(news[0]);
                }
                std::thread::yield_now();
            }
            None
        };
        assert_eq!([hear(1500), hear(1500), hear(1600)], [Some(1500), None, Some(1600)]);
    }
}
