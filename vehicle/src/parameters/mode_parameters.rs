//! Parameters of single modes and of the way home, which each autopilot has under names of its own.

use super::ConductParameter;
use super::NamedValue;
use super::conduct_parameter::{bitmask, choice, real, switch};
use crate::vehicle::{FollowHeading, FollowHeight, HeadingPolicy, IntoWind, OrbitHeading, ReturnGoal};

/// A whole number: identifier, range, field and its type, text.
macro_rules! whole {
    ($id:literal, $minimum:literal..=$maximum:literal, $($field:ident).+, $type:ty, $text:literal) => {
        ConductParameter {
            integer: true,
            get: |conduct| f64::from(conduct.$($field).+),
            set: |conduct, value| {
                conduct.$($field).+ = value as $type;
                value.fract() == 0.0
            },
            ..real!($id, None, $minimum..=$maximum, set_point_timeout_s, "", $text)
        }
    };
}

/// Degrees in a radian.
const DEGREES: f64 = 180.0 / core::f64::consts::PI;

/// An angle or its rate, which is shown in degrees: identifier, range, field, unit, text.
macro_rules! degrees {
    ($id:literal, $minimum:literal..=$maximum:literal, $($field:ident).+, $unit:literal, $text:literal) => {
        ConductParameter {
            get: |conduct| conduct.$($field).+ * DEGREES,
            set: |conduct, value| {
                conduct.$($field).+ = value / DEGREES;
                true
            },
            ..real!($id, None, $minimum..=$maximum, set_point_timeout_s, $unit, $text)
        }
    };
}

/// Those that are there unless the vehicle presents itself as ArduPilot.
#[rustfmt::skip] // One line per parameter reads as the table that it is.
pub static PX4_MODE_PARAMETERS: &[ConductParameter] = &[
    real!("RTL_DESCEND_ALT", None, 0.0..=100.0, return_home.wait_height_m, "m", "Height above home at which a return waits before it lands"),
    real!("RTL_LAND_DELAY", None, -1.0..=300.0, return_home.wait_s, "s", "Time that a return waits before it lands; -1 does not land"),
    ConductParameter {
        integer: true,
        set: |conduct, value| {
            let means = CONE_ANGLES.iter().any(|(angle, _)| f64::from(*angle) == value);
            if means {
                conduct.return_home.cone_rad = value / DEGREES;
            }
            means
        },
        get: |conduct| (conduct.return_home.cone_rad * DEGREES).round(),
        names: || CONE_ANGLES.iter().map(|(angle, name)| NamedValue::new(*angle, name)).collect(),
        ..real!("RTL_CONE_ANG", None, 0.0..=90.0, set_point_timeout_s, "deg", "Half angle of the cone within which a return near home climbs less")
    },
    choice!("RTL_TYPE", RETURN_GOALS, return_home.goal, "Where a return goes"),
    choice!("MPC_YAW_MODE", PX4_HEADINGS, heading_policy, "Heading on missions and returns"),
    real!("MC_ORBIT_RAD_MAX", None, 1.0..=10_000.0, orbit.largest_radius_m, "m", "Largest radius of an orbit"),
    choice!("MC_ORBIT_YAW_MOD", ORBIT_HEADINGS, orbit.heading, "Heading on an orbit unless its command says one"),
    real!("FLW_TGT_HT", None, 8.0..=1000.0, follow.height_m, "m", "Height at which a target is followed"),
    real!("FLW_TGT_DST", None, 1.0..=1000.0, follow.distance_m, "m", "Horizontal distance at which a target is followed"),
    degrees!("FLW_TGT_FA", -180.0..=180.0, follow.angle_rad, "deg", "Angle from which a target is followed: 0 in front, 90 to the right, 180 behind"),
    choice!("FLW_TGT_ALT_M", FOLLOW_HEIGHTS, follow.height, "What the height of following is measured from"),
    real!("FLW_TGT_RS", None, 0.0..=1.0, follow.smoothing, "", "Smoothing of the positions of a target; 0 follows them at once"),
    real!("FLW_TGT_VG", None, 0.1..=1.0, follow.velocity_gain, "", "Gain of the velocity of a target relative to that of its position"),
    real!("FLW_TGT_MAX_VEL", None, 0.0..=20.0, follow.around_m_s, "m/s", "Largest speed around a target on the way to another angle"),
];

/// Those that are there when the vehicle presents itself as ArduPilot.
#[rustfmt::skip] // As above.
pub static ARDUPILOT_MODE_PARAMETERS: &[ConductParameter] = &[
    real!("RTL_ALT_FINAL_M", Some(("RTL_ALT_FINAL", 100.0)), 0.0..=1000.0, return_home.final_height_m, "m", "Height above home at which a return ends; 0 lands").also(&[("RTL_ALT_FINAL_M", 1.0)]),
    switch!("RTL_ALT_TYPE", return_home.above_ground, "What the height of a return counts from", ["Home", "The ground, which its way follows"]),
    switch!("MIS_RESTART", mission_restarts, "What a mission does that was left and is entered again", ["Resume", "Restart"]),
    bitmask!("MIS_OPTIONS", MISSION_OPTIONS, mission_options, u32::from, options, "Options of missions: value 1 clears the mission at a reboot; the other values have no effect"),
    real!("RTL_LOIT_TIME", None, 0.0..=60_000.0, return_home.wait_s, 1000.0, "ms", "Time that a return waits above home before it descends"),
    real!("RTL_SPEED_MS", Some(("RTL_SPEED", 100.0)), 0.0..=50.0, return_home.speed_m_s, "m/s", "Speed of a return; 0 is that of missions").also(&[("RTL_SPEED_MS", 1.0)]),
    real!("RTL_CONE_SLOPE", None, 0.0..=10.0, return_home.cone_slope, "", "Slope of the cone above home within which a return climbs less; below 0.5 there is none"),
    real!("RTL_CLIMB_MIN_M", Some(("RTL_CLIMB_MIN", 100.0)), 0.0..=1000.0, return_home.least_climb_m, "m", "Least climb of a return before it travels").also(&[("RTL_CLIMB_MIN_M", 1.0)]),
    choice!("WP_YAW_BEHAVIOR", ARDUPILOT_HEADINGS, heading_policy, "Heading on missions and returns, and in Guided"),
    whole!("INITIAL_MODE", 0.0..=28.0, initial_mode, u8, "Number of the mode after a boot, until the mode switch chooses another one"),
    bitmask!("GCS_PID_MASK", TOLD_LOOPS, told_loops, u32::from, options, "Loops that PID_TUNING reports; there are no PID terms, so only the desired and achieved values are filled in"),
    real!("CIRCLE_RADIUS_M", Some(("CIRCLE_RADIUS", 100.0)), 0.0..=2000.0, orbit.radius_m, "m", "Radius of the circle mode; 0 turns on the spot").also(&[("CIRCLE_RADIUS_M", 1.0)]),
    degrees!("CIRCLE_RATE", -90.0..=90.0, orbit.rate_rad_s, "deg/s", "Rate of the circle mode; negative is counter-clockwise"),
    bitmask!("CIRCLE_OPTIONS", CIRCLE_OPTIONS, orbit.options, u32::from, options, "Options of the circle mode"),
    bitmask!("GUID_OPTIONS", GUIDED_OPTIONS, guided_options, u32::from, options, "Options of the guided mode"),
    bitmask!("AUTO_OPTIONS", AUTO_OPTIONS, auto_options, u32::from, options, "Options of Auto: value 1 allows arming in it, 2 lets it take off before the throttle is raised, 4 ignores the yaw stick, 128 turns into the wind"),
    real!("PILOT_TKO_ALT_M", Some(("PILOT_TKOFF_ALT", 100.0)), 0.0..=10.0, pilot_takeoff_m, "m", "Height above the ground to which a manual takeoff continues by itself; 0: it does not").also(&[("PILOT_TKO_ALT_M", 1.0)]),
    bitmask!("PILOT_THR_BHV", THROTTLE, sticks.throttle_behaviour, u32::from, options, "Further functions of the throttle: value 2 lets a throttle above 70 % break off a landing, 4 disarms soon after a manual landing, otherwise after DISARM_DELAY; 1 has no effect"),
    switch!("LAND_REPOSITION", sticks.move_landings, "Sticks move the place of a landing and turn the nose on the way down"),
    bitmask!("RTL_OPTIONS", RETURN_OPTIONS, return_home.options, u32::from, options, "Options of a return: value 4 ignores the yaw stick"),
    bitmask!("SRTL_OPTIONS", RETURN_OPTIONS, trail.options, u32::from, options, "Options of Smart RTL: value 4 ignores the yaw stick"),
    choice!("WVANE_ENABLE", WAYS, weathervane.way, "Side of the vehicle that turns into the wind in Guided and Auto, where GUID_OPTIONS and AUTO_OPTIONS allow it"),
    choice!("WVANE_TAKEOFF", OTHER_WAYS, weathervane.takeoff, "Side of the vehicle that turns into the wind on takeoffs"),
    real!("WVANE_GAIN", None, 0.0..=4.0, weathervane.gain_1_s, "1/s", "Yaw rate into the wind per lean angle"),
    degrees!("WVANE_ANG_MIN", 0.0..=10.0, weathervane.least_lean_rad, "deg", "Lean angle below which the vehicle does not turn into the wind"),
    real!("WVANE_HGT_MIN", None, 0.0..=50.0, weathervane.least_height_m, "m", "Height above home below which the vehicle does not turn into the wind; 0: none"),
    real!("WVANE_SPD_MAX", None, 0.0..=50.0, weathervane.fastest_m_s, "m/s", "Horizontal speed above which the vehicle does not turn into the wind; 0: any"),
    real!("WVANE_VELZ_MAX", None, 0.0..=5.0, weathervane.fastest_climb_m_s, "m/s", "Climb or sink rate above which the vehicle does not turn into the wind; 0: any"),
    switch!("WVANE_OPTIONS", weathervane.with_pitch, "Pitch turns nose or tail faster into the wind"),
    real!("ZIGZ_WP_DELAY", None, 0.0..=127.0, zigzag_wait_s, "s", "Time for which ZigZag waits after it has flown across"),
    switch!("FOLL_ENABLE", follow.enabled, "Enable the follow mode"),
    whole!("FOLL_SYSID", 0.0..=255.0, follow.system_id, u8, "System id of the target that is followed; 0 is the first one that is heard"),
    real!("FOLL_DIST_MAX", None, 0.0..=1000.0, follow.farthest_m, "m", "Distance beyond which a target is not followed; 0 is any"),
    switch!("FOLL_OFS_TYPE", follow.offset_turns, "Frame of the offset from the target", ["North, east, down", "Relative to the target's heading"]),
    real!("FOLL_OFS_X", None, -100.0..=100.0, follow.offset_x_m, "m", "Offset from the target to the north, or ahead of it; three zeros keep the offset at the start of the mode"),
    real!("FOLL_OFS_Y", None, -100.0..=100.0, follow.offset_y_m, "m", "Offset from the target to the east, or to its right"),
    real!("FOLL_OFS_Z", None, -100.0..=100.0, follow.offset_z_m, "m", "Offset from the target down"),
    choice!("FOLL_YAW_BEHAVE", FOLLOW_HEADINGS, follow.heading, "Heading while a target is followed"),
    switch!("FOLL_ALT_TYPE", follow.relative_height, "Which altitude of GLOBAL_POSITION_INT the target has", ["Above sea level", "Above home"]),
    whole!("THROW_NEXTMODE", 0.0..=27.0, throw.next_mode, u8, "Mode after a throw; 18 stays in Throw"),
    switch!("THROW_TYPE", throw.is_dropped, "Kind of throw", ["Upwards", "Drop"]),
    real!("THROW_ALT_MIN", None, 0.0..=10_000.0, throw.least_height_m, "m", "Least height above home for a throw; 0 is any"),
    real!("THROW_ALT_MAX", None, 0.0..=10_000.0, throw.most_height_m, "m", "Largest height above home for a throw; 0 is any"),
    whole!("TKOFF_RPM_MIN", 0.0..=10_000.0, takeoff_check.least, u16, "Least speed of the idling rotors for takeoff (1/min); 0 is any"),
    whole!("TKOFF_RPM_MAX", 0.0..=10_000.0, takeoff_check.most, u16, "Largest speed of the idling rotors for takeoff (1/min); 0 is any"),
    real!("SRTL_ACCURACY", None, 0.0..=10.0, trail.accuracy_m, "m", "Least distance between places of the path of Smart RTL; 0 disables it"),
    whole!("SRTL_POINTS", 0.0..=500.0, trail.most_places, u16, "Largest number of places of the path of Smart RTL; 0 disables it"),
];

const TOLD_LOOPS: &[&str] = &["Roll rate", "Pitch rate", "Yaw rate", "Vertical acceleration"];
const CONE_ANGLES: &[(i32, &str)] = &[
    (0, "No cone: always the full height"),
    (25, "25 deg"),
    (45, "45 deg"),
    (65, "65 deg"),
    (80, "80 deg"),
    (90, "Only above home"),
];
const RETURN_GOALS: &[(ReturnGoal, i32, &str)] = &[
    (ReturnGoal::Nearest, 0, "Home or a rally point, whichever is nearer"),
    (ReturnGoal::RallyPoint, 1, "Nearest rally point, or else home"),
    (ReturnGoal::Mission, 2, "Along the mission to its landing, or back along it"),
    (ReturnGoal::NearestOfAll, 3, "Nearest of all places"),
    (ReturnGoal::MissionOrBack, 4, "Along the mission to its landing or back, whichever passes fewer items"),
    (ReturnGoal::RallyPointOnly, 5, "Nearest rally point"),
    (ReturnGoal::WithinReach, 6, "As 0: the remaining battery time is not known"),
];
const PX4_HEADINGS: &[(HeadingPolicy, i32, &str)] = &[
    (HeadingPolicy::NextPlace, 0, "Towards the waypoint"),
    (HeadingPolicy::Home, 1, "Towards home"),
    (HeadingPolicy::AwayFromHome, 2, "Away from home"),
    (HeadingPolicy::Travel, 3, "Along the trajectory"),
    (HeadingPolicy::NextPlaceFirst, 4, "Towards the waypoint, before a mission flies there"),
    (HeadingPolicy::Hold, 5, "Fixed"),
];
const ARDUPILOT_HEADINGS: &[(HeadingPolicy, i32, &str)] = &[
    (HeadingPolicy::Hold, 0, "Fixed"),
    (HeadingPolicy::NextPlace, 1, "Towards the next waypoint"),
    (HeadingPolicy::NextPlaceExceptReturn, 2, "Towards the next waypoint, except on a return"),
    (HeadingPolicy::Travel, 3, "Along the track"),
];
const ORBIT_HEADINGS: &[(OrbitHeading, i32, &str)] = &[
    (OrbitHeading::Centre, 0, "Towards the centre"),
    (OrbitHeading::Initial, 1, "As at the start"),
    (OrbitHeading::Free, 2, "Uncontrolled"),
    (OrbitHeading::Travel, 3, "Along the circle"),
    (OrbitHeading::Pilot, 4, "By the pilot"),
];
const FOLLOW_HEIGHTS: &[(FollowHeight, i32, &str)] = &[
    (FollowHeight::Home, 0, "Home"),
    (FollowHeight::Ground, 1, "Ground below"),
    (FollowHeight::Target, 2, "Target"),
];
const FOLLOW_HEADINGS: &[(FollowHeading, i32, &str)] = &[
    (FollowHeading::Hold, 0, "Fixed"),
    (FollowHeading::Target, 1, "Towards the target"),
    (FollowHeading::SameAsTarget, 2, "As the target"),
    (FollowHeading::Travel, 3, "Along the flight"),
];
const CIRCLE_OPTIONS: &[&str] = &[
    "Sticks change radius and rate",
    "Face along the circle",
    "Start at the centre",
    "Look at the centre with the mount",
];

const WAYS: &[(IntoWind, i32, &str)] = &[
    (IntoWind::OnlyOnTakeoff, -1, "Only on takeoffs"),
    (IntoWind::Off, 0, "Nothing"),
    (IntoWind::Nose, 1, "Nose"),
    (IntoWind::NoseOrTail, 2, "Nose or tail"),
    (IntoWind::Side, 3, "Side"),
    (IntoWind::Tail, 4, "Tail"),
];
const OTHER_WAYS: &[(Option<IntoWind>, i32, &str)] = &[
    (None, -1, "As elsewhere"),
    (Some(IntoWind::Off), 0, "Nothing"),
    (Some(IntoWind::Nose), 1, "Nose"),
    (Some(IntoWind::NoseOrTail), 2, "Nose or tail"),
    (Some(IntoWind::Side), 3, "Side"),
    (Some(IntoWind::Tail), 4, "Tail"),
];
const THROTTLE: &[&str] =
    &["Centred in its middle", "A high throttle cancels a landing", "A landing by hand disarms"];
const AUTO_OPTIONS: &[&str] = &[
    "Allow arming",
    "Take off without raising the throttle",
    "Ignore the pilot's yaw",
    "Reserved",
    "Reserved",
    "Reserved",
    "Reserved",
    "Allow weathervaning",
];

const RETURN_OPTIONS: &[&str] = &["Reserved", "Reserved", "Ignore the pilot's yaw"];

const MISSION_OPTIONS: &[&str] = &[
    "Clear the mission at a reboot",
    "Return by the landing if the battery does not last",
    "Continue after a landing",
    "Do not reset jump counters",
];

const GUIDED_OPTIONS: &[&str] = &[
    "Allow arming from the transmitter",
    "Reserved",
    "Ignore the pilot's yaw",
    "Thrust of SET_ATTITUDE_TARGET is thrust, not climb rate",
    "Do not stabilize the position",
    "Do not stabilize the velocity",
    "Waypoint navigation",
    "Allow weathervaning",
];

fn options(bits: u32) -> u8 {
    (bits & 0xff) as u8
}

#[cfg(test)]
mod tests {
    use super::{ARDUPILOT_MODE_PARAMETERS, PX4_MODE_PARAMETERS};
    use crate::vehicle::Conduct;

    #[test]
    fn what_is_written_is_read_again() {
        for (ardupilot, table) in [(false, PX4_MODE_PARAMETERS), (true, ARDUPILOT_MODE_PARAMETERS)] {
            for parameter in table {
                let default = (parameter.get)(&Conduct::new(ardupilot));
                assert!(
                    (parameter.minimum..=parameter.maximum).contains(&default),
                    "{} = {default}",
                    parameter.id
                );
                let mut taken = 0;
                for value in (-1..100).map(f64::from).chain([0.25, 0.75]) {
                    let mut conduct = Conduct::new(ardupilot);
                    if value < parameter.minimum || value > parameter.maximum {
                        continue;
                    }
                    if (parameter.set)(&mut conduct, value) {
                        let read = (parameter.get)(&conduct);
                        assert!((read - value).abs() < 1e-9, "{} = {value}: {read}", parameter.id);
                        taken += 1;
                    }
                }
                assert!(taken >= 2, "{}", parameter.id);
            }
        }
    }
}
