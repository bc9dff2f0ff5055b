//! The page of the book that compares this vehicle with PX4 and ArduPilot, against what the vehicle answers.

use autopilot::Autopilot;
use autopilot::codec::{Frame, Message, Version, command_long};
use autopilot::compatibility::{Carried, CommandRow, commands, modes, page};
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use num_traits::FromPrimitive;
use vehicle::VehicleSettings;
use vehicle::identity::Identity;
use vehicle::parameters::Speed;
use vehicle::plan::{FaultCode, MissionItem, PlanKind, check, frame};

const UNSUPPORTED: u8 = 3;
const FAILED: u8 = 4;

fn vehicle(identity: Identity) -> Autopilot {
    let settings = VehicleSettings::new(identity);
    Autopilot::new(&settings, 1, Speed::Factor(1.0), &[LinkProfile::Ground], 0).expect("valid settings")
}

/// The result of the answer to a command.
fn ask(autopilot: &mut Autopilot, sequence: u8, number: u16, [param1, param2, param3]: [f32; 3]) -> u8 {
    let command = MavCmd::from_u16(number).expect("a command of the dialect");
    let parameters = [param1, param2, param3, 0.0, 0.0, 0.0, 0.0];
    let message = MavMessage::COMMAND_LONG(command_long((1, 1), command, parameters));
    let frame = Frame::encode(&message.into(), Version::Two, sequence, (255, 190)).expect("a frame");
    let origin = Origin { peer: PeerId { link: 0, number: 1 }, system: 255, component: 190 };
    drop(autopilot.take_outgoing());
    autopilot.receive(&origin, &frame);
    let result = autopilot.take_outgoing().find_map(|outgoing| match outgoing.message {
        Message::CommandAck(ack) if ack.command == number => Some(ack.result),
        _ => None,
    });
    result.unwrap_or_else(|| panic!("no answer to {number}"))
}

#[test]
fn the_page_is_what_the_vehicle_claims() {
    let kept = include_str!("../../book/src/vehicle/compatibility.md").replace("\r\n", "\n");
    assert!(
        kept == page(),
        "compatibility.md is stale: run `cargo run -p autopilot --example compatibility`"
    );
}

/// What the table says to be refused is refused as it says, and nothing else is.
#[test]
fn commands_are_answered_as_the_table_says() {
    // What these ask for decides whether it is supported.
    const ASKED: &[(u16, [f32; 3])] = &[
        (176, [1.0, 3.0, 0.0]),
        (218, [18.0, 0.0, 0.0]),
        (246, [1.0, 0.0, 0.0]),
        (262, [1.0, 0.0, 0.0]),
        (420, [0.0, 0.0, 0.0]),
    ];
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut wrong = Vec::new();
        // What is newer than the dialect is an item of fences only.
        let named = |row: &&CommandRow| MavCmd::from_u16(row.number).is_some();
        for (row, sequence) in commands().iter().filter(named).zip((0..=u8::MAX).cycle()) {
            let asked = ASKED.iter().find(|(number, _)| *number == row.number);
            let parameters = asked.map_or([0.0; 3], |(_, parameters)| *parameters);
            let result = ask(&mut vehicle(identity), sequence, row.number, parameters);
            let [own, other] = match identity {
                Identity::ArduPilot => [row.ardupilot, row.px4],
                _ => [row.px4, row.ardupilot],
            };
            // What only the other original has may be refused with these conventions.
            let taken = row.here.command && (result != UNSUPPORTED || own.command || !other.command);
            if (result != UNSUPPORTED) != taken {
                wrong.push(format!("{}: {result}", row.name));
            }
        }
        assert!(wrong.is_empty(), "{identity:?}: {wrong:?}");
    }
}

#[test]
fn modes_are_entered_as_the_table_says() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        for (row, sequence) in modes(identity).iter().zip(0..) {
            let number = row.custom_mode;
            let [main, sub] = match identity {
                Identity::ArduPilot => [number, 0],
                _ => [number >> 16 & 0xff, number >> 24],
            };
            let parameters = [1.0, main as f32, sub as f32];
            let result = ask(&mut vehicle(identity), sequence, 176, parameters);
            // ArduPilot calls it a failure, as it calls a mode that is there and cannot be entered now.
            let not_here = if identity.is_ardupilot() { FAILED } else { UNSUPPORTED };
            if row.here.is_none() {
                assert_eq!(result, not_here, "{row:?} {identity:?}");
            } else {
                assert!(result != UNSUPPORTED, "{row:?} {identity:?}");
            }
        }
    }
}

/// An oracle that is none of ours: what ground stations cannot fly without.
#[test]
fn the_table_has_what_every_client_needs() {
    let rows = commands();
    let row = |number: u16| rows.iter().find(|row| row.number == number).expect("there");
    let both = Carried { command: true, item: true };
    assert_eq!((row(22).here, row(22).px4, row(22).ardupilot), (both, both, both), "takeoff");
    assert_eq!(row(16).here, Carried { command: false, item: true }, "waypoint");
    assert_eq!(row(400).here, Carried { command: true, item: false }, "arming");
}

/// What the table calls an item is taken in a mission, as far as its parameters are; nothing else is known there.
#[test]
fn items_are_known_as_the_table_says() {
    let site = vehicle(Identity::ArduPilot).vehicle().site();
    let unsupported = |number: u16| {
        let item = MissionItem {
            frame: frame::GLOBAL_RELATIVE_INT,
            command: number,
            parameters: [0.0; 4],
            position: [47.0, 8.0, 10.0],
            autocontinue: true,
        };
        let kinds = [PlanKind::Mission, PlanKind::Fence, PlanKind::Rally];
        // The first item of ArduPilot's missions is home.
        let refused = |kind| {
            check::item(kind, 1, &item, &site).is_err_and(|fault| fault.code == FaultCode::Unsupported)
        };
        kinds.into_iter().all(refused)
    };
    let wrong: Vec<_> =
        commands().into_iter().filter(|row| row.here.item == unsupported(row.number)).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}
