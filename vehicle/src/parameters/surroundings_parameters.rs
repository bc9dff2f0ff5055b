//! Obstacles, traffic and remote identification by the names and numbers of both autopilots.

use super::ConductParameter;
use super::conduct_parameter::{choice, real, switch};
use crate::vehicle::{Action, BeaconBeam, Conduct, Recovery, Tracking};

/// A whole number.
macro_rules! whole {
    ($id:literal, $maximum:literal, $field:ident, $text:literal) => {
        ConductParameter {
            integer: true,
            get: |conduct| f64::from(conduct.surroundings.$field),
            set: |conduct, value| {
                let number = (0..=$maximum).find(|number| f64::from(*number) == value);
                if let Some(number) = number {
                    conduct.surroundings.$field = number;
                }
                number.is_some()
            },
            maximum: $maximum as f64,
            ..real!($id, None, 0.0..=1.0, surroundings.obstacle_delay_s, "", $text)
        }
    };
}

/// Those that are there unless the vehicle presents itself as ArduPilot.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static PX4_SURROUNDINGS: &[ConductParameter] = &[
    real!("CP_DIST", None, -1.0..=15.0, surroundings.obstacle_distance_m, "m", "Distance to keep from obstacles in Position mode; negative disables it"),
    real!("CP_DELAY", None, 0.0..=1.0, surroundings.obstacle_delay_s, "s", "Delay with which ranges are measured and the vehicle brakes"),
    choice!("MPC_ALT_MODE", ALTITUDE_MODES, surroundings.surface.tracking, "What the height refers to in Altitude and Position mode, if there is a downward rangefinder (a --world with obstacles or heights)"),
    switch!("CP_GO_NO_DATA", surroundings.go_without_data, "Move where nothing is measured, while CP_DIST is not negative"),
    choice!("NAV_TRAFF_AVOID", PX4_TRAFFIC, surroundings.traffic.action, "Action when traffic comes too near"),
    real!("NAV_TRAFF_A_HOR", None, 1.0..=10_000.0, surroundings.traffic.near_m, "m", "Horizontal distance of traffic that is too near"),
    real!("NAV_TRAFF_A_VER", None, 1.0..=10_000.0, surroundings.traffic.near_vertical_m, "m", "Vertical distance of traffic that is too near"),
    real!("NAV_TRAFF_COLL_T", None, 1.0..=3600.0, surroundings.traffic.ahead_s, "s", "Time to a collision with traffic at which the vehicle acts"),
    ConductParameter {
        get: |conduct| f64::from(u8::from(conduct.surroundings.remote_id) + u8::from(conduct.surroundings.remote_id_to_arm)),
        set: |conduct, value| set_remote_id(conduct, value),
        ..choice!("COM_ARM_ODID", REMOTE_ID, surroundings.remote_id, "Remote identification (Open Drone ID)")
    },
];

/// Those that are there if the vehicle presents itself as ArduPilot.
#[rustfmt::skip] // As above.
pub static ARDUPILOT_SURROUNDINGS: &[ConductParameter] = &[
    whole!("AVOID_ENABLE", 7_u8, avoided, "What is avoided, added up: 1 fence, 2 what the proximity sensor sees, 4 beacons; in Loiter sticks do not lead over the fence"),
    real!("AVOID_BACKUP_SPD", None, 0.0..=2.0, surroundings.backing_m_s, "m/s", "Speed with which sticks that are let go or lead outwards back away from the margin of the fence"),
    real!("AVOID_MARGIN", None, 1.0..=10.0, surroundings.obstacle_distance_m, "m", "Distance to keep from obstacles in Loiter, PosHold, ZigZag and Guided mode"),
    real!("AVOID_ALT_MIN", None, 0.0..=100.0, surroundings.avoided_above_m, "m", "Height above the ground, or above home without a rangefinder, up to which obstacles are not avoided; 0: they always are"),
    whole!("PRX1_TYPE", 17_u8, proximity_kind, "Proximity sensor: 0 none; any other kind is the lidar of --world and what companions send"),
    switch!("PRX_LOG_RAW", log.proximity_raw, "Log what the proximity sensor measures as it comes, too"),
    whole!("RNGFND1_TYPE", 100_u8, rangefinder_kind, "Downward rangefinder: 0 none; any other kind is the simulated one"),
    real!("RNGFND1_MAX", None, 0.5..=100.0, surroundings.rangefinder_farthest_m, "m", "Farthest that the rangefinder measures").also(&[("RNGFND1_MAX_CM", 100.0)]),
    real!("RNGFND1_MIN", None, 0.0..=5.0, surroundings.rangefinder_nearest_m, "m", "Nearest that the rangefinder measures").also(&[("RNGFND1_MIN_CM", 100.0)]),
    choice!("SURFTRAK_MODE", TRACKINGS, surroundings.surface.tracking, "Surface whose distance is kept in AltHold, Loiter, PosHold and ZigZag by the downward rangefinder"),
    real!("SURFTRAK_TC", None, 0.05..=5.0, surroundings.surface.smoothing_s, "s", "Time constant with which heights of the surface are followed"),
    switch!("ADSB_TYPE", surroundings.traffic.heard, "Receiver of transponders"),
    switch!("AVD_ENABLE", surroundings.traffic.enabled, "Look at traffic that comes near"),
    choice!("AVD_F_ACTION", ARDUPILOT_TRAFFIC, surroundings.traffic.action, "Action when traffic comes too near"),
    switch!("AVD_W_ACTION", surroundings.traffic.warns, "Action when traffic may come near", ["Nothing", "Report"]),
    choice!("AVD_F_RCVRY", RECOVERIES, surroundings.traffic.recovery, "Action when traffic is no longer too near"),
    real!("AVD_F_TIME", None, 0.0..=1000.0, surroundings.traffic.ahead_s, "s", "How far ahead traffic is looked for that is too near"),
    real!("AVD_W_TIME", None, 0.0..=1000.0, surroundings.traffic.warning_ahead_s, "s", "How far ahead traffic is looked for that may come near"),
    real!("AVD_F_DIST_XY", None, 0.0..=10_000.0, surroundings.traffic.near_m, "m", "Horizontal distance of traffic that is too near"),
    real!("AVD_W_DIST_XY", None, 0.0..=10_000.0, surroundings.traffic.warning_m, "m", "Horizontal distance of traffic that is reported"),
    real!("AVD_F_DIST_Z", None, 0.0..=10_000.0, surroundings.traffic.near_vertical_m, "m", "Vertical distance of traffic that is too near"),
    real!("AVD_W_DIST_Z", None, 0.0..=10_000.0, surroundings.traffic.warning_vertical_m, "m", "Vertical distance of traffic that is reported"),
    real!("AVD_F_ALT_MIN", None, 0.0..=1000.0, surroundings.traffic.least_height_m, "m", "Height above home below which traffic is only reported"),
    switch!("PLND_ENABLED", precision.enabled, "Land at a target that is seen"),
    choice!("PLND_TYPE", LANDING_SENSORS, precision.sensor, "What sees the target of a landing"),
    real!("PLND_XY_DIST_MAX", None, 0.0..=10.0, precision.farthest_m, "m", "Horizontal distance to the landing target beyond which the vehicle does not descend; 0: it always descends"),
    switch!("SIM_PLD_ENABLE", precision.simulated, "Whether a target of landings is simulated"),
    real!("SIM_PLD_LAT", None, -90.0..=90.0, precision.latitude_deg, "deg", "Latitude of the simulated target; 0 with SIM_PLD_LON 0: where the vehicle started"),
    real!("SIM_PLD_LON", None, -180.0..=180.0, precision.longitude_deg, "deg", "Longitude of the simulated target"),
    real!("SIM_PLD_HEIGHT", None, -1000.0..=1000.0, precision.height_m, "m", "Height of the simulated target above the start"),
    real!("SIM_PLD_ALT_LMT", None, 0.0..=1000.0, precision.beam_height_m, "m", "Greatest height above the simulated target at which it is seen"),
    real!("SIM_PLD_DIST_LMT", None, 0.0..=1000.0, precision.beam_radius_m, "m", "Greatest distance beside the simulated target at which it is seen"),
    choice!("SIM_PLD_TYPE", BEAMS, precision.beam, "Shape of the beam of the simulated target"),
    switch!("DID_ENABLE", surroundings.remote_id, "Remote identification (Open Drone ID)"),
    switch!("DID_OPTIONS", surroundings.remote_id_to_arm, "Options of remote identification", ["None", "Needed to arm"]),
];

const ALTITUDE_MODES: &[(Tracking, i32, &str)] = &[
    (Tracking::Off, 0, "Altitude"),
    (Tracking::Ground, 1, "Height above the ground"),
    (Tracking::Standing, 2, "Height above the ground while it hovers"),
];
const TRACKINGS: &[(Tracking, i32, &str)] = &[
    (Tracking::Off, 0, "None"),
    (Tracking::Ground, 1, "Ground"),
    (Tracking::Ceiling, 2, "Ceiling; there is no upward rangefinder"),
];
const PX4_TRAFFIC: &[(Action, i32, &str)] = &[
    (Action::None, 0, "Nothing"),
    (Action::Warn, 1, "Warn"),
    (Action::Return, 2, "Return"),
    (Action::Land, 3, "Land"),
    (Action::Hold, 4, "Hold"),
];
const ARDUPILOT_TRAFFIC: &[(Action, i32, &str)] = &[
    (Action::None, 0, "Nothing"),
    (Action::Warn, 1, "Report"),
    (Action::Return, 5, "Return"),
    (Action::Hold, 6, "Brake"),
];
const RECOVERIES: &[(Recovery, i32, &str)] = &[
    (Recovery::Remain, 0, "Nothing"),
    (Recovery::Resume, 1, "Resume the mode before"),
    (Recovery::Return, 2, "Return"),
    (Recovery::ResumeMission, 3, "Resume the mission, else Loiter"),
];
const LANDING_SENSORS: &[(u8, i32, &str)] = &[
    (0, 0, "None"),
    (1, 1, "Companion computer (LANDING_TARGET)"),
    (2, 2, "Infrared sensor of the simulated target"),
    (4, 4, "Simulated target"),
];
const BEAMS: &[(BeaconBeam, i32, &str)] = &[
    (BeaconBeam::Cylinder, 0, "Cylinder"),
    (BeaconBeam::Cone, 1, "Cone"),
    (BeaconBeam::Sphere, 2, "Sphere"),
];
/// Names of PX4's values; the second and the third both switch it on.
const REMOTE_ID: &[(bool, i32, &str)] =
    &[(false, 0, "Off"), (true, 1, "On"), (true, 2, "On, and needed to arm")];

fn set_remote_id(conduct: &mut Conduct, value: f64) -> bool {
    let known = value == 0.0 || value == 1.0 || value == 2.0;
    if known {
        let settings = &mut conduct.surroundings;
        (settings.remote_id, settings.remote_id_to_arm) = (value > 0.0, value > 1.0);
    }
    known
}
