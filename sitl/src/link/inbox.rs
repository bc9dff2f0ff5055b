//! The inbox of a peer: received bytes that wait to be decoded, and no more of them than it has room for.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use autopilot::codec::{Decoded, Frame, FrameDecoder};

/// What a piece costs beside its bytes, so that empty ones are bounded, too.
const PIECE: usize = 64;
/// Bytes of one peer that wait at most: two of the largest datagrams, or some 3,000 messages.
const CAPACITY: usize = 2 * ((1 << 16) + PIECE);
/// An incomplete frame is given up after this long a silence: the longest one takes 50 ms on a slow serial line.
const SILENCE: Duration = Duration::from_millis(200);

/// Bytes as they came: a datagram, or a part of a stream.
#[derive(Clone, Debug)]
struct Piece {
    bytes: Vec<u8>,
    /// Whether a frame can go on in the next piece.
    stream: bool,
    arrival: u64,
    sender: u64,
}

/// Received bytes that wait to be decoded, frame by frame.
#[derive(Clone, Debug, Default)]
pub struct Inbox {
    pieces: VecDeque<Piece>,
    /// Bytes in the pieces, with what they cost beside.
    queued: usize,
    decoder: FrameDecoder,
    /// Whether the decoder has bytes that it has not looked at.
    decoding: bool,
    /// Whether what the decoder has is all that belongs together.
    ended: bool,
    /// Of the piece that is being decoded.
    arrival: u64,
    sender: u64,
    last_bytes: Option<Instant>,
}

impl Inbox {
    /// How many more bytes of a stream it takes now.
    pub fn room(&self) -> usize {
        self.room_for_a_piece().unwrap_or(0)
    }

    fn room_for_a_piece(&self) -> Option<usize> {
        CAPACITY.checked_sub(self.queued + self.decoder.waiting_bytes() + PIECE)
    }

    /// Takes bytes of a sender in, which have arrived as number `arrival` of all; `stream`: whether a frame can go on in the
    /// next ones. `false`: there is no room, and they are lost.
    pub fn put(&mut self, bytes: Vec<u8>, sender: u64, stream: bool, arrival: u64, now: Instant) -> bool {
        self.last_bytes = Some(now);
        if self.room_for_a_piece().is_none_or(|room| bytes.len() > room) {
            return false;
        }
        self.queued += bytes.len() + PIECE;
        self.pieces.push_back(Piece { bytes, stream, arrival, sender });
        true
    }

    /// If there is something to decode, the number of its arrival.
    pub fn waiting(&self, now: Instant) -> Option<u64> {
        let next = self.pieces.front().map(|piece| piece.arrival);
        if self.decoding || self.is_overdue(now) { Some(self.arrival) } else { next }
    }

    /// What waits of the sender that is being decoded, as an inbox of its own: its frames stay in their order.
    pub fn split_off(&mut self) -> Self {
        let sender = self.sender;
        let (own, others): (VecDeque<_>, VecDeque<_>) =
            std::mem::take(&mut self.pieces).into_iter().partition(|piece| piece.sender == sender);
        let queued = own.iter().map(|piece| piece.bytes.len() + PIECE).sum();
        (self.pieces, self.queued) = (others, self.queued.saturating_sub(queued));
        Self {
            pieces: own,
            queued,
            decoder: std::mem::take(&mut self.decoder),
            decoding: std::mem::take(&mut self.decoding),
            ..*self
        }
    }

    /// Whether the rest of a frame is waited for in vain.
    fn is_overdue(&self, now: Instant) -> bool {
        let silent = self.last_bytes.is_some_and(|last| now.saturating_duration_since(last) > SILENCE);
        silent && self.pieces.is_empty() && self.decoder.waiting_bytes() > 0
    }

    /// Decodes a bounded number of bytes, and returns the frame that was found, if one was, and its sender.
    pub fn decode(&mut self, now: Instant) -> Option<(u64, Frame)> {
        if !self.decoding {
            if let Some(Piece { bytes, stream, arrival, sender }) = self.pieces.pop_front() {
                self.queued = self.queued.saturating_sub(bytes.len() + PIECE);
                self.decoder.feed(&bytes);
                (self.ended, self.arrival, self.sender) = (!stream, arrival, sender);
            } else if self.is_overdue(now) {
                self.ended = true;
            } else {
                return None;
            }
        }
        let decoded = self.decoder.step(self.ended);
        self.decoding = decoded != Decoded::Starved;
        match decoded {
            Decoded::Frame(frame) => Some((self.sender, frame)),
            Decoded::Noise | Decoded::Starved => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use autopilot::codec::{Frame, FrameDecoder, Version};
    use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage, SYSTEM_TIME_DATA};
    use proptest::prelude::*;

    use super::{CAPACITY, Inbox, PIECE, SILENCE};

    fn bytes() -> Vec<u8> {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        let frame = Frame::encode(&message.into(), Version::Two, 0, (255, 190));
        frame.expect("a message of MAVLink 2").bytes().to_vec()
    }

    /// Frames found by decoding all that can be decoded, and the calls that it took.
    fn decoded(inbox: &mut Inbox, now: Instant) -> (usize, usize) {
        let (mut frames, mut calls) = (0, 0);
        while inbox.waiting(now).is_some() {
            frames += usize::from(inbox.decode(now).is_some());
            calls += 1;
        }
        (frames, calls)
    }

    #[test]
    fn a_call_decodes_one_frame() {
        let (mut inbox, now) = (Inbox::default(), Instant::now());
        assert_eq!((inbox.waiting(now), inbox.decode(now)), (None, None));
        assert!(inbox.put(bytes().repeat(3), 1, false, 7, now));
        assert!(inbox.put(bytes(), 1, false, 8, now));
        for arrival in [7, 7, 7] {
            assert_eq!(inbox.waiting(now), Some(arrival));
            assert!(inbox.decode(now).is_some());
        }
        assert_eq!(inbox.decode(now), None, "the first datagram ends");
        assert_eq!(inbox.waiting(now), Some(8));
        assert_eq!(decoded(&mut inbox, now).0, 1);
    }

    /// Each of these bytes could begin a frame of 255 bytes.
    #[test]
    fn noise_is_decoded_in_bounded_steps() {
        let (mut inbox, now) = (Inbox::default(), Instant::now());
        let noise: Vec<u8> = [0xfe, 255, 0, 0, 0, 0].repeat(10_000);
        let length = noise.len();
        assert!(inbox.put(noise, 1, false, 0, now));
        let (frames, calls) = decoded(&mut inbox, now);
        assert_eq!(frames, 0);
        assert!((length / 64..length / 64 + 8).contains(&calls), "{calls}");
    }

    #[test]
    fn what_there_is_no_room_for_is_lost_as_a_whole() {
        let (mut inbox, now) = (Inbox::default(), Instant::now());
        let datagram = vec![0; 65_507];
        let put = |inbox: &mut Inbox, bytes: &[u8]| inbox.put(bytes.to_vec(), 1, false, 0, now);
        assert_eq!([&datagram; 3].map(|datagram| put(&mut inbox, datagram)), [true, true, false]);
        // Empty ones are bounded, too.
        let (mut inbox, mut taken) = (Inbox::default(), 0);
        while put(&mut inbox, &[]) && taken < CAPACITY {
            taken += 1;
        }
        assert!(taken <= CAPACITY / PIECE, "{taken}");
        assert_eq!(decoded(&mut inbox, now).0, 0);
        assert_eq!(inbox.room(), CAPACITY - PIECE, "room again");
    }

    #[test]
    fn a_frame_of_a_stream_comes_in_parts_and_one_that_stays_incomplete_is_given_up() {
        let (mut inbox, now) = (Inbox::default(), Instant::now());
        let (whole, rest) = (bytes(), bytes().split_off(5));
        assert!(inbox.put(whole[..5].to_vec(), 1, true, 0, now));
        assert_eq!(decoded(&mut inbox, now).0, 0);
        assert!(inbox.put(rest, 1, true, 0, now));
        assert_eq!(decoded(&mut inbox, now).0, 1);

        // A lost byte: the marker of a long frame swallows a short one until it is given up.
        let message = MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA { time_unix_usec: 1, time_boot_ms: 1 });
        let long = Frame::encode(&message.into(), Version::Two, 0, (255, 190)).expect("MAVLink 2");
        assert!(inbox.put([&long.bytes()[..3], &whole].concat(), 1, true, 0, now));
        let (before, after) = (now + SILENCE, now + SILENCE * 2);
        assert_eq!(decoded(&mut inbox, before).0 + decoded(&mut inbox, after).0, 1);
        assert_eq!(inbox.waiting(after), None);
    }

    #[test]
    fn what_waits_of_one_sender_moves_in_its_order() {
        let (mut shared, now) = (Inbox::default(), Instant::now());
        for (arrival, sender) in [(1, 7), (2, 8), (3, 7)] {
            assert!(shared.put(bytes().repeat(2), sender, false, arrival, now));
        }
        assert_eq!(shared.decode(now).map(|(sender, _)| sender), Some(7));
        let mut own = shared.split_off();
        assert_eq!((own.waiting(now), shared.waiting(now)), (Some(1), Some(2)));
        let senders = |inbox: &mut Inbox| {
            let mut senders = Vec::new();
            while inbox.waiting(now).is_some() {
                senders.extend(inbox.decode(now).map(|(sender, _)| sender));
            }
            senders
        };
        assert_eq!((senders(&mut own), senders(&mut shared)), (vec![7, 7, 7], vec![8, 8]));
        assert_eq!((own.room(), shared.room()), (CAPACITY - PIECE, CAPACITY - PIECE));
    }

    proptest! {
        /// However a stream is cut: its frames are those that decoding it as a whole finds.
        #[test]
        fn cuts_change_nothing(
            parts in prop::collection::vec((prop::collection::vec(any::<u8>(), 0..40), any::<bool>()), 1..20),
            cuts in prop::collection::vec(1_usize..60, 1..40),
        ) {
            let of = |(noise, frame): &(Vec<u8>, bool)| if *frame { bytes() } else { noise.clone() };
            let stream: Vec<u8> = parts.iter().flat_map(of).collect();
            let (mut inbox, now) = (Inbox::default(), Instant::now());
            let mut rest = stream.as_slice();
            for cut in cuts.iter().cycle().take(stream.len()) {
                let (piece, behind) = rest.split_at((*cut).min(rest.len()));
                prop_assert!(inbox.put(piece.to_vec(), 1, true, 0, now));
                rest = behind;
            }
            let whole = FrameDecoder::default().push(&stream);
            prop_assert_eq!(decoded(&mut inbox, now).0, whole.len());
        }
    }
}
