//! ArduPilot's sources of the estimator (EK3_SRC…), and its parameters of visual odometry (VISO_…).

use serde::{Deserialize, Serialize};

use super::super::sensor_errors::Triple;
use super::super::vision::{VisionSettings, VisionUse};
use super::{Aiding, GpsUse};

/// Numbers of sources.
const GPS: u8 = 3;
const VISION: u8 = 6;
/// Of EK3_SRC_OPTIONS: velocities of all sets are fused.
const ALL_VELOCITIES: u8 = 1;
/// How many standard deviations measurements may be off: EK3_POS_I_GATE and EK3_VEL_I_GATE, hundredths.
const GATE: f64 = 5.0;

/// One set: a number for each quantity, by which ArduPilot knows its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct SourceSet {
    /// Of the horizontal position.
    pub position: u8,
    /// Of the horizontal velocity.
    pub velocity: u8,
    /// Of the height.
    pub height: u8,
    /// Of the vertical velocity.
    pub climb: u8,
    /// Of the heading.
    pub heading: u8,
}

/// The parameters, with ArduPilot's defaults.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SourceSets {
    /// The set that is used after a start.
    pub first: SourceSet,
    /// Another one to change to.
    pub second: SourceSet,
    /// And one more.
    pub third: SourceSet,
    /// Options, as EK3_SRC_OPTIONS adds them up.
    pub options: u8,
    /// Kind of visual odometry (VISO_TYPE); 0: none.
    pub vision_kind: u8,
    /// Least standard deviation of positions, m.
    pub position_noise_m: f64,
    /// Of velocities, m/s.
    pub velocity_noise_m_s: f64,
    /// Of headings, rad.
    pub heading_noise_rad: f64,
    /// Time from an estimate to its message, ms.
    pub delay_ms: u16,
    /// Where on the vehicle the place is that estimates are of, FRD, m.
    pub place: Triple,
    /// What positions are multiplied by (VISO_SCALE).
    pub scale: f64,
    /// Least quality of an estimate that is used, %; −1: any.
    pub least_quality: i8,
}

impl Default for SourceSet {
    /// None, but for the barometer.
    fn default() -> Self {
        Self { position: 0, velocity: 0, height: 1, climb: 0, heading: 0 }
    }
}

impl Default for SourceSets {
    fn default() -> Self {
        Self {
            first: SourceSet { position: GPS, velocity: GPS, height: 1, climb: GPS, heading: 1 },
            second: SourceSet::default(),
            third: SourceSet::default(),
            options: ALL_VELOCITIES,
            vision_kind: 0,
            position_noise_m: 0.2,
            velocity_noise_m_s: 0.1,
            heading_noise_rad: 0.2,
            delay_ms: 10,
            place: Triple::default(),
            scale: 1.0,
            least_quality: 0,
        }
    }
}

impl SourceSet {
    fn numbers(&self) -> [u8; 5] {
        [self.position, self.velocity, self.height, self.climb, self.heading]
    }
}

impl SourceSets {
    fn sets(&self) -> [&SourceSet; 3] {
        [&self.first, &self.second, &self.third]
    }

    /// Whether any set asks for vision although there is none.
    pub fn lack_vision(&self) -> bool {
        self.vision_kind == 0 && self.sets().iter().any(|set| set.numbers().contains(&VISION))
    }

    /// What is fused under a set, from 0.
    pub fn aiding(&self, set: usize) -> Aiding {
        let sets = self.sets();
        let active = sets.get(set).copied().unwrap_or(&self.first);
        let all = self.options & ALL_VELOCITIES != 0;
        let moves =
            |source: u8| active.velocity == source || all && sets.iter().any(|set| set.velocity == source);
        let climbs = |source: u8| active.climb == source || all && sets.iter().any(|set| set.climb == source);
        let vision = VisionSettings {
            uses: VisionUse {
                horizontal: active.position == VISION,
                vertical: active.height == VISION,
                velocity: moves(VISION),
                climb: climbs(VISION),
                heading: active.heading == VISION,
            },
            is_height_reference: active.height == VISION,
            excludes_compass: active.heading == VISION,
            position_noise_m: self.position_noise_m,
            velocity_noise_m_s: self.velocity_noise_m_s,
            heading_noise_rad: self.heading_noise_rad,
            believes_told_noise: true,
            position_gate: GATE,
            velocity_gate: GATE,
            delay_us: u64::from(self.delay_ms) * 1000,
            place_m: [self.place.x, self.place.y, self.place.z],
            scale: self.scale,
            least_quality: if self.least_quality < 0 { i8::MIN } else { self.least_quality },
        };
        let position = active.position == GPS;
        Aiding {
            gps: GpsUse { position, height: position && active.height != VISION, velocity: moves(GPS) },
            vision: (self.vision_kind != 0 && vision.uses.anything()).then_some(vision),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Aiding, SourceSet, SourceSets};

    #[test]
    fn sets_choose_what_is_fused() {
        let none = SourceSets::default();
        assert_eq!(none.aiding(0), Aiding::default());
        assert!(!none.lack_vision());
        // By vision alone, which there must be.
        let first = SourceSet { position: 6, velocity: 6, height: 6, climb: 6, heading: 6 };
        let asked = SourceSets { first, ..none };
        assert!(asked.lack_vision() && asked.aiding(0).vision.is_none() && !asked.aiding(0).gps.aids());
        let used = SourceSets { vision_kind: 1, ..asked };
        let vision = used.aiding(0).vision.expect("used");
        assert!(vision.uses.horizontal && vision.uses.heading && vision.is_height_reference);
        assert!(!used.lack_vision());
    }

    #[test]
    fn velocities_of_other_sets_are_fused_unless_an_option_says_no() {
        let second = SourceSet { position: 6, velocity: 6, ..SourceSet::default() };
        let both = SourceSets { second, vision_kind: 1, ..SourceSets::default() };
        let [first, second] = [0, 1].map(|set| both.aiding(set));
        assert!(first.gps.position && first.gps.velocity && second.gps.velocity && !second.gps.position);
        let uses = first.vision.expect("its velocity").uses;
        assert!(uses.velocity && !uses.horizontal);
        let apart = SourceSets { options: 0, ..both };
        assert!(apart.aiding(0).vision.is_none() && !apart.aiding(1).gps.aids());
        assert_eq!(both.aiding(7), both.aiding(0), "there is no eighth set");
    }
}
