//! The live page of a running program: what it is shown, and what comes of its orders.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use clap::Parser;
use sitl::configuration::{Arguments, Settings};
use sitl::record::{RecordEnd, replay};
use sitl::{Failure, Session, Summary};
use tungstenite::Message;
use tungstenite::protocol::WebSocket;

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_secs(60);

/// A program with a live page, and a pilot before it.
struct Pilot {
    /// Address of the server, and the token.
    server: (String, String),
    browser: WebSocket<TcpStream>,
    stop: Arc<AtomicBool>,
    program: JoinHandle<Summary>,
    orders: u64,
    /// The latest of what was said.
    news: serde_json::Value,
}

fn session(arguments: &[&str]) -> Result<Session, Failure> {
    let start = ["lmpc-sitl", "--link", "udpin:0", "--log", "off"];
    let arguments = Arguments::try_parse_from(start.iter().chain(arguments)).expect("valid arguments");
    Session::new(Settings::resolve(&arguments).expect("valid settings"))
}

impl Pilot {
    fn of(arguments: &[&str]) -> Self {
        let arguments: Vec<String> =
            ["--view", "127.0.0.1:0"].iter().chain(arguments).map(|word| (*word).to_owned()).collect();
        let stop = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&stop);
        let (tell, opened) = std::sync::mpsc::channel();
        // A session stays in its thread.
        let program = std::thread::spawn(move || {
            let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
            let session = session(&words).expect("free ports");
            tell.send(session.pilot_url().expect("a page")).expect("the test waits");
            session.run(&told)
        });
        let url = opened.recv_timeout(PATIENCE).expect("a page");
        let (address, token) =
            url.strip_prefix("http://").and_then(|url| url.split_once("/#token=")).expect(&url);
        let stream = TcpStream::connect(address).expect("a server");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let (mut browser, _) =
            tungstenite::client(format!("ws://{address}/stream"), stream).expect("a stream");
        browser.send(Message::text(format!(r#"{{"token": "{token}"}}"#))).expect("sent");
        let server = (address.to_owned(), token.to_owned());
        Self { server, browser, stop, program, orders: 0, news: serde_json::Value::Null }
    }

    /// The next message, as JSON if it is text.
    fn next(&mut self) -> Result<serde_json::Value, Vec<u8>> {
        loop {
            match self.browser.read().expect("a message") {
                Message::Text(text) => {
                    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
                    if value["news"].is_object() {
                        self.news = value["news"].clone();
                    }
                    return Ok(value);
                }
                Message::Binary(bytes) => return Err(bytes.to_vec()),
                _ => {}
            }
        }
    }

    /// Why an order is refused, if it is.
    fn order(&mut self, please: serde_json::Value) -> Option<String> {
        self.orders += 1;
        let order = serde_json::json!({ "order": self.orders, "vehicle": 1, "please": please });
        self.browser.send(Message::text(order.to_string())).expect("sent");
        loop {
            if let Ok(value) = self.next()
                && value["answer"] == self.orders
            {
                return value["refused"].as_str().map(str::to_owned);
            }
        }
    }

    /// Waits for a frame that fulfils a condition on simulation time, s, and place, NED, m.
    fn wait(&mut self, what: &str, condition: impl Fn(f64, [f64; 3]) -> bool) {
        let start = Instant::now();
        let real = |bytes: &[u8], at: usize| {
            f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().expect("four")))
        };
        loop {
            if let Err(bytes) = self.next() {
                let time_s = f64::from_le_bytes(bytes[8..16].try_into().expect("eight"));
                let place_m = [36, 40, 44].map(|at| real(&bytes, at));
                if condition(time_s, place_m) {
                    return;
                }
                assert!(start.elapsed() < PATIENCE, "not {what}: {time_s} s, {place_m:?}");
            }
        }
    }

    /// The answer to a record that is opened in the page.
    fn film(&self, record: &[u8]) -> Vec<u8> {
        let (address, token) = &self.server;
        let mut stream = TcpStream::connect(address).expect("a server");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let length = record.len();
        write!(
            stream,
            "POST /film HTTP/1.1\r\nHost: {address}\r\nAuthorization: Bearer {token}\r\nContent-Length: {length}\r\n\
             Connection: close\r\n\r\n"
        )
        .expect("sent");
        stream.write_all(record).expect("sent");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("an answer");
        let body = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").expect("a head") + 4;
        answer.split_off(body)
    }

    fn end(self) -> Summary {
        self.stop.store(true, Ordering::Relaxed);
        self.program.join().expect("no panic")
    }
}

fn near(place_m: [f64; 3], goal_m: [f64; 3]) -> bool {
    place_m.iter().zip(goal_m).all(|(is, goal)| (is - goal).abs() < 0.1)
}

/// A record once it has a second of its flight.
fn written(record: &str) -> Vec<u8> {
    let start = Instant::now();
    loop {
        let bytes = std::fs::read(record).expect("a record");
        if bytes.windows(7).any(|word| word == b"\nstate ") {
            return bytes;
        }
        assert!(start.elapsed() < PATIENCE, "nothing is written");
        std::thread::yield_now();
    }
}

fn fly_there(conventions: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let record = folder.path().join("flight.lmpc");
    let record = record.to_str().expect("text");
    let mut pilot = Pilot::of(&["--autopilot", conventions, "--record", record, "--speed", "10"]);
    assert_eq!(pilot.order(serde_json::json!({ "action": "take_off", "height_m": 6.0 })), None);
    pilot.wait("up", |_, place_m| near(place_m, [0.0, 0.0, -6.0]));
    let order = serde_json::json!({ "action": "fly_to", "place_m": [4.0, -3.0], "height_m": 8.0 });
    assert_eq!(pilot.order(order), None);
    pilot.wait("there", |_, place_m| near(place_m, [4.0, -3.0, -8.0]));
    let wind = serde_json::json!({ "action": "wind", "speed_m_s": 3.0, "from_deg": 90.0 });
    assert_eq!(pilot.order(wind), None);
    assert_eq!(pilot.order(serde_json::json!({ "action": "fault", "fault": "rotor3=weak" })), None);
    // The page has the record replayed, as far as it goes, while the flight goes on.
    let film = pilot.film(&written(record));
    assert!(film.starts_with(b"LMPCFILM") && film.len() > 10_000, "{}", String::from_utf8_lossy(&film));
    let refused = String::from_utf8(pilot.film(b"nothing")).expect("text");
    assert!(refused.starts_with("is not a record: line 1"), "{refused}");
    assert_eq!(pilot.order(serde_json::json!({ "action": "land" })), None);
    pilot.wait("down", |_, place_m| place_m[2] > -0.05);
    let flown = pilot.end();
    assert!(flown.incomplete.is_empty() && flown.losses.is_empty());
    let replayed = replay(std::path::Path::new(record)).expect("the same flight");
    assert_eq!(replayed[0].end, RecordEnd::Complete);
    assert_eq!(replayed[0].flight, flown.flights[0], "bit for bit");
    let page = folder.path().join("flight.html");
    let line = ["lmpc-sitl", "--view-record", record, "--view-page", page.to_str().expect("text")];
    sitl::run(Arguments::try_parse_from(line).expect("arguments")).expect("a page");
    // `LMPCFILM` in base64: the flight itself, not what was sent to it.
    let text = std::fs::read_to_string(page).expect("a page");
    assert!(text.contains("data-name=\"flight.lmpc\">TE1QQ0ZJTE"), "{}", text.len());
}

#[test]
fn a_page_is_written_of_a_flight_that_is_named_and_can_be_shown() {
    let refused = |line: &[&str]| {
        let words = ["lmpc-sitl"].iter().chain(line);
        let failure = sitl::run(Arguments::try_parse_from(words).expect("arguments")).expect_err("refused");
        failure.to_string()
    };
    assert!(refused(&["--view-page", "a.html"]).contains("add --view-record FILE"));
    assert!(refused(&["--view-record", "a.txt", "--view-page", "a.html"]).contains("a record (.lmpc)"));
    assert!(refused(&["--view-record", "no.csv", "--view-page", "a.html"]).contains("cannot read no.csv"));
    let with_ready_file =
        refused(&["--view-record", "no.csv", "--view-page", "a.html", "--ready-file", "ready"]);
    assert!(with_ready_file.contains("cannot be used with --view-page"), "{with_ready_file}");
    let folder = tempfile::tempdir().expect("a folder");
    let sized = |name: &str, megabytes: u64| {
        let path = folder.path().join(name);
        // No blocks of the disk are behind it.
        std::fs::File::create(&path).and_then(|file| file.set_len(megabytes * 1_000_000)).expect("a file");
        path.to_str().expect("text").to_owned()
    };
    let within = refused(&["--view-record", &sized("a.ulg", 376), "--view-page", "a.html"]);
    assert!(
        within.ends_with(
            "376 MB is too large: a browser can open at most 375 MB this way; show it with --view-record alone"
        ),
        "{within}"
    );
    assert!(refused(&["--view-record", &sized("a.csv", 501)]).contains("500 MB"), "a table");
    assert!(refused(&["--view-record", &sized("b.ulg", 1001)]).contains("1000 MB"), "a log");
    assert!(refused(&["--view-record", "no.lmpc", "--speed", "2"]).contains("--speed: cannot be used"));
}

#[test]
fn a_pilot_flies_by_the_page_and_the_flight_is_replayed_bit_for_bit() {
    fly_there("px4");
}

#[test]
fn the_same_in_the_conventions_of_ardupilot() {
    fly_there("ardupilot");
}

#[test]
fn refusals_say_why() {
    let mut pilot = Pilot::of(&[]);
    for (please, reason) in [
        (serde_json::json!({ "action": "start_mission" }), "mission"),
        (serde_json::json!({ "action": "fly_to", "place_m": [1e9, 0], "height_m": 5 }), "place"),
        (serde_json::json!({ "action": "fly_to", "place_m": [0, 0], "height_m": 1e6 }), "height"),
        (serde_json::json!({ "action": "take_off", "height_m": -3 }), "height -3 m; use 0.5 to 1000 m"),
        (serde_json::json!({ "action": "fault", "fault": "rotor9=off" }), "unknown unit `rotor9`"),
        (
            serde_json::json!({ "action": "wind", "speed_m_s": 60, "from_deg": 0 }),
            "wind 60 m/s; use 0 to 50 m/s",
        ),
        (serde_json::json!({ "action": "speed", "factor": -7 }), "SIM_SPEEDUP"),
        (serde_json::json!({ "action": "step", "time_s": 1 }), "pause first"),
    ] {
        let refused = pilot.order(please.clone());
        assert!(refused.as_ref().is_some_and(|why| why.contains(reason)), "{please}: {refused:?}");
    }
    pilot.end();
}

#[test]
fn paused_time_goes_on_by_steps_alone() {
    let mut pilot = Pilot::of(&[]);
    assert_eq!(pilot.order(serde_json::json!({ "action": "speed", "factor": 0 })), None);
    pilot.wait("shown", |_, _| true);
    // What was on its way is older than the pause: the time of a frame after a step is exact.
    assert_eq!(pilot.order(serde_json::json!({ "action": "step", "time_s": 0.001 })), None);
    let stood = std::cell::Cell::new(-1.0);
    pilot.wait("still", |time_s, _| stood.replace(time_s) == time_s);
    let stood = stood.get();
    assert_eq!(pilot.order(serde_json::json!({ "action": "step", "time_s": 0.25 })), None);
    pilot.wait("a step on", |time_s, _| (time_s - stood - 0.25).abs() < 1e-9);
    assert!(pilot.order(serde_json::json!({ "action": "step", "time_s": 1e3 })).is_some());
    pilot.end();
}

#[test]
fn lines_for_the_pilot_and_faults_are_news() {
    let mut pilot = Pilot::of(&[]);
    assert_eq!(pilot.order(serde_json::json!({ "action": "arm" })), None);
    assert_eq!(pilot.order(serde_json::json!({ "action": "fault", "fault": "gps=off" })), None);
    let start = Instant::now();
    while pilot.news["vehicles"][0]["faults"] != serde_json::json!(["gps=off"]) {
        let _frame = pilot.next();
        assert!(start.elapsed() < PATIENCE, "{}", pilot.news);
    }
    let texts = pilot.news["texts"].as_array().expect("lines");
    assert!(
        texts.iter().any(|line| line["text"].as_str().is_some_and(|text| text.contains("Armed"))),
        "{texts:?}"
    );
    assert!(texts.windows(2).all(|two| two[0]["number"].as_u64() < two[1]["number"].as_u64()));
    pilot.end();
}

#[test]
fn a_taken_address_ends_the_program_before_it_begins() {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = taken.local_addr().expect("an address").to_string();
    let failure = session(&["--view", &address]).expect_err("taken");
    assert_eq!(failure.exit_code(), 3);
    assert!(failure.to_string().contains("--view") && failure.to_string().contains(&address), "{failure}");
}
