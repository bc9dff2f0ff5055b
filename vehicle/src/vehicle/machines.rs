//! The machines that the vehicle consists of, each with a state of its own.

use super::autostart::Autostart;
use super::battery::Battery;
use super::failsafe::Failsafe;
use super::fence_watch::FenceWatch;
use super::hold_watch::HoldWatch;
use super::injection::Injection;
use super::landing::Landing;
use super::manual_control::ManualControl;
use super::mission::Mission;
use super::obstacle_watch::ObstacleWatch;
use super::offboard::Offboard;
use super::remote_id::RemoteId;
use super::return_home::Return;
use super::rotor_watch::RotorWatch;
use super::speeds::Speeds;
use super::takeoff::Takeoff;
use super::traffic_watch::TrafficWatch;

/// All machines. None sees another one: each is shown a situation and asks in a proposal.
#[derive(Debug)]
pub struct Machines {
    /// The start of the mission without a pilot.
    pub autostart: Autostart,
    /// What is broken.
    pub injection: Injection,
    /// The battery.
    pub battery: Battery,
    /// Breaches of the fence.
    pub fence: FenceWatch,
    /// Failsafes.
    pub failsafe: Failsafe,
    /// The rotors, and the descent without one.
    pub rotors: RotorWatch,
    /// Whether the position can be held.
    pub hold: HoldWatch,
    /// Touch-down and lift-off.
    pub landing: Landing,
    /// Takeoffs.
    pub takeoff: Takeoff,
    /// Sticks.
    pub manual_control: ManualControl,
    /// Set-points.
    pub offboard: Offboard,
    /// The way home.
    pub return_home: Return,
    /// The mission.
    pub mission: Mission,
    /// What stands around.
    pub obstacles: ObstacleWatch,
    /// What flies around.
    pub traffic: TrafficWatch,
    /// What it tells of itself.
    pub remote_id: RemoteId,
    /// Speeds that hold instead of the parameters'.
    pub speeds: Speeds,
}
