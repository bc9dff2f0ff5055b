//! Bytes that are no frames, frames that are cut, changed or mean nothing: nothing breaks, and the flight goes on
//! undisturbed.

use crate::common::{Bench, command_long};
use autopilot::codec::{Frame, FrameDecoder, Version, target_of};
use mavlink::Message as _;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use proptest::prelude::*;
use vehicle::identity::Identity;

/// A whole frame around any payload.
fn framed(id: u32, payload: &[u8], version: Version) -> Option<Frame> {
    let [low, middle, high, _] = id.to_le_bytes();
    let mut bytes = match version {
        Version::One if id > 255 => return None,
        Version::One => vec![0xfe, payload.len() as u8, 7, 255, 190, low],
        Version::Two => vec![0xfd, payload.len() as u8, 0, 0, 7, 255, 190, low, middle, high],
    };
    bytes.extend(payload);
    let checksum = mavlink::calculate_crc(&bytes[1..], MavMessage::extra_crc(id));
    bytes.extend(checksum.to_le_bytes());
    Frame::parse(&bytes)
}

/// What the vehicle reads.
const READ: [u32; 23] =
    [0, 4, 11, 20, 21, 23, 43, 44, 45, 48, 66, 69, 70, 75, 76, 82, 84, 86, 110, 111, 117, 256, 77];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Noise yields nothing, and holds no more than one frame's bytes.
    #[test]
    fn noise_does_not_grow(pieces in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..400), 1..40)) {
        let mut decoder = FrameDecoder::default();
        for piece in &pieces {
            decoder.push(piece);
            prop_assert!(decoder.waiting_bytes() <= 300);
        }
        let mut decoder = FrameDecoder::default();
        for piece in &pieces {
            decoder.datagram(piece);
            prop_assert_eq!(decoder.waiting_bytes(), 0);
        }
    }

    /// A frame is found behind noise, in pieces of any size.
    #[test]
    fn a_frame_is_found_behind_noise(
        noise in prop::collection::vec(any::<u8>(), 0..100), cuts in prop::collection::vec(1_usize..20, 1..200),
        old in any::<bool>(),
    ) {
        let version = if old { Version::One } else { Version::Two };
        let message = command_long(MavCmd::MAV_CMD_NAV_LAND, [1.0; 7], 0).into();
        let frame = Frame::encode(&message, version, 3, (255, 190)).unwrap();
        // After an unlucky beginning a false frame may swallow the true one; the next one is found.
        let mut bytes = noise;
        for _ in 0..9 {
            bytes.extend(frame.bytes());
        }
        let mut decoder = FrameDecoder::default();
        let mut found = Vec::new();
        let mut rest = bytes.as_slice();
        for cut in cuts.iter().cycle() {
            let (piece, behind) = rest.split_at((*cut).min(rest.len()));
            found.extend(decoder.push(piece));
            rest = behind;
            if rest.is_empty() { break; }
        }
        prop_assert!(found.contains(&frame));
    }

    /// Any payload of any length of any message that is read: no panic, and the vehicle on the ground stays a number.
    #[test]
    fn any_payload_is_survived(
        frames in prop::collection::vec((prop::sample::select(&READ[..]), prop::collection::vec(any::<u8>(), 0..=255), any::<bool>()), 1..60),
        ardupilot in any::<bool>(),
    ) {
        let mut bench = Bench::new(if ardupilot { Identity::ArduPilot } else { Identity::Px4 });
        for (id, payload, old) in frames {
            let version = if old { Version::One } else { Version::Two };
            if let Some(frame) = framed(id, &payload, version) {
                let _target = target_of(&frame);
                bench.receive(&frame);
                bench.fly(0.003);
            }
        }
        prop_assert!(bench.autopilot.vehicle().outputs().position_m.iter().all(|x| x.is_finite()));
    }

    /// Numbers without meaning in what flies: whatever is asked for, it is flown within limits or refused.
    #[test]
    fn any_set_point_is_flown_or_refused(
        targets in prop::collection::vec((prop::array::uniform11(any::<f32>()), any::<u16>(), 0_u8..22, any::<bool>()), 1..20),
    ) {
        let mut bench = Bench::hovering(Identity::Px4);
        for (values, mask, coordinates, global) in targets {
            let mut payload = vec![0; 4];
            for value in values { payload.extend(value.to_le_bytes()); }
            payload.extend((mask & !(1 << 9)).to_le_bytes());
            payload.extend([1, 1, coordinates]);
            let frame = framed(if global { 86 } else { 84 }, &payload, Version::Two).unwrap();
            bench.receive(&frame);
            bench.set_mode(vehicle::Mode::Offboard);
            bench.fly(0.3);
        }
        let outputs = bench.autopilot.vehicle().outputs();
        prop_assert!(outputs.position_m.iter().chain(&outputs.velocity_m_s).all(|x| x.is_finite()));
        prop_assert!(outputs.velocity_m_s.norm() < 40.0, "{}", outputs.velocity_m_s);
    }
}

/// Frames for others, of unknown kinds and for nobody: the flight is the same, bit for bit.
#[test]
fn the_flight_goes_on_undisturbed() {
    let state = |disturbed: bool| {
        let mut bench = Bench::hovering(Identity::Px4);
        for number in 0..500_u32 {
            if disturbed {
                let payload: Vec<u8> = (0..number % 200).map(|byte| (byte * 37 + number) as u8).collect();
                // SET_POSITION_TARGET to another system, HEARTBEAT, DISTANCE_SENSOR, STATUSTEXT.
                for id in [0, 132, 253] {
                    if let Some(frame) = framed(id, &payload, Version::Two) {
                        bench.receive(&frame);
                    }
                }
                let mut other = vec![0x3f; 53];
                (other[50], other[51]) = (99, 1);
                bench.receive(&framed(84, &other, Version::Two).unwrap());
            }
            bench.fly(0.01);
        }
        bench.autopilot.vehicle().simulation().state()
    };
    assert_eq!(state(false), state(true));
}

/// A cut payload reads as if its zeros were there.
#[test]
fn cut_payloads_mean_the_same() {
    let message = command_long(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0; 7], 0).into();
    let two = Frame::encode(&message, Version::Two, 0, (255, 190)).unwrap();
    let one = Frame::encode(&message, Version::One, 0, (255, 190)).unwrap();
    assert!(two.payload_bytes().len() < one.payload_bytes().len());
    assert_eq!(autopilot::codec::Command::read(&two), autopilot::codec::Command::read(&one));
}

/// Messages of the dialect are found by their numbers, also the one whose checksum begins with zero; others are noise.
#[test]
fn every_known_message_is_read() {
    for id in 0..20_000 {
        let known = MavMessage::default_message_from_id(id).is_some();
        assert_eq!(framed(id, &[1, 2, 3], Version::Two).is_some(), known, "{id}");
    }
}

/// An interval beyond all times is the longest that MESSAGE_INTERVAL can tell.
#[test]
#[allow(deprecated)] // Clients send GET_MESSAGE_INTERVAL all the same.
fn an_endless_interval_is_survived() {
    let mut bench = Bench::new(Identity::Px4);
    for interval in [1e38, f32::INFINITY] {
        let set = [30.0, interval, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, set), 0);
        bench.fly(0.01);
        let get = [30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_GET_MESSAGE_INTERVAL, get), 0);
        let told = bench.heard.iter().any(|message| {
            matches!(message, autopilot::codec::Message::Typed(MavMessage::MESSAGE_INTERVAL(interval))
                if interval.message_id == 30 && interval.interval_us == i32::MAX)
        });
        assert!(told, "{:?}", bench.heard);
    }
}
