//! How good the estimate is.

use mavlink::dialects::ardupilotmega::{ESTIMATOR_STATUS_DATA, EstimatorStatusFlags, MavMessage};
use vehicle::Vehicle;
use vehicle::estimation::TestRatios;

/// ESTIMATOR_STATUS: what of the estimate can be flown by. The truth can.
pub fn estimator_status(vehicle: &Vehicle) -> MavMessage {
    let validity = vehicle.validity();
    let estimate = vehicle.estimate();
    let ratios = estimate.map_or_else(TestRatios::default, |estimate| estimate.test_ratios);
    let horizontal = validity.horizontal_position;
    let flags = [
        (validity.tilt && validity.heading, EstimatorStatusFlags::ESTIMATOR_ATTITUDE),
        (validity.horizontal_velocity, EstimatorStatusFlags::ESTIMATOR_VELOCITY_HORIZ),
        (validity.vertical_velocity, EstimatorStatusFlags::ESTIMATOR_VELOCITY_VERT),
        (horizontal, EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_REL),
        (horizontal, EstimatorStatusFlags::ESTIMATOR_POS_HORIZ_ABS),
        (validity.vertical_position, EstimatorStatusFlags::ESTIMATOR_POS_VERT_ABS),
        // The ground is flat.
        (validity.vertical_position, EstimatorStatusFlags::ESTIMATOR_POS_VERT_AGL),
        (horizontal, EstimatorStatusFlags::ESTIMATOR_PRED_POS_HORIZ_REL),
        (horizontal, EstimatorStatusFlags::ESTIMATOR_PRED_POS_HORIZ_ABS),
        (
            ratios.horizontal_position > 1.0 || ratios.velocity > 1.0,
            EstimatorStatusFlags::ESTIMATOR_GPS_GLITCH,
        ),
    ];
    let flags = flags.into_iter().filter(|(set, _)| *set).map(|(_, flag)| flag).collect();
    MavMessage::ESTIMATOR_STATUS(ESTIMATOR_STATUS_DATA {
        time_usec: vehicle.time_us(),
        vel_ratio: ratios.velocity as f32,
        pos_horiz_ratio: ratios.horizontal_position as f32,
        pos_vert_ratio: ratios.height as f32,
        mag_ratio: ratios.heading as f32,
        pos_horiz_accuracy: estimate.map_or(0.0, |estimate| estimate.horizontal_accuracy_m as f32),
        pos_vert_accuracy: estimate.map_or(0.0, |estimate| estimate.vertical_accuracy_m as f32),
        flags,
        ..ESTIMATOR_STATUS_DATA::default()
    })
}
