//! A command for a component that is not there is refused at once, in its name: clients take an answer from nobody else.

use autopilot::Autopilot;
use autopilot::codec::{Frame, Message, Version};
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::{
    COMMAND_INT_DATA, COMMAND_LONG_DATA, HEARTBEAT_DATA, MavCmd, MavMessage, MavResult,
};
use vehicle::VehicleSettings;
use vehicle::identity::Identity;
use vehicle::parameters::Speed;

const GROUND_STATION: (u8, u8) = (255, 190);
const WINCH: u8 = 169;

fn vehicle(identity: Identity) -> Autopilot {
    let settings = VehicleSettings::new(identity);
    Autopilot::new(&settings, 1, Speed::Factor(1.0), &[LinkProfile::Ground], 0).expect("valid settings")
}

/// Hands a message over and returns the answers to commands: the component that answers, and the result.
fn answers(autopilot: &mut Autopilot, sender: (u8, u8), message: MavMessage) -> Vec<(u8, u8)> {
    let frame = Frame::encode(&message.into(), Version::Two, 0, sender).expect("a frame");
    let (system, component) = sender;
    let origin = Origin { peer: PeerId { link: 0, number: 1 }, system, component };
    autopilot.take_outgoing();
    autopilot.receive(&origin, &frame);
    let outgoing = autopilot.take_outgoing().filter_map(|outgoing| match outgoing.message {
        Message::CommandAck(ack) => Some((outgoing.component, ack.result)),
        _ => None,
    });
    outgoing.collect()
}

fn long(command: MavCmd, target_system: u8, target_component: u8) -> MavMessage {
    let data = COMMAND_LONG_DATA { command, target_system, target_component, ..COMMAND_LONG_DATA::default() };
    MavMessage::COMMAND_LONG(data)
}

const REFUSED: u8 = MavResult::MAV_RESULT_UNSUPPORTED as u8;

#[test]
fn every_component_answers_every_command() {
    let commands = [
        MavCmd::MAV_CMD_DO_WINCH,
        MavCmd::MAV_CMD_DO_GRIPPER,
        MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
        MavCmd::MAV_CMD_REQUEST_MESSAGE,
    ];
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut autopilot = vehicle(identity);
        for command in commands {
            for component in 0..=u8::MAX {
                let given = answers(&mut autopilot, GROUND_STATION, long(command, 1, component));
                let [(speaker, result)] = given[..] else { panic!("{command:?} to {component}: {given:?}") };
                assert_eq!(speaker, if component == 0 { 1 } else { component });
                let ours = [0, 1, 100, 154].contains(&component);
                assert!(ours || result == REFUSED, "{command:?} to {component}: {result}");
            }
        }
        assert!(!autopilot.vehicle().is_armed(), "what is for another component changes nothing");
    }
}

#[test]
fn who_is_there_answers_for_itself() {
    let mut autopilot = vehicle(Identity::Px4);
    let winch = long(MavCmd::MAV_CMD_DO_WINCH, 1, WINCH);
    assert_eq!(answers(&mut autopilot, GROUND_STATION, winch.clone()), [(WINCH, REFUSED)]);
    let data = COMMAND_INT_DATA {
        command: MavCmd::MAV_CMD_DO_WINCH,
        target_system: 1,
        target_component: WINCH,
        ..COMMAND_INT_DATA::default()
    };
    let int = MavMessage::COMMAND_INT(data);
    assert_eq!(answers(&mut autopilot, GROUND_STATION, int), [(WINCH, REFUSED)]);
    // What is for another system, or for a component of all systems, is nobody's here.
    for system in [0, 2] {
        let other = long(MavCmd::MAV_CMD_DO_WINCH, system, WINCH);
        assert_eq!(answers(&mut autopilot, GROUND_STATION, other), []);
    }
    let heartbeat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
    assert_eq!(answers(&mut autopilot, (1, WINCH), heartbeat), []);
    assert_eq!(answers(&mut autopilot, GROUND_STATION, winch), []);
}
