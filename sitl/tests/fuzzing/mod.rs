//! A fuzzer of what comes over links: real frames, changed, cut, spliced and mixed with noise, into the decoder and the
//! vehicle. The same seed makes the same bytes.

use mavlink::dialects::common::MavMessage;
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use sitl::Autopilot;
use sitl::codec::{Frame, FrameDecoder};
use sitl::identity::Identity;
use sitl::parameters::Speed;
use sitl::record::Digest;
use sitl::service::{LinkProfile, Origin, PeerId};
use sitl::vehicle::VehicleSettings;

const CORPUS: &str = include_str!("../corpus/frames.txt");

/// Pieces of bytes of one case.
const PIECES: usize = 600;
/// After these every bounded memory has been filled once.
const WARM_UP: usize = 200;
/// What a case may hold more at its end than after that, bytes.
const GROWTH: i64 = 64 * 1024;
/// What the decoder may hold: less than the longest frame.
const LONGEST_FRAME: usize = 280;
/// Numbers that break things.
const NUMBERS: [f32; 10] =
    [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, -1e38, 1e-42, -0.0, 0.0, 2_147_483_648.0, -1.0];

/// The frames of the corpus.
pub fn corpus() -> Vec<Vec<u8>> {
    let bytes = |line: &str| {
        let hex = line.split(' ').nth(1).expect("a name and bytes");
        (0..hex.len()).step_by(2).map(|i| u8::from_str_radix(&hex[i..i + 2], 16).expect("hex")).collect()
    };
    CORPUS.lines().map(bytes).collect()
}

/// Tells how a case that failed is repeated.
struct Repeat(u64);

impl Drop for Repeat {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("repeat it: cargo run -p sitl --example fuzz -- --seed {} --cases 1", self.0);
        }
    }
}

/// Flies one case: bytes of all kinds, in streams and datagrams, from many peers. Panics if the vehicle does, if its flight
/// ends, or if its memory grows. Returns the number of frames that arrived.
pub fn case(seed: u64, corpus: &[Vec<u8>]) -> u64 {
    let _repeat = Repeat(seed);
    let mut bytes = Bytes { corpus, random: Pcg64Mcg::seed_from_u64(seed) };
    let identity = if seed.is_multiple_of(2) { Identity::Px4 } else { Identity::ArduPilot };
    let mut target = Target::new(identity);
    if bytes.below(2) == 0 {
        target.take_off();
    }
    for _ in 0..WARM_UP {
        target.receive(&mut bytes);
    }
    let memory = allocation_counter::measure(|| {
        for _ in WARM_UP..PIECES {
            target.receive(&mut bytes);
        }
    });
    assert!(memory.bytes_current < GROWTH, "seed {seed}: memory grew by {} bytes", memory.bytes_current);
    target.frames
}

/// Flies the same orders twice, once with garbage between them, and compares the flights.
pub fn undisturbed(seed: u64, corpus: &[Vec<u8>]) {
    let _repeat = Repeat(seed);
    let fly = |disturbed: bool| {
        let mut bytes = Bytes { corpus, random: Pcg64Mcg::seed_from_u64(seed) };
        let mut target = Target::new(Identity::Px4);
        target.take_off();
        let (mut digest, mut decoder) = (Digest::default(), FrameDecoder::default());
        for tick in 0..8_000 {
            if disturbed && tick % 3 == 0 {
                for frame in decoder.datagram(&bytes.garbage()) {
                    target.autopilot.receive(&origin(tick % 400, &frame), &frame);
                }
            }
            if tick % 2_000 == 1_000 {
                let place = [tick as f32 / 1000.0, -2.0, -4.0];
                target.order(84, &position_target(place));
                target.order(76, &command(176, [1.0, 6.0, 0.0]));
            } else if tick % 100 == 0 && tick > 1_000 {
                target.order(84, &position_target([((tick / 2_000) * 2 + 1) as f32, -2.0, -4.0]));
            }
            target.tick();
            digest.update(target.autopilot.vehicle());
        }
        assert!(target.autopilot.vehicle().outputs().position_m.norm() > 3.0, "it has not flown");
        digest.value()
    };
    assert_eq!(fly(false), fly(true), "garbage changed the flight");
}

/// The vehicle and the decoder before it.
struct Target {
    autopilot: Autopilot,
    stream: FrameDecoder,
    frames: u64,
}

impl Target {
    fn new(identity: Identity) -> Self {
        let arguments = sitl::configuration::Arguments { autopilot: Some(identity), ..Default::default() };
        let settings: VehicleSettings =
            sitl::configuration::Settings::resolve(&arguments).expect("defaults").vehicles[0].vehicle.clone();
        let links = [LinkProfile::Ground, LinkProfile::Onboard];
        let autopilot = Autopilot::new(&settings, 1, Speed::Max, &links, 0).expect("defaults");
        Self { autopilot, stream: FrameDecoder::default(), frames: 0 }
    }

    fn order(&mut self, id: u32, payload: &[u8]) {
        let frame = Frame::parse(&framed(2, [9, 255, 190], id, payload)).expect("a frame");
        self.autopilot.receive(&origin(0, &frame), &frame);
    }

    fn take_off(&mut self) {
        self.order(76, &command(400, [1.0, 21196.0, 0.0]));
        self.order(76, &command(22, [f32::NAN; 3]));
        for _ in 0..1_500 {
            self.tick();
        }
    }

    fn tick(&mut self) {
        self.autopilot.tick().expect("the flight goes on");
        drop(self.autopilot.take_outgoing());
    }

    /// One piece of bytes from a peer, then some time.
    fn receive(&mut self, bytes: &mut Bytes<'_>) {
        let piece = bytes.piece();
        let frames = match bytes.below(2) {
            0 => FrameDecoder::default().datagram(&piece),
            _ => {
                let cut = bytes.below(piece.len() + 1);
                let mut frames = self.stream.push(&piece[..cut]);
                frames.extend(self.stream.push(&piece[cut..]));
                frames
            }
        };
        assert!(self.stream.waiting_bytes() <= LONGEST_FRAME);
        for frame in frames {
            self.frames += 1;
            self.autopilot.receive(&origin(bytes.below(400) as u64, &frame), &frame);
        }
        for _ in 0..bytes.below(12) {
            self.tick();
        }
        let outputs = self.autopilot.vehicle().outputs();
        assert!(outputs.position_m.iter().chain(&outputs.velocity_m_s).all(|number| number.is_finite()));
    }
}

fn origin(peer: u64, frame: &Frame) -> Origin {
    let peer = PeerId { link: (peer % 2) as usize, number: peer as _ };
    Origin { peer, system: frame.system(), component: frame.component() }
}

/// Bytes made of the corpus.
struct Bytes<'a> {
    corpus: &'a [Vec<u8>],
    random: Pcg64Mcg,
}

impl Bytes<'_> {
    fn below(&mut self, end: usize) -> usize {
        (self.random.next_u64() % end.max(1) as u64) as usize
    }

    fn noise(&mut self) -> Vec<u8> {
        let length = self.below(400);
        (0..length).map(|_| self.random.next_u64() as u8).collect()
    }

    fn real(&mut self) -> Vec<u8> {
        self.corpus[self.below(self.corpus.len())].clone()
    }

    /// A whole frame with another content.
    fn changed(&mut self) -> Vec<u8> {
        let frame = Frame::parse(&self.real()).expect("the corpus has frames");
        let mut payload = frame.payload_bytes().to_vec();
        let mut id = frame.message_id();
        for _ in 0..=self.below(4) {
            let at = self.below(payload.len());
            match self.below(6) {
                0 => {
                    if let Some(byte) = payload.get_mut(at) {
                        *byte ^= 1 << (self.random.next_u64() % 8);
                    }
                }
                1 => {
                    let number = NUMBERS[self.below(NUMBERS.len())].to_le_bytes();
                    if let Some(place) = payload.get_mut(at / 4 * 4..at / 4 * 4 + 4) {
                        place.copy_from_slice(&number);
                    }
                }
                2 => {
                    let value = [0, 1, 127, 128, 254, 255][self.below(6)];
                    if let Some(byte) = payload.get_mut(at) {
                        *byte = value;
                    }
                }
                3 => payload.truncate(at),
                4 => {
                    let longer = self.below(256);
                    payload.resize(longer, self.random.next_u64() as u8);
                }
                _ => {
                    let other = Frame::parse(&self.real()).expect("the corpus has frames");
                    id = other.message_id();
                }
            }
        }
        let version = if id < 256 && self.below(4) == 0 { 1 } else { 2 };
        let sender = [self.random.next_u64() as u8, 250 + self.below(6) as u8, 190];
        framed(version, sender, id, &payload)
    }

    /// Anything.
    fn piece(&mut self) -> Vec<u8> {
        match self.below(10) {
            0 => self.noise(),
            1 => {
                // Cut anywhere.
                let mut bytes = self.real();
                bytes.truncate(self.below(bytes.len()));
                bytes
            }
            2 => {
                // Changed anywhere, the checksum left as it is.
                let mut bytes = self.real();
                let at = self.below(bytes.len());
                bytes[at] ^= 1 << self.below(8);
                bytes
            }
            3 => {
                // The head of one and the tail of another.
                let (mut bytes, other) = (self.real(), self.real());
                bytes.truncate(self.below(bytes.len()));
                bytes.extend(&other[self.below(other.len())..]);
                bytes
            }
            4 => [self.noise(), self.real(), self.changed()].concat(),
            5 | 6 => self.real(),
            _ => self.changed(),
        }
    }

    /// A datagram that means nothing to the vehicle: noise, a frame with a wrong checksum, one that is cut, one for
    /// another system.
    fn garbage(&mut self) -> Vec<u8> {
        let bytes = match self.below(4) {
            0 => self.noise(),
            1 => {
                let mut bytes = self.real();
                bytes.truncate(self.below(bytes.len()));
                bytes
            }
            2 => {
                let mut bytes = self.changed();
                let last = bytes.len() - 1;
                bytes[last] ^= 1 + self.below(255) as u8;
                bytes
            }
            _ => {
                // COMMAND_LONG that disarms by force, for system 99.
                let mut payload = command(400, [0.0, 21196.0, 0.0]);
                payload[30] = 99;
                return framed(2, [0, 255, 190], 76, &payload);
            }
        };
        // A frame hidden in noise would be one.
        if FrameDecoder::default().datagram(&bytes).is_empty() { bytes } else { Vec::new() }
    }
}

fn command(number: u16, [a, b, c]: [f32; 3]) -> Vec<u8> {
    let filler = if a.is_nan() { f32::NAN } else { 0.0 };
    let mut payload: Vec<u8> =
        [a, b, c, filler, filler, filler, filler].iter().flat_map(|value| value.to_le_bytes()).collect();
    payload.extend(number.to_le_bytes());
    payload.extend([1, 1, 0]);
    payload
}

fn position_target([x, y, z]: [f32; 3]) -> Vec<u8> {
    let mut payload = vec![0; 4];
    let numbers = [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    payload.extend(numbers.iter().flat_map(|value| value.to_le_bytes()));
    payload.extend(0b1001_1111_1000_u16.to_le_bytes());
    payload.extend([1, 1, 1]);
    payload
}

/// A frame with its checksum; of an unknown message with a wrong one.
fn framed(version: u8, [sequence, system, component]: [u8; 3], id: u32, payload: &[u8]) -> Vec<u8> {
    let [low, middle, high, _] = id.to_le_bytes();
    let length = payload.len().min(255);
    let mut bytes = match version {
        1 => vec![0xfe, length as u8, sequence, system, component, low],
        _ => vec![0xfd, length as u8, 0, 0, sequence, system, component, low, middle, high],
    };
    bytes.extend(&payload[..length]);
    let extra = <MavMessage as mavlink::Message>::extra_crc(id);
    let checksum = mavlink::calculate_crc(&bytes[1..], extra);
    bytes.extend(checksum.to_le_bytes());
    bytes
}
