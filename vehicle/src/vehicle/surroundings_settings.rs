//! What the vehicle does about obstacles, traffic and remote identification.

use serde::{Deserialize, Serialize};

use super::failsafe::Action;
use super::surface_tracking::SurfaceSettings;
use crate::mode::Mode;

/// Parameters of it. Each field says whose they are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurroundingsSettings {
    /// Distance to keep from obstacles, m; negative: none is kept (PX4: CP_DIST, ArduPilot: AVOID_MARGIN).
    pub obstacle_distance_m: f64,
    /// Time by which it reacts late, s (PX4: CP_DELAY).
    pub obstacle_delay_s: f64,
    /// Whether it moves where nothing is measured (PX4: CP_GO_NO_DATA).
    pub go_without_data: bool,
    /// What is avoided: bits (ArduPilot: AVOID_ENABLE).
    pub avoided: u8,
    /// Up to this height, m, obstacles are not avoided: above the ground if that is measured, else above home; zero: they always are
    /// (ArduPilot: AVOID_ALT_MIN).
    #[serde(default)]
    pub avoided_above_m: f64,
    /// How fast it backs away from the fence, m/s (ArduPilot: AVOID_BACKUP_SPD).
    #[serde(default = "slow")]
    pub backing_m_s: f64,
    /// Kind of the instrument that measures around, zero for none (ArduPilot: PRX1_TYPE).
    pub proximity_kind: u8,
    /// Kind of the downward rangefinder, zero for none (ArduPilot: RNGFND1_TYPE).
    pub rangefinder_kind: u8,
    /// Farthest that it measures, m (ArduPilot: RNGFND1_MAX).
    pub rangefinder_farthest_m: f64,
    /// Nearest that it measures, m (ArduPilot: RNGFND1_MIN).
    pub rangefinder_nearest_m: f64,
    /// When the height above the ground is kept.
    #[serde(default)]
    pub surface: SurfaceSettings,
    /// What is done about traffic.
    pub traffic: TrafficSettings,
    /// Whether it identifies itself (ArduPilot: DID_ENABLE; PX4: COM_ARM_ODID above 0).
    pub remote_id: bool,
    /// Whether it does not arm before it can (ArduPilot: bit 0 of DID_OPTIONS; PX4: COM_ARM_ODID = 2).
    pub remote_id_to_arm: bool,
}

/// Records of before it could be chosen have this one.
fn slow() -> f64 {
    0.75
}

/// When traffic is too near, and what is done then.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrafficSettings {
    /// Whether transponders are heard (ArduPilot: ADSB_TYPE).
    pub heard: bool,
    /// Whether it is looked at (ArduPilot: AVD_ENABLE).
    pub enabled: bool,
    /// What is done (PX4: NAV_TRAFF_AVOID, ArduPilot: AVD_F_ACTION).
    pub action: Action,
    /// Whether what may come near is told (ArduPilot: AVD_W_ACTION).
    pub warns: bool,
    /// What is done when it is over (ArduPilot: AVD_F_RCVRY).
    pub recovery: Recovery,
    /// Horizontal distance that is too near, m (PX4: NAV_TRAFF_A_HOR, ArduPilot: AVD_F_DIST_XY).
    pub near_m: f64,
    /// Vertical distance that is too near, m (PX4: NAV_TRAFF_A_VER, ArduPilot: AVD_F_DIST_Z).
    pub near_vertical_m: f64,
    /// So far ahead is looked, s (PX4: NAV_TRAFF_COLL_T, ArduPilot: AVD_F_TIME).
    pub ahead_s: f64,
    /// Horizontal distance that is told, m (ArduPilot: AVD_W_DIST_XY).
    pub warning_m: f64,
    /// Vertical distance that is told, m (ArduPilot: AVD_W_DIST_Z).
    pub warning_vertical_m: f64,
    /// So far ahead is looked for what is told, s (ArduPilot: AVD_W_TIME).
    pub warning_ahead_s: f64,
    /// Lower than this above home, m, nothing is done but told (ArduPilot: AVD_F_ALT_MIN).
    pub least_height_m: f64,
}

/// What is done when traffic is gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Recovery {
    /// Nothing.
    Remain,
    /// Back to the mode before.
    Resume,
    /// Home.
    Return,
    /// Back to the mission if that was interrupted, else it stays.
    ResumeMission,
}

impl Recovery {
    /// The mode that follows one that was interrupted.
    pub fn mode(self, before: Mode) -> Option<Mode> {
        match self {
            Self::Remain => None,
            Self::Resume => Some(before),
            Self::Return => Some(Mode::Return),
            Self::ResumeMission if before == Mode::Mission => Some(Mode::Mission),
            Self::ResumeMission => Some(Mode::Position),
        }
    }
}

/// The defaults of PX4: 500 m and 60 s, and a warning.
impl Default for SurroundingsSettings {
    fn default() -> Self {
        Self {
            obstacle_distance_m: -1.0,
            obstacle_delay_s: 0.4,
            go_without_data: false,
            avoided: 3,
            avoided_above_m: 0.0,
            backing_m_s: slow(),
            proximity_kind: 0,
            rangefinder_kind: 0,
            rangefinder_farthest_m: 40.0,
            rangefinder_nearest_m: 0.2,
            surface: SurfaceSettings::new(false),
            traffic: TrafficSettings {
                heard: true,
                enabled: true,
                action: Action::Warn,
                warns: false,
                recovery: Recovery::Remain,
                near_m: 500.0,
                near_vertical_m: 500.0,
                ahead_s: 60.0,
                warning_m: 500.0,
                warning_vertical_m: 500.0,
                warning_ahead_s: 60.0,
                least_height_m: 0.0,
            },
            remote_id: false,
            remote_id_to_arm: false,
        }
    }
}

impl SurroundingsSettings {
    /// The defaults, which differ by convention.
    pub fn new(ardupilot: bool) -> Self {
        let px4 = Self::default();
        if !ardupilot {
            return px4;
        }
        let traffic = TrafficSettings {
            enabled: false,
            warns: true,
            recovery: Recovery::Return,
            near_m: 100.0,
            near_vertical_m: 100.0,
            ahead_s: 30.0,
            warning_m: 300.0,
            warning_vertical_m: 300.0,
            warning_ahead_s: 30.0,
            ..px4.traffic
        };
        let surface = SurfaceSettings::new(true);
        Self {
            obstacle_distance_m: 2.0,
            obstacle_delay_s: 0.0,
            go_without_data: true,
            surface,
            traffic,
            ..px4
        }
    }
}
