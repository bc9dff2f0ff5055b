//! PX4's: outputs, devices and calibrations of a board.

use super::KeptParameter;
use super::parameter::kept;

/// In groups with one reason each.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static PARAMETERS: &[&[KeptParameter]] = &[
    kept!(Px4, "the airframe (--airframe, FRAME_…) says where the rotors are and what they do", real [
        ("CA_ROTOR0_PX", 0.15, -100.0..=100.0, "m", "First rotor, forwards"),
        ("CA_ROTOR0_PY", 0.15, -100.0..=100.0, "m", "First rotor, to the right"),
        ("CA_ROTOR0_KM", 0.05, -1.0..=1.0, "", "First rotor, ratio of torque and thrust"),
        ("CA_ROTOR1_PX", -0.15, -100.0..=100.0, "m", "Second rotor, forwards"),
        ("CA_ROTOR1_PY", -0.15, -100.0..=100.0, "m", "Second rotor, to the right"),
        ("CA_ROTOR1_KM", 0.05, -1.0..=1.0, "", "Second rotor, ratio of torque and thrust"),
        ("CA_ROTOR2_PX", 0.15, -100.0..=100.0, "m", "Third rotor, forwards"),
        ("CA_ROTOR2_PY", -0.15, -100.0..=100.0, "m", "Third rotor, to the right"),
        ("CA_ROTOR2_KM", -0.05, -1.0..=1.0, "", "Third rotor, ratio of torque and thrust"),
        ("CA_ROTOR3_PX", -0.15, -100.0..=100.0, "m", "Fourth rotor, forwards"),
        ("CA_ROTOR3_PY", 0.15, -100.0..=100.0, "m", "Fourth rotor, to the right"),
        ("CA_ROTOR3_KM", -0.05, -1.0..=1.0, "", "Fourth rotor, ratio of torque and thrust"),
    ], whole [
        ("CA_ROTOR_COUNT", 4, 0..=12, "", "Number of rotors"),
        ("SYS_CTRL_ALLOC", 1, 0..=1, "", "Dynamic control allocation"),
        ("PWM_MAIN_FUNC1", 101, 0..=2032, "", "Function of the first output"),
        ("PWM_MAIN_FUNC2", 102, 0..=2032, "", "Function of the second output"),
        ("PWM_MAIN_FUNC3", 103, 0..=2032, "", "Function of the third output"),
        ("PWM_MAIN_FUNC4", 104, 0..=2032, "", "Function of the fourth output"),
        ("PWM_MAIN_MIN1", 1000, 800..=1400, "us", "Shortest pulse of the first output"),
        ("PWM_MAIN_MAX1", 2000, 1600..=2200, "us", "Longest pulse of the first output"),
        ("BAT1_N_CELLS", 4, 0..=16, "", "Cells of the battery; its voltages are those of the airframe"),
    ]),
    kept!(Px4, "the instruments are calibrated and see what --sensors says", real [
    ], whole [
        ("EKF2_AID_MASK", 1, 0..=511, "", "Use of instruments before version 1.14"),
        ("EKF2_HGT_MODE", 1, 0..=3, "", "Reference of height before version 1.14"),
        ("SIM_GPS_USED", 10, 0..=50, "", "Satellites of the simulated receiver; here --fault and failure injection stop it"),
        ("CAL_ACC0_ID", 1310988, 0..=2147483520, "", "Accelerometer that the calibration is for"),
        ("CAL_GYRO0_ID", 1310988, 0..=2147483520, "", "Gyroscope that the calibration is for"),
        ("CAL_MAG0_ID", 197388, 0..=2147483520, "", "Magnetometer that the calibration is for"),
        ("IMU_GYRO_RATEMAX", 400, 100..=2000, "Hz", "Largest rate of the gyroscopes"),
        ("SENS_FLOW_ROT", 0, 0..=7, "", "Orientation of the optical flow sensor"),
        ("RC_CHAN_CNT", 0, 0..=18, "", "Number of channels; here that of the radio"),
    ]),
    kept!(Px4, "obstacles are braked for, and not flown around", real [
        ("CP_GUIDE_ANG", 30.0, 0.0..=90.0, "deg", "Angle by which sticks are turned away from obstacles"),
    ], whole [
        ("COM_OBS_AVOID", 0, 0..=1, "", "Ask a companion computer for ways around obstacles"),
    ]),
    kept!(Px4, "the camera, the gripper and the gimbal are always there, and commands work them", real [
        ("TRIG_INTERVAL", 40.0, 4.0..=10000.0, "ms", "Time between images; here DO_SET_CAM_TRIGG_INTERVAL"),
        ("TRIG_DISTANCE", 25.0, 0.0..=1000000.0, "m", "Distance between images; here DO_SET_CAM_TRIGG_DIST"),
        ("TRIG_ACT_TIME", 40.0, 0.1..=3000.0, "ms", "Length of the trigger's pulse"),
        ("PD_GRIPPER_TO", 1.0, 0.0..=30.0, "s", "Longest time that a gripper takes"),
    ], whole [
        ("TRIG_MODE", 0, 0..=4, "", "When images are taken"),
        ("TRIG_INTERFACE", 4, 1..=4, "", "How the camera is connected"),
        ("PD_GRIPPER_EN", 1, 0..=1, "", "Enable the gripper"),
        ("PD_GRIPPER_TYPE", 0, -1..=0, "", "Type of the gripper: -1 undefined, 0 a servo"),
        ("MNT_MAV_SYSID", 1, 1..=255, "", "System id of the gimbal"),
        ("MNT_MAV_COMPID", 154, 1..=255, "", "Component id of the gimbal"),
        ("UXRCE_DDS_DOM_ID", 0, 0..=232, "", "Domain of the bridge to ROS 2; the book has one over MAVLink"),
    ]),
    kept!(Px4, "the nose turns into the wind only in ArduPilot's conventions", real [], whole [
        ("WV_EN", 0, 0..=1, "", "Turn the nose into the wind"),
    ]),
];
