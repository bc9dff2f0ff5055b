//! MAVLink names of the closed loop's parameters, with those that earlier versions had.
//!
//! A name has at most 16 characters and begins with its group, by which ground stations sort: `FRAME`, `ROTOR`, `CTRL`, `ALT`,
//! `POS` and `ATT` for the three controllers, `LIM`, `SENS`. Behind the group come whole words in the order in which they are
//! read aloud (`ATT_Q_PITCH_RATE`). Q and R are the weights of errors and of increments; axes go by their words (pitch, north).

/// Names of one parameter of the closed loop.
#[derive(Clone, Copy, Debug)]
pub struct LoopName {
    /// Public name in the closed loop.
    pub dotted: &'static str,
    /// MAVLink name.
    pub id: &'static str,
    /// Earlier MAVLink name, still accepted.
    pub former: Option<&'static str>,
}

const fn renamed(dotted: &'static str, id: &'static str, former: &'static str) -> LoopName {
    LoopName { dotted, id, former: Some(former) }
}

const fn kept(dotted: &'static str, id: &'static str) -> LoopName {
    LoopName { dotted, id, former: None }
}

/// All that have a MAVLink name.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static LOOP_NAMES: &[LoopName] = &[
    renamed("airframe.mass", "FRAME_MASS", "AF_MASS"),
    renamed("airframe.arm_length", "FRAME_ARM_LENGTH", "AF_ARM"),
    renamed("airframe.inertia.x", "FRAME_INERTIA_X", "AF_J_X"),
    renamed("airframe.inertia.y", "FRAME_INERTIA_Y", "AF_J_Y"),
    renamed("airframe.inertia.z", "FRAME_INERTIA_Z", "AF_J_Z"),
    renamed("airframe.drag.x", "FRAME_DRAG_X", "AF_DRAG_X"),
    renamed("airframe.drag.y", "FRAME_DRAG_Y", "AF_DRAG_Y"),
    renamed("airframe.drag.z", "FRAME_DRAG_Z", "AF_DRAG_Z"),
    renamed("airframe.rotor.thrust_coefficient", "ROTOR_THRUST_K", "AF_ROT_K1"),
    renamed("airframe.rotor.torque_coefficient", "ROTOR_TORQUE_K", "AF_ROT_K2"),
    renamed("airframe.rotor.speed_min", "ROTOR_SPEED_MIN", "AF_ROT_MIN"),
    renamed("airframe.rotor.speed_max", "ROTOR_SPEED_MAX", "AF_ROT_MAX"),
    renamed("airframe.rotor.time_constant", "ROTOR_TIME_CONST", "AF_ROT_TAU"),
    renamed("controller.kind", "CTRL_KIND", "C_KIND"),
    renamed("controller.governor", "CTRL_GOVERNOR", "C_GOVERNOR"),
    renamed("controller.mass_factor", "CTRL_MASS_FACTOR", "C_MASSF"),
    renamed("controller.altitude.sample_time", "ALT_SAMPLE_TIME", "C_ALT_DT"),
    renamed("controller.altitude.terms", "ALT_TERMS", "C_ALT_N"),
    renamed("controller.altitude.scale", "ALT_SCALE", "C_ALT_A"),
    renamed("controller.altitude.prediction_horizon", "ALT_PRED_HORIZON", "C_ALT_NP"),
    renamed("controller.altitude.control_horizon", "ALT_CTRL_HORIZON", "C_ALT_CNTRL_HRZN"),
    renamed("controller.altitude.alpha", "ALT_ALPHA", "C_ALT_ALPHA"),
    renamed("controller.altitude.lambda", "ALT_LAMBDA", "C_ALT_LAM"),
    renamed("controller.altitude.output_weight", "ALT_Q", "C_ALT_Q"),
    renamed("controller.altitude.rate_weight", "ALT_Q_RATE", "C_ALT_QD"),
    renamed("controller.altitude.increment_weight", "ALT_R", "C_ALT_R"),
    renamed("controller.position.sample_time", "POS_SAMPLE_TIME", "C_POS_DT"),
    renamed("controller.position.terms", "POS_TERMS", "C_POS_N"),
    renamed("controller.position.scale", "POS_SCALE", "C_POS_A"),
    renamed("controller.position.prediction_horizon", "POS_PRED_HORIZON", "C_POS_NP"),
    renamed("controller.position.control_horizon", "POS_CTRL_HORIZON", "C_PS_CNTRL_HRZN"),
    renamed("controller.position.alpha", "POS_ALPHA", "C_POS_ALPHA"),
    renamed("controller.position.lambda", "POS_LAMBDA", "C_POS_LAM"),
    renamed("controller.position.output_weight.x", "POS_Q_NORTH", "C_POS_Q_X"),
    renamed("controller.position.output_weight.y", "POS_Q_EAST", "C_POS_Q_Y"),
    renamed("controller.position.rate_weight.x", "POS_Q_NORTH_RATE", "C_POS_QD_X"),
    renamed("controller.position.rate_weight.y", "POS_Q_EAST_RATE", "C_POS_QD_Y"),
    renamed("controller.position.increment_weight.theta", "POS_R_PITCH", "C_POS_R_THE"),
    renamed("controller.position.increment_weight.phi", "POS_R_ROLL", "C_POS_R_PHI"),
    renamed("controller.attitude.sample_time", "ATT_SAMPLE_TIME", "C_ATT_DT"),
    renamed("controller.attitude.terms", "ATT_TERMS", "C_ATT_N"),
    renamed("controller.attitude.scale", "ATT_SCALE", "C_ATT_A"),
    renamed("controller.attitude.prediction_horizon", "ATT_PRED_HORIZON", "C_ATT_NP"),
    renamed("controller.attitude.control_horizon", "ATT_CTRL_HORIZON", "C_ATT_CNTRL_HRZN"),
    renamed("controller.attitude.alpha", "ATT_ALPHA", "C_ATT_ALPHA"),
    renamed("controller.attitude.lambda", "ATT_LAMBDA", "C_ATT_LAM"),
    renamed("controller.attitude.output_weight.phi", "ATT_Q_ROLL", "C_ATT_Q_PHI"),
    renamed("controller.attitude.output_weight.theta", "ATT_Q_PITCH", "C_ATT_Q_THE"),
    renamed("controller.attitude.output_weight.psi", "ATT_Q_YAW", "C_ATT_Q_PSI"),
    renamed("controller.attitude.rate_weight.phi", "ATT_Q_ROLL_RATE", "C_ATT_QD_PHI"),
    renamed("controller.attitude.rate_weight.theta", "ATT_Q_PITCH_RATE", "C_ATT_QD_THE"),
    renamed("controller.attitude.rate_weight.psi", "ATT_Q_YAW_RATE", "C_ATT_QD_PSI"),
    renamed("controller.attitude.increment_weight.phi", "ATT_R_ROLL", "C_ATT_R_PHI"),
    renamed("controller.attitude.increment_weight.theta", "ATT_R_PITCH", "C_ATT_R_THE"),
    renamed("controller.attitude.increment_weight.psi", "ATT_R_YAW", "C_ATT_R_PSI"),
    kept("limits.tilt", "LIM_TILT"),
    renamed("limits.tilt_rate", "LIM_TILT_RATE", "LIM_TILT_R"),
    renamed("limits.tilt_acceleration", "LIM_TILT_ACCEL", "LIM_TILT_A"),
    kept("limits.thrust.min", "LIM_THRUST_MIN"),
    kept("limits.thrust.max", "LIM_THRUST_MAX"),
    renamed("limits.speed.horizontal", "LIM_SPEED_HORIZ", "LIM_SPEED_H"),
    kept("limits.speed.up", "LIM_SPEED_UP"),
    kept("limits.speed.down", "LIM_SPEED_DOWN"),
    renamed("limits.acceleration.horizontal", "LIM_ACCEL_HORIZ", "LIM_ACC_H"),
    renamed("limits.acceleration.vertical", "LIM_ACCEL_VERT", "LIM_ACC_V"),
    renamed("limits.jerk.horizontal", "LIM_JERK_HORIZ", "LIM_JERK_H"),
    renamed("limits.jerk.vertical", "LIM_JERK_VERT", "LIM_JERK_V"),
    renamed("limits.yaw_rate", "LIM_YAW_RATE", "LIM_YAW_R"),
    renamed("limits.yaw_acceleration", "LIM_YAW_ACCEL", "LIM_YAW_A"),
    renamed("limits.yaw_jerk", "LIM_YAW_JERK", "LIM_YAW_J"),
    renamed("sensor.output_feedback", "SENS_KALMAN", "SNSR_OTPT_FDBCK"),
    renamed("sensor.position_noise", "SENS_POS_NOISE", "SNSR_PSTN_NS"),
    renamed("sensor.velocity_noise", "SENS_VEL_NOISE", "SNSR_VLCTY_NS"),
    renamed("sensor.attitude_noise", "SENS_ATT_NOISE", "SNSR_ATTTD_NS"),
    renamed("sensor.body_rate_noise", "SENS_RATE_NOISE", "SNSR_BDY_RT_NS"),
    renamed("sensor.seed", "SENS_SEED", "SENSOR_SEED"),
    // Newer than version 0.1.
    kept("controller.model", "CTRL_MODEL"),
    kept("controller.learning", "CTRL_LEARNING"),
    kept("controller.altitude.damping_weight", "ALT_Q_DAMP"),
    kept("controller.position.damping_weight.x", "POS_Q_NORTH_DAMP"),
    kept("controller.position.damping_weight.y", "POS_Q_EAST_DAMP"),
    kept("controller.attitude.damping_weight.phi", "ATT_Q_ROLL_DAMP"),
    kept("controller.attitude.damping_weight.theta", "ATT_Q_PITCH_DAMP"),
    kept("controller.attitude.damping_weight.psi", "ATT_Q_YAW_DAMP"),
    kept("airframe.inertia.xy", "FRAME_INERTIA_XY"),
    kept("airframe.inertia.xz", "FRAME_INERTIA_XZ"),
    kept("airframe.inertia.yz", "FRAME_INERTIA_YZ"),
    kept("airframe.centre_of_gravity.x", "FRAME_CENTRE_X"),
    kept("airframe.centre_of_gravity.y", "FRAME_CENTRE_Y"),
    kept("airframe.centre_of_gravity.z", "FRAME_CENTRE_Z"),
    kept("airframe.body_drag.x", "FRAME_BODYDRAG_X"),
    kept("airframe.body_drag.y", "FRAME_BODYDRAG_Y"),
    kept("airframe.body_drag.z", "FRAME_BODYDRAG_Z"),
    kept("airframe.rotor.fall_time_ratio", "ROTOR_FALL_RATIO"),
    kept("airframe.rotor.inertia", "ROTOR_INERTIA"),
    kept("airframe.rotor.drag_coefficient", "ROTOR_DRAG_K"),
    kept("airframe.rotor.inflow_coefficient", "ROTOR_INFLOW_K"),
    kept("airframe.rotor.lift_coefficient", "ROTOR_LIFT_K"),
    kept("airframe.rotor.radius", "ROTOR_RADIUS"),
    kept("airframe.rotor.ground_effect", "ROTOR_GROUND_EFF"),
    kept("airframe.battery.sag", "FRAME_BATT_SAG"),
    kept("airframe.battery.voltage", "FRAME_BATT_VOLT"),
    kept("airframe.battery.resistance", "FRAME_BATT_RESIS"),
    kept("airframe.battery.capacity", "FRAME_BATT_CAPAC"),
];

/// The MAVLink name of a dotted name; `None` for what describes the start of a flight, not the vehicle.
pub fn loop_name(dotted: &str) -> Option<&'static LoopName> {
    LOOP_NAMES.iter().find(|name| name.dotted == dotted)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use quadrotor::PARAMETERS;

    use super::{LOOP_NAMES, loop_name};
    use crate::identity::Identity;
    use crate::parameters::ParameterTable;

    /// Longest name of a MAVLink parameter.
    const LONGEST: usize = 16;
    /// They describe the start of a flight and are set by the command line.
    const START: [&str; 4] = ["initial.", "environment.", "reference.", "airframe.preset"];

    #[test]
    fn every_parameter_of_the_vehicle_has_a_name() {
        for parameter in PARAMETERS {
            let of_start = START.iter().any(|prefix| parameter.name.starts_with(prefix));
            assert_eq!(loop_name(parameter.name).is_none(), of_start, "{}", parameter.name);
        }
        for name in LOOP_NAMES {
            assert!(PARAMETERS.iter().any(|parameter| parameter.name == name.dotted), "{}", name.dotted);
        }
    }

    /// Clients tell parameters apart by 16 bytes, and by the group before the first underscore.
    #[test]
    fn names_fit_and_neither_they_nor_the_former_ones_collide() {
        for identity in [Identity::Px4, Identity::ArduPilot, Identity::Generic] {
            let table = ParameterTable::new(identity);
            let mut seen = BTreeSet::new();
            for entry in table.entries() {
                for name in [Some(entry.id), entry.former].into_iter().flatten() {
                    assert!(seen.insert(name), "{name} twice");
                    assert!(name.len() <= LONGEST, "{name}");
                    let plain = |byte: u8| byte == b'_' || byte.is_ascii_uppercase() || byte.is_ascii_digit();
                    // Some of ArduPilot's have no group.
                    let alone = ["FLTMODE", "SIMPLE", "TUNE"].iter().any(|start| name.starts_with(start));
                    let grouped = name.contains('_') || alone;
                    assert!(grouped && name.bytes().all(plain), "{name}");
                }
            }
        }
        let groups: BTreeSet<_> = LOOP_NAMES.iter().filter_map(|name| name.id.split('_').next()).collect();
        assert_eq!(Vec::from_iter(groups), ["ALT", "ATT", "CTRL", "FRAME", "LIM", "POS", "ROTOR", "SENS"]);
    }

    /// As version 0.1 listed them.
    #[test]
    fn every_former_name_finds_the_parameter() {
        let table = ParameterTable::new(Identity::Px4);
        let former = FORMER.split_whitespace();
        assert_eq!(former.clone().count(), 76);
        for (former, name) in former.zip(LOOP_NAMES) {
            let found = table.find(former).map(|entry| (entry.id, entry.dotted()));
            assert_eq!(found, Some((name.id, Some(name.dotted))), "{former}");
        }
    }

    const FORMER: &str = "\
        AF_MASS AF_ARM AF_J_X AF_J_Y AF_J_Z AF_DRAG_X AF_DRAG_Y AF_DRAG_Z AF_ROT_K1 AF_ROT_K2 \
        AF_ROT_MIN AF_ROT_MAX AF_ROT_TAU C_KIND C_GOVERNOR C_MASSF C_ALT_DT C_ALT_N C_ALT_A \
        C_ALT_NP C_ALT_CNTRL_HRZN C_ALT_ALPHA C_ALT_LAM C_ALT_Q C_ALT_QD C_ALT_R C_POS_DT C_POS_N \
        C_POS_A C_POS_NP C_PS_CNTRL_HRZN C_POS_ALPHA C_POS_LAM C_POS_Q_X C_POS_Q_Y C_POS_QD_X \
        C_POS_QD_Y C_POS_R_THE C_POS_R_PHI C_ATT_DT C_ATT_N C_ATT_A C_ATT_NP C_ATT_CNTRL_HRZN \
        C_ATT_ALPHA C_ATT_LAM C_ATT_Q_PHI C_ATT_Q_THE C_ATT_Q_PSI C_ATT_QD_PHI C_ATT_QD_THE \
        C_ATT_QD_PSI C_ATT_R_PHI C_ATT_R_THE C_ATT_R_PSI LIM_TILT LIM_TILT_R LIM_TILT_A \
        LIM_THRUST_MIN LIM_THRUST_MAX LIM_SPEED_H LIM_SPEED_UP LIM_SPEED_DOWN LIM_ACC_H LIM_ACC_V \
        LIM_JERK_H LIM_JERK_V LIM_YAW_R LIM_YAW_A LIM_YAW_J SNSR_OTPT_FDBCK SNSR_PSTN_NS \
        SNSR_VLCTY_NS SNSR_ATTTD_NS SNSR_BDY_RT_NS SENSOR_SEED";
}
