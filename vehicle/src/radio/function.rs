//! What a switch can do, by ArduPilot's numbers (RCn_OPTION, MAV_CMD_DO_AUX_FUNCTION).

/// What a switch does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Enters a mode, by ArduPilot's number, and leaves it for that of the mode switch.
    Mode(u32),
    /// Marks the ends of the zigzag mode, and flies across to them.
    ZigZagEnd,
    /// Adds the place to the mission.
    SaveWaypoint,
    /// Lets the mission begin anew.
    ResetMission,
    /// Removes the mission.
    ClearMission,
    /// Switches the fence.
    Fence,
    /// Stops the rotors.
    EmergencyStop,
    /// Arms and disarms.
    Arming,
    /// Arms at the high end, and stops the rotors at the low one.
    ArmingOrStop,
    /// Disarms.
    Disarming,
    /// Lets sticks refer to the heading of arming.
    Simple,
    /// The same in the middle, and at the high end to the direction away from home.
    SuperSimple,
    /// Switches the downward rangefinder.
    Rangefinder,
    /// Switches the distance that is kept from what is measured around.
    Proximity,
    /// Switches what is done about traffic.
    Traffic,
    /// Chooses the surface whose distance is kept: the ground at the low end, none in the middle.
    SurfaceTracking,
    /// Switches a relay, counted from 0.
    Relay(u8),
    /// Grabs and releases.
    Gripper,
    /// Takes an image.
    Image,
    /// Records a video.
    Video,
    /// Folds the gimbal away.
    RetractGimbal,
    /// Locks the gimbal on the place that it sees.
    LockGimbal,
    /// Moves the landing gear.
    LandingGear,
    /// Takes what a ground station sends in place of the radio's pulses, or not.
    Overrides,
    /// Lets the parachute open.
    ParachuteEnable,
    /// Releases it.
    ParachuteRelease,
    /// Both, and at the low end neither.
    Parachute,
    /// Lets Loiter stay above the target that is seen.
    PrecisionLoiter,
    /// Chooses the set of sources that the estimator uses.
    SourceSet,
}

/// Numbers that there are.
const FUNCTIONS: &[(u32, Function)] = &[
    (2, Function::Mode(14)),
    (3, Function::Simple),
    (4, Function::Mode(6)),
    (7, Function::SaveWaypoint),
    (9, Function::Image),
    (10, Function::Rangefinder),
    (11, Function::Fence),
    (13, Function::SuperSimple),
    (16, Function::Mode(3)),
    (17, Function::Mode(15)),
    (18, Function::Mode(9)),
    (19, Function::Gripper),
    (21, Function::ParachuteEnable),
    (22, Function::ParachuteRelease),
    (23, Function::Parachute),
    (24, Function::ResetMission),
    (27, Function::RetractGimbal),
    (28, Function::Relay(0)),
    (29, Function::LandingGear),
    (31, Function::EmergencyStop),
    (33, Function::Mode(17)),
    (34, Function::Relay(1)),
    (35, Function::Relay(2)),
    (36, Function::Relay(3)),
    (37, Function::Mode(18)),
    (38, Function::Traffic),
    (39, Function::PrecisionLoiter),
    (40, Function::Proximity),
    (41, Function::Arming),
    (42, Function::Mode(21)),
    (46, Function::Overrides),
    (52, Function::Mode(1)),
    (55, Function::Mode(4)),
    (56, Function::Mode(5)),
    (57, Function::Mode(23)),
    (58, Function::ClearMission),
    (60, Function::Mode(24)),
    (61, Function::ZigZagEnd),
    (66, Function::Relay(4)),
    (67, Function::Relay(5)),
    (68, Function::Mode(0)),
    (69, Function::Mode(16)),
    (70, Function::Mode(2)),
    (71, Function::Mode(22)),
    (72, Function::Mode(7)),
    (73, Function::Mode(11)),
    (75, Function::SurfaceTracking),
    (81, Function::Disarming),
    (90, Function::SourceSet),
    (99, Function::Mode(27)),
    (153, Function::Arming),
    (154, Function::Arming),
    (165, Function::ArmingOrStop),
    (166, Function::Video),
    (186, Function::LockGimbal),
];

/// Numbers of channels that are no switches, but point the gimbal: roll, pitch, yaw.
pub const GIMBAL_AXES: [u32; 3] = [212, 213, 214];

impl Function {
    /// Whether it counts where a switch with it is found at first.
    pub fn counts_at_first(self) -> bool {
        matches!(self, Self::ParachuteEnable | Self::Parachute)
    }
}

/// The function of a number; `None`: there is none.
pub fn function(number: u32) -> Option<Function> {
    FUNCTIONS.iter().find(|(known, _)| *known == number).map(|(_, function)| *function)
}
