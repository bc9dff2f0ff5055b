//! The server as browsers and strangers meet it.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Mutex;
use std::sync::mpsc::sync_channel;
use std::time::{Duration, Instant};

use flate2::read::GzDecoder;
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::protocol::WebSocket;
use tungstenite::{Error, Message};
use viewer::{
    Action, Frame, News, Order, Past, Recording, Replayer, Scene, VehicleNews, VehicleState, Viewer,
};

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_secs(10);

fn viewer() -> Viewer {
    Viewer::open("127.0.0.1", 0, Past::default()).expect("a free port")
}

/// The answer to a GET request with these headers.
fn get(address: SocketAddr, path: &str, headers: &[(&str, &str)]) -> String {
    ask(address, &format!("GET {path}"), headers, b"")
}

/// The answer to a request, as text.
fn ask(address: SocketAddr, what: &str, headers: &[(&str, &str)], body: &[u8]) -> String {
    String::from_utf8_lossy(&answer(address, what, headers, body)).into_owned()
}

/// The answer to a request.
fn answer(address: SocketAddr, what: &str, headers: &[(&str, &str)], body: &[u8]) -> Vec<u8> {
    let mut stream = TcpStream::connect(address).expect("a server");
    stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    let lines: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
    write!(stream, "{what} HTTP/1.1\r\n{lines}Connection: close\r\n\r\n").expect("sent");
    // What is refused is not read to its end.
    let _refused = stream.write_all(body);
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).expect("an answer");
    bytes
}

fn get_ours(address: SocketAddr, path: &str) -> String {
    get(address, path, &[("Host", &address.to_string())])
}

type Browser = WebSocket<TcpStream>;

/// A connection to the stream as the page makes it.
fn browser(address: SocketAddr, origin: &str) -> Result<Browser, String> {
    let mut request = format!("ws://{address}/stream").into_client_request().expect("a request");
    request.headers_mut().insert("Origin", HeaderValue::from_str(origin).expect("a header"));
    let stream = TcpStream::connect(address).expect("a server");
    stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    tungstenite::client(request, stream).map(|(browser, _)| browser).map_err(|error| error.to_string())
}

fn our_browser(viewer: &Viewer) -> Browser {
    let address = viewer.address();
    browser(address, &format!("http://{address}")).expect("our own page")
}

fn send(browser: &mut Browser, text: &str) {
    browser.send(Message::text(text)).expect("sent");
}

/// The next text that holds a word.
fn next_text(browser: &mut Browser, word: &str) -> serde_json::Value {
    loop {
        if let Message::Text(text) = browser.read().expect("a message")
            && text.contains(word)
        {
            return serde_json::from_str(&text).expect("JSON");
        }
    }
}

/// The time in the next frame, s.
fn next_time_s(browser: &mut Browser) -> f64 {
    loop {
        if let Message::Binary(bytes) = browser.read().expect("a message") {
            return f64::from_le_bytes(bytes[8..16].try_into().expect("eight bytes"));
        }
    }
}

fn next_order(viewer: &Viewer) -> Order {
    let start = Instant::now();
    loop {
        if let Some(order) = viewer.next_order() {
            return order;
        }
        assert!(start.elapsed() < PATIENCE, "no order");
        std::thread::yield_now();
    }
}

fn frame(time_s: f64) -> Frame {
    Frame { time_s, speed: 1.0, pace: 1.0, vehicles: vec![VehicleState::default()] }
}

#[test]
fn the_page_and_its_files_are_served_with_their_types_and_a_strict_policy() {
    let viewer = viewer();
    for (path, content_type, within) in [
        ("/", "text/html; charset=utf-8", "<title>LMPC quadrotor</title>"),
        ("/page/main.js", "text/javascript; charset=utf-8", "import { View }"),
        ("/page/style.css", "text/css; charset=utf-8", "prefers-color-scheme: dark"),
        ("/three/three.module.min.js", "text/javascript; charset=utf-8", "SPDX-License-Identifier: MIT"),
        ("/session.json", "application/json", r#"{"recording":null}"#),
    ] {
        let answer = get_ours(viewer.address(), path);
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        assert!(head.starts_with("HTTP/1.1 200"), "{path}: {head}");
        assert!(head.contains(&format!("content-type: {content_type}")), "{path}: {head}");
        assert!(
            head.contains("content-security-policy: default-src 'none'; script-src 'self';"),
            "{path}: {head}"
        );
        assert!(head.contains("x-content-type-options: nosniff"), "{path}: {head}");
        assert!(body.contains(within), "{path}");
    }
    for path in ["/page/", "/Cargo.toml", "/../Cargo.toml", "/%2e%2e/Cargo.toml", "/recording"] {
        assert!(get_ours(viewer.address(), path).starts_with("HTTP/1.1 404"), "{path}");
    }
}

#[test]
fn files_are_packed_for_those_who_unpack_them() {
    let viewer = viewer();
    let host = viewer.address().to_string();
    let original = include_bytes!("../assets/three/three.core.min.js");
    for (accepted, is_packed) in [
        ("gzip, deflate, br", true),
        ("br;q=1.0, GZIP;q=0.5", true),
        ("br, gzip;q=0", false),
        ("identity", false),
    ] {
        let headers = [("Host", host.as_str()), ("Accept-Encoding", accepted)];
        let answer = answer(viewer.address(), "GET /three/three.core.min.js", &headers, b"");
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head") + 4;
        let (head, body) = (String::from_utf8_lossy(&answer[..end]), &answer[end..]);
        assert_eq!(head.contains("content-encoding: gzip"), is_packed, "{accepted}: {head}");
        assert!(head.contains("vary: accept-encoding"), "{accepted}: {head}");
        let mut content = Vec::new();
        if is_packed {
            assert!(body.len() < original.len() / 2, "{}", body.len());
            GzDecoder::new(body).read_to_end(&mut content).expect("gzip");
        } else {
            content.extend_from_slice(body);
        }
        assert!(content == original, "{accepted}");
    }
}

#[test]
fn strangers_get_nothing() {
    let viewer = viewer();
    let address = viewer.address();
    let refused = |headers: &[(&str, &str)]| get(address, "/", headers);
    assert!(refused(&[("Host", "evil.example")]).starts_with("HTTP/1.1 403"), "a name that leads here");
    let host = address.to_string();
    let answer = refused(&[("Host", &host), ("Origin", "http://evil.example")]);
    assert!(answer.starts_with("HTTP/1.1 403") && !answer.contains("<html"), "{answer}");
    assert!(browser(address, "http://evil.example").expect_err("a stranger").contains("403"));
    assert!(browser(address, "null").expect_err("a stranger").contains("403"));
    // Nothing of the answers has the secret.
    let secret = viewer.pilot_url().rsplit('=').next().expect("a token").to_owned();
    assert_eq!(secret.len(), 32);
    assert!(
        !get_ours(address, "/").contains(&secret) && !get_ours(address, "/session.json").contains(&secret)
    );
}

#[test]
fn orders_need_the_token_and_are_answered() {
    let viewer = viewer();
    let mut browser = our_browser(&viewer);
    let order =
        r#"{"order": 7, "vehicle": 1, "please": {"action": "fly_to", "place_m": [1, 2], "height_m": 3}}"#;
    send(&mut browser, order);
    let answer = next_text(&mut browser, "answer");
    assert!(
        answer["answer"] == 7 && answer["refused"].as_str().is_some_and(|why| why.contains("token")),
        "{answer}"
    );
    send(&mut browser, r#"{"token": "0123456789abcdef0123456789abcdef"}"#);
    assert_eq!(next_text(&mut browser, "controls")["controls"], false);
    send(&mut browser, order);
    assert!(next_text(&mut browser, "answer")["refused"].is_string());
    assert!(viewer.next_order().is_none(), "nothing reaches the simulation");

    let url = viewer.pilot_url();
    let token = url.rsplit('=').next().expect("a token");
    send(&mut browser, &format!(r#"{{"token": "{token}"}}"#));
    assert_eq!(next_text(&mut browser, "controls")["controls"], true);
    send(&mut browser, order);
    let Order { vehicle, action, reply } = next_order(&viewer);
    assert_eq!((vehicle, action), (1, Action::FlyTo { place_m: [1.0, 2.0], height_m: 3.0 }));
    reply.send(Err("too far".to_owned()));
    let answer = next_text(&mut browser, "answer");
    assert!(answer["answer"] == 7 && answer["refused"] == "too far", "{answer}");
    send(&mut browser, r#"{"order": 8, "vehicle": 1, "please": {"action": "land"}}"#);
    next_order(&viewer).reply.send(Ok(()));
    assert!(next_text(&mut browser, "answer")["refused"].is_null());
    for wrong in ["{}", "[]", r#"{"order": 9, "vehicle": 1, "please": {"action": "explode"}}"#, "\u{1F681}"] {
        send(&mut browser, wrong);
        let answer = next_text(&mut browser, "answer");
        assert!(
            answer["refused"].as_str().is_some_and(|why| why.contains("not an order")),
            "{wrong}: {answer}"
        );
    }
}

#[test]
fn whoever_comes_later_gets_the_latest_of_everything() {
    let viewer = viewer();
    viewer.show_scene(&Scene::default());
    let mode = |mode: &str| News {
        vehicles: vec![VehicleNews { id: 1, mode: mode.to_owned(), faults: Vec::new() }],
        texts: Vec::new(),
    };
    viewer.tell(&mode("Hold"));
    viewer.tell(&mode("Land"));
    viewer.show(&frame(1.0));
    viewer.show(&frame(2.0));
    let mut first = our_browser(&viewer);
    assert!(next_text(&mut first, "scene")["scene"]["vehicles"].is_array());
    assert_eq!(next_text(&mut first, "news")["news"]["vehicles"][0]["mode"], "Land");
    assert_eq!(next_time_s(&mut first), 2.0);
    let mut second = our_browser(&viewer);
    assert_eq!(next_time_s(&mut second), 2.0);
    viewer.show(&frame(3.0));
    assert_eq!([next_time_s(&mut first), next_time_s(&mut second)], [3.0; 2]);
    assert!(viewer.is_watched());
}

/// Memory that this process has now, bytes; not known on every system.
fn resident_bytes() -> Option<usize> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(pages.split(' ').nth(1)?.parse::<usize>().ok()? * 4096)
}

#[test]
fn a_browser_that_reads_nothing_neither_delays_the_others_nor_gets_what_is_old_nor_takes_memory() {
    let viewer = viewer();
    let mut slow = our_browser(&viewer);
    let mut quick = our_browser(&viewer);
    let many = Frame { vehicles: vec![VehicleState::default(); 200], ..frame(0.0) };
    let before = resident_bytes();
    // As much as no socket buffers: more than 200 MB. Each call returns at once, or this would not end.
    for number in 1..=8_000 {
        viewer.show(&Frame { time_s: f64::from(number), ..many.clone() });
    }
    let start = Instant::now();
    while next_time_s(&mut quick) < 8_000.0 {
        assert!(start.elapsed() < PATIENCE, "the quick one waits for the slow one");
    }
    if let (Some(before), Some(now)) = (before, resident_bytes()) {
        // A quarter of what a queue for the slow one would take. Other tests run meanwhile.
        assert!(now < before + (50 << 20), "{now} bytes, {before} before");
    }
    let mut frames = 0;
    while next_time_s(&mut slow) < 8_000.0 {
        frames += 1;
    }
    assert!(frames < 8_000, "{frames}: old frames are left out");
}

#[test]
fn browsers_and_their_messages_are_bounded() {
    let viewer = viewer();
    viewer.show(&frame(1.0));
    let mut seated: Vec<Browser> = (0..32).map(|_| our_browser(&viewer)).collect();
    seated.iter_mut().for_each(|browser| assert_eq!(next_time_s(browser), 1.0));
    // Who is sent away leaves no place behind.
    for _ in 0..2 {
        let mut late = our_browser(&viewer);
        send(&mut late, r#"{"token": ""}"#);
        let end = late.read();
        assert!(matches!(&end, Ok(Message::Close(Some(why))) if u16::from(why.code) == 1013), "{end:?}");
    }
    // Who may give orders finds a place, and has it beside those who look on.
    let url = viewer.pilot_url();
    let token = url.rsplit('=').next().expect("a token");
    let mut pilots: Vec<Browser> = (0..8).map(|_| our_browser(&viewer)).collect();
    for pilot in &mut pilots {
        send(pilot, &format!(r#"{{"token": "{token}"}}"#));
        assert_eq!(next_text(pilot, "controls")["controls"], true);
        assert_eq!(next_time_s(pilot), 1.0);
    }
    let mut flood = seated.pop().expect("a browser");
    let _refused = flood.send(Message::text("x".repeat(100_000)));
    let end = loop {
        match flood.read() {
            Ok(Message::Close(_)) | Err(_) => break true,
            Ok(_) => {}
        }
    };
    assert!(end, "it is sent away");
    // A seat is free again.
    let start = Instant::now();
    loop {
        let mut next = our_browser(&viewer);
        match next.read() {
            Ok(Message::Binary(_)) => break,
            Ok(_) | Err(Error::ConnectionClosed | Error::Protocol(_) | Error::Io(_)) => {}
            Err(error) => panic!("{error}"),
        }
        assert!(start.elapsed() < PATIENCE, "no seat");
    }
}

#[test]
fn a_recording_is_served_by_its_name() {
    let folder = std::env::temp_dir().join(format!("viewer-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("flight.csv");
    std::fs::write(&path, "time,position.x\n0,1\n").expect("written");
    let recording = Recording::read(&path).expect("a file");
    std::fs::remove_dir_all(&folder).expect("removed");
    let viewer = Viewer::open("127.0.0.1", 0, Past { recording: Some(recording), replayer: None })
        .expect("a free port");
    assert!(get_ours(viewer.address(), "/session.json").ends_with(r#"{"recording":"flight.csv"}"#));
    let answer = get_ours(viewer.address(), "/recording");
    assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("time,position.x\n0,1\n"), "{answer}");
}

#[test]
fn a_record_is_replayed_for_who_has_the_token_one_at_a_time() {
    let (begun, is_begun) = sync_channel::<()>(0);
    let (may_end, end) = sync_channel::<()>(0);
    let end = Mutex::new(end);
    let replayer = Replayer::new(move |record: &[u8]| match record {
        b"slow" => {
            begun.send(()).expect("a test that waits");
            end.lock().expect("no panic").recv().expect("a test that goes on");
            Ok(b"film of the slow one".to_vec())
        }
        b"strange" => Err("line 1 is not the header of one".to_owned()),
        record => Ok([b"film of ", record].concat()),
    });
    let past = Past { recording: None, replayer: Some(replayer) };
    let viewer = Viewer::open("127.0.0.1", 0, past).expect("a free port");
    let address = viewer.address();
    let url = viewer.pilot_url();
    let token = url.rsplit('=').next().expect("a token").to_owned();
    let post = |token: &str, record: &[u8]| {
        let (host, length) = (address.to_string(), record.len().to_string());
        let headers =
            [("Host", &*host), ("Authorization", &format!("Bearer {token}")), ("Content-Length", &length)];
        ask(address, "POST /film", &headers, record)
    };
    let answer = post(&token, b"a flight");
    assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("\r\n\r\nfilm of a flight"), "{answer}");
    let answer = post(&token, b"strange");
    assert!(
        answer.starts_with("HTTP/1.1 422") && answer.ends_with("line 1 is not the header of one"),
        "{answer}"
    );
    let answer = post("0123456789abcdef0123456789abcdef", b"a flight");
    assert!(answer.starts_with("HTTP/1.1 403") && answer.contains("token"), "{answer}");
    assert!(ask(address, "POST /film", &[("Host", &address.to_string())], b"").starts_with("HTTP/1.1 403"));
    std::thread::scope(|scope| {
        let slow = scope.spawn(|| post(&token, b"slow"));
        is_begun.recv().expect("it begins");
        let answer = post(&token, b"a flight");
        assert!(answer.starts_with("HTTP/1.1 409") && answer.contains("try again"), "{answer}");
        may_end.send(()).expect("it waits");
        assert!(slow.join().expect("no panic").ends_with("film of the slow one"));
    });
    let replays_none = self::viewer();
    let token = replays_none.pilot_url().rsplit('=').next().expect("a token").to_owned();
    let address = replays_none.address();
    let headers = [("Host", &*address.to_string()), ("Authorization", &format!("Bearer {token}"))];
    assert!(ask(address, "POST /film", &headers, b"").starts_with("HTTP/1.1 404"));
}

#[test]
fn a_taken_port_is_an_error_that_names_it_and_an_ended_server_frees_its_own() {
    let first = viewer();
    let port = first.address().port();
    let error = Viewer::open("127.0.0.1", port, Past::default()).expect_err("taken").to_string();
    assert!(error.contains(&format!("127.0.0.1:{port}")) && error.contains("choose another"), "{error}");
    drop(first);
    assert!(Viewer::open("127.0.0.1", port, Past::default()).is_ok());
}
