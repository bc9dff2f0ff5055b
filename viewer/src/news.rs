//! What is said in words: modes, faults and lines for the pilot.

use serde::Serialize;

/// All of it.
#[derive(Clone, Debug, PartialEq, Default, Serialize)]
pub struct News {
    /// One for each vehicle.
    pub vehicles: Vec<VehicleNews>,
    /// The latest lines, the oldest first.
    pub texts: Vec<Text>,
}

/// What is said of one vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VehicleNews {
    /// System id.
    pub id: u8,
    /// Its mode.
    pub mode: String,
    /// What is broken.
    pub faults: Vec<String>,
}

/// A line for the pilot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Text {
    /// Counts up, so that no line is shown twice.
    pub number: u64,
    /// Simulation time, s.
    pub time_s: f64,
    /// System id of who says it.
    pub vehicle: u8,
    /// 0 (emergency) to 7 (debug), as in syslog.
    pub severity: u8,
    /// What.
    pub text: String,
}
