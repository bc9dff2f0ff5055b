//! What a tick allocates, with all that it sends.

use std::net::UdpSocket;
use std::time::Instant;

use clap::Parser;
use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::Mode;

use super::Fleet;
use super::station::command;
use crate::configuration::{Arguments, Settings};

/// Ticks between two looks at the links.
const LOOK: u64 = 10;

fn fly(fleet: &mut Fleet, ticks: u64, now: Instant) {
    for tick in 0..ticks {
        fleet.fly_member(0, 1, now);
        if tick % LOOK == 0 {
            fleet.flush();
        }
    }
}

/// With the default telemetry of a ground station and of an onboard computer.
#[test]
fn a_hovering_vehicle_flies_and_tells_without_allocating() {
    let clients = [(); 2].map(|()| UdpSocket::bind("127.0.0.1:0").expect("a free port"));
    let [ground, onboard] = clients.each_ref().map(|client| client.local_addr().expect("an address"));
    let line = format!("lmpc-sitl --link udpout:{ground} --link udpout:{onboard},onboard");
    let arguments = Arguments::try_parse_from(line.split(' ')).expect("arguments");
    let settings = Settings::resolve(&arguments).expect("settings");
    let mut fleet = Fleet::open(&settings, 0).expect("free ports");
    let now = Instant::now();
    fleet.receive(now);
    fleet.take_in(0, &command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0), now);
    fleet.take_in(0, &command(MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, f32::NAN), now);
    fly(&mut fleet, 30_000, now);
    let vehicle = fleet.members()[0].autopilot().vehicle();
    assert_eq!((vehicle.mode(), vehicle.is_armed()), (Mode::Hold, true));
    let allocations = allocation_counter::measure(|| fly(&mut fleet, 20_000, now));
    assert_eq!(allocations.count_total, 0, "{allocations:?}");
    for client in &clients {
        client.set_nonblocking(true).expect("a socket");
        assert!(client.recv(&mut [0; 2048]).is_ok(), "telemetry was sent");
    }
}
