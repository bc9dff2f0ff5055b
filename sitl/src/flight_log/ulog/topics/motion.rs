//! Attitude, position and motion: believed, true and asked for.

use quadrotor::Outputs;
use vehicle::SteeringKind;
use vehicle::estimation::Validity;

use super::super::row::Row;
use crate::flight_log::LogSource;

/// Quaternion, FRD into NED.
pub fn attitude(source: &LogSource<'_>, row: &mut Row) {
    row.reals(source.vehicle.outputs().quaternion);
}

pub fn true_attitude(source: &LogSource<'_>, row: &mut Row) {
    row.reals(source.vehicle.truth().quaternion);
}

/// The thrust is a share of the strongest one, along the downward axis of the body.
pub fn attitude_setpoint(source: &LogSource<'_>, row: &mut Row) {
    let tracked = source.vehicle.tracked_attitude();
    let [i, j, k, w] = tracked.attitude.coords.data.0[0];
    row.reals([w, i, j, k]).reals([tracked.body_rate_rad_s.z, 0.0, 0.0, -tracked.thrust]);
}

pub fn angular_velocity(source: &LogSource<'_>, row: &mut Row) {
    row.reals(source.vehicle.outputs().body_rate_rad_s.data.0[0]);
}

pub fn true_angular_velocity(source: &LogSource<'_>, row: &mut Row) {
    row.reals(source.vehicle.truth().body_rate_rad_s.data.0[0]);
}

pub fn local_position(source: &LogSource<'_>, row: &mut Row) {
    position_row(source, row, &source.vehicle.validity(), source.vehicle.outputs());
}

pub fn true_local_position(source: &LogSource<'_>, row: &mut Row) {
    position_row(source, row, &Validity::ALL, source.vehicle.truth());
}

/// Validity, then the motion, then the origin and the height above ground.
fn position_row(source: &LogSource<'_>, row: &mut Row, validity: &Validity, motion: &Outputs) {
    let origin = source.vehicle.frame().origin();
    let (horizontal, vertical) = (validity.horizontal_position, validity.vertical_position);
    row.bool(horizontal).bool(vertical);
    row.bool(validity.horizontal_velocity).bool(validity.vertical_velocity);
    row.reals(motion.position_m.data.0[0]).reals(motion.velocity_m_s.data.0[0]);
    row.reals([motion.attitude_rad.z]).bool(horizontal).bool(vertical);
    row.f64(origin.latitude_deg).f64(origin.longitude_deg).f32(origin.altitude_m as f32);
    row.reals([-motion.position_m.z]).bool(vertical);
}

/// NaN while the vehicle is not steered by position.
pub fn local_position_setpoint(source: &LogSource<'_>, row: &mut Row) {
    let vehicle = source.vehicle;
    let reference = &vehicle.outputs().setpoint;
    if vehicle.steering_kind() != SteeringKind::Position {
        row.floats([f32::NAN; 14]);
        return;
    }
    row.reals(reference.position_m.data.0[0]).reals(reference.velocity_m_s.data.0[0]);
    row.reals(reference.acceleration_m_s2.data.0[0]);
    row.reals([0.0, 0.0, -vehicle.outputs().thrust_n / source.strongest_n()]);
    row.reals([reference.yaw_rad, reference.yaw_rate_rad_s]);
}

pub fn global_position(source: &LogSource<'_>, row: &mut Row) {
    let place = source.place(source.vehicle.outputs());
    row.f64(place.latitude_deg).f64(place.longitude_deg).reals([place.altitude_m]);
}

pub fn true_global_position(source: &LogSource<'_>, row: &mut Row) {
    let place = source.vehicle.frame().to_geodetic(&source.vehicle.truth().position_m);
    row.f64(place.latitude_deg).f64(place.longitude_deg).reals([place.altitude_m]);
}
