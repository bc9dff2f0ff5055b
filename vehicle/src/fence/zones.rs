//! All areas together.

use super::Zone;

/// What a fence consists of.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Zones {
    /// The areas.
    pub zones: Vec<Zone>,
    /// Where to return to when the fence is breached, north and east, m.
    pub return_m: Option<[f64; 2]>,
}
