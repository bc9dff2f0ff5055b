//! ArduPilot's logs: their shape, when they begin and end, and what LOG_BITMASK chooses.

use crate::common;
use crate::common::requests::set_parameter;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use crate::common::Bench;
use mavlink::dialects::ardupilotmega::{MavCmd, MavFrame, MavMessage, OBSTACLE_DISTANCE_3D_DATA};
use sitl::files::LogFolder;
use sitl::flight_log::{FlightLog, LogSettings, LogStart, MESSAGES};
use vehicle::identity::Identity;

/// Rows of a log by the names of their messages: each field by its name.
type Rows = BTreeMap<String, Vec<BTreeMap<String, f64>>>;

fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8(bytes[..end].to_vec()).expect("text")
}

/// The number at the front of some bytes, as the published format has its letter, and how long it is.
fn number(kind: char, bytes: &[u8]) -> (f64, usize) {
    macro_rules! of {
        ($kind:ty, $length:literal, $scale:literal) => {
            (<$kind>::from_le_bytes(bytes[..$length].try_into().expect("bytes")) as f64 * $scale, $length)
        };
    }
    match kind {
        'b' => of!(i8, 1, 1.0),
        'B' | 'M' => of!(u8, 1, 1.0),
        'h' => of!(i16, 2, 1.0),
        'H' => of!(u16, 2, 1.0),
        'c' => of!(i16, 2, 0.01),
        'C' => of!(u16, 2, 0.01),
        'i' => of!(i32, 4, 1.0),
        'I' => of!(u32, 4, 1.0),
        'e' => of!(i32, 4, 0.01),
        'E' => of!(u32, 4, 0.01),
        'L' => of!(i32, 4, 1e-7),
        'f' => of!(f32, 4, 1.0),
        'd' => of!(f64, 8, 1.0),
        'q' => of!(i64, 8, 1.0),
        'Q' => of!(u64, 8, 1.0),
        'n' => (f64::NAN, 4),
        'N' => (f64::NAN, 16),
        'Z' => (f64::NAN, 64),
        other => panic!("{other}"),
    }
}

/// Reads a log by its own FMT messages alone.
fn read(path: &Path) -> (Rows, Vec<String>) {
    let log = std::fs::read(path).expect("a log");
    let (mut formats, mut rows, mut lines) = (BTreeMap::new(), Rows::new(), Vec::new());
    formats.insert(128, ("FMT".to_owned(), 89, "BBnNZ".to_owned(), String::new()));
    let mut at = 0;
    while at < log.len() {
        assert_eq!(log[at..at + 2], [0xa3, 0x95], "at {at}");
        let (name, length, kinds, labels) = formats.get(&log[at + 2]).expect("a format before data").clone();
        let body = &log[at + 3..at + length];
        at += length;
        if name == "FMT" {
            let format = (text(&body[2..6]), usize::from(body[1]), text(&body[6..22]), text(&body[22..86]));
            formats.insert(body[0], format);
            continue;
        }
        if name == "MSG" {
            lines.push(text(&body[8..]));
        }
        let (mut rest, mut row) = (body, BTreeMap::new());
        assert_eq!(kinds.len(), labels.split(',').count(), "{name}");
        for (kind, label) in kinds.chars().zip(labels.split(',')) {
            let (value, size) = number(kind, rest);
            rest = &rest[size..];
            row.insert(label.to_owned(), value);
        }
        assert!(rest.is_empty(), "{name}");
        rows.entry(name).or_default().push(row);
    }
    (rows, lines)
}

/// A vehicle, its log, and where that is.
struct Logged {
    bench: Bench,
    log: FlightLog,
    place: tempfile::TempDir,
    now: Instant,
}

impl Logged {
    fn new() -> Self {
        let place = tempfile::tempdir().expect("a folder");
        let folder = LogFolder::open(place.path()).expect("a folder");
        let settings =
            LogSettings { folder: None, start: LogStart::Arm, most_bytes: u64::MAX, most_files: 10 };
        // A Sunday in 2024.
        let unix_us = 1_720_000_000_000_000;
        let bench = Bench::started_at(&common::settings(Identity::ArduPilot), unix_us);
        Self { bench, log: FlightLog::new(folder, settings), place, now: Instant::now() }
    }

    fn fly(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1000.0) as usize {
            self.bench.fly(0.001);
            self.log.tick(&mut self.bench.autopilot, self.now);
        }
    }

    fn set(&mut self, name: &str, value: f64) {
        self.bench.send(set_parameter(name, value as f32));
    }

    fn flight(&mut self) {
        assert_eq!(self.bench.set_mode(vehicle::Mode::Offboard), 0);
        self.bench.arm();
        assert_eq!(self.bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0]), 0);
        self.fly(7.0);
        assert_eq!(self.bench.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), 0);
        self.fly(16.0);
        assert!(!self.bench.autopilot.vehicle().is_armed());
    }

    fn logs(&mut self) -> Vec<std::path::PathBuf> {
        self.log.finish(&mut self.bench.autopilot);
        let entries = std::fs::read_dir(self.place.path()).expect("a folder");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "BIN"));
        paths.sort();
        paths
    }
}

#[test]
fn a_flight_is_in_the_log_with_its_happenings() {
    let mut logged = Logged::new();
    logged.fly(0.5);
    logged.flight();
    let truth = *logged.bench.autopilot.vehicle().truth();
    let last = std::fs::read_to_string(logged.place.path().join("LASTLOG.TXT")).expect("there");
    assert_eq!(last, "1\r\n");
    let paths = logged.logs();
    assert!(paths.len() == 1 && paths[0].ends_with("00000001.BIN"), "{paths:?}");
    let (rows, lines) = read(&paths[0]);
    let names = ["ATT", "GPS", "IMU", "XKF4", "PARM", "MODE", "EV", "ARM", "ORGN", "UNIT", "MULT", "FMTU"];
    for name in names.iter().copied().chain(MESSAGES.iter().map(|message| message.name)) {
        // A vehicle without rangefinders or a target of landings says nothing of them.
        assert_eq!(rows.contains_key(name), !["RFND", "PL", "PRX", "PRXR"].contains(&name), "{name}");
    }
    // SITL, ArduCopter, and this program's version.
    let written = rows["VER"][0].clone();
    let version = env!("CARGO_PKG_VERSION").split('.').map(|part| part.parse::<f64>().unwrap());
    assert!(version.eq(["Maj", "Min", "Pat"].map(|name| written[name])), "{written:?}");
    assert_eq!((written["BT"], written["BU"]), (3.0, 2.0));
    assert!(lines[0].contains("Copter") && lines.iter().any(|line| line == "Armed"), "{lines:?}");
    let column =
        |message: &str, field: &str| -> Vec<f64> { rows[message].iter().map(|row| row[field]).collect() };
    let highest = column("CTUN", "Alt").into_iter().fold(0.0, f64::max);
    assert!((4.8..5.2).contains(&highest), "{highest} m");
    // Armed, disarmed; in the air and back: ArduCopter's numbers.
    assert_eq!(column("EV", "Id"), [10.0, 18.0, 28.0, 18.0, 11.0]);
    assert_eq!(column("ARM", "ArmState"), [1.0, 0.0]);
    assert_eq!(column("MODE", "ModeNum")[..2], [4.0, 9.0]);
    // 1 720 000 000 s after 1970 is week 2321 of GPS.
    assert!(column("GPS", "GWk").iter().all(|week| *week == 2321.0));
    let frame = logged.bench.autopilot.vehicle().frame();
    let place = frame.to_geodetic(&truth.position_m);
    let latitude = column("SIM", "Lat");
    assert!((latitude[latitude.len() - 1] - place.latitude_deg).abs() < 2e-6);
    // Ten times a second while it is written.
    let times = column("ATT", "TimeUS");
    assert!(times.windows(2).all(|pair| (1.0..=100_000.0).contains(&(pair[1] - pair[0]))));
    assert!(column("BAT", "Volt").iter().all(|volt| (9.0..13.0).contains(volt)));
    let power: Vec<f64> = column("RCOU", "C1");
    assert!(
        power.iter().all(|pulse| (1000.0..=2000.0).contains(pulse))
            && power.iter().any(|pulse| *pulse > 1300.0)
    );
}

#[test]
fn one_log_serves_a_boot_unless_it_rotates() {
    for (rotates, expected) in [(0.0, 1), (1.0, 2)] {
        let mut logged = Logged::new();
        logged.set("LOG_FILE_DSRMROT", rotates);
        for _ in 0..2 {
            logged.flight();
            logged.fly(16.0);
        }
        assert_eq!(logged.logs().len(), expected, "LOG_FILE_DSRMROT {rotates}");
    }
    let mut logged = Logged::new();
    logged.fly(2.0);
    assert!(logged.logs().is_empty());
    logged.set("LOG_DISARMED", 1.0);
    logged.fly(2.0);
    logged.bench.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    logged.fly(2.0);
    let paths = logged.logs();
    assert_eq!(paths.len(), 2, "another one with each boot");
    let (rows, _) = read(&paths[1]);
    let first_us = rows["ATT"][0]["TimeUS"];
    assert!(first_us < 1e6, "{first_us}: time begins with the boot");
}

#[test]
fn the_bit_mask_chooses() {
    let counts = |bits: f64| {
        let mut logged = Logged::new();
        logged.set("LOG_BITMASK", bits);
        logged.set("LOG_DISARMED", 1.0);
        logged.fly(2.0);
        let paths = logged.logs();
        let (rows, _) = read(&paths[0]);
        ["ATT", "IMU", "GPS", "BARO", "ANG"].map(|name| rows.get(name).map_or(0, Vec::len))
    };
    let [attitude, inertial, receiver, barometer, control] = counts(0.0);
    assert_eq!((attitude, inertial, receiver, control), (0, 0, 0, 0));
    assert!((19..=22).contains(&barometer), "{barometer}");
    let [attitude, inertial, receiver, _, control] = counts(1.0 + 4.0 + 262_144.0);
    assert!((195..=205).contains(&attitude) && (195..=205).contains(&inertial), "{attitude}, {inertial}");
    assert!((9..=12).contains(&receiver), "{receiver}");
    // 400 times a second, as often as ArduCopter's control loop runs.
    assert!((796..=804).contains(&control), "{control}");
}

/// Suite: BaseLoggingRates.
#[test]
fn rates_without_fast_bits_are_arducopters() {
    let mut logged = Logged::new();
    logged.set("LOG_DISARMED", 1.0);
    logged.fly(4.0);
    let (rows, _) = read(&logged.logs()[0]);
    for (name, rate) in [("ATT", 10.0), ("ANG", 10.0), ("IMU", 25.0)] {
        let count = rows[name].len() as f64;
        assert!((count / 4.0 - rate).abs() < 1.0, "{name}: {count}");
    }
}

/// Suite: AC_Avoidance_Proximity. The simulated sensor of a vehicle among no obstacles sees nothing within its range; what a companion
/// tells is nearer.
#[test]
fn what_is_measured_around_is_in_the_log() {
    let mut logged = Logged::new();
    for (name, value) in [("LOG_DISARMED", 1.0), ("PRX1_TYPE", 10.0), ("PRX_LOG_RAW", 1.0)] {
        logged.set(name, value);
    }
    logged.fly(1.0);
    for _ in 0..10 {
        // 4.5 m to the right and a little behind: 100 degrees from the nose.
        let (right, ahead) = 100_f32.to_radians().sin_cos();
        logged.bench.send(MavMessage::OBSTACLE_DISTANCE_3D(OBSTACLE_DISTANCE_3D_DATA {
            x: 4.5 * ahead,
            y: 4.5 * right,
            min_distance: 0.1,
            max_distance: 20.0,
            frame: MavFrame::MAV_FRAME_BODY_FRD,
            ..OBSTACLE_DISTANCE_3D_DATA::default()
        }));
        logged.fly(0.1);
    }
    let (rows, _) = read(&logged.logs()[0]);
    for name in ["PRX", "PRXR"] {
        assert!((19..=22).contains(&rows[name].len()), "{name}: {}", rows[name].len());
        let (first, last) = (&rows[name][5], &rows[name][15]);
        for direction in (0..360).step_by(45) {
            let label = format!("D{direction}");
            let expected_m = if direction == 90 { 4.5 } else { 40.0 };
            assert_eq!(first[&label], 40.0, "{name} {label}");
            assert!((last[&label] - expected_m).abs() < 0.1, "{name} {label}: {}", last[&label]);
        }
    }
    let (first, last) = (&rows["PRX"][5], &rows["PRX"][15]);
    assert_eq!((first["CDis"], last["He"], last["Layer"]), (0.0, 2.0, 2.0));
    assert!((last["CDis"] - 4.5).abs() < 0.1, "{}", last["CDis"]);
    assert!((last["CAn"] - 100.0).abs() <= 5.0, "{}", last["CAn"]);
}

#[test]
fn every_message_fits_its_description() {
    for message in MESSAGES {
        assert!(message.name.len() <= 4 && message.labels().len() <= 64, "{}", message.name);
        assert!(message.fields.len() < 16, "{}", message.name);
    }
}

/// Suite: CameraLogMessages: an image is in the log with the place and the attitude that clients are told.
#[test]
fn images_are_in_the_log_with_their_places() {
    let mut logged = Logged::new();
    assert_eq!(logged.bench.set_mode(vehicle::Mode::Offboard), 0);
    logged.bench.arm();
    assert_eq!(logged.bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0]), 0);
    let mut told = Vec::new();
    for seconds in [3.0, 9.0] {
        logged.fly(seconds);
        assert_eq!(
            logged.bench.command(MavCmd::MAV_CMD_DO_DIGICAM_CONTROL, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
            0
        );
        logged.fly(0.1);
        let feedback = |message: &autopilot::codec::Message| match message {
            autopilot::codec::Message::Typed(MavMessage::CAMERA_FEEDBACK(told)) => Some(told.clone()),
            _ => None,
        };
        told.extend(logged.bench.heard.iter().filter_map(feedback));
    }
    let (rows, _) = read(&logged.logs()[0]);
    assert_eq!((told.len(), rows["CAM"].len()), (2, 2));
    for (row, told) in rows["CAM"].iter().zip(&told) {
        for (name, expected, within) in [
            ("Lat", f64::from(told.lat) / 1e7, 2e-7),
            ("Lng", f64::from(told.lng) / 1e7, 2e-7),
            ("Alt", f64::from(told.alt_msl), 0.02),
            ("RelAlt", f64::from(told.alt_rel), 0.02),
            ("GPSAlt", f64::from(told.alt_msl), 1.0),
            ("R", f64::from(told.roll), 0.01),
            ("P", f64::from(told.pitch), 0.01),
            ("Y", f64::from(told.yaw), 0.01),
            ("Img", f64::from(told.img_idx), 0.0),
            ("GPSWeek", 2321.0, 0.0),
        ] {
            assert!((row[name] - expected).abs() <= within, "{name}: {} and {expected}", row[name]);
        }
    }
    assert!(told[1].alt_rel > 9.0 && told[0].alt_rel < 8.0);
}
