//! What only PX4 has, or what ArduPilot has with other numbers.

use core::convert::identity;

use super::ConductParameter;
use super::conduct_parameter::{bitmask, choice, real, switch, whole};
use super::conduct_parameters::FENCE_ACTIONS;
use crate::estimation::MagnetometerUse;
use crate::estimation::aiding::HeightReference;
use crate::vehicle::{Action, BatteryActions};

/// Parameters that are there unless the vehicle presents itself as ArduPilot.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static PX4_PARAMETERS: &[ConductParameter] = &[
    choice!("NAV_DLL_ACT", GROUND_STATION_ACTIONS, failsafe.ground_station_lost, "Action when the ground station is lost"),
    choice!("COM_LOW_BAT_ACT", BATTERY_POLICIES, failsafe.battery, "Action when the battery is critical; 3 returns, then lands when the battery is almost empty"),
    bitmask!("EKF2_GPS_CTRL", GPS_PARTS, simulated.errors.switches.gps_control, whole_bits, f64::from, "What of GPS is used; without the first bit nothing"),
    bitmask!("EKF2_EV_CTRL", VISION_PARTS, aiding.px4.control, identity, identity, "What of external vision is fused (VISION_POSITION_ESTIMATE, ODOMETRY)"),
    choice!("EKF2_HGT_REF", HEIGHT_REFERENCES, aiding.px4.height_reference, "What heights refer to"),
    real!("EKF2_EVP_NOISE", None, 0.01..=5.0, aiding.px4.position_noise_m, "m", "Least standard deviation of positions of external vision"),
    real!("EKF2_EVV_NOISE", None, 0.01..=5.0, aiding.px4.velocity_noise_m_s, "m/s", "Least standard deviation of velocities of external vision"),
    real!("EKF2_EVA_NOISE", None, 0.05..=5.0, aiding.px4.heading_noise_rad, "rad", "Least standard deviation of headings of external vision"),
    switch!("EKF2_EV_NOISE_MD", aiding.px4.ignores_told_noise, "Ignore the covariances of external vision"),
    real!("EKF2_EVP_GATE", None, 1.0..=50.0, aiding.px4.position_gate, "", "How many standard deviations a position of external vision may be off"),
    real!("EKF2_EVV_GATE", None, 1.0..=50.0, aiding.px4.velocity_gate, "", "How many standard deviations a velocity of external vision may be off"),
    real!("EKF2_EV_DELAY", None, 0.0..=300.0, aiding.px4.delay_ms, "ms", "Time from an estimate of external vision to its message"),
    real!("EKF2_EV_POS_X", None, -10.0..=10.0, aiding.px4.place.x, "m", "Place that external vision tells, forwards of the inertial unit"),
    real!("EKF2_EV_POS_Y", None, -10.0..=10.0, aiding.px4.place.y, "m", "Place that external vision tells, to the right of it"),
    real!("EKF2_EV_POS_Z", None, -10.0..=10.0, aiding.px4.place.z, "m", "Place that external vision tells, below it"),
    whole!("EKF2_EV_QMIN", 0..=100, aiding.px4.least_quality, i8, "Least quality of ODOMETRY that is fused, %; 0: any"),
    switch!("EKF2_BARO_CTRL", simulated.errors.switches.barometer_control, "Use of the barometer"),
    choice!("EKF2_MAG_TYPE", MAGNETOMETER_USES, simulated.errors.switches.magnetometer, "Use of the magnetometer"),
    choice!("COM_POSCTL_NAVL", POSITION_ACTIONS, failsafe.position_lost, "Action when the position estimate is lost"),
    real!("GF_MAX_HOR_DIST", None, 0.0..=100_000.0, failsafe.fence_radius_m, "m", "Radius of the fence around home; 0 disables it"),
    real!("GF_MAX_VER_DIST", None, 0.0..=10_000.0, failsafe.fence_height_m, "m", "Height of the fence above home; 0 disables it"),
    choice!("GF_ACTION", FENCE_ACTIONS, failsafe.fence, "Action at the fence"),
    real!("MPC_TKO_SPEED", None, 0.0..=5.0, speeds.takeoff_m_s, "m/s", "Climb rate of a takeoff below MPC_LAND_ALT1"),
    real!("MPC_LAND_ALT1", None, 0.0..=122.0, speeds.slow_below_m, "m", "Height above the ground below which a landing slows down and a takeoff climbs with MPC_TKO_SPEED"),
    real!("MPC_LAND_ALT3", None, 0.0..=122.0, speeds.crawl_below_m, "m", "Height that a rangefinder shows below which a landing sinks with MPC_LAND_CRWL"),
    real!("MPC_LAND_CRWL", None, 0.1..=10.0, speeds.crawl_m_s, "m/s", "Sink rate of a landing below MPC_LAND_ALT3"),
    real!("MIS_YAW_ERR", None, 0.0..=90.0, mission_heading.error_rad, DEGREES, "deg", "Largest error of the heading with which a mission leaves a waypoint that asks for one"),
    real!("MIS_YAW_TMT", None, -1.0..=20.0, mission_heading.timeout_s, "s", "Positive: a mission waits for no heading, as PX4's multicopters do then"),
    real!("FD_FAIL_R", None, 0.0..=180.0, crash.roll_rad, DEGREES, "deg", "Roll that counts as a failure; 0 disables it"),
    real!("FD_FAIL_P", None, 0.0..=180.0, crash.pitch_rad, DEGREES, "deg", "Pitch that counts as a failure; 0 disables it"),
    real!("FD_FAIL_R_TTRI", None, 0.02..=5.0, crash.roll_s, "s", "Time that the roll must last to count as a failure"),
    real!("FD_FAIL_P_TTRI", None, 0.02..=5.0, crash.pitch_s, "s", "Time that the pitch must last to count as a failure"),
    real!("COM_LKDOWN_TKO", None, -1.0..=5.0, crash.lockdown_s, "s", "Time from arming in which a failure stops the rotors"),
    whole!("CBRK_FLIGHTTERM", 0..=121_212, crash.circuit_breaker, u32, "Circuit breaker of flight termination; 121212: a failure in flight is only reported"),
];

const POSITION_ACTIONS: &[(Action, i32, &str)] =
    &[(Action::Warn, 0, "Warn"), (Action::Land, 1, "Land"), (Action::Terminate, 2, "Terminate")];
/// Of a radian.
const DEGREES: f64 = 180.0 / core::f64::consts::PI;
const GPS_PARTS: &[&str] = &["Longitude and latitude", "Altitude", "Velocity", "Heading of two antennas"];
const MAGNETOMETER_USES: &[(MagnetometerUse, i32, &str)] = &[
    (MagnetometerUse::Automatic, 0, "Automatic"),
    (MagnetometerUse::Heading, 1, "Heading; here as automatic"),
    (MagnetometerUse::None, 5, "None"),
    (MagnetometerUse::AtStart, 6, "At the start; here as automatic"),
];

const VISION_PARTS: &[&str] = &["Horizontal position", "Vertical position", "Velocity", "Heading"];
const HEIGHT_REFERENCES: &[(HeightReference, i32, &str)] = &[
    (HeightReference::Gps, 1, "GPS; here with the barometer"),
    (HeightReference::Barometer, 0, "Barometer; here as GPS"),
    (HeightReference::Range, 2, "Range sensor; here as GPS"),
    (HeightReference::Vision, 3, "External vision"),
];

fn whole_bits(value: f64) -> u32 {
    value as u32
}

const GROUND_STATION_ACTIONS: &[(Action, i32, &str)] = &[
    (Action::None, 0, "Nothing"),
    (Action::Hold, 1, "Hold"),
    (Action::Return, 2, "Return"),
    (Action::Land, 3, "Land"),
    (Action::Terminate, 5, "Terminate"),
    (Action::Disarm, 6, "Disarm"),
];
const BATTERY_POLICIES: &[(BatteryActions, i32, &str)] = &[
    (BatteryActions::WARN, 0, "Warn"),
    (BatteryActions::LAND, 2, "Land"),
    (BatteryActions::RETURN_THEN_LAND, 3, "Return, then land"),
];
