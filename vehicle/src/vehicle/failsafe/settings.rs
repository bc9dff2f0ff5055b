//! When a failsafe begins, and what it does.

use serde::{Deserialize, Serialize};

use super::{Action, Cause};
use crate::fence::Inclusions;
use crate::radio::RadioLossAction;

/// Thresholds and actions; the parameters are PX4's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailsafeSettings {
    /// A ground station is lost when none has been heard for this long by the wall clock, s (COM_DL_LOSS_T).
    pub ground_station_timeout_s: f64,
    /// What is done then (NAV_DLL_ACT).
    pub ground_station_lost: Action,
    /// A number of FS_GCS_ENABLE, and one of FS_THR_ENABLE, that means nothing: the vehicle returns by the one and lands by the other, as
    /// ArduPilot does, and shows the number again.
    #[serde(default)]
    pub unknown_numbers: [Option<u8>; 2],
    /// What is done when set-points stop (COM_OBL_RC_ACT).
    pub set_points_lost: Action,
    /// Remaining shares of the battery below which it is low, critical and empty (BAT_LOW_THR, BAT_CRIT_THR, BAT_EMERGEN_THR).
    pub battery_low: f64,
    #[allow(missing_docs)] // With the one above.
    pub battery_critical: f64,
    #[allow(missing_docs)] // With the one above.
    pub battery_emergency: f64,
    /// What a weak battery does (COM_LOW_BAT_ACT; ArduPilot: BATT_FS_LOW_ACT, BATT_FS_CRT_ACT).
    #[serde(default)]
    pub battery: BatteryActions,
    /// Voltages and charges below which the battery is low or critical as well.
    #[serde(default)]
    pub battery_limits: BatteryLimits,
    /// What the fence does (GF_ACTION).
    pub fence: Action,
    /// Whether it acts as soon as the vehicle could not stop before the fence, not only beyond it (GF_PREDICT).
    #[serde(default = "yes")]
    pub fence_ahead: bool,
    /// Whether the fence is looked at (ArduPilot: FENCE_ENABLE; MAV_CMD_DO_FENCE_ENABLE).
    #[serde(default = "yes")]
    pub fence_enabled: bool,
    /// What of it (ArduPilot: FENCE_TYPE).
    #[serde(default)]
    pub fence_parts: FenceParts,
    /// How it is taken (ArduPilot: FENCE_OPTIONS).
    #[serde(default)]
    pub fence_options: FenceOptions,
    /// Farthest from home, m; 0: anywhere (GF_MAX_HOR_DIST).
    pub fence_radius_m: f64,
    /// Highest, m; 0: any height (GF_MAX_VER_DIST).
    pub fence_height_m: f64,
    /// What that is above (ArduPilot: FENCE_ALT_MAX_TP).
    #[serde(default)]
    pub fence_height_from: FenceDatum,
    /// Lowest, m (ArduPilot: FENCE_ALT_MIN).
    #[serde(default)]
    pub fence_floor_m: f64,
    /// What that is above (ArduPilot: FENCE_ALT_MIN_TP).
    #[serde(default)]
    pub fence_floor_from: FenceDatum,
    /// How far inside of its borders sticks stop, m (ArduPilot: FENCE_MARGIN).
    #[serde(default)]
    pub fence_margin_m: f64,
    /// How often the way to its borders is told within the margin, Hz; 0: once (ArduPilot: FENCE_NTF_FREQ).
    #[serde(default = "each_second")]
    pub fence_tells_hz: f64,
    /// Whether it is switched on by itself (ArduPilot: FENCE_AUTOENABLE).
    #[serde(default)]
    pub fence_starts: FenceStart,
    /// Strongest wind, m/s; not positive: any (COM_WIND_MAX).
    pub wind_m_s: f64,
    /// What is done in a stronger one (COM_WIND_MAX_ACT).
    pub high_wind: Action,
    /// What is done without an estimate of the place (COM_POSCTL_NAVL; ArduPilot: FS_EKF_ACTION).
    pub position_lost: Action,
    /// Whether that holds for modes that need no place, too.
    #[serde(default)]
    pub position_lost_everywhere: bool,
    /// What is done when the pilot is lost (NAV_RCL_ACT; ArduPilot: FS_THR_ENABLE).
    #[serde(default = "returns")]
    pub pilot_lost: RadioLossAction,
    /// Whether it lands on the others when a rotor is lost, stops them, too, or only warns and goes on in the mode that was, as if
    /// there were four (COM_ACT_FAIL_ACT).
    pub rotor_failure: Action,
}

/// So do records of before it could be chosen.
fn each_second() -> f64 {
    1.0
}

/// Records of before it could be chosen have none.
fn yes() -> bool {
    true
}

/// So do those of before there was a radio.
fn returns() -> RadioLossAction {
    RadioLossAction::Return
}

/// Parts of the fence that are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FenceParts {
    /// The greatest height.
    pub height: bool,
    /// The greatest distance.
    pub distance: bool,
    /// The zones.
    pub zones: bool,
    /// The least height.
    #[serde(default)]
    pub floor: bool,
}

/// ArduPilot's bits of the parts.
const HEIGHT: u8 = 1;
const DISTANCE: u8 = 2;
const ZONES: u8 = 4;
const FLOOR: u8 = 8;

impl FenceParts {
    /// As the bits of ArduPilot's FENCE_TYPE.
    pub fn bits(self) -> u8 {
        let of = |part: bool, bit: u8| if part { bit } else { 0 };
        of(self.height, HEIGHT) | of(self.distance, DISTANCE) | of(self.zones, ZONES) | of(self.floor, FLOOR)
    }

    /// From these bits.
    pub fn from_bits(bits: u8) -> Self {
        Self {
            height: bits & HEIGHT != 0,
            distance: bits & DISTANCE != 0,
            zones: bits & ZONES != 0,
            floor: bits & FLOOR != 0,
        }
    }
}

/// When the fence is switched on by itself, until the vehicle stands again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FenceStart {
    /// Not.
    #[default]
    Never,
    /// After a takeoff.
    Takeoff,
    /// After a takeoff; ArduPilot switches only the floor off for the landing.
    TakeoffExceptFloor,
    /// When it is armed.
    Armed,
}

/// What a height of the fence is above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FenceDatum {
    /// Home.
    #[default]
    Home,
    /// Mean sea level.
    SeaLevel,
    /// The origin of the local frame.
    Origin,
    /// The ground below the vehicle.
    Ground,
}

impl Default for FenceParts {
    fn default() -> Self {
        Self { height: true, distance: true, zones: true, floor: false }
    }
}

/// When a battery is low or critical beside its share of the charge (ArduPilot: BATT_LOW_VOLT, BATT_LOW_MAH and their like).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BatteryLimits {
    /// Voltages, V; 0: any.
    pub low_v: f64,
    #[allow(missing_docs)] // With the one above.
    pub critical_v: f64,
    /// Remaining charges, mA·h; 0: any.
    pub low_mah: f64,
    #[allow(missing_docs)] // With the one above.
    pub critical_mah: f64,
    /// A voltage counts when it has been low for so long, s.
    pub low_s: f64,
    /// Least voltage, V, and remaining charge, mA·h, to arm with; 0: any.
    #[serde(default)]
    pub to_arm_v: f64,
    #[allow(missing_docs)] // With the one above.
    #[serde(default)]
    pub to_arm_mah: f64,
    /// Whether the voltage is looked at without the drop that the current makes.
    pub at_rest: bool,
    /// Where the voltage is measured; −1: nowhere, the battery is missing (ArduPilot: BATT_VOLT_PIN).
    #[serde(default = "connected")]
    pub pin: i16,
}

/// Records of before it could be missing have the pin of ArduPilot's simulation.
fn connected() -> i16 {
    13
}

impl BatteryLimits {
    /// Whether no battery is measured.
    pub fn is_missing(&self) -> bool {
        self.pin < 0
    }
}

/// No voltage, as packs have one to twelve cells; ArduPilot has 10.5 V, for three of them.
impl Default for BatteryLimits {
    fn default() -> Self {
        Self {
            low_v: 0.0,
            critical_v: 0.0,
            low_mah: 0.0,
            critical_mah: 0.0,
            low_s: 10.0,
            to_arm_v: 0.0,
            to_arm_mah: 0.0,
            at_rest: false,
            pin: connected(),
        }
    }
}

/// How the fence is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FenceOptions {
    /// Whether no other mode can be chosen while the vehicle comes back from a breach.
    pub keeps_mode: bool,
    /// Whether it is enough to be in one of several zones to stay in; else the vehicle stays where all of them are.
    pub union: bool,
    /// Whether the way to the fence is told within its margin.
    #[serde(default)]
    pub tells_margin: bool,
}

/// PX4's.
impl Default for FenceOptions {
    fn default() -> Self {
        Self { keeps_mode: false, union: true, tells_margin: false }
    }
}

/// What a weak battery does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BatteryActions {
    /// When it is low.
    pub low: Action,
    /// When it is critical.
    pub critical: Action,
    /// When it is all but empty.
    pub empty: Action,
}

impl BatteryActions {
    /// Nothing but warnings.
    pub const WARN: Self = Self { low: Action::Warn, critical: Action::Warn, empty: Action::Warn };
    /// Lands when critical.
    pub const LAND: Self = Self { critical: Action::Land, empty: Action::Land, ..Self::WARN };
    /// Returns when critical, lands when empty.
    pub const RETURN_THEN_LAND: Self = Self { critical: Action::Return, ..Self::LAND };
}

impl Default for BatteryActions {
    fn default() -> Self {
        Self::RETURN_THEN_LAND
    }
}

/// PX4's values, but for three: a critical battery returns, an empty one lands, and a failed rotor lands (PX4 warns of all), and the fence
/// is seen ahead (PX4 acts beyond it, and so does ArduPilot's identity). A vehicle that is there to be tested shows what it can do.
impl Default for FailsafeSettings {
    fn default() -> Self {
        Self {
            ground_station_timeout_s: 10.0,
            ground_station_lost: Action::None,
            unknown_numbers: [None; 2],
            set_points_lost: Action::Hold,
            battery_low: 0.15,
            battery_critical: 0.07,
            battery_emergency: 0.05,
            battery: BatteryActions::default(),
            battery_limits: BatteryLimits::default(),
            fence: Action::Hold,
            fence_ahead: true,
            fence_enabled: true,
            fence_parts: FenceParts::default(),
            fence_options: FenceOptions::default(),
            fence_radius_m: 0.0,
            fence_height_m: 0.0,
            fence_height_from: FenceDatum::Home,
            fence_floor_m: -10.0,
            fence_floor_from: FenceDatum::Home,
            fence_margin_m: 0.0,
            fence_tells_hz: each_second(),
            fence_starts: FenceStart::Never,
            wind_m_s: -1.0,
            high_wind: Action::Warn,
            position_lost: Action::Land,
            position_lost_everywhere: false,
            pilot_lost: RadioLossAction::Return,
            rotor_failure: Action::Land,
        }
    }
}

impl FailsafeSettings {
    /// The defaults, which differ by convention: ArduPilot's fence is off; it returns beyond it and lets nobody choose another mode until it is
    /// back, stays where all inclusion zones are, misses its ground station after 5 s, and only warns of a weak battery.
    pub fn new(ardupilot: bool) -> Self {
        let px4 = Self::default();
        if !ardupilot {
            return px4;
        }
        Self {
            fence: Action::Return,
            fence_enabled: false,
            fence_ahead: false,
            fence_radius_m: 300.0,
            fence_height_m: 100.0,
            fence_margin_m: 2.0,
            fence_tells_hz: each_second(),
            fence_options: FenceOptions { keeps_mode: true, union: false, tells_margin: false },
            ground_station_timeout_s: 5.0,
            battery: BatteryActions::WARN,
            ..px4
        }
    }

    /// How several zones to stay in combine.
    pub fn fence_inclusions(&self) -> Inclusions {
        if self.fence_options.union { Inclusions::Any } else { Inclusions::All }
    }

    /// What is done for a cause.
    pub fn action(&self, cause: Cause) -> Action {
        match cause {
            Cause::RotorFailure => self.rotor_failure,
            Cause::PositionLost => self.position_lost,
            Cause::BatteryEmergency => self.battery.empty,
            Cause::BatteryCritical => self.battery.critical,
            Cause::BatteryLow => self.battery.low,
            Cause::Fence => self.fence,
            Cause::HighWind => self.high_wind,
            Cause::GroundStationLost => self.ground_station_lost,
            Cause::SetPointsLost => self.set_points_lost,
            Cause::PilotLost => Action::without_pilot(self.pilot_lost),
        }
    }
}
