//! Settings of the simulator.

use std::path::PathBuf;

use vehicle::parameters::Speed;
use vehicle::{Notice, VehicleSettings};

use super::Mount;
use crate::fmu::FmuChoice;

/// Settings of the simulator of an external autopilot.
#[derive(Clone, Debug, PartialEq)]
pub struct HilSettings {
    /// Address to listen on.
    pub host: String,
    /// Port to listen on; 0: any.
    pub port: u16,
    /// How the autopilot sits on the airframe.
    pub mount: Mount,
    /// What moves in place of our plant.
    pub fmu: Option<FmuChoice>,
    /// Airframe, start and wind.
    pub vehicle: VehicleSettings,
    /// MAVLink system id of the simulator.
    pub system_id: u8,
    /// Pace.
    pub speed: Speed,
    /// File to write when the autopilot can connect.
    pub ready_file: Option<PathBuf>,
    /// Whether the flight is followed in one line, and not in a panel.
    pub no_panel: bool,
    /// End, µs of simulation time.
    pub end_us: Option<u64>,
    /// What the user is told at the start.
    pub notes: Vec<Notice>,
}
