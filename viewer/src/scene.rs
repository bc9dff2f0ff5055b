//! What does not move by itself: vehicles' shapes, plans, fences and obstacles.

use serde::Serialize;

/// All of it. Places are NED, m.
#[derive(Clone, Debug, PartialEq, Default, Serialize)]
pub struct Scene {
    /// One for each vehicle.
    pub vehicles: Vec<VehicleScene>,
    /// What stands around.
    pub obstacles: Vec<ObstacleScene>,
    /// How high the ground is, unless it is flat.
    pub ground: Option<GroundScene>,
}

/// What belongs to one vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VehicleScene {
    /// System id.
    pub id: u8,
    /// Places of the rotors, FRD, m.
    pub rotors_m: [[f64; 3]; 4],
    /// Home.
    pub home_m: [f64; 3],
    /// The mission's places in their order.
    pub mission: Vec<Waypoint>,
    /// The fence, while it is on.
    pub fence: Option<FenceScene>,
}

/// A place of a mission.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Waypoint {
    /// Number of its item.
    pub item: usize,
    /// Places on the way there, from the one before it on.
    pub through_m: Vec<[f64; 3]>,
    /// Where.
    pub position_m: [f64; 3],
}

/// Where a vehicle may fly.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FenceScene {
    /// What radius and height are from.
    pub home_m: [f64; 3],
    /// Greatest distance, m; 0: any.
    pub radius_m: f64,
    /// Greatest height, m; 0: any.
    pub height_m: f64,
    /// Areas.
    pub zones: Vec<ZoneScene>,
}

/// An area.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZoneScene {
    /// Whether to stay in it; else out of it.
    pub inclusion: bool,
    /// Corners, north and east, m; circles have many.
    pub corners_m: Vec<[f64; 2]>,
}

/// Heights of the ground at the corners of squares. Beyond them it goes on as high as at their edge.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroundScene {
    /// North and east of the first height, m: the south-west corner.
    pub corner_m: [f64; 2],
    /// Side of the squares, m.
    pub step_m: f64,
    /// Rows from south to north, each from west to east and equally long: heights, m.
    pub rows_m: Vec<Vec<f64>>,
}

/// Something that stands.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObstacleScene {
    /// What people call it.
    pub name: String,
    /// Corners of its ground plan, north and east, m.
    pub corners_m: Vec<[f64; 2]>,
    /// Its lower and its upper end above the origin, m: what is in the ground is left out.
    pub heights_m: [f64; 2],
}
