//! A vehicle that rests flies several ticks at once, and neither its flight nor its services depend on how many.

use autopilot::Autopilot;
use autopilot::codec::{Frame, Message, Version, command_long};
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use vehicle::VehicleSettings;
use vehicle::identity::Identity;
use vehicle::parameters::Speed;

const VEHICLE: (u8, u8) = (1, 1);
const STATION: (u8, u8) = (255, 190);
const END: u64 = 40_000;
const AUTOPILOT_VERSION: f32 = 148.0;
/// ArduCopter's GUIDED.
const GUIDED: f32 = 4.0;

/// Commands at ticks that are no multiples of anything: a calibration of the compass that ends in a reboot, then a flight.
const COMMANDS: [(u64, MavCmd, [f32; 7]); 4] = [
    (1_003, MavCmd::MAV_CMD_DO_START_MAG_CAL, [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]),
    (15_002, MavCmd::MAV_CMD_DO_SET_MODE, [1.0, GUIDED, 0.0, 0.0, 0.0, 0.0, 0.0]),
    (15_003, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    (15_004, MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0]),
];

/// An autopilot like ArduPilot's.
fn autopilot() -> Autopilot {
    let settings = VehicleSettings::new(Identity::ArduPilot);
    Autopilot::new(&settings, VEHICLE.0, Speed::Factor(1.0), &[LinkProfile::Ground], 0)
        .expect("valid settings")
}

/// A command of the ground station reaches it.
fn command(autopilot: &mut Autopilot, number: MavCmd, parameters: [f32; 7]) {
    let message: Message = MavMessage::COMMAND_LONG(command_long(VEHICLE, number, parameters)).into();
    let frame = Frame::encode(&message, Version::Two, 0, STATION).expect("a message of MAVLink 2");
    let peer = PeerId { link: 0, number: 1 };
    autopilot.receive(&Origin { peer, system: STATION.0, component: STATION.1 }, &frame);
}

/// Flies on to the end, at most so many ticks at once. Returns the vehicle, what it sent with the times, µs, and how often it was called.
fn flown(most: u64) -> (Autopilot, Vec<(u64, u32)>, u64) {
    let mut autopilot = autopilot();
    let (mut tick, mut calls, mut sent) = (0, 0, Vec::new());
    let mut fly_to = |autopilot: &mut Autopilot, end: u64| {
        while tick < end {
            tick += autopilot.fly(most.min(end - tick)).expect("the flight goes on");
            calls += 1;
            let time_us = autopilot.time_us();
            sent.extend(autopilot.take_outgoing().map(|outgoing| (time_us, outgoing.message.id())));
        }
    };
    for (at, number, parameters) in COMMANDS {
        fly_to(&mut autopilot, at);
        command(&mut autopilot, number, parameters);
    }
    fly_to(&mut autopilot, END);
    (autopilot, sent, calls)
}

#[test]
fn services_act_at_the_same_times_however_many_ticks_are_flown_at_once() {
    let (one, sent, _) = flown(1);
    assert_eq!((one.boots(), one.time_us()), (2, 1000 * END));
    assert!(one.vehicle().is_armed() && one.vehicle().outputs().position_m.z < -4.9, "it hovers");
    for most in [3, 10, u64::MAX] {
        let (other, messages, calls) = flown(most);
        assert_eq!(other.vehicle().simulation().state(), one.vehicle().simulation().state(), "{most}");
        assert_eq!((other.boots(), other.time_us()), (2, 1000 * END));
        assert!(calls < 2 * END / 3, "{calls} calls");
        // Regular messages come when they are due; what else is told may come a few milliseconds later.
        assert_eq!(messages.len(), sent.len(), "{most}");
        for ((at_us, id), (then_us, other)) in sent.iter().zip(&messages) {
            assert!(
                id == other && then_us.abs_diff(*at_us) < 5_000,
                "{id} at {at_us}, {other} at {then_us} µs"
            );
        }
    }
}

/// Whoever flies it may let it rest for up to 50 ms, unless a message is due, something was asked of it, or it is about to boot.
#[test]
fn it_need_not_be_flown_while_it_rests_and_nothing_is_asked() {
    let mut autopilot = autopilot();
    let fly_to = |autopilot: &mut Autopilot, tick: u64| {
        while autopilot.time_us() < 1000 * tick {
            autopilot.fly(tick - autopilot.time_us() / 1000).expect("it stands");
        }
    };
    let with = |first: f32| [first, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    fly_to(&mut autopilot, 12_001);
    assert_eq!(autopilot.rests_until_us(), Some(12_050_000));
    command(&mut autopilot, MavCmd::MAV_CMD_REQUEST_MESSAGE, with(AUTOPILOT_VERSION));
    assert_eq!(autopilot.rests_until_us(), None, "an answer may be due");
    fly_to(&mut autopilot, 12_002);
    assert_eq!(autopilot.rests_until_us(), Some(12_050_000));
    command(&mut autopilot, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, with(1.0));
    fly_to(&mut autopilot, 12_003);
    assert_eq!(autopilot.rests_until_us(), None, "it is about to boot");
    fly_to(&mut autopilot, 20_002);
    // Long ticks are counted from the boot.
    assert_eq!((autopilot.boots(), autopilot.rests_until_us()), (2, Some(20_007_000)));
}

/// Regular messages do not wait for the end of a rest: at most for that of a long tick.
#[test]
fn a_rest_ends_when_a_message_is_due() {
    let mut autopilot = autopilot();
    let mut messages = 0;
    while autopilot.time_us() < 20_000_000 {
        let end_us = autopilot.rests_until_us().unwrap_or(autopilot.time_us() + 1000);
        while autopilot.time_us() < end_us {
            autopilot.fly((end_us - autopilot.time_us()) / 1000).expect("it stands");
            let now_us = autopilot.time_us();
            let sent = autopilot.take_outgoing().count();
            assert!(sent == 0 || end_us - now_us < 5_000, "{sent} at {now_us} are told at {end_us} µs");
            messages += sent;
        }
    }
    assert!(messages > 100, "{messages}");
}
