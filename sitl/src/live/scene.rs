//! Plans, fences and obstacles as the page draws them.

use std::f64::consts::TAU;

use vehicle::Vehicle;
use vehicle::fence::{Fence, Shape, Zone};
use vehicle::plan::{PlanKind, compile};
use vehicle::surroundings::{Obstacle, Shape as ObstacleShape};
use viewer::{FenceScene, ObstacleScene, Scene, VehicleScene, Waypoint, ZoneScene};

use crate::fleet::{Fleet, Member};

/// Corners of a circle.
const CORNERS: usize = 48;

/// What stands still around a fleet.
pub fn scene(fleet: &Fleet) -> Scene {
    let first = fleet.members().first();
    let obstacles = first.map(|member| member.autopilot().settings().surroundings.obstacles.as_slice());
    Scene {
        vehicles: fleet.members().iter().map(of_member).collect(),
        obstacles: obstacles.unwrap_or_default().iter().map(obstacle).collect(),
    }
}

fn of_member(member: &Member) -> VehicleScene {
    let vehicle = member.autopilot().vehicle();
    let rotors = vehicle.simulation().configuration().airframe.layout.rotors;
    let arm_m = vehicle.simulation().configuration().airframe.arm_length_m;
    VehicleScene {
        id: member.autopilot().system_id(),
        rotors_m: rotors.map(|rotor| [arm_m * rotor.x, arm_m * rotor.y, 0.0]),
        home_m: vehicle.home().position_m.into(),
        mission: mission(vehicle),
        fence: vehicle.fence().filter(Fence::bounds).map(|fence| fence_scene(&fence)),
    }
}

/// The places that the mission flies to. A height that an item leaves open is that of the one before it.
fn mission(vehicle: &Vehicle) -> Vec<Waypoint> {
    let items = vehicle.plans().get(PlanKind::Mission).items();
    let program = compile::mission(items, &vehicle.site());
    let home_m = vehicle.home().position_m;
    let mut at_m = home_m;
    let mut places = Vec::new();
    for item in program.first()..program.len() {
        let Some(navigate) = program.navigate(item) else { continue };
        if let Some(place) = navigate.place() {
            if let Some([north_m, east_m]) = place.horizontal_m {
                (at_m.x, at_m.y) = (north_m, east_m);
            }
            at_m.z = place.down_m(home_m.z).unwrap_or(at_m.z);
            places.push(Waypoint { item, position_m: at_m.into() });
        }
    }
    places
}

fn fence_scene(fence: &Fence<'_>) -> FenceScene {
    let zones = fence.zones.map(|zones| zones.zones.iter().map(zone).collect());
    FenceScene {
        home_m: fence.home_m.into(),
        radius_m: fence.radius_m,
        height_m: fence.height_m,
        zones: zones.unwrap_or_default(),
    }
}

fn zone(zone: &Zone) -> ZoneScene {
    let corners_m = match &zone.shape {
        Shape::Circle { centre_m, radius_m } => circle(*centre_m, *radius_m),
        Shape::Polygon(polygon) => polygon.corners().to_vec(),
    };
    ZoneScene { inclusion: zone.inclusion, corners_m }
}

fn circle([north_m, east_m]: [f64; 2], radius_m: f64) -> Vec<[f64; 2]> {
    let corner = |index: usize| {
        let (sine, cosine) = libm::sincos(TAU * index as f64 / CORNERS as f64);
        [north_m + radius_m * cosine, east_m + radius_m * sine]
    };
    (0..CORNERS).map(corner).collect()
}

fn obstacle(obstacle: &Obstacle) -> ObstacleScene {
    let corners_m = match obstacle.shape {
        ObstacleShape::Cylinder { centre_m, radius_m } => circle(centre_m, radius_m),
        ObstacleShape::Box { centre_m: [north_m, east_m], size_m: [length_m, width_m], heading_rad } => {
            let (sine, cosine) = libm::sincos(heading_rad);
            [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
                .map(|(along, across)| (along * length_m / 2.0, across * width_m / 2.0))
                .map(|(x, y)| [north_m + cosine * x - sine * y, east_m + sine * x + cosine * y])
                .to_vec()
        }
    };
    ObstacleScene { name: obstacle.name.clone(), corners_m, heights_m: [obstacle.bottom_m, obstacle.top_m] }
}
