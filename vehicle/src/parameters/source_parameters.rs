//! ArduPilot's sources of the estimator, and its parameters of visual odometry.

use super::ConductParameter;
use super::conduct_parameter::{choice, real, whole};

/// The parameters.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static SOURCE_PARAMETERS: &[ConductParameter] = &[
    whole!("EK3_SRC1_POSXY", 0..=8, aiding.ardupilot.first.position, u8, "First source of horizontal positions: 3 GPS, 6 vision, otherwise none"),
    whole!("EK3_SRC1_VELXY", 0..=7, aiding.ardupilot.first.velocity, u8, "First source of horizontal velocities: 3 GPS, 6 vision, otherwise none"),
    whole!("EK3_SRC1_POSZ", 0..=6, aiding.ardupilot.first.height, u8, "First source of height: 6 vision, otherwise barometer and GPS together"),
    whole!("EK3_SRC1_VELZ", 0..=6, aiding.ardupilot.first.climb, u8, "First source of vertical velocities: 6 vision; GPS has that of EK3_SRC1_VELXY"),
    whole!("EK3_SRC1_YAW", 0..=8, aiding.ardupilot.first.heading, u8, "First source of the heading: 6 vision, otherwise the compass"),
    whole!("EK3_SRC2_POSXY", 0..=8, aiding.ardupilot.second.position, u8, "Second source of horizontal positions: 3 GPS, 6 vision, otherwise none"),
    whole!("EK3_SRC2_VELXY", 0..=7, aiding.ardupilot.second.velocity, u8, "Second source of horizontal velocities: 3 GPS, 6 vision, otherwise none"),
    whole!("EK3_SRC2_POSZ", 0..=6, aiding.ardupilot.second.height, u8, "Second source of height: 6 vision, otherwise barometer and GPS together"),
    whole!("EK3_SRC2_VELZ", 0..=6, aiding.ardupilot.second.climb, u8, "Second source of vertical velocities: 6 vision; GPS has that of EK3_SRC2_VELXY"),
    whole!("EK3_SRC2_YAW", 0..=8, aiding.ardupilot.second.heading, u8, "Second source of the heading: 6 vision, otherwise the compass"),
    whole!("EK3_SRC3_POSXY", 0..=8, aiding.ardupilot.third.position, u8, "Third source of horizontal positions: 3 GPS, 6 vision, otherwise none"),
    whole!("EK3_SRC3_VELXY", 0..=7, aiding.ardupilot.third.velocity, u8, "Third source of horizontal velocities: 3 GPS, 6 vision, otherwise none"),
    whole!("EK3_SRC3_POSZ", 0..=6, aiding.ardupilot.third.height, u8, "Third source of height: 6 vision, otherwise barometer and GPS together"),
    whole!("EK3_SRC3_VELZ", 0..=6, aiding.ardupilot.third.climb, u8, "Third source of vertical velocities: 6 vision; GPS has that of EK3_SRC3_VELXY"),
    whole!("EK3_SRC3_YAW", 0..=8, aiding.ardupilot.third.heading, u8, "Third source of the heading: 6 vision, otherwise the compass"),
    whole!("EK3_SRC_OPTIONS", 0..=3, aiding.ardupilot.options, u8, "Options of sources; with the first bit, velocities of all sets are fused"),
    choice!("VISO_TYPE", VISION_KINDS, aiding.ardupilot.vision_kind, "Kind of visual odometry; all kinds send messages"),
    real!("VISO_SCALE", None, 0.0..=100.0, aiding.ardupilot.scale, "", "What positions of visual odometry are multiplied by"),
    real!("VISO_POS_X", None, -5.0..=5.0, aiding.ardupilot.place.x, "m", "Place that visual odometry tells, forwards of the inertial unit"),
    real!("VISO_POS_Y", None, -5.0..=5.0, aiding.ardupilot.place.y, "m", "Place that visual odometry tells, to the right of it"),
    real!("VISO_POS_Z", None, -5.0..=5.0, aiding.ardupilot.place.z, "m", "Place that visual odometry tells, below it"),
    real!("VISO_POS_M_NSE", None, 0.1..=10.0, aiding.ardupilot.position_noise_m, "m", "Least standard deviation of positions of visual odometry"),
    real!("VISO_VEL_M_NSE", None, 0.05..=5.0, aiding.ardupilot.velocity_noise_m_s, "m/s", "Least standard deviation of velocities of visual odometry"),
    real!("VISO_YAW_M_NSE", None, 0.05..=1.0, aiding.ardupilot.heading_noise_rad, "rad", "Least standard deviation of headings of visual odometry"),
    whole!("VISO_DELAY_MS", 0..=250, aiding.ardupilot.delay_ms, u16, "Time from an estimate of visual odometry to its message, ms"),
    whole!("VISO_QUAL_MIN", -1..=100, aiding.ardupilot.least_quality, i8, "Least quality of ODOMETRY that is fused, %; -1: any"),
];

const VISION_KINDS: &[(u8, i32, &str)] =
    &[(0, 0, "None"), (1, 1, "MAVLink"), (2, 2, "Intel T265"), (3, 3, "VOXL")];
