//! What is flown, under which circumstances.

use nalgebra::Vector3;
use quadrotor::{Configuration, Disturbance, Inputs, PositionReference};

use super::flyer::Flyer;
use super::path::Path;

/// A row of the table of bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// 300 m at the speed limit.
    Cruise,
    /// Raw goals.
    Goal,
    /// Smooth paths within the limits.
    Path,
    /// Smooth paths beyond the limits.
    BeyondLimits,
    /// A steady side force.
    SideForce,
    /// A wrong mass.
    Mass,
    /// Slow rotors.
    RotorLag,
    /// A spin about the thrust axis.
    Spin,
}

impl Row {
    /// Name in results.json and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cruise => "cruise",
            Self::Goal => "goal",
            Self::Path => "path",
            Self::BeyondLimits => "beyond-limits",
            Self::SideForce => "side-force",
            Self::Mass => "mass",
            Self::RotorLag => "rotor-lag",
            Self::Spin => "spin",
        }
    }
}

/// Where the vehicle is asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demand {
    /// A raw step from the origin, NED, m.
    Goal([f64; 3]),
    /// A trajectory with velocity and acceleration.
    Path(Path),
}

/// One flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The row that it belongs to.
    pub row: Row,
    /// Its name, unique.
    pub name: String,
    /// Vehicle, limits and weights; the kind of controller is the flyer's.
    pub configuration: Configuration,
    /// What is asked for.
    pub demand: Demand,
    /// A steady force from the start, NED, N.
    pub force_n: [f64; 3],
    /// How long, s.
    pub duration_s: f64,
}

impl Plan {
    /// Whether a flyer can do it: the geometric controller follows paths only.
    pub fn can_be_flown_by(&self, flyer: Flyer) -> bool {
        flyer != Flyer::Geometric || matches!(self.demand, Demand::Path(_))
    }

    /// What is asked for at a time.
    pub fn reference(&self, time_s: f64) -> PositionReference {
        match self.demand {
            Demand::Goal(goal_m) => PositionReference::goal(goal_m, 0.0),
            Demand::Path(path) => path.reference(time_s),
        }
    }

    /// What pushes.
    pub fn disturbance(&self) -> Disturbance {
        Disturbance { force_n: Vector3::from(self.force_n), ..Disturbance::default() }
    }

    /// All inputs of a closed loop.
    pub fn inputs(&self, time_us: u64) -> Inputs {
        Inputs {
            reference: self.reference(time_us as f64 * 1e-6),
            disturbance: self.disturbance(),
            ..Inputs::default()
        }
    }
}
