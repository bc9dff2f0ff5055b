//! PX4's: checks before arming, failsafes and modes that there are not.

use super::KeptParameter;
use super::parameter::kept;

/// In groups with one reason each.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static PARAMETERS: &[&[KeptParameter]] = &[
    kept!(Px4, "a failsafe acts at once, on the causes that the book lists", real [
        ("COM_FAIL_ACT_T", 5.0, 0.0..=25.0, "s", "Time in Hold mode before a failsafe acts"),
        ("COM_WIND_WARN", -1.0, -1.0..=30.0, "m/s", "Wind speed that is warned of; here COM_WIND_MAX"),
        ("COM_POS_FS_EPH", 5.0, -1.0..=400.0, "m", "Horizontal error at which the position is lost"),
        ("COM_VEL_FS_EVH", 1.0, 0.0..=100.0, "m/s", "Error of the speed at which it is lost"),
        ("COM_POS_LOW_EPH", -1.0, -1.0..=1000.0, "m", "Horizontal error that is warned of"),
        ("COM_KILL_DISARM", 5.0, 0.0..=30.0, "s", "Time after which a killed vehicle disarms; here at once"),
        ("MAN_KILL_GEST_T", -1.0, -1.0..=15.0, "s", "Time of the stick gesture that kills; negative: none"),
        ("RTL_TIME_FACTOR", 1.1, 1.0..=2.0, "", "Factor on the estimated time to return"),
    ], whole [
        ("COM_DLL_EXCEPT", 0, 0..=31, "", "Modes that go on without a ground station"),
        ("COM_FLT_TIME_MAX", -1, -1..=10000, "s", "Longest flight; negative: any"),
        ("COM_FLTT_LOW_ACT", 3, 0..=3, "", "Action when the battery does not last for longer than the return"),
        ("COM_POS_LOW_ACT", 3, 0..=5, "", "Action when the position is inaccurate"),
        ("COM_QC_ACT", 0, 0..=4, "", "Action when a quad-chute is needed"),
        ("COM_IMB_PROP_ACT", 0, -1..=1, "", "Action when a propeller is out of balance"),
        ("COM_OBL_ACT", 0, -1..=1, "", "Action when offboard set-points stop; here COM_OBL_RC_ACT"),
        ("FD_EXT_ATS_EN", 0, 0..=1, "", "Fly with an external trigger of the parachute"),
        ("FD_EXT_ATS_TRIG", 1900, 0..=10000, "us", "Pulse of the external trigger of the parachute"),
        ("GF_SOURCE", 0, 0..=1, "", "Position that the fence is checked with; here the estimate"),
        ("RTL_PLD_MD", 0, 0..=2, "", "Precision landing after a return"),
        ("RTL_TIME_MARGIN", 100, 0..=3600, "s", "Margin on the estimated time to return"),
    ]),
    kept!(Px4, "arming needs a valid estimate, whatever its innovations are", real [
        ("COM_ARM_EKF_POS", 0.5, 0.1..=1.0, "", "Largest test ratio of the position to arm with"),
        ("COM_ARM_EKF_VEL", 0.5, 0.1..=1.0, "", "Largest test ratio of the speed to arm with"),
        ("COM_ARM_EKF_HGT", 1.0, 0.1..=1.0, "", "Largest test ratio of the height to arm with"),
        ("COM_ARM_EKF_YAW", 0.5, 0.1..=1.0, "", "Largest test ratio of the heading to arm with"),
    ], whole [
        ("COM_RC_ARM_HYST", 1000, 100..=1500, "ms", "Time of the stick gesture that arms"),
        ("COM_MOT_TEST_EN", 1, 0..=1, "", "Allow motor tests; here they always are while it is disarmed"),
        ("COM_THROW_EN", 0, 0..=1, "", "Throw launch"),
        ("COM_TAKEOFF_ACT", 0, 0..=1, "", "What follows a takeoff: 0 hold, 1 mission; here it holds"),
    ]),
    kept!(Px4, "sticks ask for speeds in proportion, and references keep the limits of jerk", real [
        ("MPC_XY_MAN_EXPO", 0.6, 0.0..=1.0, "", "Curve of the sticks, horizontal"),
        ("MPC_Z_MAN_EXPO", 0.6, 0.0..=1.0, "", "Curve of the sticks, vertical"),
        ("MPC_YAW_EXPO", 0.6, 0.0..=1.0, "", "Curve of the sticks, heading"),
        ("MPC_MAN_Y_TAU", 0.08, 0.0..=5.0, "s", "Time constant of the stick that turns"),
        ("MPC_VELD_LP", 5.0, 0.0..=50.0, "Hz", "Low-pass filter of the derivative of the speed"),
        ("MPC_VEL_LP", 0.0, 0.0..=50.0, "Hz", "Low-pass filter of the speed"),
        ("MPC_LAND_RADIUS", 1000.0, -1.0..=100000.0, "m", "Distance by which sticks may move the place of a landing"),
        ("SYS_VEHICLE_RESP", -0.4, -1.0..=1.0, "", "Overall responsiveness; negative leaves the limits as they are"),
        ("HTE_HT_NOISE", 0.0036, 0.0..=1.0, "", "Noise of the learned hover thrust; here the mass is learned"),
        ("HTE_ACC_GATE", 3.0, 1.0..=10.0, "", "Gate of the learned hover thrust; here the mass is learned"),
    ], whole [
        ("MPC_USE_HTE", 1, 0..=1, "", "Learn the hover thrust; here the mass is learned"),
        ("MC_AT_START", 0, 0..=1, "", "Start autotuning"),
    ]),
    kept!(Px4, "missions are checked against the fence, and may begin anywhere", real [
        ("MIS_DIST_1WP", 10000.0, -1.0..=100000.0, "m", "Largest distance to the first waypoint"),
        ("NAV_MIN_LTR_ALT", -1.0, -1.0..=1000.0, "m", "Smallest height to hold at after a takeoff"),
        ("LNDMC_ALT_GND", 2.0, -1.0..=10.0, "m", "Height below which the ground effect counts"),
    ], whole []),
    kept!(Px4, "precision landings look for their target while they descend", real [
        ("PLD_BTOUT", 5.0, 0.0..=50.0, "s", "Time after which a target counts as lost"),
        ("PLD_HACC_RAD", 0.2, 0.0..=10.0, "m", "Distance above the target within which it descends"),
        ("PLD_FAPPR_ALT", 0.1, 0.0..=10.0, "m", "Height of the final approach"),
        ("PLD_SRCH_ALT", 10.0, 0.0..=100.0, "m", "Height from which the target is looked for"),
        ("PLD_SRCH_TOUT", 10.0, 0.0..=100.0, "s", "Longest search for the target"),
    ], whole [
        ("PLD_MAX_SRCH", 3, 0..=100, "", "Largest number of searches"),
        ("LTEST_MODE", 0, 0..=1, "", "Whether the target moves"),
    ]),
];
