//! The messages that estimates come in, and which autopilot fuses which.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    ATT_POS_MOCAP_DATA, GLOBAL_VISION_POSITION_ESTIMATE_DATA, ODOMETRY_DATA, VICON_POSITION_ESTIMATE_DATA,
    VISION_POSITION_DELTA_DATA, VISION_POSITION_ESTIMATE_DATA, VISION_SPEED_ESTIMATE_DATA,
};

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Estimate {
    /// VISION_POSITION_ESTIMATE.
    Position,
    /// GLOBAL_VISION_POSITION_ESTIMATE, with the same fields.
    GlobalPosition,
    /// VICON_POSITION_ESTIMATE, with the same fields but for the counter of resets.
    Vicon,
    /// VISION_SPEED_ESTIMATE.
    Speed,
    /// ATT_POS_MOCAP.
    Mocap,
    /// ODOMETRY.
    Odometry,
    /// VISION_POSITION_DELTA.
    Delta,
}

impl Estimate {
    /// Identifiers of all of them.
    pub const IDS: &'static [u32] = &[
        VISION_POSITION_ESTIMATE_DATA::ID,
        GLOBAL_VISION_POSITION_ESTIMATE_DATA::ID,
        VICON_POSITION_ESTIMATE_DATA::ID,
        VISION_SPEED_ESTIMATE_DATA::ID,
        ATT_POS_MOCAP_DATA::ID,
        ODOMETRY_DATA::ID,
        VISION_POSITION_DELTA_DATA::ID,
    ];

    /// The one with an identifier.
    pub fn of_id(id: u32) -> Option<Self> {
        const ALL: [Estimate; 7] = [
            Estimate::Position,
            Estimate::GlobalPosition,
            Estimate::Vicon,
            Estimate::Speed,
            Estimate::Mocap,
            Estimate::Odometry,
            Estimate::Delta,
        ];
        Self::IDS.iter().zip(ALL).find(|(known, _)| **known == id).map(|(_, estimate)| estimate)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => VISION_POSITION_ESTIMATE_DATA::NAME,
            Self::GlobalPosition => GLOBAL_VISION_POSITION_ESTIMATE_DATA::NAME,
            Self::Vicon => VICON_POSITION_ESTIMATE_DATA::NAME,
            Self::Speed => VISION_SPEED_ESTIMATE_DATA::NAME,
            Self::Mocap => ATT_POS_MOCAP_DATA::NAME,
            Self::Odometry => ODOMETRY_DATA::NAME,
            Self::Delta => VISION_POSITION_DELTA_DATA::NAME,
        }
    }

    /// Whether PX4's estimator fuses it. PX4 receives ATT_POS_MOCAP, too, but EKF2 does not fuse it.
    pub fn is_for_px4(self) -> bool {
        matches!(self, Self::Position | Self::Odometry)
    }
}

#[cfg(test)]
mod tests {
    use super::Estimate;

    #[test]
    fn each_identifier_has_its_message() {
        for id in Estimate::IDS {
            assert!(Estimate::of_id(*id).is_some(), "{id}");
        }
        assert_eq!(Estimate::of_id(102), Some(Estimate::Position));
        assert_eq!(Estimate::of_id(331), Some(Estimate::Odometry));
        assert_eq!(Estimate::of_id(11011), Some(Estimate::Delta));
        assert_eq!(Estimate::of_id(0), None);
    }
}
