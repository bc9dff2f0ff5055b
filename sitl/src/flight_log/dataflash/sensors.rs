//! What the instruments show.

use vehicle::Vehicle;
use vehicle::estimation::gps::{HORIZONTAL_DILUTION, VERTICAL_DILUTION};
use vehicle::surroundings::FARTHEST_RANGE_M;

use super::field::{Field, field, instance};
use crate::flight_log::LogSource;
use crate::flight_log::source::LoggedFix;

/// ArduPilot's number of no fix.
const NO_FIX: f64 = 1.0;
/// From 1970 to the begin of GPS time, with the leap seconds since then, s.
const GPS_EPOCH_S: u64 = 315_964_800 - 18;
pub const WEEK_MS: u64 = 7 * 24 * 3600 * 1000;

/// A value of the fix; 0 without one.
fn of_fix(source: &LogSource<'_>, value: fn(&LoggedFix) -> f64) -> f64 {
    source.fix().as_ref().map_or(0.0, value)
}

/// Time of GPS now, ms.
fn gps_ms(source: &LogSource<'_>) -> u64 {
    gps_ms_at(source.vehicle, source.vehicle.time_us())
}

/// Time of GPS at a time of the simulation, µs; ms.
pub fn gps_ms_at(vehicle: &Vehicle, time_us: u64) -> u64 {
    ((vehicle.unix_start_us() + time_us) / 1000).saturating_sub(GPS_EPOCH_S * 1000)
}

fn time_ms(source: &LogSource<'_>) -> f64 {
    (source.vehicle.time_us() / 1000) as f64
}

fn inertial(source: &LogSource<'_>) -> ([f64; 3], [f64; 3]) {
    let reading = source.vehicle.readings().inertial;
    (reading.body_rate_rad_s.into(), reading.specific_force_m_s2.into())
}

/// The receiver.
pub const GPS: &[Field] = &[
    instance("I"),
    field("Status", 'B', '-', '-', |source| source.fix().map_or(NO_FIX, |fix| f64::from(fix.kind))),
    field("GMS", 'I', 's', 'C', |source| (gps_ms(source) % WEEK_MS) as f64),
    field("GWk", 'H', '-', '-', |source| (gps_ms(source) / WEEK_MS) as f64),
    field("NSats", 'B', 'S', '0', |source| of_fix(source, |fix| f64::from(fix.satellites))),
    field("HDop", 'c', '-', 'B', |_| HORIZONTAL_DILUTION),
    field("Lat", 'L', 'D', 'G', |source| of_fix(source, |fix| fix.place.latitude_deg)),
    field("Lng", 'L', 'U', 'G', |source| of_fix(source, |fix| fix.place.longitude_deg)),
    field("Alt", 'e', 'm', 'B', |source| of_fix(source, |fix| fix.place.altitude_m)),
    field("Spd", 'f', 'n', '0', |source| of_fix(source, |fix| fix.speed_m_s)),
    field("GCrs", 'f', 'h', '0', |source| of_fix(source, |fix| fix.course_deg)),
    field("VZ", 'f', 'n', '0', |source| of_fix(source, |fix| fix.sink_m_s)),
    field("Yaw", 'f', 'h', '0', |_| 0.0),
    field("U", 'B', '-', '-', |_| 1.0),
];

/// How accurate the receiver is.
pub const GPA: &[Field] = &[
    instance("I"),
    field("VDop", 'C', '-', 'B', |_| VERTICAL_DILUTION),
    field("HAcc", 'C', 'm', 'B', |source| of_fix(source, |fix| fix.horizontal_accuracy_m)),
    field("VAcc", 'C', 'm', 'B', |source| of_fix(source, |fix| fix.vertical_accuracy_m)),
    field("SAcc", 'C', 'n', 'B', |source| of_fix(source, |fix| fix.velocity_accuracy_m_s)),
    field("YAcc", 'f', 'd', '0', |_| 0.0),
    field("VV", 'B', '-', '-', |source| if source.fix().is_some() { 1.0 } else { 0.0 }),
    field("SMS", 'I', 's', 'C', time_ms),
    field("Delta", 'H', 's', 'C', |_| 200.0),
];

/// The inertial unit.
pub const IMU: &[Field] = &[
    instance("I"),
    field("GyrX", 'f', 'E', '0', |source| inertial(source).0[0]),
    field("GyrY", 'f', 'E', '0', |source| inertial(source).0[1]),
    field("GyrZ", 'f', 'E', '0', |source| inertial(source).0[2]),
    field("AccX", 'f', 'o', '0', |source| inertial(source).1[0]),
    field("AccY", 'f', 'o', '0', |source| inertial(source).1[1]),
    field("AccZ", 'f', 'o', '0', |source| inertial(source).1[2]),
    field("EG", 'I', '-', '-', |_| 0.0),
    field("EA", 'I', '-', '-', |_| 0.0),
    field("T", 'f', 'O', '0', |_| 25.0),
    field("GH", 'B', '-', '-', |source| f64::from(u8::from(source.vehicle.instrument_health().gyroscope))),
    field("AH", 'B', '-', '-', |source| {
        f64::from(u8::from(source.vehicle.instrument_health().accelerometer))
    }),
    field("GHz", 'H', 'z', '0', |_| 1000.0),
    field("AHz", 'H', 'z', '0', |_| 1000.0),
];

/// Vibration.
pub const VIBE: &[Field] = &[
    instance("IMU"),
    field("VibeX", 'f', 'o', '0', |source| source.vibration_m_s2()[0]),
    field("VibeY", 'f', 'o', '0', |source| source.vibration_m_s2()[1]),
    field("VibeZ", 'f', 'o', '0', |source| source.vibration_m_s2()[2]),
    field("Clip", 'I', '-', '-', |source| f64::from(source.clipped().iter().sum::<u32>())),
];

/// The barometer.
pub const BARO: &[Field] = &[
    instance("I"),
    field("Alt", 'f', 'm', '0', |source| source.barometer().0 - source.vehicle.frame().origin().altitude_m),
    field("Press", 'f', 'P', '0', |source| f64::from(source.barometer().1) * 100.0),
    field("Temp", 'c', 'O', 'B', |_| 25.0),
    field("CRt", 'f', 'n', '0', |source| -source.vehicle.outputs().velocity_m_s.z),
    field("SMS", 'I', 's', 'C', time_ms),
    field("Offset", 'f', 'm', '0', |_| 0.0),
    field("GndTemp", 'f', 'O', '0', |_| 25.0),
    field("Health", 'B', '-', '-', |source| {
        f64::from(u8::from(source.vehicle.instrument_health().barometer))
    }),
];

/// The magnetometer, mGauss.
pub const MAG: &[Field] = &[
    instance("I"),
    field("MagX", 'h', 'G', 'C', |source| 1e3 * source.field_gauss()[0]),
    field("MagY", 'h', 'G', 'C', |source| 1e3 * source.field_gauss()[1]),
    field("MagZ", 'h', 'G', 'C', |source| 1e3 * source.field_gauss()[2]),
    field("OfsX", 'h', 'G', 'C', |_| 0.0),
    field("OfsY", 'h', 'G', 'C', |_| 0.0),
    field("OfsZ", 'h', 'G', 'C', |_| 0.0),
    field("MOX", 'h', 'G', 'C', |_| 0.0),
    field("MOY", 'h', 'G', 'C', |_| 0.0),
    field("MOZ", 'h', 'G', 'C', |_| 0.0),
    field("Health", 'B', '-', '-', |source| {
        f64::from(u8::from(source.vehicle.instrument_health().magnetometer))
    }),
    field("S", 'I', 's', 'F', |source| source.vehicle.time_us() as f64),
];

/// The downward rangefinder: 25 is down, 4 is a good range, 3 is one that is too far.
pub const RFND: &[Field] = &[
    instance("Instance"),
    field("Dist", 'f', 'm', '0', |source| source.vehicle.obstacles().below_m().unwrap_or(0.0)),
    field(
        "Stat",
        'B',
        '-',
        '-',
        |source| if source.vehicle.obstacles().below_m().is_some() { 4.0 } else { 3.0 },
    ),
    field("Orient", 'B', '-', '-', |_| 25.0),
    field("Quality", 'b', '%', '0', |_| -1.0),
];

/// From the vehicle to the target of a landing, NED, m.
fn way_to_target_m(source: &LogSource<'_>, axis: usize) -> f64 {
    let target_m = source.vehicle.precision_landing().target_m();
    let way_m = target_m.map(|target_m| target_m - source.vehicle.outputs().position_m);
    way_m.and_then(|way_m| way_m.get(axis).copied()).unwrap_or(0.0)
}

/// The target of a landing.
pub const PL: &[Field] = &[
    field("Heal", 'B', '-', '-', |_| 1.0),
    field("TAcq", 'B', '-', '-', |source| {
        f64::from(u8::from(source.vehicle.precision_landing().target_m().is_some()))
    }),
    field("pX", 'f', 'm', '0', |source| way_to_target_m(source, 0)),
    field("pY", 'f', 'm', '0', |source| way_to_target_m(source, 1)),
    field("vX", 'f', 'n', '0', |source| -source.vehicle.outputs().velocity_m_s.x),
    field("vY", 'f', 'n', '0', |source| -source.vehicle.outputs().velocity_m_s.y),
    field("LastMeasMS", 'I', 's', 'C', |source| {
        source.vehicle.precision_landing().seen_us().map_or(0.0, |seen_us| (seen_us / 1000) as f64)
    }),
];

/// ArduPilot's number of the layer around the horizon, of its five by elevation.
const LEVEL: f64 = 2.0;
/// ArduPilot's number of a proximity sensor that works.
const WORKS: f64 = 2.0;

/// The nearest thing in an eighth of the turn, the first of them around the nose; m. Where nothing is in range, that range.
fn nearest_m(source: &LogSource<'_>, eighth: usize) -> f64 {
    let is_there = |angle_deg: f64| ((angle_deg + 22.5) / 45.0) as usize % 8 == eighth;
    let there = source.seen_around().filter(|(angle_deg, _)| is_there(*angle_deg));
    there.map(|(_, range_m)| range_m).fold(FARTHEST_RANGE_M, f64::min)
}

/// The nearest thing around: its direction from the nose, degrees, and how far it is, m. Zeros without any.
fn nearest_around(source: &LogSource<'_>) -> (f64, f64) {
    source.seen_around().min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or_default()
}

/// Distances around.
const AROUND: [Field; 8] = [
    field("D0", 'f', 'm', '0', |source| nearest_m(source, 0)),
    field("D45", 'f', 'm', '0', |source| nearest_m(source, 1)),
    field("D90", 'f', 'm', '0', |source| nearest_m(source, 2)),
    field("D135", 'f', 'm', '0', |source| nearest_m(source, 3)),
    field("D180", 'f', 'm', '0', |source| nearest_m(source, 4)),
    field("D225", 'f', 'm', '0', |source| nearest_m(source, 5)),
    field("D270", 'f', 'm', '0', |source| nearest_m(source, 6)),
    field("D315", 'f', 'm', '0', |source| nearest_m(source, 7)),
];

/// The proximity sensor.
pub const PRX: &[Field] = &[
    field("Layer", 'B', '#', '-', |_| LEVEL),
    field("He", 'B', '-', '-', |_| WORKS),
    AROUND[0],
    AROUND[1],
    AROUND[2],
    AROUND[3],
    AROUND[4],
    AROUND[5],
    AROUND[6],
    AROUND[7],
    field("DUp", 'f', 'm', '0', |_| 0.0),
    field("CAn", 'f', 'h', '0', |source| nearest_around(source).0),
    field("CDis", 'f', 'm', '0', |source| nearest_around(source).1),
];

/// The same before ArduPilot's filter. There is none here.
pub const PRXR: &[Field] = &[
    field("Layer", 'B', '#', '-', |_| LEVEL),
    AROUND[0],
    AROUND[1],
    AROUND[2],
    AROUND[3],
    AROUND[4],
    AROUND[5],
    AROUND[6],
    AROUND[7],
];
