//! A tick of the MAVLink vehicle, with the messages that it sends to a ground station.

use std::hint::black_box;

use autopilot::Autopilot;
use autopilot::codec::{Frame, Message, Version, command_long};
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use vehicle::identity::Identity;
use vehicle::parameters::Speed;
use vehicle::{Mode, VehicleSettings};

const VEHICLE: (u8, u8) = (1, 1);
const GROUND_STATION: (u8, u8) = (255, 190);
/// Ticks after which it hovers.
const TAKEOFF_TICKS: u32 = 12_000;
/// Above sea level, m: ten metres above the default place.
const ALTITUDE_M: f32 = 498.0;

/// Ticks of a vehicle that hovers; what it sends is encoded.
pub fn run(times: u32) {
    let mut vehicle = hovering();
    for _ in 0..times {
        tick(&mut vehicle);
    }
}

fn hovering() -> Autopilot {
    let settings = VehicleSettings::new(Identity::Px4);
    let mut vehicle = Autopilot::new(&settings, VEHICLE.0, Speed::Factor(1.0), &[LinkProfile::Ground], 0)
        .expect("the defaults fly");
    command(&mut vehicle, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let up = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, ALTITUDE_M];
    command(&mut vehicle, MavCmd::MAV_CMD_NAV_TAKEOFF, up);
    for _ in 0..TAKEOFF_TICKS {
        tick(&mut vehicle);
    }
    assert!(vehicle.vehicle().mode() != Mode::Takeoff, "it hovers");
    vehicle
}

fn tick(vehicle: &mut Autopilot) {
    vehicle.tick().expect("the flight goes on");
    vehicle.transfer(0, |_| Some(true));
    for (sequence, outgoing) in vehicle.take_outgoing().enumerate() {
        let sender = (VEHICLE.0, outgoing.component);
        black_box(Frame::encode(&outgoing.message, Version::Two, sequence as u8, sender));
    }
}

fn command(vehicle: &mut Autopilot, command: MavCmd, parameters: [f32; 7]) {
    let message: Message = MavMessage::COMMAND_LONG(command_long(VEHICLE, command, parameters)).into();
    let frame = Frame::encode(&message, Version::Two, 0, GROUND_STATION).expect("a message of MAVLink 2");
    let peer = PeerId { link: 0, number: 1 };
    vehicle.receive(&Origin { peer, system: GROUND_STATION.0, component: GROUND_STATION.1 }, &frame);
}
