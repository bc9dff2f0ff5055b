//! The numbers of the commands of plans (MAV_CMD).

pub const NAV_WAYPOINT: u16 = 16;
pub const NAV_LOITER_UNLIM: u16 = 17;
pub const NAV_LOITER_TURNS: u16 = 18;
pub const NAV_LOITER_TIME: u16 = 19;
pub const NAV_RETURN_TO_LAUNCH: u16 = 20;
pub const NAV_LAND: u16 = 21;
pub const NAV_TAKEOFF: u16 = 22;
pub const NAV_LOITER_TO_ALT: u16 = 31;
pub const NAV_ROI: u16 = 80;
pub const NAV_SPLINE_WAYPOINT: u16 = 82;
pub const NAV_VTOL_TAKEOFF: u16 = 84;
pub const NAV_VTOL_LAND: u16 = 85;
pub const NAV_GUIDED_ENABLE: u16 = 92;
pub const NAV_DELAY: u16 = 93;
pub const NAV_PAYLOAD_PLACE: u16 = 94;
pub const CONDITION_DELAY: u16 = 112;
pub const CONDITION_DISTANCE: u16 = 114;
pub const CONDITION_YAW: u16 = 115;
pub const DO_JUMP: u16 = 177;
pub const DO_CHANGE_SPEED: u16 = 178;
pub const DO_SET_HOME: u16 = 179;
pub const DO_SET_RELAY: u16 = 181;
pub const DO_REPEAT_RELAY: u16 = 182;
pub const DO_SET_SERVO: u16 = 183;
pub const DO_REPEAT_SERVO: u16 = 184;
pub const DO_SET_ACTUATOR: u16 = 187;
pub const DO_RETURN_PATH_START: u16 = 188;
pub const DO_LAND_START: u16 = 189;
pub const DO_SET_REVERSE: u16 = 194;
pub const DO_SET_ROI_LOCATION: u16 = 195;
pub const DO_SET_ROI_WPNEXT_OFFSET: u16 = 196;
pub const DO_SET_ROI_NONE: u16 = 197;
pub const DO_CONTROL_VIDEO: u16 = 200;
pub const DO_SET_ROI: u16 = 201;
pub const DO_DIGICAM_CONFIGURE: u16 = 202;
pub const DO_DIGICAM_CONTROL: u16 = 203;
pub const DO_MOUNT_CONFIGURE: u16 = 204;
pub const DO_MOUNT_CONTROL: u16 = 205;
pub const DO_SET_CAM_TRIGG_DIST: u16 = 206;
pub const DO_FENCE_ENABLE: u16 = 207;
pub const DO_PARACHUTE: u16 = 208;
pub const DO_INVERTED_FLIGHT: u16 = 210;
pub const DO_GRIPPER: u16 = 211;
pub const DO_AUTOTUNE_ENABLE: u16 = 212;
pub const DO_SET_CAM_TRIGG_INTERVAL: u16 = 214;
pub const DO_SET_RESUME_REPEAT_DIST: u16 = 215;
pub const DO_SPRAYER: u16 = 216;
pub const DO_SEND_SCRIPT_MESSAGE: u16 = 217;
pub const DO_AUX_FUNCTION: u16 = 218;
pub const DO_GUIDED_LIMITS: u16 = 222;
pub const DO_ENGINE_CONTROL: u16 = 223;
pub const OBLIQUE_SURVEY: u16 = 260;
pub const SET_CAMERA_MODE: u16 = 530;
pub const SET_CAMERA_ZOOM: u16 = 531;
pub const SET_CAMERA_FOCUS: u16 = 532;
pub const SET_CAMERA_SOURCE: u16 = 534;
pub const JUMP_TAG: u16 = 600;
pub const DO_JUMP_TAG: u16 = 601;
pub const DO_GIMBAL_MANAGER_PITCHYAW: u16 = 1000;
pub const DO_GIMBAL_MANAGER_CONFIGURE: u16 = 1001;
pub const IMAGE_START_CAPTURE: u16 = 2000;
pub const IMAGE_STOP_CAPTURE: u16 = 2001;
pub const DO_TRIGGER_CONTROL: u16 = 2003;
pub const VIDEO_START_CAPTURE: u16 = 2500;
pub const VIDEO_STOP_CAPTURE: u16 = 2501;
pub const DO_VTOL_TRANSITION: u16 = 3000;
pub const CONDITION_GATE: u16 = 4501;
pub const NAV_FENCE_RETURN_POINT: u16 = 5000;
pub const NAV_FENCE_POLYGON_VERTEX_INCLUSION: u16 = 5001;
pub const NAV_FENCE_POLYGON_VERTEX_EXCLUSION: u16 = 5002;
pub const NAV_FENCE_CIRCLE_INCLUSION: u16 = 5003;
pub const NAV_FENCE_CIRCLE_EXCLUSION: u16 = 5004;
pub const NAV_FENCE_HOME_CIRCLE_INCLUSION: u16 = 5005;
pub const NAV_RALLY_POINT: u16 = 5100;
pub const NAV_SCRIPT_TIME: u16 = 42702;
pub const DO_WINCH: u16 = 42600;
pub const AIRFRAME_CONFIGURATION: u16 = 2520;

/// Commands of fences.
pub(super) const FENCE_COMMANDS: [u16; 6] = [
    NAV_FENCE_RETURN_POINT,
    NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
    NAV_FENCE_CIRCLE_INCLUSION,
    NAV_FENCE_CIRCLE_EXCLUSION,
    NAV_FENCE_HOME_CIRCLE_INCLUSION,
];
