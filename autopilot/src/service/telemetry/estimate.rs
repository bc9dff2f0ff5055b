//! How good the estimate is.

use mavlink::dialects::ardupilotmega::{
    EKF_STATUS_REPORT_DATA, ESTIMATOR_STATUS_DATA, EkfStatusFlags, EstimatorStatusFlags, MavMessage,
};
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

/// EKF_STATUS_REPORT: the same in ArduPilot's terms. Its variances are innovations as shares of what is still accepted.
pub fn ekf_status_report(vehicle: &Vehicle) -> MavMessage {
    let validity = vehicle.validity();
    let ratios = vehicle.estimate().map_or_else(TestRatios::default, |estimate| estimate.test_ratios);
    let (horizontal, attitude) = (validity.horizontal_position, validity.tilt && validity.heading);
    let flags = [
        (attitude, EkfStatusFlags::EKF_ATTITUDE),
        (validity.horizontal_velocity, EkfStatusFlags::EKF_VELOCITY_HORIZ),
        (validity.vertical_velocity, EkfStatusFlags::EKF_VELOCITY_VERT),
        (horizontal, EkfStatusFlags::EKF_POS_HORIZ_REL),
        (horizontal, EkfStatusFlags::EKF_POS_HORIZ_ABS),
        (validity.vertical_position, EkfStatusFlags::EKF_POS_VERT_ABS),
        (validity.vertical_position, EkfStatusFlags::EKF_POS_VERT_AGL),
        (attitude && !horizontal, EkfStatusFlags::EKF_CONST_POS_MODE),
        (horizontal, EkfStatusFlags::EKF_PRED_POS_HORIZ_REL),
        (horizontal, EkfStatusFlags::EKF_PRED_POS_HORIZ_ABS),
        (!attitude, EkfStatusFlags::EKF_UNINITIALIZED),
    ];
    let flags = flags.into_iter().filter(|(set, _)| *set).map(|(_, flag)| flag).collect();
    MavMessage::EKF_STATUS_REPORT(EKF_STATUS_REPORT_DATA {
        velocity_variance: ratios.velocity as f32,
        pos_horiz_variance: ratios.horizontal_position as f32,
        pos_vert_variance: ratios.height as f32,
        compass_variance: ratios.heading as f32,
        flags,
        ..EKF_STATUS_REPORT_DATA::default()
    })
}
