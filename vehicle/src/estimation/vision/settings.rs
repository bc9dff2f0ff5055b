//! How estimates from outside are used.

use super::{VisionReading, VisionRefusal};

/// What of them is fused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct VisionUse {
    /// Horizontal position.
    pub horizontal: bool,
    /// Height.
    pub vertical: bool,
    /// Horizontal velocity.
    pub velocity: bool,
    /// Vertical velocity.
    pub climb: bool,
    /// Heading.
    pub heading: bool,
}

/// What is fused, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisionSettings {
    /// What.
    pub uses: VisionUse,
    /// Whether their height is the vehicle's; otherwise only its changes count.
    pub is_height_reference: bool,
    /// Whether the compass is not fused any more once a heading has come, even if no other follows.
    pub excludes_compass: bool,
    /// Least standard deviation of positions, m.
    pub position_noise_m: f64,
    /// Of velocities, m/s.
    pub velocity_noise_m_s: f64,
    /// Of headings, rad.
    pub heading_noise_rad: f64,
    /// Whether a greater deviation that a reading tells counts.
    pub believes_told_noise: bool,
    /// How many standard deviations a position may be off.
    pub position_gate: f64,
    /// The same of a velocity.
    pub velocity_gate: f64,
    /// Time from an estimate to its message, µs.
    pub delay_us: u64,
    /// Where on the vehicle the place is that estimates are of, FRD, m.
    pub place_m: [f64; 3],
    /// What positions are multiplied by.
    pub scale: f64,
    /// Least quality of a reading that is used, %.
    pub least_quality: i8,
}

impl VisionSettings {
    /// Whether a reading is good enough.
    ///
    /// # Errors
    /// [`VisionRefusal`]: why it is not.
    pub fn check(&self, reading: &VisionReading) -> Result<(), VisionRefusal> {
        if !reading.is_possible() {
            return Err(VisionRefusal::Impossible);
        }
        if reading.quality < self.least_quality {
            return Err(VisionRefusal::Poor { quality: reading.quality, least: self.least_quality });
        }
        Ok(())
    }
}

impl VisionUse {
    /// Whether anything is fused.
    pub fn anything(&self) -> bool {
        *self != Self::default()
    }

    /// Whether they tell where the vehicle is, or how fast it moves.
    pub fn aids(&self) -> bool {
        self.horizontal || self.velocity
    }

    /// Whether a reading has something that is fused.
    pub fn wants(&self, reading: &VisionReading) -> bool {
        let place = self.horizontal || self.vertical;
        let motion = self.velocity || self.climb;
        place && reading.position.is_some()
            || motion && reading.velocity.is_some()
            || self.heading && reading.attitude.is_some()
    }
}
