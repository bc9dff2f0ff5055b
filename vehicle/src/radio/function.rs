//! What a switch can do, by ArduPilot's numbers (RCn_OPTION, MAV_CMD_DO_AUX_FUNCTION).

/// What a switch does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Enters a mode, by ArduPilot's number, and leaves it for that of the mode switch.
    Mode(u32),
    /// Adds the place to the mission.
    SaveWaypoint,
    /// Switches the fence.
    Fence,
    /// Stops the rotors.
    EmergencyStop,
    /// Arms and disarms.
    Arming,
}

/// Numbers that there are.
const FUNCTIONS: &[(u32, Function)] = &[
    (2, Function::Mode(14)),
    (4, Function::Mode(6)),
    (7, Function::SaveWaypoint),
    (11, Function::Fence),
    (16, Function::Mode(3)),
    (17, Function::Mode(15)),
    (18, Function::Mode(9)),
    (31, Function::EmergencyStop),
    (33, Function::Mode(17)),
    (37, Function::Mode(18)),
    (41, Function::Arming),
    (42, Function::Mode(21)),
    (52, Function::Mode(1)),
    (55, Function::Mode(4)),
    (56, Function::Mode(5)),
    (57, Function::Mode(23)),
    (68, Function::Mode(0)),
    (69, Function::Mode(16)),
    (70, Function::Mode(2)),
    (72, Function::Mode(7)),
    (73, Function::Mode(11)),
    (153, Function::Arming),
    (154, Function::Arming),
];

/// The function of a number; `None`: there is none.
pub fn function(number: u32) -> Option<Function> {
    FUNCTIONS.iter().find(|(known, _)| *known == number).map(|(_, function)| *function)
}
