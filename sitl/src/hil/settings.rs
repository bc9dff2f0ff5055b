//! What the simulator is told.

use std::path::PathBuf;

use vehicle::VehicleSettings;
use vehicle::parameters::Speed;

use super::Mount;

/// What the simulator of an external autopilot does.
#[derive(Clone, Debug, PartialEq)]
pub struct HilSettings {
    /// Address to listen on.
    pub host: String,
    /// Port to listen on; 0: any.
    pub port: u16,
    /// How the autopilot sits on the airframe.
    pub mount: Mount,
    /// Airframe, start and wind.
    pub vehicle: VehicleSettings,
    /// MAVLink system id of the simulator.
    pub system_id: u8,
    /// Pace.
    pub speed: Speed,
    /// File that tells that the autopilot can connect.
    pub ready_file: Option<PathBuf>,
    /// End, µs of simulation time.
    pub end_us: Option<u64>,
    /// What the user is to be told at the start, a line each.
    pub notes: Vec<String>,
}
