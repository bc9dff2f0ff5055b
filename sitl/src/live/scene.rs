//! Plans, fences and obstacles as the page draws them.

use std::f64::consts::TAU;

use autopilot::Autopilot;
use nalgebra::Vector3;
use vehicle::fence::{Fence, Inclusions, Shape, Zone};
use vehicle::surroundings::{Obstacle, Shape as ObstacleShape, Terrain};
use vehicle::{PlannedLeg, Vehicle};
use viewer::{FenceScene, ObstacleScene, Scene, VehicleScene, Waypoint, ZoneScene};

use super::ground::ground;

/// Corners of a circle.
const CORNERS: usize = 48;

/// Notices when another scene is to be drawn: to draw it takes longer than to see that it is the same.
#[derive(Debug, Default)]
pub struct SceneWatch(Option<Vec<Outline>>);

/// What the scene of a vehicle is made of, in short.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Outline {
    system_id: u8,
    rotors_m: [[f64; 3]; 4],
    home_m: Vector3<f64>,
    takeoff_height_m: f64,
    /// Starts of the vehicle, and plans that were replaced since.
    plans: (u32, u32),
    fence: Option<FenceOutline>,
}

/// The same of a fence; its areas are in a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FenceOutline {
    has_zones: bool,
    inclusions: Inclusions,
    home_m: Vector3<f64>,
    radius_m: f64,
    height_m: f64,
}

impl SceneWatch {
    /// What stands still around vehicles, unless it is what it was at the last call.
    pub fn changed<'a>(&mut self, autopilots: impl Iterator<Item = &'a Autopilot> + Clone) -> Option<Scene> {
        let outlines = autopilots.clone().map(Outline::of).collect();
        let differs = self.0.as_ref() != Some(&outlines);
        self.0 = Some(outlines);
        differs.then(|| scene(autopilots))
    }
}

impl Outline {
    fn of(autopilot: &Autopilot) -> Self {
        let vehicle = autopilot.vehicle();
        let fence = vehicle.fence().filter(Fence::bounds).map(|fence| FenceOutline {
            has_zones: fence.zones.is_some(),
            inclusions: fence.inclusions,
            home_m: fence.home_m,
            radius_m: fence.radius_m,
            height_m: fence.height_m,
        });
        Self {
            system_id: autopilot.system_id(),
            rotors_m: rotors_m(vehicle),
            home_m: vehicle.home().position_m,
            takeoff_height_m: vehicle.conduct().takeoff_height_m,
            plans: (autopilot.boots(), vehicle.plans_revision()),
            fence,
        }
    }
}

/// What stands still around vehicles.
pub fn scene<'a>(autopilots: impl Iterator<Item = &'a Autopilot> + Clone) -> Scene {
    let first = autopilots.clone().next();
    let surroundings = first.map(|autopilot| &autopilot.settings().surroundings);
    Scene {
        vehicles: autopilots.map(of_one).collect(),
        obstacles: surroundings
            .map(|all| all.obstacles.iter().map(|one| obstacle(one, &all.terrain)).collect())
            .unwrap_or_default(),
        ground: surroundings.and_then(|all| ground(&all.terrain)),
    }
}

fn rotors_m(vehicle: &Vehicle) -> [[f64; 3]; 4] {
    let airframe = &vehicle.simulation().configuration().airframe;
    let arm_m = airframe.arm_length_m;
    airframe.layout.rotors.map(|rotor| [arm_m * rotor.x, arm_m * rotor.y, 0.0])
}

fn of_one(autopilot: &Autopilot) -> VehicleScene {
    let vehicle = autopilot.vehicle();
    VehicleScene {
        id: autopilot.system_id(),
        rotors_m: rotors_m(vehicle),
        home_m: vehicle.home().position_m.into(),
        mission: vehicle.planned_way().iter().map(waypoint).collect(),
        fence: vehicle.fence().filter(Fence::bounds).map(|fence| fence_scene(&fence)),
    }
}

fn waypoint(leg: &PlannedLeg) -> Waypoint {
    Waypoint {
        item: leg.item,
        through_m: leg.through_m.iter().map(to_centimetres).collect(),
        position_m: leg.place_m.into(),
    }
}

/// Ways over ground have many places.
fn to_centimetres(place_m: &Vector3<f64>) -> [f64; 3] {
    place_m.map(|metres| (metres * 100.0).round() / 100.0).into()
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

fn obstacle(obstacle: &Obstacle, terrain: &Terrain) -> ObstacleScene {
    let (ObstacleShape::Cylinder { centre_m, .. } | ObstacleShape::Box { centre_m, .. }) = obstacle.shape;
    let corners_m = match obstacle.shape {
        ObstacleShape::Cylinder { radius_m, .. } => circle(centre_m, radius_m),
        ObstacleShape::Box { size_m: [length_m, width_m], heading_rad, .. } => {
            let [north_m, east_m] = centre_m;
            let (sine, cosine) = libm::sincos(heading_rad);
            [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
                .map(|(along, across)| (along * length_m / 2.0, across * width_m / 2.0))
                .map(|(x, y)| [north_m + cosine * x - sine * y, east_m + sine * x + cosine * y])
                .to_vec()
        }
    };
    // What stands on a slope is rooted far below it, and over a hollow farther below than at its corners.
    let ground_m = outline_m(centre_m, &corners_m).map(|place_m| -terrain.z_m(place_m));
    let bottom_m = obstacle.bottom_m.max(ground_m.fold(f64::INFINITY, f64::min));
    let heights_m = [bottom_m.min(obstacle.top_m), obstacle.top_m];
    ObstacleScene { name: obstacle.name.clone(), corners_m, heights_m }
}

/// Places below an area: its middle, and on its sides.
fn outline_m(centre_m: [f64; 2], corners_m: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> {
    /// So many parts of each side.
    const PARTS: usize = 16;
    let next_m = corners_m.iter().cycle().skip(1);
    let on_side_m = |(from_m, to_m): (&[f64; 2], &[f64; 2])| {
        let (from_m, to_m) = (*from_m, *to_m);
        (0..PARTS).map(move |part| {
            let share = part as f64 / PARTS as f64;
            [0, 1].map(|axis| from_m[axis] + share * (to_m[axis] - from_m[axis]))
        })
    };
    std::iter::once(centre_m).chain(corners_m.iter().zip(next_m).flat_map(on_side_m))
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use clap::Parser;
    use mavlink::dialects::ardupilotmega::{MavMessage, MavParamType, PARAM_SET_DATA};

    use vehicle::surroundings::{Hill, Obstacle, Relief, Shape, Terrain};

    use super::{SceneWatch, obstacle};
    use crate::configuration::{Arguments, Settings};
    use crate::fleet::{Fleet, Member};

    #[test]
    fn a_scene_is_drawn_when_it_has_changed_and_only_then() {
        let line = "lmpc-sitl --link udpin:0 --set GF_MAX_HOR_DIST=40 --set GF_ACTION=1";
        let arguments = Arguments::try_parse_from(line.split(' ')).expect("arguments");
        let settings = Settings::resolve(&arguments).expect("settings");
        let mut fleet = Fleet::open(&settings, 0).expect("a free port");
        let mut watch = SceneWatch::default();
        let mut look = |fleet: &Fleet| watch.changed(fleet.members().iter().map(Member::autopilot));
        let radius_m = |scene: viewer::Scene| scene.vehicles[0].fence.as_ref().map(|fence| fence.radius_m);
        assert_eq!(look(&fleet).and_then(radius_m), Some(40.0));
        assert!(look(&fleet).is_none());
        let wider = MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: 60.0,
            target_system: 1,
            target_component: 1,
            param_id: "GF_MAX_HOR_DIST".into(),
            param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
        });
        fleet.ask(0, wider, Instant::now());
        assert_eq!(look(&fleet).and_then(radius_m), Some(60.0));
        assert!(look(&fleet).is_none());
    }

    /// From crest to crest of two hills 20 m high, 100 m apart: in the middle the ground is at 0 m.
    #[test]
    fn a_wall_across_a_hollow_reaches_down_to_its_bottom_and_none_stands_on_its_head() {
        let hill = |north_m| Hill { centre_m: [north_m, 0.0], radius_m: 45.0, top_m: 5.0, height_m: 20.0 };
        let terrain = Terrain::new(Relief { grid: None, hills: vec![hill(-50.0), hill(50.0)] });
        let wall = |top_m| {
            let shape = Shape::Box { centre_m: [0.0, 0.0], size_m: [100.0, 1.0], heading_rad: 0.0 };
            let wall = Obstacle { name: "wall".to_owned(), shape, bottom_m: f64::NEG_INFINITY, top_m };
            obstacle(&wall, &terrain).heights_m
        };
        assert_eq!(wall(30.0), [0.0, 30.0]);
        assert_eq!(wall(-3.0), [-3.0, -3.0], "wholly below the ground");
    }
}
