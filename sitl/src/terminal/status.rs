//! What the status line says of vehicles.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::status_line::Segment;
use crate::fleet::{Fleet, Member};
use crate::link::Links;

/// Ranks of the segments: the state is said in any case.
const STATE: u8 = 0;
const PLACE: u8 = 2;
const BATTERY: u8 = 3;
const CLIENTS: u8 = 5;

/// The state of a fleet.
pub fn of_fleet(fleet: &Fleet) -> Vec<Segment> {
    let mut segments = match fleet.members() {
        [only] => of_one(only),
        many => of_many(many),
    };
    let clients: usize = fleet.hubs().iter().map(Links::active_peers).sum();
    segments.push(Segment::new(CLIENTS, counted(clients, "client")));
    segments
}

/// The state of an external autopilot, and where the vehicle is, NED, m.
pub fn of_autopilot(state: &str, position_m: &Vector3<f64>) -> Vec<Segment> {
    vec![Segment::new(STATE, state), place(position_m)]
}

fn of_one(member: &Member) -> Vec<Segment> {
    let vehicle = member.autopilot().vehicle();
    let armed = if vehicle.is_armed() { "armed" } else { "disarmed" };
    let mode = vehicle.identity().mode_name(vehicle.mode());
    vec![
        Segment::new(STATE, format!("{armed} {mode}")),
        place(&vehicle.outputs().position_m),
        battery(vehicle.battery_remaining()),
    ]
}

/// How many are in which state, and the weakest battery.
fn of_many(members: &[Member]) -> Vec<Segment> {
    let lost = members.iter().filter(|member| member.loss().is_some()).count();
    let flying = || members.iter().filter(|member| member.loss().is_none());
    let vehicles = || flying().map(|member| member.autopilot().vehicle());
    let armed = vehicles().filter(|vehicle| vehicle.is_armed()).count();
    let mut modes = BTreeMap::new();
    for vehicle in vehicles() {
        *modes.entry(vehicle.identity().mode_name(vehicle.mode())).or_insert(0) += 1;
    }
    let modes: Vec<String> = modes.into_iter().map(|(mode, count)| format!("{count} {mode}")).collect();
    let state = match lost {
        0 => format!("{armed} of {} armed", members.len()),
        _ => format!("{armed} of {} armed, {lost} lost", members.len()),
    };
    vec![
        Segment::new(STATE, state),
        Segment::new(PLACE, modes.join(", ")),
        battery(vehicles().map(|vehicle| vehicle.battery_remaining()).fold(1.0, f64::min)),
    ]
}

fn place(position_m: &Vector3<f64>) -> Segment {
    // Adding zero makes a plus of minus zero.
    let [north, east, down] = position_m.map(|metres| (metres * 10.0).round() / 10.0 + 0.0).data.0[0];
    Segment::new(PLACE, format!("N {north:5.1} E {east:5.1} up {:4.1} m", 0.0 - down))
}

fn battery(remaining: f64) -> Segment {
    Segment::new(BATTERY, format!("battery {:.0} %", 100.0 * remaining))
}

fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}
