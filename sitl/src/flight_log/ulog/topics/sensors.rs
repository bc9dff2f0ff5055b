//! What the instruments show, and how good the estimate is.

use vehicle::estimation::gps::{HORIZONTAL_DILUTION, VERTICAL_DILUTION};

use super::super::row::Row;
use crate::flight_log::LogSource;

/// How often the inertial sensors are sampled, µs.
pub const IMU_US: u64 = 20_000;

/// PX4's numbers of the kinds of a fix.
const NO_FIX: u8 = 1;
const FIX_3D: u8 = 3;

pub fn gps_position(source: &LogSource<'_>, row: &mut Row) {
    let vehicle = source.vehicle;
    row.u64(vehicle.unix_start_us() + vehicle.time_us());
    let Some(fix) = source.fix() else {
        // A place and accuracies of zero would be the best of all.
        row.f64(0.0).f64(0.0).f64(0.0).f64(0.0).floats([f32::NAN; 6]).u8(NO_FIX).u8(0);
        return;
    };
    row.f64(fix.place.latitude_deg).f64(fix.place.longitude_deg);
    // The ellipsoid is the sea level.
    row.f64(fix.place.altitude_m).f64(fix.place.altitude_m);
    row.reals([fix.horizontal_accuracy_m, fix.vertical_accuracy_m]);
    row.reals([HORIZONTAL_DILUTION, VERTICAL_DILUTION]);
    row.reals([fix.speed_m_s]);
    row.f32((fix.course_deg as f32).to_radians()).u8(FIX_3D).u8(fix.satellites);
}

/// Both are told with the time that they are integrated over.
pub fn sensor_combined(source: &LogSource<'_>, row: &mut Row) {
    let inertial = source.vehicle.readings().inertial;
    row.reals(inertial.body_rate_rad_s.data.0[0]).u32(IMU_US as u32);
    row.reals(inertial.specific_force_m_s2.data.0[0]).u32(IMU_US as u32);
}

pub fn imu_status(source: &LogSource<'_>, row: &mut Row) {
    for times in source.clipped() {
        row.u32(times);
    }
    let level = source.vibration_m_s2().map(|axis| axis as f32);
    row.f32(level.iter().map(|axis| axis * axis).sum::<f32>().sqrt());
}

/// Bits of what holds.
fn bits<const N: usize>(set: [(bool, u16); N]) -> u16 {
    set.into_iter().map(|(set, bit)| u16::from(set) << bit).sum()
}

/// The checks are bits: velocity, horizontal position, height, three of the field, heading. So is what of the solution is
/// valid, with PX4's numbers, and health and timeouts: velocity, position, height.
pub fn estimator_status(source: &LogSource<'_>, row: &mut Row) {
    let (validity, estimate) = (source.vehicle.validity(), source.vehicle.estimate());
    let exact = source.test_ratios();
    let ratios = [exact.velocity, exact.horizontal_position, exact.height, exact.heading];
    let ratios = ratios.map(|ratio| ratio as f32);
    row.floats(ratios);
    row.reals([
        estimate.map_or(0.0, |estimate| estimate.horizontal_accuracy_m),
        estimate.map_or(0.0, |estimate| estimate.vertical_accuracy_m),
        0.0,
    ]);
    let [velocity, position, height, heading] = ratios.map(|ratio| ratio > 1.0);
    row.u16(bits([(velocity, 0), (position, 1), (height, 2), (heading, 6)]));
    let (horizontal, vertical) = (validity.horizontal_position, validity.vertical_position);
    row.u16(bits([
        (validity.tilt && validity.heading, 0),
        (validity.horizontal_velocity, 1),
        (validity.vertical_velocity, 2),
        // Relative and absolute.
        (horizontal, 3),
        (horizontal, 4),
        // Above the sea and, because it is flat, above the ground.
        (vertical, 5),
        (vertical, 6),
        // Predicted, relative and absolute.
        (horizontal, 8),
        (horizontal, 9),
        // The GPS receiver contradicts the estimate.
        (exact.horizontal_position > 1.0 || exact.velocity > 1.0, 10),
    ]));
    let velocities = validity.horizontal_velocity && validity.vertical_velocity;
    let health = bits([(velocities, 0), (horizontal, 1), (vertical, 2)]) as u8;
    row.u8(health).u8(!health & 0b111);
}

pub fn magnetometer(source: &LogSource<'_>, row: &mut Row) {
    row.reals(source.field_gauss());
}

/// The pressure is rounded in hPa, as clients are told it: readers compare the two.
pub fn air_data(source: &LogSource<'_>, row: &mut Row) {
    let (altitude_m, pressure_hpa) = source.barometer();
    row.reals([altitude_m]).f32(pressure_hpa * 100.0);
}
