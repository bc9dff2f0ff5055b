//! PX4's parameters of external vision (EKF2_EV_…).

use serde::{Deserialize, Serialize};

use super::super::sensor_errors::Triple;
use super::super::vision::{VisionSettings, VisionUse};
use super::{Aiding, GpsUse};

/// Bits of EKF2_EV_CTRL.
const HORIZONTAL: u32 = 1;
const VERTICAL: u32 = 2;
const VELOCITY: u32 = 4;
const YAW: u32 = 8;

/// The parameters, with PX4's defaults.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Px4Aiding {
    /// What of external vision is used, as EKF2_EV_CTRL adds it up.
    pub control: u32,
    /// What heights refer to.
    pub height_reference: HeightReference,
    /// Least standard deviation of positions, m.
    pub position_noise_m: f64,
    /// Of velocities, m/s.
    pub velocity_noise_m_s: f64,
    /// Of headings, rad.
    pub heading_noise_rad: f64,
    /// Whether the deviations that messages tell are ignored.
    pub ignores_told_noise: bool,
    /// How many standard deviations a position may be off.
    pub position_gate: f64,
    /// The same of a velocity.
    pub velocity_gate: f64,
    /// Time from an estimate to its message, ms.
    pub delay_ms: f64,
    /// Where on the vehicle the place is that estimates are of, FRD, m.
    pub place: Triple,
    /// Least quality of an estimate that is used, %; 0: any.
    pub least_quality: i8,
}

/// What heights refer to, by PX4's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum HeightReference {
    /// The barometer; here as GPS.
    Barometer,
    /// The GPS receiver.
    #[default]
    Gps,
    /// A range sensor; here as GPS.
    Range,
    /// External vision.
    Vision,
}

impl Default for Px4Aiding {
    fn default() -> Self {
        Self {
            control: 0,
            height_reference: HeightReference::Gps,
            position_noise_m: 0.1,
            velocity_noise_m_s: 0.1,
            heading_noise_rad: 0.1,
            ignores_told_noise: false,
            position_gate: 5.0,
            velocity_gate: 3.0,
            delay_ms: 0.0,
            place: Triple::default(),
            least_quality: 0,
        }
    }
}

impl Px4Aiding {
    /// What is fused. Whether GPS is used at all stands in EKF2_GPS_CTRL.
    pub fn aiding(&self) -> Aiding {
        let uses = |bit: u32| self.control & bit != 0;
        let refers = uses(VERTICAL) && self.height_reference == HeightReference::Vision;
        let vision = VisionSettings {
            uses: VisionUse {
                horizontal: uses(HORIZONTAL),
                vertical: uses(VERTICAL),
                velocity: uses(VELOCITY),
                climb: uses(VELOCITY),
                heading: uses(YAW),
            },
            is_height_reference: refers,
            excludes_compass: false,
            position_noise_m: self.position_noise_m,
            velocity_noise_m_s: self.velocity_noise_m_s,
            heading_noise_rad: self.heading_noise_rad,
            believes_told_noise: !self.ignores_told_noise,
            position_gate: self.position_gate,
            velocity_gate: self.velocity_gate,
            delay_us: (self.delay_ms * 1e3) as u64,
            place_m: [self.place.x, self.place.y, self.place.z],
            scale: 1.0,
            least_quality: if self.least_quality > 0 { self.least_quality } else { i8::MIN },
        };
        Aiding {
            gps: GpsUse { position: true, height: !refers, velocity: true },
            vision: vision.uses.anything().then_some(vision),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Aiding, HeightReference, Px4Aiding};

    #[test]
    fn bits_choose_what_is_fused() {
        assert_eq!(Px4Aiding::default().aiding(), Aiding::default());
        let settings = Px4Aiding { control: 0b1001, ..Px4Aiding::default() };
        let vision = settings.aiding().vision.expect("used");
        assert!(vision.uses.horizontal && vision.uses.heading && !vision.uses.vertical);
        assert!(!vision.uses.velocity && !vision.is_height_reference);
        let height_reference = HeightReference::Vision;
        let settings = Px4Aiding { control: 0b0110, height_reference, ..Px4Aiding::default() };
        let aiding = settings.aiding();
        assert!(aiding.vision.expect("used").is_height_reference && !aiding.gps.height);
        // Vision is no reference that is not fused.
        let settings = Px4Aiding { control: 0b0101, height_reference, ..Px4Aiding::default() };
        assert!(settings.aiding().gps.height);
    }
}
