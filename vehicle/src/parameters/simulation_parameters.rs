//! ArduPilot's names of what is simulated around the vehicle and in its instruments.

use libm::{atan2, cos, hypot, sin};

use super::ConductParameter;
use super::conduct_parameter::{bitmask, choice, chosen, real, switch, whole};
use crate::vehicle::{Conduct, WIND_FROM_DEG};
use crate::world::WindProfile;

/// The wind, which can be changed in flight. ArduPilot keeps it in its files; PX4 has no such parameters, and the vehicle none in its files
/// when it presents itself as PX4: the wind of a run is what its start says.
#[rustfmt::skip]
pub static WIND_PARAMETERS: &[ConductParameter] = &[
    chosen!("SIM_WIND_SPD", 0.0..=50.0, simulated.wind_m_s, 0.0, "m/s", "Mean speed of the wind"),
    chosen!("SIM_WIND_DIR", -360.0..=360.0, simulated.wind_from_deg, WIND_FROM_DEG, "deg", "Direction that the wind comes from"),
    chosen!("SIM_WIND_TURB", 0.0..=20.0, simulated.gusts_m_s, 0.0, "m/s", "Standard deviation of the gusts"),
];

/// The same wind by the names of PX4's own simulation (SIH): how fast the air comes from the north and from the east.
pub static PX4_WIND_PARAMETERS: &[ConductParameter] = &[
    ConductParameter {
        get: |conduct| come_from(conduct)[0],
        set: |conduct, north_m_s| blow_from(conduct, [north_m_s, come_from(conduct)[1]]),
        ..real!(
            "SIH_WIND_N",
            None,
            -50.0..=50.0,
            takeoff_height_m,
            "m/s",
            "Mean speed of the wind from the north"
        )
    },
    ConductParameter {
        get: |conduct| come_from(conduct)[1],
        set: |conduct, east_m_s| blow_from(conduct, [come_from(conduct)[0], east_m_s]),
        ..real!(
            "SIH_WIND_E",
            None,
            -50.0..=50.0,
            takeoff_height_m,
            "m/s",
            "Mean speed of the wind from the east"
        )
    },
];

/// How fast the wind comes from the north and from the east, m/s.
fn come_from(conduct: &Conduct) -> [f64; 2] {
    let (speed_m_s, from_rad) = (
        conduct.simulated.wind_m_s.unwrap_or(0.0),
        conduct.simulated.wind_from_deg.unwrap_or(WIND_FROM_DEG).to_radians(),
    );
    // What is left of rounding is no wind.
    let is_none = |share: f64| speed_m_s == 0.0 || share.abs() < 1e-12;
    [cos(from_rad), sin(from_rad)].map(|share| if is_none(share) { 0.0 } else { speed_m_s * share })
}

/// Lets it come from there; `false` if it is stronger than the wind may be.
fn blow_from(conduct: &mut Conduct, [north_m_s, east_m_s]: [f64; 2]) -> bool {
    let speed_m_s = hypot(north_m_s, east_m_s);
    if speed_m_s > STRONGEST_M_S {
        return false;
    }
    if speed_m_s > 0.0 {
        conduct.simulated.wind_from_deg = Some(atan2(east_m_s, north_m_s).to_degrees());
    }
    conduct.simulated.wind_m_s = Some(speed_m_s);
    true
}

/// Strongest mean wind, m/s.
const STRONGEST_M_S: f64 = 50.0;

/// Parameters of the simulation, which the vehicle has when it presents itself as ArduPilot.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static SIMULATION_PARAMETERS: &[ConductParameter] = &[
    real!("SIM_WIND_DIR_Z", None, -90.0..=90.0, simulated.wind_shape.upwards_deg, "deg", "How steeply the wind blows upwards"),
    real!("SIM_WIND_TC", None, 0.0..=600.0, simulated.wind_shape.change_s, "s", "Time constant with which a change of the wind takes effect"),
    choice!("SIM_WIND_T", WIND_PROFILES, simulated.wind_shape.profile, "How the wind grows with height"),
    real!("SIM_WIND_T_ALT", None, 1.0..=10_000.0, simulated.wind_shape.full_m, "m", "Height at which a wind that grows has its full speed"),
    real!("SIM_WIND_T_COEF", None, 0.0..=1.0, simulated.wind_shape.slope_per_s, "1/s", "How much slower a linear wind is per metre below SIM_WIND_T_ALT"),
    chosen!("SIM_BATT_VOLTAGE", 0.0..=100.0, simulated.battery_v, 12.6, "V", "Voltage at rest that the battery is charged to when this is set"),
    real!("SIM_BATT_CAP_AH", None, 0.01..=1000.0, battery_capacity_ah, "Ah", "Capacity of the battery; the same as BATT_CAPACITY").other(),
    bitmask!("SIM_ENGINE_FAIL", ROTORS, simulated.weak_rotors, whole_bits, f64::from, "Rotors that make SIM_ENGINE_MUL of their thrust, in the order of SERVO_OUTPUT_RAW"),
    real!("SIM_ENGINE_MUL", None, 0.0..=1.0, simulated.weak_share, "", "Share of the thrust that the rotors of SIM_ENGINE_FAIL make"),
    real!("SIM_SHOVE_X", None, -1000.0..=1000.0, simulated.pushes.shove.acceleration.x, "m/s^2", "Push, forwards"),
    real!("SIM_SHOVE_Y", None, -1000.0..=1000.0, simulated.pushes.shove.acceleration.y, "m/s^2", "Push, to the right"),
    real!("SIM_SHOVE_Z", None, -1000.0..=1000.0, simulated.pushes.shove.acceleration.z, "m/s^2", "Push, down"),
    whole!("SIM_SHOVE_TIME", 0..=600_000, simulated.pushes.shove.time_ms, u32, "Duration of the push (ms); setting it starts the push, and it returns to 0 at the end"),
    real!("SIM_TWIST_X", None, -1000.0..=1000.0, simulated.pushes.twist.acceleration.x, "rad/s^2", "Twist, about the roll axis"),
    real!("SIM_TWIST_Y", None, -1000.0..=1000.0, simulated.pushes.twist.acceleration.y, "rad/s^2", "Twist, about the pitch axis"),
    real!("SIM_TWIST_Z", None, -1000.0..=1000.0, simulated.pushes.twist.acceleration.z, "rad/s^2", "Twist, about the yaw axis"),
    whole!("SIM_TWIST_TIME", 0..=600_000, simulated.pushes.twist.time_ms, u32, "Duration of the twist (ms); setting it starts the twist, and it returns to 0 at the end"),
    whole!("SIM_ESC_ARM_RPM", 0..=10_000, takeoff_check.idling, u16, "Speed of armed, idling motors, as their telemetry reports it"),
    whole!("GPS1_TYPE", 0..=26, simulated.errors.switches.gps_kind, u8, "Kind of GPS receiver; 0: none, 14: fixes come by GPS_INPUT, anything else: the simulated one"),
    whole!("GPS_TYPE", 0..=26, simulated.errors.switches.gps_kind, u8, "Kind of GPS receiver; the same as GPS1_TYPE").other(),
    switch!("SIM_GPS1_ENABLE", simulated.errors.switches.gps, "Whether the GPS receiver works"),
    switch!("SIM_GPS_DISABLE", simulated.errors.switches.gps, "Whether the GPS receiver is silent; the opposite of SIM_GPS1_ENABLE", not).other(),
    whole!("SIM_GPS1_NUMSATS", 0..=40, simulated.errors.gps_satellites, u8, "Satellites that the receiver says it uses"),
    whole!("SIM_GPS_NUMSATS", 0..=40, simulated.errors.gps_satellites, u8, "Satellites that the receiver says it uses").other(),
    whole!("SIM_GPS1_FIXTYPE", 0..=6, simulated.errors.gps_fix_type, u8, "Kind of fix that the receiver tells: 0 none, 1 no fix, 2 two dimensions, 3 three, 4 differential, 5 RTK float, 6 RTK fixed; below 3 it has no place"),
    whole!("SIM_GPS1_HZ", 2..=50, simulated.errors.gps_rate_hz, u8, "Rate of GPS fixes, Hz"),
    whole!("SIM_GPS_HZ", 2..=50, simulated.errors.gps_rate_hz, u8, "Rate of GPS fixes, Hz; the same as SIM_GPS1_HZ").other(),
    whole!("SIM_GPS1_LAG_MS", 0..=300, simulated.errors.gps_latency_ms, u16, "Delay from a GPS fix to its message, ms; the estimator knows it"),
    whole!("SIM_GPS_LAG_MS", 0..=300, simulated.errors.gps_latency_ms, u16, "Delay from a GPS fix to its message, ms; the same as SIM_GPS1_LAG_MS").other(),
    real!("SIM_GPS1_NOISE", None, 0.0..=100.0, simulated.errors.gps_noise_m, "m", "Standard deviation of additional noise of GPS heights").also(&[("SIM_GPS_NOISE", 1.0)]),
    real!("SIM_GPS1_GLTCH_X", None, -1.0..=1.0, simulated.errors.gps_glitch.x, "deg", "Error of the GPS latitude").also(&[("SIM_GPS_GLITCH_X", 1.0)]),
    real!("SIM_GPS1_GLTCH_Y", None, -1.0..=1.0, simulated.errors.gps_glitch.y, "deg", "Error of the GPS longitude").also(&[("SIM_GPS_GLITCH_Y", 1.0)]),
    real!("SIM_GPS1_GLTCH_Z", None, -10_000.0..=10_000.0, simulated.errors.gps_glitch.z, "m", "Error of the GPS height, upwards").also(&[("SIM_GPS_GLITCH_Z", 1.0)]),
    switch!("SIM_GPS1_JAM", simulated.errors.gps_jammed, "Whether GPS is jammed: no fix for three seconds, then fixes that come and go and are wrong"),
    switch!("SIM_GPS_JAM", simulated.errors.gps_jammed, "Whether GPS is jammed; the same as SIM_GPS1_JAM").other(),
    real!("SIM_ACC1_RND", None, 0.0..=100.0, simulated.errors.accelerometer_noise_m_s2, "m/s^2", "Standard deviation of additional noise of the accelerometers").also(&[("SIM_ACC_RND", 1.0)]),
    real!("SIM_ACC1_BIAS_X", None, -20.0..=20.0, simulated.errors.accelerometer_bias_m_s2.x, "m/s^2", "Offset of the accelerometer, forwards"),
    real!("SIM_ACC1_BIAS_Y", None, -20.0..=20.0, simulated.errors.accelerometer_bias_m_s2.y, "m/s^2", "Offset of the accelerometer, to the right"),
    real!("SIM_ACC1_BIAS_Z", None, -20.0..=20.0, simulated.errors.accelerometer_bias_m_s2.z, "m/s^2", "Offset of the accelerometer, down"),
    real!("SIM_ACCEL1_FAIL", None, -100.0..=100.0, simulated.errors.accelerometer_reads_m_s2, "m/s^2", "What all accelerometers read instead of the truth; 0: the truth"),
    switch!("SIM_ACC_FAIL_MSK", simulated.errors.switches.accelerometer_off, "Whether the accelerometers are silent"),
    real!("SIM_GYR1_RND", None, 0.0..=1000.0, simulated.errors.gyroscope_noise_deg_s, "deg/s", "Standard deviation of additional noise of the gyroscopes").also(&[("SIM_GYR_RND", 1.0)]),
    real!("SIM_GYR1_BIAS_X", None, -5.0..=5.0, simulated.errors.gyroscope_bias_rad_s.x, "rad/s", "Offset of the roll gyroscope"),
    real!("SIM_GYR1_BIAS_Y", None, -5.0..=5.0, simulated.errors.gyroscope_bias_rad_s.y, "rad/s", "Offset of the pitch gyroscope"),
    real!("SIM_GYR1_BIAS_Z", None, -5.0..=5.0, simulated.errors.gyroscope_bias_rad_s.z, "rad/s", "Offset of the yaw gyroscope"),
    switch!("SIM_GYR_FAIL_MSK", simulated.errors.switches.gyroscope_off, "Whether the gyroscopes are silent"),
    whole!("SIM_BARO_COUNT", -1..=3, simulated.barometers, i8, "Barometers on the board, which all measure the same; with 0 or less the vehicle reports a configuration error after a reboot"),
    whole!("BARO_PROBE_EXT", 0..=16_383, simulated.outer_barometers, u32, "Types of external barometers to look for; if not 0, one is found, which measures the same"),
    real!("SIM_BARO_RND", None, 0.0..=100.0, simulated.errors.barometer_noise_m, "m", "Standard deviation of additional noise of the barometer"),
    real!("SIM_BARO_DRIFT", None, -100.0..=100.0, simulated.errors.barometer_drift_m_s, "m/s", "How fast the barometer's height drifts"),
    real!("SIM_BARO_GLITCH", None, -10_000.0..=10_000.0, simulated.errors.barometer_glitch_m, "m", "Error of the barometer's height"),
    switch!("SIM_BARO_DISABLE", simulated.errors.switches.barometer_off, "Whether the barometer is silent"),
    switch!("SIM_BARO_FREEZE", simulated.errors.switches.barometer_frozen, "Whether the barometer repeats itself"),
    real!("SIM_MAG_RND", None, 0.0..=10_000.0, simulated.errors.magnetometer_noise_mgauss, "mGauss", "Standard deviation of additional noise of the magnetometer"),
    real!("SIM_MAG1_OFS_X", None, -2000.0..=2000.0, simulated.errors.magnetometer_offset_mgauss.x, "mGauss", "Offset of the magnetometer, forwards"),
    real!("SIM_MAG1_OFS_Y", None, -2000.0..=2000.0, simulated.errors.magnetometer_offset_mgauss.y, "mGauss", "Offset of the magnetometer, to the right"),
    real!("SIM_MAG1_OFS_Z", None, -2000.0..=2000.0, simulated.errors.magnetometer_offset_mgauss.z, "mGauss", "Offset of the magnetometer, down"),
    switch!("SIM_MAG1_FAIL", simulated.errors.switches.magnetometer_off, "Whether the magnetometer is silent"),
];

const WIND_PROFILES: &[(WindProfile, i32, &str)] = &[
    (WindProfile::Even, 1, "The same at all heights"),
    (WindProfile::SquareRoot, 0, "With the square root of the height"),
    (WindProfile::Linear, 2, "Linearly, by SIM_WIND_T_COEF"),
];
const ROTORS: &[&str] = &["Rotor 1", "Rotor 2", "Rotor 3", "Rotor 4"];

fn whole_bits(value: f64) -> u32 {
    value as u32
}
