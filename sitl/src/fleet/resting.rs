//! A vehicle that rests behind its clock flies as if it had followed it tick by tick, and is not flown while nobody asks.

use std::path::Path;
use std::time::{Duration, Instant};

use clap::Parser;
use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, MavCmd, MavMessage, MavParamType, MavType, PARAM_REQUEST_LIST_DATA, PARAM_SET_DATA,
};
use vehicle::parameters::Speed;
use vehicle::{Mode, TICK_US};

use super::station::{command, received};
use super::{Clock, Fleet};
use crate::configuration::{Arguments, Settings};
use crate::link::Received;

/// Ticks after which it hovers.
const HOVERS: u64 = 20_000;
const END: u64 = 30_000;
/// No vehicle that rests is as many ticks behind its clock.
const MOST_BEHIND: u64 = 50;

/// How simulation time goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    /// By a clock at real time, which is looked at each so many ms.
    Clock(u64),
    /// Each tick is flown as it comes.
    Ticks,
}

/// One vehicle, and how its time goes on.
struct Bench {
    fleet: Fleet,
    clock: Clock,
    course: Course,
    start: Instant,
    tick: u64,
}

impl Bench {
    fn new(course: Course, options: &str) -> Self {
        let line = format!("lmpc-sitl --link udpout:127.0.0.1:9 {options}");
        let arguments = Arguments::try_parse_from(line.split_whitespace()).expect("arguments");
        let settings = Settings::resolve(&arguments).expect("settings");
        let mut fleet = Fleet::open(&settings, 0).expect("a free port");
        let start = Instant::now();
        fleet.receive(start);
        let clock = Clock::new(Speed::Factor(1.0), 0..settings.vehicles.len(), settings.end_us, start);
        Self { fleet, clock, course, start, tick: 0 }
    }

    /// What the wall clock would show.
    fn now(&self) -> Instant {
        // Pace is calculated in fractions of a second, and cut.
        self.start + Duration::from_millis(self.tick) + Duration::from_micros(100)
    }

    /// Simulation time goes on to a tick.
    fn go_on(&mut self, to: u64) {
        while self.tick < to {
            let begun_us = self.tick * TICK_US;
            match self.course {
                Course::Clock(period) => {
                    self.tick += period.min(to - self.tick);
                    let now = self.now();
                    self.clock.advance(&mut self.fleet, now, 1);
                }
                Course::Ticks => {
                    self.tick += 1;
                    let span_us = begun_us..self.tick * TICK_US;
                    self.fleet.fly(0..self.fleet.members().len(), span_us, false, self.now());
                }
            }
            let now = self.now();
            self.fleet.keep_links_alive(now);
            self.fleet.transfer(now);
        }
    }

    fn hand_in(&mut self, received: &Received) {
        let now = self.now();
        self.fleet.distribute(0, received, now);
        // That a ground station is heard is told with the next look, which is now.
        self.fleet.keep_links_alive(now);
    }

    fn command(&mut self, number: MavCmd, param1: f32, param7: f32) {
        self.hand_in(&command(number, param1, param7));
    }

    fn take_off(&mut self) {
        self.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
        self.command(MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, f32::NAN);
        self.go_on(HOVERS);
        let vehicle = self.fleet.members()[0].autopilot().vehicle();
        assert_eq!((vehicle.mode(), vehicle.is_armed()), (Mode::Hold, true));
    }

    /// Times that the first vehicle and its clock have come to, ms.
    fn times_ms(&self) -> (u64, u64) {
        (self.fleet.members()[0].time_us() / 1000, self.fleet.time_us() / 1000)
    }
}

fn heartbeat() -> Received {
    received(MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        mavtype: MavType::MAV_TYPE_GCS,
        ..HEARTBEAT_DATA::default()
    }))
}

fn parameter(name: &str, value: f32) -> Received {
    received(MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: value,
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    }))
}

/// Flies, with messages in the middle of long ticks: a heartbeat, a parameter, a landing, a reboot. Returns what was recorded of
/// the flight and of the traffic.
fn flown(course: Course, folder: &Path) -> (String, Vec<(u64, Vec<u8>)>) {
    let [record, traffic] = ["record", "traffic.tlog"].map(|name| folder.join(name));
    let mut bench =
        Bench::new(course, &format!("--record {} --tlog {}", record.display(), traffic.display()));
    bench.take_off();
    bench.go_on(HOVERS + 1_002);
    bench.hand_in(&heartbeat());
    bench.go_on(HOVERS + 1_501);
    bench.hand_in(&parameter("MPC_XY_VEL_MAX", 7.0));
    bench.go_on(HOVERS + 3_004);
    bench.command(MavCmd::MAV_CMD_NAV_LAND, 0.0, 0.0);
    bench.go_on(END - 1_498);
    bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 0.0, 0.0);
    bench.go_on(END - 997);
    bench.command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1.0, 0.0);
    bench.go_on(END + 1);
    let now = bench.now();
    let (members, lacking) = bench.fleet.finish(now);
    assert_eq!((members[0].time_us(), lacking), ((END + 1) * TICK_US, Vec::new()));
    assert_eq!(members[0].autopilot().boots(), 2);
    let text = std::fs::read_to_string(&record).expect("a record");
    (text, frames(&std::fs::read(&traffic).expect("a log")))
}

/// The frames of a log with their times, µs.
fn frames(log: &[u8]) -> Vec<(u64, Vec<u8>)> {
    const TIME: usize = 8;
    const OVERHEAD: usize = 12;
    let (mut frames, mut rest) = (Vec::new(), log);
    while let Some((time, behind)) = rest.split_first_chunk::<TIME>() {
        let (frame, next) = behind.split_at(OVERHEAD + usize::from(behind[1]));
        frames.push((u64::from_be_bytes(*time), frame.to_vec()));
        rest = next;
    }
    frames
}

#[test]
fn what_comes_in_the_middle_of_a_long_tick_is_handled_at_its_time() {
    let flown = |course| {
        let folder = tempfile::tempdir().expect("a folder");
        flown(course, folder.path())
    };
    let (record, traffic) = flown(Course::Ticks);
    assert!(traffic.len() > 1000, "{} frames", traffic.len());
    for period in [1, 2, 7] {
        let (same_record, same_traffic) = flown(Course::Clock(period));
        assert!(same_record == record, "another flight, looked at each {period} ms");
        assert_eq!(same_traffic.len(), traffic.len());
        // Regular messages come when they are due, what else is told with the next of them or at the end of a long tick.
        for ((at_us, frame), (then_us, same)) in traffic.iter().zip(&same_traffic) {
            assert!(
                same == frame && then_us.abs_diff(*at_us) < 5_000,
                "{frame:?} at {at_us}, {same:?} at {then_us} µs"
            );
        }
    }
}

#[test]
fn a_vehicle_that_rests_is_not_flown_while_nobody_asks() {
    let mut bench = Bench::new(Course::Clock(1), "");
    bench.take_off();
    let (mut looks, mut latest) = (0, HOVERS);
    for tick in HOVERS + 1..HOVERS + 1_000 {
        bench.go_on(tick);
        let (time, clock) = bench.times_ms();
        assert!(clock == tick && (time..time + MOST_BEHIND).contains(&tick), "at {time} of {tick}");
        looks += u64::from(time > latest);
        latest = time;
    }
    assert_eq!(looks, 35, "times in a second");
    // Whoever looks at it sees it where its clock is.
    let now = bench.now();
    bench.fleet.catch_up_all(now);
    assert_eq!(bench.times_ms(), (HOVERS + 999, HOVERS + 999));
    // A message finds it there, too, and it is awake until the links have been looked at.
    bench.go_on(HOVERS + 1_002);
    bench.hand_in(&heartbeat());
    assert_eq!(bench.times_ms(), (HOVERS + 1_002, HOVERS + 1_002));
    bench.go_on(HOVERS + 1_003);
    assert_eq!(bench.times_ms(), (HOVERS + 1_003, HOVERS + 1_003));
    bench.go_on(HOVERS + 1_006);
    assert_eq!(bench.times_ms(), (HOVERS + 1_004, HOVERS + 1_006), "at rest again");
    // What flies follows its clock.
    bench.command(MavCmd::MAV_CMD_NAV_LAND, 0.0, 0.0);
    for tick in HOVERS + 1_007..HOVERS + 1_020 {
        bench.go_on(tick);
        assert_eq!(bench.times_ms(), (tick, tick));
    }
}

#[test]
fn nobody_rests_behind_a_clock_that_is_slow_or_ends() {
    let mut bench = Bench::new(Course::Clock(1), "");
    bench.go_on(1_003);
    assert_eq!(bench.times_ms(), (1_000, 1_003), "on the ground");
    bench.hand_in(&parameter("SIM_SPEEDUP", 0.0));
    bench.go_on(1_010);
    assert_eq!(bench.times_ms(), (1_003, 1_003), "paused");
    assert!(bench.clock.step(2 * TICK_US));
    bench.go_on(1_011);
    assert_eq!(bench.times_ms(), (1_005, 1_005), "a step");
    bench.hand_in(&parameter("SIM_SPEEDUP", 0.5));
    for tick in 1_012..1_030 {
        bench.go_on(tick);
        assert_eq!(bench.times_ms().0, bench.times_ms().1, "slow");
    }
    assert!(bench.times_ms().0 > 1_010, "and it flies");
    let mut bench = Bench::new(Course::Clock(1), "--duration 1.003");
    bench.go_on(1_003);
    assert!(bench.clock.is_over(&bench.fleet));
    assert_eq!(bench.times_ms(), (1_003, 1_003), "at the end");
}

/// A client that waits for a long answer gets it as soon as one whose vehicle flies.
#[test]
fn a_vehicle_is_awake_while_it_answers() {
    let mut bench = Bench::new(Course::Clock(1), "");
    bench.go_on(1_002);
    let list = PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 };
    bench.hand_in(&received(MavMessage::PARAM_REQUEST_LIST(list)));
    let mut awake = 0;
    for tick in 1_003..3_000 {
        let answers = bench.fleet.members()[0].autopilot().is_answering();
        bench.go_on(tick);
        if answers {
            assert_eq!(bench.times_ms(), (tick, tick));
            awake += 1;
        }
    }
    assert!(awake > 100, "a list is a long answer: {awake} ms");
    assert_eq!(bench.times_ms(), (2_970, 2_999), "at rest again");
}
