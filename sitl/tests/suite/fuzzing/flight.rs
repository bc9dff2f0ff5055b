//! Bytes of all kinds into the decoder and the vehicle.

use std::collections::BTreeSet;

use autopilot::Autopilot;
use autopilot::codec::{Frame, FrameDecoder};
use autopilot::compatibility;
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use autopilot::file_work::Immediate;
use sitl::configuration::{Arguments, Conventions, Settings};
use sitl::files::{Disk, LogFolder};
use sitl::record::Digest;
use tempfile::TempDir;
use vehicle::estimation::SensorModel;
use vehicle::parameters::Speed;

use super::bytes::{Bytes, command, framed, position_target};

/// Pieces of bytes of one case.
const PIECES: usize = 600;
/// After these every bounded memory has been filled once.
const WARM_UP: usize = 200;
/// What a case may hold more at its end than after that, bytes: some plans, open files and descriptions of parameters, which alone
/// are half of it.
const GROWTH: i64 = 768 * 1024;
/// Turns of long answers in a tick.
const TURNS: usize = 1;
/// What the decoder may hold: less than the longest frame.
const LONGEST_FRAME: usize = 280;
/// Flies one case: bytes of all kinds, in streams and datagrams, from many peers. Panics if the vehicle does, if its flight
/// ends, or if its memory grows. Returns the number of frames that arrived.
pub fn anything(seed: u64) -> u64 {
    let mut bytes = Bytes::new(seed);
    let conventions = if seed.is_multiple_of(2) { Conventions::Px4 } else { Conventions::ArduPilot };
    let sensors = if seed.is_multiple_of(8) { SensorModel::Realistic } else { SensorModel::Ideal };
    let mut target = Target::new(conventions, sensors);
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
pub fn undisturbed(seed: u64) -> u64 {
    let fly = |disturbed: bool| {
        let mut bytes = Bytes::new(seed);
        let mut target = Target::new(Conventions::Px4, SensorModel::Ideal);
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
    1
}

/// The vehicle and the decoder before it.
struct Target {
    autopilot: Autopilot,
    stream: FrameDecoder,
    frames: u64,
    /// Messages that the table of compatibility says to be sent.
    sent: BTreeSet<u32>,
    /// What clients may read and write.
    _folder: TempDir,
}

impl Target {
    fn new(conventions: Conventions, sensors: SensorModel) -> Self {
        let arguments =
            Arguments { autopilot: Some(conventions), sensors: Some(sensors), ..Arguments::default() };
        let settings = Settings::resolve(&arguments).expect("defaults").vehicles[0].vehicle.clone();
        let links = [LinkProfile::Ground, LinkProfile::Onboard];
        let mut autopilot = Autopilot::new(&settings, 1, Speed::Max, &links, 0).expect("defaults");
        let folder = tempfile::tempdir().expect("a folder");
        let shared = folder.path().join("shared");
        std::fs::create_dir(&shared).expect("a folder");
        std::fs::write(shared.join("notes.txt"), [b'n'; 5_000]).expect("written");
        let logs = LogFolder::open(&folder.path().join("logs")).expect("a folder");
        std::fs::write(logs.path().join("flight_00001_id1.ulg"), [7; 20_000]).expect("written");
        let disk = Disk::open(Some(&logs), Some(&(shared, true))).expect("folders");
        autopilot.share(Box::new(Immediate(disk)));
        let rows = compatibility::messages().into_iter().filter(|row| row.here.sent);
        let sent = rows.map(|row| row.id).collect();
        Self { autopilot, stream: FrameDecoder::default(), frames: 0, sent, _folder: folder }
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
        // As much as a link of 460800 baud takes.
        self.autopilot.transfer(TURNS, |_| Some(true));
        for outgoing in self.autopilot.take_outgoing() {
            let id = outgoing.message.id();
            assert!(self.sent.contains(&id), "message {id} is sent, but no service claims it in `answers`");
        }
    }

    /// One piece of bytes from a peer, then some time.
    fn receive(&mut self, bytes: &mut Bytes) {
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
        // Most come from a few: who talks with a vehicle stays.
        let peers = if bytes.below(4) == 0 { 400 } else { 3 };
        let peer = bytes.below(peers) as u64;
        for frame in frames {
            self.frames += 1;
            self.autopilot.receive(&origin(peer, &frame), &frame);
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
