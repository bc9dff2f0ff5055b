//! A place to go to.

/// Where to go and stay; what is `None` stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Reposition {
    /// North and east, m.
    pub horizontal_m: Option<[f64; 2]>,
    /// Down, m.
    pub down_m: Option<f64>,
    /// Heading, rad.
    pub yaw_rad: Option<f64>,
    /// Whether the height is given above the ground: the way there follows the ground.
    pub is_above_ground: bool,
}
