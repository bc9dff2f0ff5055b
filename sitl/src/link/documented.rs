//! The bounds that the threat model promises are those of the code.

use super::{allowance, descriptors, strangers, tcp, udp};
use crate::signing::{MOST_AHEAD, MOST_STREAMS, NEW_STREAM_BEHIND};

const PAGE: &str = include_str!("../../../book/src/vehicle/threat-model.md");
/// Timestamps per second.
const TIMESTAMPS: u64 = 100_000;

#[test]
fn the_threat_model_has_the_bounds_of_the_code() {
    let peers = udp::MOST_PEERS;
    for (row, numbers) in [
        ("A UDP sender becomes", vec![format!("{} strangers", strangers::MOST_STRANGERS)]),
        ("A UDP peer is forgotten", vec![format!("{} s", udp::EXPIRY.as_secs())]),
        ("Peers of a UDP socket", vec![format!("| {peers} |"), format!("{} s", udp::PAUSE.as_secs())]),
        ("TCP clients that have sent", vec![format!("{} per link", tcp::MOST_SPEAKERS)]),
        (
            "TCP clients that only",
            vec![format!("{} per link", tcp::MOST_LISTENERS), format!("{} s", tcp::GRACE.as_secs())],
        ),
        ("New TCP connections", vec![format!("{} per pass", tcp::MOST_ACCEPTED)]),
        ("A TCP client that takes", vec![format!("{} s", tcp::STALL.as_secs())]),
        ("Descriptors that", vec![format!("| {},", descriptors::RESERVED)]),
        ("heartbeats and answers", vec![format!("{} times", allowance::FACTOR)]),
        (
            "once it has kept talking",
            vec![
                format!("{} s", allowance::TALK.as_secs()),
                format!("below {} s", allowance::SILENCE.as_secs()),
            ],
        ),
        ("A message is refused if", vec![format!("{} s", MOST_AHEAD / TIMESTAMPS)]),
        ("A new stream", vec![format!("{} s", NEW_STREAM_BEHIND / TIMESTAMPS)]),
        ("Streams remembered", vec![format!("{MOST_STREAMS} per vehicle")]),
    ] {
        let line = PAGE.lines().find(|line| line.contains(row)).unwrap_or_else(|| panic!("no line: {row}"));
        for number in numbers {
            assert!(line.contains(&number), "`{number}` is not in: {line}");
        }
    }
}
