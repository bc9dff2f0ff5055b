//! Logs of flights: what is declared is what is written, and logging changes nothing of a flight.

use crate::common;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use crate::common::Bench;
use mavlink::dialects::ardupilotmega::{FailureUnit, MavCmd};
use sitl::files::LogFolder;
use sitl::flight_log::{FlightLog, LogSettings, LogSource, LogStart, Row, TOPICS};
use sitl::record::Digest;
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::identity::Identity;

fn settings(start: LogStart, most_bytes: u64, most_files: usize) -> LogSettings {
    LogSettings { folder: None, start, most_bytes, most_files }
}

/// Bytes of fields as ULog counts them.
fn size(fields: &str) -> usize {
    fields
        .split_terminator(';')
        .map(|field| {
            let kind = field.split(' ').next().expect("a type");
            let (kind, count) = match kind.strip_suffix(']').and_then(|kind| kind.split_once('[')) {
                Some((kind, count)) => (kind, count.parse().expect("a number")),
                None => (kind, 1),
            };
            let each = match kind {
                "bool" | "uint8_t" => 1,
                "uint16_t" => 2,
                "float" | "uint32_t" => 4,
                "double" | "uint64_t" => 8,
                other => panic!("{other}"),
            };
            each * count
        })
        .sum()
}

#[test]
fn every_sample_has_the_bytes_that_its_topic_declares() {
    let bench = Bench::hovering(Identity::Px4);
    for topic in TOPICS {
        let mut row = Row::default();
        (topic.sample)(&LogSource::of(&bench.autopilot), &mut row);
        assert_eq!(row.bytes().len(), size(topic.fields), "{}", topic.name);
        assert!(topic.period_us.is_multiple_of(10_000), "{}", topic.name);
    }
}

/// What a topic says now.
fn sample(bench: &Bench, name: &str) -> Vec<u8> {
    let topic = TOPICS.iter().find(|topic| topic.name == name).expect(name);
    let mut row = Row::default();
    (topic.sample)(&LogSource::of(&bench.autopilot), &mut row);
    row.bytes().to_vec()
}

/// Floats of a topic, from a byte on, beside what they should be.
fn assert_floats<'a>(bench: &Bench, name: &str, from: usize, expected: impl IntoIterator<Item = &'a f64>) {
    let bytes = sample(bench, name);
    for (bytes, expected) in bytes[from..].chunks_exact(4).zip(expected) {
        let value = f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        assert!((f64::from(value) - expected).abs() < 1e-5, "{name}: {value} is not {expected}");
    }
}

fn assert_floats_within(bench: &Bench, name: &str, from: usize, low: f32, high: f32) {
    for bytes in sample(bench, name)[from..].chunks_exact(4) {
        let value = f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        assert!((low..high).contains(&value), "{name}: {value}");
    }
}

/// By realistic sensors the vehicle believes one thing and another is true; and what it no longer knows is marked.
#[test]
fn ground_truth_is_the_truth_and_what_is_not_known_is_not_valid() {
    let mut settings = common::settings(Identity::Px4);
    settings.sensors = SensorSettings { model: SensorModel::Realistic, seed: 3 };
    let mut bench = Bench::of(&settings);
    bench.fly_until("health", 10.0, |bench| bench.autopilot.vehicle().arming_obstacles().is_empty());
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
    bench.fly(10.0);
    let vehicle = bench.autopilot.vehicle();
    let (believed, truth) = (vehicle.outputs(), vehicle.truth());
    assert!((believed.position_m - truth.position_m).norm() > 0.01, "the sensors are not realistic");
    let valid = |bench: &Bench, name: &str| sample(bench, name)[..4].to_vec();
    for (what, outputs) in [("", believed), ("_groundtruth", truth)] {
        let topic = |name: &str| format!("{name}{what}");
        let position = topic("vehicle_local_position");
        assert_eq!(valid(&bench, &position), [1; 4]);
        assert_floats(&bench, &position, 4, outputs.position_m.iter().chain(&outputs.velocity_m_s));
        assert_floats(&bench, &topic("vehicle_attitude"), 0, &outputs.quaternion);
        assert_floats(&bench, &topic("vehicle_angular_velocity"), 0, &outputs.body_rate_rad_s);
        let place = vehicle.frame().to_geodetic(&outputs.position_m);
        let latitude = sample(&bench, &topic("vehicle_global_position"))[..8].to_vec();
        let latitude_deg = f64::from_le_bytes(latitude.try_into().expect("eight bytes"));
        assert!((latitude_deg - place.latitude_deg).abs() < 1e-7, "{latitude_deg}");
    }

    let status = sample(&bench, "estimator_status");
    assert_eq!(status[32..], [0b111, 0]);
    let accuracy_m = f32::from_le_bytes(status[16..20].try_into().expect("four bytes"));
    assert!((0.05..2.0).contains(&accuracy_m), "{accuracy_m}");
    // 70 µg/√Hz over 500 Hz on three axes: 27 mm/s², and what the flight shakes.
    assert_floats_within(&bench, "vehicle_imu_status", 12, 0.02, 0.5);

    let mut no_gps = [0.0; 7];
    (no_gps[0], no_gps[1]) = (FailureUnit::FAILURE_UNIT_SENSOR_GPS as u32 as f32, 1.0);
    assert_eq!(bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, no_gps), 0);
    bench.fly_until("lost", 20.0, |bench| !bench.autopilot.vehicle().validity().horizontal_position);
    assert_eq!(valid(&bench, "vehicle_local_position"), [0, 1, 0, 1]);
    let accuracies = &sample(&bench, "vehicle_gps_position")[40..48];
    assert!(
        accuracies.chunks_exact(4).all(|bytes| f32::from_le_bytes(bytes.try_into().expect("four")).is_nan())
    );
    // The last two bytes: health and timeouts of velocity, position and height.
    assert_eq!(sample(&bench, "estimator_status")[32..], [0b100, 0b011]);
    assert_eq!(valid(&bench, "vehicle_local_position_groundtruth"), [1; 4]);
}

/// Messages of a ULog behind its header: kind and bytes.
fn messages(log: &[u8]) -> Vec<(char, Vec<u8>)> {
    assert_eq!(&log[..8], b"ULog\x01\x12\x35\x01");
    let (mut messages, mut at) = (Vec::new(), 16);
    while at < log.len() {
        let length = usize::from(u16::from_le_bytes([log[at], log[at + 1]]));
        messages.push((char::from(log[at + 2]), log[at + 3..at + 3 + length].to_vec()));
        at += 3 + length;
    }
    messages
}

fn arm_and_disarm(bench: &mut Bench, digest: &mut Digest, log: &mut Option<FlightLog>) {
    let now = Instant::now();
    let mut fly = |bench: &mut Bench, seconds: f64| {
        for _ in 0..(seconds * 1000.0) as usize {
            bench.fly(0.001);
            digest.update(bench.autopilot.vehicle());
            if let Some(log) = log {
                log.tick(&mut bench.autopilot, now);
            }
        }
    };
    for _ in 0..2 {
        fly(bench, 0.5);
        bench.arm();
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
        fly(bench, 6.0);
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), 0);
        fly(bench, 12.0);
        assert!(!bench.autopilot.vehicle().is_armed());
    }
}

#[test]
fn each_flight_has_its_log_and_is_the_same_without() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = LogFolder::open(place.path()).expect("a folder");
    let mut digests = Vec::new();
    for logged in [true, false] {
        let mut log = logged.then(|| FlightLog::new(folder.clone(), settings(LogStart::Arm, u64::MAX, 10)));
        let (mut bench, mut digest) = (Bench::new(Identity::Px4), Digest::default());
        arm_and_disarm(&mut bench, &mut digest, &mut log);
        digests.push(digest.value());
    }
    assert_eq!(digests[0], digests[1]);
    let mut names: Vec<_> = std::fs::read_dir(place.path())
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    names.sort();
    assert_eq!(names.len(), 2, "one for each flight");
    assert!(folder.is_over("flight_00001_id1.ulg") && folder.is_over("flight_00002_id1.ulg"));
    for name in names {
        let messages = messages(&std::fs::read(name).expect("a log"));
        let kinds = messages.iter().fold(BTreeMap::new(), |mut kinds, (kind, _)| {
            *kinds.entry(*kind).or_insert(0) += 1;
            kinds
        });
        assert_eq!((kinds[&'B'], kinds[&'F'], kinds[&'A']), (1, TOPICS.len(), TOPICS.len()));
        // Every second, and at the end.
        assert!(kinds[&'S'] > 10 && !kinds.contains_key(&'O'), "{kinds:?}");
        assert!(kinds[&'P'] > 50 && kinds[&'L'] >= 5, "{kinds:?}");
        // The first thing is the flag message, and data only come behind all definitions.
        assert_eq!((messages[0].0, messages[0].1.len()), ('B', 40));
        let first_data = messages.iter().position(|(kind, _)| *kind == 'D').expect("data");
        assert!(messages[first_data..].iter().all(|(kind, _)| matches!(kind, 'D' | 'L' | 'S' | 'P')));
        // Each topic comes as often as it says, and none jumps in time.
        let mut times: BTreeMap<u16, Vec<u64>> = BTreeMap::new();
        for (_, data) in messages.iter().filter(|(kind, _)| *kind == 'D') {
            let time_us = u64::from_le_bytes(data[2..10].try_into().expect("eight bytes"));
            times.entry(u16::from_le_bytes([data[0], data[1]])).or_default().push(time_us);
        }
        for ((number, topic), times) in (0..).zip(TOPICS).map(|topic| (topic, times.get(&topic.0))) {
            let times = times.unwrap_or_else(|| panic!("{number} {}", topic.name));
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{}", topic.name);
            let most = topic.period_us;
            assert!(times.windows(2).all(|pair| pair[1] - pair[0] <= most), "{}", topic.name);
        }
    }
}

#[test]
fn a_full_file_goes_on_in_the_next_and_the_oldest_go() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = LogFolder::open(place.path()).expect("a folder");
    let mut log = FlightLog::new(folder.clone(), settings(LogStart::Boot, 200_000, 3));
    let mut bench = Bench::new(Identity::Px4);
    let start = Instant::now();
    for _ in 0..60_000 {
        bench.fly(0.001);
        log.tick(&mut bench.autopilot, start);
    }
    // Time stands still, but what was logged is on the disk a second later.
    let newest = |place: &std::path::Path| {
        let paths = std::fs::read_dir(place).expect("a folder").map(|entry| entry.expect("an entry").path());
        paths.max().map(|path| std::fs::read(path).expect("a log")).expect("one")
    };
    bench.fly(0.3);
    bench.autopilot.announce(vehicle::Severity::Info, "the last words");
    bench.fly(0.01);
    log.tick(&mut bench.autopilot, start);
    log.keep_up(&mut bench.autopilot, start + Duration::from_secs(1));
    assert!(newest(place.path()).windows(14).any(|bytes| bytes == b"the last words"));
    log.finish(&mut bench.autopilot);
    let mut last = 0;
    let mut names: Vec<_> = std::fs::read_dir(place.path())
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    names.sort();
    assert_eq!(names.len(), 3);
    for name in names {
        let content = std::fs::read(&name).expect("a log");
        assert!(
            content.len() < 300_000
                && folder.is_over(name.file_name().and_then(|name| name.to_str()).expect("text"))
        );
        // Each is whole, and begins where the one before it has ended.
        let times: Vec<u64> = messages(&content)
            .iter()
            .filter(|(kind, data)| *kind == 'D' && data[..2] == [0, 0])
            .map(|(_, data)| u64::from_le_bytes(data[2..10].try_into().expect("eight bytes")))
            .collect();
        assert!(last == 0 || times[0] - last <= 20_000, "{} after {last}", times[0]);
        last = times[times.len() - 1];
    }
    assert!(last >= 60_000_000);
}
