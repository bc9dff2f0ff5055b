//! What the vehicles of a run share.

/// Whose the ports are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Ports {
    /// Each vehicle has its own, counted up
    #[default]
    Own,
    /// All vehicles are behind the same ports, told apart by system id
    Shared,
}

/// Whose simulation time is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Clocks {
    /// All vehicles tick together, at one speed
    #[default]
    Shared,
    /// Each vehicle has its own time and SIM_SPEEDUP
    Separate,
}
