//! Vehicles within a fence.

use super::requests::{reposition, set_parameter_as};
use mavlink::dialects::ardupilotmega::*;
use nalgebra::Vector3;
use vehicle::plan::{MissionItem, Plan, PlanKind, command, frame};
use vehicle::{Mode, VehicleSettings};

use super::Bench;

/// Answers to commands (MAV_RESULT).
pub const TEMPORARILY_REJECTED: u8 = 1;
pub const DENIED: u8 = 2;
pub const FAILED: u8 = 4;

/// An item of a fence, or a rally point, at a place north and east of the origin, m.
pub fn item(
    settings: &VehicleSettings,
    command: u16,
    parameter: f64,
    [north, east]: [f64; 2],
) -> MissionItem {
    let place = vehicle::world::LocalFrame::new(settings.origin).to_geodetic(&Vector3::new(north, east, 0.0));
    MissionItem {
        frame: frame::GLOBAL_RELATIVE_INT,
        command,
        parameters: [parameter, 0.0, 0.0, 0.0],
        position: [place.latitude_deg, place.longitude_deg, 0.0],
        autocontinue: true,
    }
}

pub fn polygon(settings: &VehicleSettings, inclusion: bool, corners: &[[f64; 2]]) -> Vec<MissionItem> {
    let command = if inclusion {
        command::NAV_FENCE_POLYGON_VERTEX_INCLUSION
    } else {
        command::NAV_FENCE_POLYGON_VERTEX_EXCLUSION
    };
    corners.iter().map(|corner| item(settings, command, corners.len() as f64, *corner)).collect()
}

pub fn square(settings: &VehicleSettings, half_m: f64) -> Vec<MissionItem> {
    polygon(settings, true, &[[-half_m, -half_m], [half_m, -half_m], [half_m, half_m], [-half_m, half_m]])
}

/// A vehicle with plans that hovers 10 m up.
pub fn hovering(start: &VehicleSettings, fence: Vec<MissionItem>, rally: Vec<MissionItem>) -> Bench {
    let mut start = start.clone();
    start.plans.set(PlanKind::Fence, Plan::new(fence));
    start.plans.set(PlanKind::Rally, Plan::new(rally));
    let mut bench = Bench::of(&start);
    bench.arm();
    let altitude = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 498.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, altitude), 0, "{:?}", bench.texts());
    bench.fly_until("takeoff", 20.0, |bench| bench.mode() == Mode::Hold);
    bench
}

pub fn go_to(bench: &mut Bench, north: f64, east: f64) -> u8 {
    let place = bench.autopilot.vehicle().frame().to_geodetic(&Vector3::new(north, east, 0.0));
    let message = reposition(&place, MavFrame::MAV_FRAME_GLOBAL, f32::NAN);
    bench.heard.clear();
    bench.send(message);
    bench.acks().last().expect("an answer").result
}

/// Flies to a place, and comes to rest.
pub fn there(bench: &mut Bench, north: f64, east: f64) {
    assert_eq!(go_to(bench, north, east), 0, "{:?}", bench.texts());
    bench.fly_until("there", 60.0, |bench| {
        let [x, y, _] = bench.position();
        (x - north).hypot(y - east) < 0.3 && Vector3::from(bench.velocity()).norm() < 0.1
    });
}

/// Full stick forward.
pub fn forward(bench: &mut Bench) {
    let stick = MANUAL_CONTROL_DATA { target: 1, x: 1000, z: 500, ..MANUAL_CONTROL_DATA::default() };
    bench.send(MavMessage::MANUAL_CONTROL(stick));
}

/// Sets a parameter as ArduPilot's clients do: a whole number as a float. Its value then, if there is one.
pub fn set_cast(bench: &mut Bench, id: &str, value: f32) -> Option<f32> {
    bench.heard.clear();
    bench.send(set_parameter_as(id, value, MavParamType::MAV_PARAM_TYPE_INT32));
    bench.parameters().pop().map(|now| now.param_value)
}
