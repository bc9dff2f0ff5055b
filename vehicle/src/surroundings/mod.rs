//! What is around the vehicle: the ground, obstacles that stand, and aircraft that fly by. Ranges are measured to the former; the latter are heard.

mod aircraft;
mod obstacle;
mod range_scan;
mod scripted_aircraft;
mod terrain;

use serde::{Deserialize, Serialize};

pub use aircraft::Aircraft;
pub use obstacle::{Obstacle, Shape};
pub use range_scan::{FARTHEST_RANGE_M, NEAREST_RANGE_M, RangeScan, Reading, SECTOR_RAD, SECTORS};
pub use scripted_aircraft::{ScriptedAircraft, Way};
pub use terrain::{HeightGrid, Hill, Relief, Terrain};

/// All of it, as files and flags describe it.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Surroundings {
    /// What stands; there is a lidar if anything does.
    pub obstacles: Vec<Obstacle>,
    /// What flies by.
    pub aircraft: Vec<ScriptedAircraft>,
    /// How high the ground is.
    #[serde(default)]
    pub terrain: Terrain,
}
