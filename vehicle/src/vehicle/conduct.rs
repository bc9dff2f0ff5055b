//! How the vehicle conducts itself: its own parameters, beside those of the closed loop.

use serde::{Deserialize, Serialize};

use super::arming_settings::ArmingSettings;
use super::battery_pack::BatteryPack;
use super::crash_settings::CrashSettings;
use super::failsafe::FailsafeSettings;
use super::follow_settings::FollowSettings;
use super::ground_stations::GroundStations;
use super::heading_policy::HeadingPolicy;
use super::log_conduct::LogConduct;
use super::mission_heading::MissionHeading;
use super::orbit_request::OrbitSettings;
use super::precision_settings::PrecisionSettings;
use super::return_settings::ReturnSettings;
use super::simulated::Simulated;
use super::speed_settings::SpeedSettings;
use super::stick_settings::StickSettings;
use super::stream_rates::StreamRates;
use super::surroundings_settings::SurroundingsSettings;
use super::takeoff_check::TakeoffCheckSettings;
use super::throw::ThrowSettings;
use super::trail::TrailSettings;
use super::weathervane::WeathervaneSettings;
use crate::equipment::EquipmentSettings;
use crate::estimation::aiding::AidingSettings;
use crate::kept::KeptValues;
use crate::radio::RadioSettings;

/// Parameters of the vehicle's behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conduct {
    /// Height of a takeoff that names none, m.
    pub takeoff_height_m: f64,
    /// Height above the ground to which a takeoff by hand goes on by itself, m; 0: it does not (ArduPilot: PILOT_TKOFF_ALT).
    #[serde(default)]
    pub pilot_takeoff_m: f64,
    /// Set-points are lost when none has come for this long, s.
    pub set_point_timeout_s: f64,
    /// Height above home of the way home, m.
    pub return_height_m: f64,
    /// Waypoints that name no acceptance radius are passed within this one, m.
    pub acceptance_radius_m: f64,
    /// Nearer to home than this, m, a return lands without climbing.
    pub return_near_m: f64,
    /// Sink rate near the ground, m/s.
    pub land_speed_m_s: f64,
    /// Below this height, m, it sinks with that speed.
    #[serde(default = "two")]
    pub land_slow_below_m: f64,
    /// Sink rate farther up, m/s; 0: the limit.
    #[serde(default)]
    pub land_fast_m_s: f64,
    /// PX4's speeds beside those of automatic flight.
    #[serde(default)]
    pub speeds: SpeedSettings,
    /// Disarms this long after touch-down, s; not positive: never.
    pub disarm_after_landing_s: f64,
    /// Disarms when not taken off this long after arming, s; not positive: never.
    pub disarm_before_takeoff_s: f64,
    /// Horizontal speed of a full stick, m/s.
    pub stick_speed_m_s: f64,
    /// Climb rate of a full stick, m/s.
    pub stick_climb_m_s: f64,
    /// Sink rate of a full stick, m/s.
    pub stick_sink_m_s: f64,
    /// Sticks are lost when none has come for this long, s.
    pub stick_timeout_s: f64,
    /// Charge of the full battery, A·h.
    pub battery_capacity_ah: f64,
    /// Least remaining share of the battery to arm with.
    pub battery_to_arm: f64,
    /// Whether clients may break units.
    #[serde(default = "yes")]
    pub failure_injection: bool,
    /// What it does about obstacles, traffic and remote identification.
    #[serde(default)]
    pub surroundings: SurroundingsSettings,
    /// The way home beside its height.
    #[serde(default)]
    pub return_home: ReturnSettings,
    /// Where the nose points on a way that names no heading.
    #[serde(default)]
    pub heading_policy: HeadingPolicy,
    /// Orbits.
    #[serde(default)]
    pub orbit: OrbitSettings,
    /// ArduPilot's number of the mode at the start.
    #[serde(default = "loiter")]
    pub initial_mode: u8,
    /// Loops that PID_TUNING reports, as the sum of bits of ArduPilot's parameter.
    #[serde(default)]
    pub told_loops: u8,
    /// Options of ArduPilot's guided mode, as the parameter adds them up.
    #[serde(default = "thrust_as_thrust")]
    pub guided_options: u8,
    /// Options of its automatic mode.
    #[serde(default)]
    pub auto_options: u8,
    /// Which ground stations it listens to.
    #[serde(default)]
    pub ground_stations: GroundStations,
    /// How it turns into the wind.
    #[serde(default)]
    pub weathervane: WeathervaneSettings,
    /// Time that the zigzag mode waits where it has flown across to, s.
    #[serde(default)]
    pub zigzag_wait_s: f64,
    /// How a target is followed.
    #[serde(default)]
    pub follow: FollowSettings,
    /// The trail that leads back.
    #[serde(default)]
    pub trail: TrailSettings,
    /// Whether a mission that was left begins anew (ArduPilot: MIS_RESTART).
    #[serde(default)]
    pub mission_restarts: bool,
    /// How exactly a mission takes the headings that it asks for.
    #[serde(default)]
    pub mission_heading: MissionHeading,
    /// Options of missions, as ArduPilot's parameter adds them up (MIS_OPTIONS).
    #[serde(default)]
    pub mission_options: u8,
    /// What is checked before arming.
    #[serde(default)]
    pub arming: ArmingSettings,
    /// When a failsafe begins, and what it does.
    #[serde(default)]
    pub failsafe: FailsafeSettings,
    /// What is simulated around the vehicle.
    #[serde(default)]
    pub simulated: Simulated,
    /// What is kept for scripts and changes nothing.
    #[serde(default)]
    pub kept: KeptValues,
    /// How often groups of messages are sent.
    #[serde(default)]
    pub stream_rates: StreamRates,
    /// When it counts as crashed.
    #[serde(default)]
    pub crash: CrashSettings,
    /// What is logged, in ArduPilot's convention.
    #[serde(default)]
    pub log: LogConduct,
    /// How the sticks are flown.
    #[serde(default)]
    pub sticks: StickSettings,
    /// The pilot's radio.
    #[serde(default)]
    pub radio: RadioSettings,
    /// The throw mode.
    #[serde(default)]
    pub throw: ThrowSettings,
    /// What is looked at before a takeoff.
    #[serde(default)]
    pub takeoff_check: TakeoffCheckSettings,
    /// What it carries.
    #[serde(default)]
    pub equipment: EquipmentSettings,
    /// Landings at a target that is seen.
    #[serde(default)]
    pub precision: PrecisionSettings,
    /// What the estimator fuses.
    #[serde(default)]
    pub aiding: AidingSettings,
}

/// Records of before the first mode could be chosen begin in Loiter.
fn loiter() -> u8 {
    5
}

/// Records of before it could be chosen have this one.
fn two() -> f64 {
    2.0
}

/// Records of before there were faults have none.
fn yes() -> bool {
    true
}

/// Of the options of the guided mode: the thrust of an attitude is one, and no climb rate. Records of before there were climb rates
/// have it.
const THRUST_AS_THRUST: u8 = 8;

/// Of the options of the automatic mode.
const AUTO_ARMS: u8 = 1;
const AUTO_TAKES_OFF: u8 = 2;

fn thrust_as_thrust() -> u8 {
    THRUST_AS_THRUST
}

/// | parameter | default | reason |
/// | --- | --- | --- |
/// | takeoff height | 2.5 m | PX4's |
/// | set-point timeout | 1 s; ArduPilot 3 s | theirs |
/// | return height | 30 m (ArduPilot 15 m), near 5 m | theirs |
/// | way home | PX4: 30 m to wait at, a cone of 45°; ArduPilot: 5 s above home, a cone of slope 3 | theirs |
/// | heading on the way | to the next place, ArduPilot not on the way home | theirs |
/// | acceptance radius | 2 m | theirs, for copters |
/// | land speed | 0.7 m/s below 2 m; ArduPilot 0.5 m/s below 10 m | theirs, but that PX4 is slow below 5 m |
/// | disarm | 2 s after landing, 10 s before takeoff | PX4's |
/// | sticks | 5 m/s (ArduPilot 12.5), up 2, down 1.5 m/s (ArduPilot 2.5 both), 0.5 s (ArduPilot 1 s) | theirs, but that PX4's pilot is as fast as our limits leave room to brake |
/// | battery | 2.2 A·h of three cells | half an hour for 0.7 kg |
/// | failure injection | not allowed; ArduPilot: allowed | PX4's; ArduPilot has no such parameter |
impl Conduct {
    /// Sink rate of a full stick, m/s: ArduPilot's pilots come down as fast as they climb unless told otherwise.
    pub fn fastest_stick_sink_m_s(&self) -> f64 {
        if self.stick_sink_m_s > 0.0 { self.stick_sink_m_s } else { self.stick_climb_m_s }
    }

    /// Whether the thrust of attitudes is one in ArduPilot's guided mode, and no climb rate.
    pub fn thrust_is_asked_for(&self) -> bool {
        self.guided_options & THRUST_AS_THRUST != 0
    }

    /// Whether ArduPilot's automatic mode may be armed in.
    pub fn auto_allows_arming(&self) -> bool {
        self.auto_options & AUTO_ARMS != 0
    }

    /// Whether that mode takes off before anybody has raised the throttle.
    pub fn auto_takes_off_by_itself(&self) -> bool {
        self.auto_options & AUTO_TAKES_OFF != 0
    }

    /// The defaults, which differ by convention.
    pub fn new(ardupilot: bool) -> Self {
        Self {
            takeoff_height_m: 2.5,
            pilot_takeoff_m: 0.0,
            set_point_timeout_s: if ardupilot { 3.0 } else { 1.0 },
            return_height_m: if ardupilot { 15.0 } else { 30.0 },
            acceptance_radius_m: 2.0,
            return_near_m: 10.0,
            land_speed_m_s: if ardupilot { 0.5 } else { 0.7 },
            land_slow_below_m: if ardupilot { 10.0 } else { two() },
            land_fast_m_s: 0.0,
            speeds: SpeedSettings::default(),
            disarm_after_landing_s: 2.0,
            disarm_before_takeoff_s: 10.0,
            stick_speed_m_s: if ardupilot { 12.5 } else { 5.0 },
            stick_climb_m_s: if ardupilot { 2.5 } else { 2.0 },
            stick_sink_m_s: if ardupilot { 0.0 } else { 1.5 },
            stick_timeout_s: if ardupilot { 1.0 } else { 0.5 },
            battery_capacity_ah: BatteryPack::default().capacity_ah,
            battery_to_arm: 0.15,
            failure_injection: ardupilot,
            surroundings: SurroundingsSettings::new(ardupilot),
            return_home: ReturnSettings::new(ardupilot),
            heading_policy: if ardupilot {
                HeadingPolicy::NextPlaceExceptReturn
            } else {
                HeadingPolicy::NextPlace
            },
            orbit: OrbitSettings::default(),
            initial_mode: loiter(),
            told_loops: 0,
            guided_options: 0,
            auto_options: 0,
            ground_stations: GroundStations::default(),
            weathervane: WeathervaneSettings::default(),
            zigzag_wait_s: 0.0,
            follow: FollowSettings::default(),
            trail: TrailSettings::default(),
            mission_restarts: false,
            mission_heading: MissionHeading::default(),
            mission_options: 0,
            arming: ArmingSettings::default(),
            failsafe: FailsafeSettings::new(ardupilot),
            simulated: Simulated::default(),
            kept: KeptValues::default(),
            stream_rates: StreamRates::default(),
            crash: CrashSettings::default(),
            log: LogConduct::default(),
            sticks: StickSettings::new(ardupilot),
            radio: RadioSettings::new(ardupilot),
            throw: ThrowSettings::default(),
            takeoff_check: TakeoffCheckSettings::default(),
            equipment: EquipmentSettings::default(),
            precision: PrecisionSettings::default(),
            aiding: AidingSettings::default(),
        }
    }
}
