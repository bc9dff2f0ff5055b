//! How messages leave by UDP: several in a datagram, none cut, each sender's in their order.

use std::collections::BTreeMap;
use std::net::UdpSocket;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use autopilot::codec::{Frame, FrameDecoder, id};
use clap::Parser;
use sitl::Session;
use sitl::configuration::{Arguments, Settings};

/// Datagrams that a ground station has got from a run.
fn datagrams(line: &str) -> Vec<Vec<u8>> {
    let client = UdpSocket::bind("127.0.0.1:0").expect("a free port");
    let address = client.local_addr().expect("an address");
    let line = format!("lmpc-sitl --link udpout:{address} {line}");
    let arguments = Arguments::try_parse_from(line.split_whitespace()).expect("arguments");
    let session = Session::new(Settings::resolve(&arguments).expect("settings")).expect("free ports");
    let reader = std::thread::spawn(move || {
        let mut datagrams = Vec::new();
        let mut buffer = vec![0; 65_536];
        loop {
            let length = client.recv(&mut buffer).expect("bytes");
            if length == 0 {
                return datagrams;
            }
            datagrams.push(buffer[..length].to_vec());
        }
    });
    session.run(&Arc::new(AtomicBool::new(false)));
    // An empty datagram ends the reader, behind all others.
    let end = UdpSocket::bind("127.0.0.1:0").expect("a free port");
    end.send_to(&[], address).expect("sent");
    reader.join().expect("a reader")
}

/// Whole frames that a datagram consists of, and nothing else.
fn frames(datagram: &[u8]) -> Vec<Frame> {
    let mut decoder = FrameDecoder::default();
    let frames = decoder.datagram(datagram);
    assert_eq!((decoder.rejected_bytes(), decoder.waiting_bytes()), (0, 0), "a frame is cut");
    frames
}

#[test]
fn messages_share_datagrams_and_keep_their_order() {
    let datagrams = datagrams("--vehicles 3 --ports shared --speed max --duration 20");
    assert!(datagrams.iter().all(|datagram| datagram.len() <= 1120));
    let mut next = BTreeMap::<(u8, u8), u8>::new();
    let mut count = 0;
    for frame in datagrams.iter().flat_map(|datagram| frames(datagram)) {
        count += 1;
        let sender = (frame.system(), frame.component());
        let expected = next.entry(sender).or_insert_with(|| frame.sequence());
        assert_eq!(frame.sequence(), *expected, "{sender:?}");
        *expected = expected.wrapping_add(1);
    }
    assert_eq!(next.len(), 3);
    assert!(count > 2_500 && datagrams.len() * 10 < count, "{count} frames in {} datagrams", datagrams.len());
}

/// At real time a look at the links is a tick or two.
#[test]
fn messages_of_a_tick_come_together() {
    let datagrams = datagrams("--speed 1 --duration 0.3");
    let told: Vec<Vec<u32>> =
        datagrams.iter().map(|datagram| frames(datagram).iter().map(Frame::message_id).collect()).collect();
    // The first tick tells everything.
    let first = told.iter().find(|told| told.contains(&id::LOCAL_POSITION_NED)).expect("telemetry");
    assert!(first.len() >= 10, "{first:?}");
    assert!(told.len() < told.concat().len(), "{told:?}");
}
