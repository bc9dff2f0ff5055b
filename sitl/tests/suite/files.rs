//! MAVLink FTP: what may be reached, what not, and files over a channel that loses.

use crate::common;
use crate::common::Bench;
use crate::common::channel::Lossy;
use crate::common::ftp_client::*;
use autopilot::file_work::Immediate;
use sitl::files::Disk;
use tempfile::TempDir;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, Plan, PlanKind};

/// A folder with something in it, beside a secret.
fn shared() -> (TempDir, std::path::PathBuf) {
    let place = tempfile::tempdir().expect("a folder");
    let root = place.path().join("root");
    std::fs::create_dir_all(root.join("below/deeper")).expect("folders");
    std::fs::write(place.path().join("secret"), "secret").expect("written");
    std::fs::write(root.join("hello.txt"), "hello").expect("written");
    std::fs::write(root.join("below/there.txt"), vec![7; 1000]).expect("written");
    (place, root)
}

/// What the root always has, with a camera definition of so many bytes, and what else it has.
fn made_and(others: &[&str], definition: usize) -> Vec<String> {
    let made = ["D@MISSION", "D@PARAM", "Dmetadata", "Dplans"].map(str::to_owned);
    let others = others.iter().map(|name| (*name).to_owned());
    made.into_iter().chain([format!("Fcamera.xml\t{definition}")]).chain(others).collect()
}

#[test]
fn the_root_shows_what_there_is_and_files_read_as_they_are() {
    let (_place, root) = shared();
    let mut client = Client::sharing(&root, false);
    let definition = client.read("/camera.xml").expect("there").len();
    assert_eq!(client.list("/"), Ok(made_and(&["Dfiles"], definition)));
    assert_eq!(client.list(""), client.list("/"));
    // PX4's clients look for its card.
    assert_eq!(client.list("/fs"), Ok(vec!["Dmicrosd".to_owned()]));
    assert_eq!(client.list("/fs/microsd/"), client.list("/"));
    assert_eq!(client.read("/fs/microsd/files/hello.txt"), Ok(b"hello".to_vec()));
    assert_eq!(client.list("/fs/microsdcard"), Err(NOT_FOUND));
    assert_eq!(client.list("/fs/microsd/log"), client.list("/logs"));
    let listed = ["Dbelow", "Fhello.txt\t5"].map(str::to_owned).to_vec();
    assert_eq!(client.list("/files"), Ok(listed.clone()));
    assert_eq!(client.list("files/./"), Ok(listed));
    assert_eq!(client.read("/files/hello.txt"), Ok(b"hello".to_vec()));
    assert_eq!(client.read("files//below/there.txt"), Ok(vec![7; 1000]));
    // The protocol's checksum of "hello": CRC-32 from zero, not inverted.
    let crc = client.on(CHECKSUM, "/files/hello.txt").expect("a checksum");
    assert_eq!(u32::from_le_bytes(crc.try_into().expect("four bytes")), crc32("hello".as_bytes()));
    let general = String::from_utf8(client.read("/metadata/general.json").expect("there")).expect("text");
    let parameters = client.read("metadata/parameters.json").expect("there");
    assert!(general.contains(&format!("\"fileCrc\":{}", crc32(&parameters))), "{general}");
    assert_eq!(client.read("/files/hello.txt/x"), Err(NOT_FOUND));
    assert_eq!(client.read("/files/below"), Err(NOT_FOUND));
    assert_eq!(client.on(99, "/"), Err(UNKNOWN));
    assert_eq!(client.ask(READ, 0, &[0; 10]), Err(INVALID_SESSION));
    // Without anything shared there is nothing to be found.
    let mut bare = Client::of(Disk::default());
    assert_eq!(bare.list("/files"), Err(NOT_FOUND));
    assert_eq!(bare.list("/"), Ok(made_and(&[], definition)));
}

/// What is downloaded is what `--mission` reads.
#[test]
fn the_mission_is_a_file_that_reads_as_the_mission() {
    let item = |frame, command, parameters, position| MissionItem {
        frame,
        command,
        parameters,
        position,
        autocontinue: true,
    };
    let items = vec![
        item(3, 22, [0.0, 0.0, 0.0, f64::NAN], [47.397_742, 8.545_594, 10.0]),
        item(6, 16, [1.5, 2.0, 0.0, f64::NAN], [47.398_1, 8.545_7, 12.25]),
        item(2, 177, [1.0, 2.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        item(2, 20, [0.0; 4], [0.0, 0.0, 0.0]),
    ];
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut settings = common::settings(identity);
        settings.plans.set(PlanKind::Mission, Plan::new(items.clone()));
        let mut client = Client { bench: Bench::of(&settings), sequence: 0 };
        let text = client.read("/plans/mission.waypoints").expect("there");
        let text = String::from_utf8(text).expect("text");
        let site = client.bench.autopilot.vehicle().site();
        let read = vehicle::plan::file::parse(&text, &site).expect("a plan");
        let read = read.get(PlanKind::Mission).items();
        let flown = client.bench.autopilot.vehicle().plans().get(PlanKind::Mission).items();
        assert_eq!(&read[read.len() - 3..], &flown[flown.len() - 3..], "{text}");
        assert_eq!(client.read("/plans/rally.waypoints"), Ok(b"QGC WPL 110\n".to_vec()));
        assert_eq!(client.on(CREATE, "/plans/mission.waypoints"), Err(PROTECTED));
    }
}

/// Paths to what is outside, or is no file.
#[cfg(unix)]
const OUTSIDE: [&str; 20] = [
    "/files/../secret",
    "/files/below/../../secret",
    "/files/absolute",
    "/files/relative",
    "/files/up/secret",
    "/files/slash/etc/passwd",
    "/files/loop",
    "/files/zero",
    "/files/pipe",
    "/etc/passwd",
    "../secret",
    "/files/..",
    "files/\u{202e}",
    "/files/up",
    "/secret",
    "\\files\\hello.txt",
    "/files/hello.txt\\..\\x",
    "/proc/self/environ",
    "@PARAM/../../etc/passwd",
    "/metadata/../secret",
];

/// Links out of the root and inside of it, and what is neither file nor folder.
#[cfg(unix)]
fn make_traps(secret: &std::path::Path, root: &std::path::Path) {
    use std::os::unix::fs::symlink;

    symlink(secret, root.join("absolute")).expect("a link");
    symlink("../secret", root.join("relative")).expect("a link");
    symlink("..", root.join("up")).expect("a link");
    symlink("/", root.join("slash")).expect("a link");
    symlink("hello.txt", root.join("inside")).expect("a link");
    symlink("loop", root.join("loop")).expect("a link");
    symlink("/dev/zero", root.join("zero")).expect("a link");
    let pipe = rustix::fs::mknodat(
        rustix::fs::CWD,
        root.join("pipe"),
        rustix::fs::FileType::Fifo,
        rustix::fs::Mode::from_raw_mode(0o600),
        0,
    );
    pipe.expect("a pipe");
}

#[cfg(unix)]
#[test]
fn nothing_leads_out_of_the_root() {
    let (place, root) = shared();
    let secret = place.path().join("secret");
    make_traps(&secret, &root);
    let mut client = Client::sharing(&root, true);
    let before = std::fs::read_dir(place.path()).expect("a folder").count();
    let long = format!("/files/{}", "x".repeat(230));
    for path in OUTSIDE.into_iter().chain([long.as_str()]) {
        for opcode in [OPEN, CHECKSUM] {
            let refused = client.on(opcode, path);
            assert!(matches!(refused, Err(NOT_FOUND | FAIL)), "{path}: {refused:?}");
        }
        // To be changed: not there, not allowed, or (a folder of that name) not empty.
        for opcode in [CREATE, OPEN_TO_WRITE, TRUNCATE, MAKE_FOLDER] {
            let refused = client.on(opcode, path);
            if path.ends_with('\u{202e}') && refused.is_ok() {
                // A strange name, but one inside.
                continue;
            }
            assert!(refused.is_err(), "{opcode} {path}: {refused:?}");
        }
        let refused = client.on(RENAME, &format!("/files/hello.txt\0{path}"));
        assert!(refused.is_err() || path.ends_with('\u{202e}'), "{path}: {refused:?}");
    }
    assert_eq!(std::fs::read(&secret).expect("still there"), b"secret");
    assert_eq!(std::fs::read_dir(place.path()).expect("a folder").count(), before);
    // A link that stays inside is as good as its target; one that does not is not even listed.
    assert_eq!(client.read("/files/inside"), Ok(b"hello".to_vec()));
    let listed = client.list("/files").expect("a list");
    assert!(listed.contains(&"Finside\t5".to_owned()), "{listed:?}");
    for hidden in ["absolute", "relative", "up", "slash", "loop", "zero", "pipe"] {
        assert!(!listed.iter().any(|entry| entry[1..].split('\t').next() == Some(hidden)), "{hidden}");
    }
    // To remove a link is not to remove what it leads to.
    assert_eq!(client.on(REMOVE, "/files/relative"), Ok(vec![]));
    assert_eq!(std::fs::read(&secret).expect("still there"), b"secret");
    // A path that is no text.
    assert_eq!(client.ask(OPEN, 0, b"/files/\xff\xfe"), Err(NOT_FOUND));
}

#[test]
fn what_may_only_be_read_is_protected() {
    let (_place, root) = shared();
    let mut client = Client::sharing(&root, false);
    for path in [
        "/files/new",
        "/files/hello.txt",
        "/@PARAM/param.xml",
        "/metadata/general.json",
        "/camera.xml",
        "/",
        "",
    ] {
        for opcode in [CREATE, OPEN_TO_WRITE, REMOVE, MAKE_FOLDER, REMOVE_FOLDER, TRUNCATE] {
            assert_eq!(client.on(opcode, path), Err(PROTECTED), "{opcode} {path}");
        }
        assert_eq!(client.on(RENAME, &format!("/files/hello.txt\0{path}")), Err(PROTECTED), "{path}");
    }
    assert_eq!(client.read("/files/hello.txt"), Ok(b"hello".to_vec()));
    client.on(OPEN, "/files/hello.txt").expect("readable");
    assert_eq!(client.ask(WRITE, 0, b"x"), Err(PROTECTED));
    client.on(OPEN, "/@PARAM/param.pck").expect("readable");
    assert_eq!(client.ask(WRITE, 0, b"x"), Err(PROTECTED));
}

#[test]
fn files_are_written_moved_and_removed() {
    let (_place, root) = shared();
    let mut client = Client::sharing(&root, true);
    assert_eq!(client.on(CREATE, "/files/new.bin"), Ok(0_u32.to_le_bytes().to_vec()));
    for at in (0..1000_u32).step_by(200) {
        assert_eq!(client.ask(WRITE, at, &[at as u8; 200]), Ok(200_u32.to_le_bytes().to_vec()));
    }
    client.ask(RESET, 0, &[]).expect("closed");
    assert_eq!(client.read("/files/new.bin").expect("there")[400..600], [144; 200]);
    assert_eq!(client.on(RENAME, "/files/new.bin\0/files/below/moved.bin"), Ok(vec![]));
    assert_eq!(client.read("/files/new.bin"), Err(NOT_FOUND));
    assert_eq!(client.on(RENAME, "/files/hello.txt\0/files/below/moved.bin"), Err(EXISTS));
    assert_eq!(client.ask(TRUNCATE, 3, b"/files/below/moved.bin"), Ok(vec![]));
    assert_eq!(client.read("/files/below/moved.bin"), Ok(vec![0; 3]));
    assert_eq!(client.on(REMOVE_FOLDER, "/files/below"), Err(EXISTS));
    assert_eq!(client.on(MAKE_FOLDER, "/files/other"), Ok(vec![]));
    assert_eq!(client.on(MAKE_FOLDER, "/files/other"), Err(EXISTS));
    assert_eq!(client.on(REMOVE_FOLDER, "/files/other"), Ok(vec![]));
    assert_eq!(client.on(REMOVE, "/files/other"), Err(NOT_FOUND));
    assert_eq!(client.on(REMOVE, "/files/below/moved.bin"), Ok(vec![]));
    assert_eq!(client.on(REMOVE_FOLDER, "/files"), Err(PROTECTED));
    assert_eq!(client.on(RENAME, "/files/hello.txt"), Err(3));
    assert_eq!(client.read("/files/hello.txt"), Ok(b"hello".to_vec()));
}

#[test]
fn a_retry_is_answered_again_and_not_carried_out_again() {
    let (_place, root) = shared();
    let mut client = Client::sharing(&root, true);
    let path = b"/files/once";
    let make = request(500, MAKE_FOLDER, 0, path.len() as u8, 0, path);
    for _ in 0..3 {
        client.bench.heard.clear();
        client.bench.send(make.clone());
        assert_eq!(answers(&client.bench.heard)[0].result, Ok(vec![]));
    }
    // Another request is another one, and so is the same long after.
    assert_eq!(client.on(MAKE_FOLDER, "/files/once"), Err(EXISTS));
    client.bench.fly(2.5);
    client.bench.heard.clear();
    client.bench.send(make);
    assert_eq!(answers(&client.bench.heard)[0].result, Err(EXISTS));
}

#[test]
fn quotas_hold_and_say_so() {
    let (_place, root) = shared();
    let mut client = Client::sharing(&root, true);
    // 16 MB a file, 64 MB in all: by truncation, which costs nothing here.
    assert_eq!(client.on(CREATE, "/files/big"), Ok(0_u32.to_le_bytes().to_vec()));
    assert_eq!(client.ask(TRUNCATE, (16 << 20) + 1, b"/files/big"), Err(ERRNO));
    assert_eq!(client.ask(TRUNCATE, 16 << 20, b"/files/big"), Ok(vec![]));
    assert_eq!(client.ask(WRITE, 16 << 20, b"x"), Err(ERRNO));
    assert_eq!(client.ask(WRITE, u32::MAX, b"x"), Err(ERRNO));
    for name in ["b", "c"] {
        let path = format!("/files/{name}");
        client.on(CREATE, &path).expect("room");
        assert_eq!(client.ask(TRUNCATE, 16 << 20, path.as_bytes()), Ok(vec![]));
    }
    client.on(CREATE, "/files/d").expect("room");
    assert_eq!(client.ask(TRUNCATE, 16 << 20, b"/files/d"), Err(ERRNO));
    assert_eq!(client.ask(TRUNCATE, 15 << 20, b"/files/d"), Ok(vec![]));
    client.on(REMOVE, "/files/big").expect("removed");
    assert_eq!(client.ask(TRUNCATE, 16 << 20, b"/files/d"), Ok(vec![]));
    // Names, too.
    let (fits, long) = (format!("/files/{}", "n".repeat(128)), format!("/files/{}", "n".repeat(129)));
    assert_eq!(client.on(MAKE_FOLDER, &fits), Ok(vec![]));
    assert_eq!(client.on(MAKE_FOLDER, &long), Err(FAIL));

    // Open files: a client's own oldest makes room; a fifth client waits until one is idle.
    let open = |bench: &mut Bench, system: u8, session: u8| {
        bench.heard.clear();
        let message = request(u16::from(session) * 2, OPEN, session, 16, 0, b"/files/hello.txt");
        let frame = autopilot::codec::Frame::encode(
            &message.into(),
            autopilot::codec::Version::Two,
            session,
            (system, 190),
        );
        let peer = autopilot::envelope::PeerId { link: 0, number: u64::from(system) };
        let origin = autopilot::envelope::Origin { peer, system, component: 190 };
        bench.autopilot.receive(&origin, &frame.expect("a frame"));
        bench.listen();
        answers(&bench.heard)[0].result.clone().map(|_| ())
    };
    let mut bench = client.bench;
    bench.fly(11.0);
    for system in 10..14 {
        for session in 0..6 {
            assert_eq!(open(&mut bench, system, session), Ok(()), "{system} {session}");
        }
    }
    assert_eq!(open(&mut bench, 14, 0), Err(5));
    bench.fly(11.0);
    assert_eq!(open(&mut bench, 14, 0), Ok(()));
}

/// Bytes as `du --apparent-size` counts them, and 4096 for each file and folder.
fn measured(folder: &std::path::Path) -> u64 {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    entries
        .map(|entry| {
            let metadata = entry.metadata().expect("metadata");
            let below = if metadata.is_dir() { measured(&entry.path()) } else { metadata.len() };
            4096 + below
        })
        .sum()
}

/// The quota is that of what is really there: at any depth, and of open files without a name.
#[cfg(unix)]
#[test]
fn nothing_escapes_the_quota() {
    const QUOTA: u64 = 64 << 20;
    let (_place, root) = shared();
    let mut client = Client::sharing(&root, true);
    // Folders go down to the limit and no deeper, whether made there or moved there.
    let mut path = "/files".to_owned();
    while client.on(MAKE_FOLDER, &format!("{path}/d")).is_ok() {
        path += "/d";
    }
    assert_eq!(path.matches("/d").count(), 32);
    client.on(MAKE_FOLDER, "/files/e").expect("room");
    client.on(MAKE_FOLDER, "/files/e/e").expect("room");
    let halfway = &path[..path.len() - 2];
    assert_eq!(client.on(RENAME, &format!("/files/e\0{halfway}/e")), Err(FAIL), "it would be too deep");
    assert_eq!(client.on(RENAME, &format!("/files/e/e\0{halfway}/e")), Ok(vec![]));
    // What others have put deeper is counted: the folder is looked at again after a quarter of a second.
    let deep = root.join("x/".repeat(60));
    std::fs::create_dir_all(&deep).expect("folders");
    std::fs::File::create(deep.join("sparse")).and_then(|file| file.set_len(20 << 20)).expect("a file");
    std::thread::sleep(std::time::Duration::from_millis(260));
    // As much as there is room for, by writing and by truncation.
    let free = QUOTA - measured(&root);
    let mut left = free;
    for name in ["a", "b", "c"] {
        let file = format!("{halfway}/{name}");
        client.on(CREATE, &file).expect("room for an entry");
        left -= 4096;
        let size = left.min(16 << 20);
        assert_eq!(client.ask(TRUNCATE, size as u32, file.as_bytes()), Ok(vec![]), "{name}: {size}");
        left -= size;
    }
    assert_eq!((left, measured(&root)), (0, QUOTA));
    assert_eq!(client.on(CREATE, "/files/more"), Err(ERRNO));
    assert_eq!(client.on(MAKE_FOLDER, "/files/more"), Err(ERRNO));
    client.on(OPEN_TO_WRITE, &format!("{halfway}/c")).expect("there");
    let size =
        std::fs::metadata(root.join(halfway.trim_start_matches("/files/")).join("c")).expect("there").len();
    assert_eq!(client.ask(WRITE, size as u32, b"x"), Err(ERRNO));
    // Removed but open: its place is not free before it is closed.
    client.on(REMOVE, &format!("{halfway}/c")).expect("removed");
    assert_eq!(measured(&root), QUOTA - 4096 - size);
    assert_eq!(client.on(CREATE, "/files/more"), Err(ERRNO));
    assert_eq!(client.ask(WRITE, size as u32, b"x"), Err(ERRNO));
    client.ask(RESET, 0, &[]).expect("closed");
    client.on(CREATE, "/files/more").expect("room again");
    assert_eq!(client.ask(TRUNCATE, size as u32, b"/files/more"), Ok(vec![]));
    assert_eq!(client.ask(TRUNCATE, size as u32 + 1, b"/files/more"), Err(ERRNO));
    assert_eq!(measured(&root), QUOTA);
}

/// Asks until it is answered.
fn ask(
    lossy: &mut Lossy,
    sequence: u16,
    opcode: u8,
    size: u8,
    offset: u32,
    data: &[u8],
) -> Result<Vec<u8>, u8> {
    for _ in 0..20 {
        lossy.send(request(sequence, opcode, 3, size, offset, data));
        for _ in 0..200 {
            let heard = lossy.step();
            let answer =
                answers(&heard).into_iter().find(|answer| answer.sequence == sequence.wrapping_add(1));
            if let Some(answer) = answer {
                return answer.result;
            }
        }
    }
    panic!("request {sequence} was never answered");
}

/// A file down in bursts, whose gaps are read again, and another up: both whole, on every seed.
#[test]
fn files_arrive_whole_over_a_lossy_channel() {
    for seed in 1..=4 {
        let (_place, root) = shared();
        let content = noise(50_000);
        std::fs::write(root.join("noise"), &content).expect("written");
        let mut lossy = Lossy::new(seed);
        let files = Disk::open(None, Some(&(root.clone(), true))).expect("a folder");
        lossy.bench.autopilot.share(Box::new(Immediate(files)));
        ask(&mut lossy, 10, OPEN, 12, 0, b"/files/noise").expect("it is there");
        let mut got: Vec<Option<u8>> = vec![None; content.len()];
        let mut sequence = 100;
        while let Some(gap) = got.iter().position(Option::is_none) {
            sequence += 500;
            lossy.send(request(sequence, BURST, 3, 239, gap as u32, &[]));
            let mut silent_ms = 0;
            while silent_ms < 150 {
                let pieces = answers(&lossy.step());
                silent_ms = if pieces.is_empty() { silent_ms + 1 } else { 0 };
                for piece in pieces.iter().filter(|piece| piece.opcode == BURST) {
                    let Ok(bytes) = &piece.result else { continue };
                    for (place, byte) in got[piece.offset as usize..].iter_mut().zip(bytes) {
                        *place = Some(*byte);
                    }
                }
                if pieces.iter().any(|piece| piece.last) {
                    break;
                }
            }
            assert!(lossy.now_ms < 60_000, "seed {seed}: stuck at {gap}");
        }
        assert!(
            got.into_iter().map(|byte| byte.expect("complete")).eq(content.iter().copied()),
            "seed {seed}"
        );

        ask(&mut lossy, 20, RESET, 0, 0, &[]).expect("closed");
        ask(&mut lossy, 22, CREATE, 9, 0, b"/files/up").expect("made");
        for (number, piece) in (0_u16..).zip(content.chunks(239)) {
            let offset = u32::from(number) * 239;
            ask(&mut lossy, 100 + 2 * number, WRITE, piece.len() as u8, offset, piece).expect("written");
        }
        ask(&mut lossy, 30, TERMINATE, 0, 0, &[]).expect("closed");
        assert_eq!(std::fs::read(root.join("up")).expect("there"), content, "seed {seed}");
        ask(&mut lossy, 40, RENAME, 24, 0, b"/files/up\0/files/renamed")
            .expect("renamed, however often asked");
        assert!(root.join("renamed").exists() && lossy.up.lost > 0 && lossy.down.lost > 0);
    }
}
