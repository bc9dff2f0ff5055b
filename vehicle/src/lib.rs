//! A simulated quadrotor that can be flown: modes, arming, missions, fences, failsafes, faults and an estimator over the closed
//! loop of [`quadrotor`]. It speaks no protocol, owns no socket and reads no clock: requests in SI units and ticks of
//! simulation time go in, motion and notices come out.
//!
//! ```text
//!  world        local frame, air, wind, magnetic field
//!  fence        areas, and the ways around them
//!  radio        how a pilot's radio is read
//!  plan         missions, fences and rally points: items, their checks and files, and the typed steps made from them
//!  fault        what is broken
//!  surroundings what stands and flies around
//!  equipment    servos, relays, gripper, camera and gimbal
//!  estimation   instruments and the estimator
//!  mode         flight modes; mode_table has their numbers and names
//!  identity     whose conventions the vehicle follows: PX4's, ArduPilot's or none
//!  vehicle      the state machines over the closed loop, and the place that decides between them
//!  foreign      a closed loop or a plant from elsewhere, in place of ours
//!  parameters   all settings by their identifiers
//!  designs      controllers that were designed already
//! ```

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod absent_mode;
mod designs;
pub mod equipment;
pub mod estimation;
pub mod fault;
pub mod fence;
mod flight_error;
pub mod foreign;
pub mod identity;
pub mod kept;
mod mode;
mod mode_table;
pub mod parameters;
pub mod plan;
pub mod radio;
pub mod surroundings;
mod vehicle;
pub mod world;

pub use absent_mode::AbsentMode;
pub use flight_error::FlightError;
pub use mode::{Leader, Mode, Needs};
pub use vehicle::{
    Action, ArmingObstacle, ArmingSubject, AttitudeSetPoint, AxisTarget, BasicId, Battery, BatteryActions,
    BatteryLimits, BatteryPack, BeaconBeam, Cause, ChangeError, Conduct, Encounter, Failsafe,
    FailsafeSettings, FenceOptions, FenceParts, FenceRecord, FenceStart, FlightTimes, FollowHeading,
    FollowHeight, FollowSettings, GroupRates, HeadingPolicy, Home, LandedState, LogConduct, MissionState,
    MissionStatus, MotorTest, Notice, ObstacleWatch, OperatorId, OperatorPlace, OrbitHeading, OrbitRequest,
    OrbitSettings, OrbitStatus, Pilot, PlannedLeg, PositionSetPoint, PrecisionLanding, PrecisionSettings,
    Pulses, Recovery, Refusal, RemoteId, Reposition, ReturnGoal, ReturnSettings, SelfId, SetPoint, Severity,
    Sighting, Simulated, SteeringKind, StickSettings, Sticks, StreamRates, Surface, SurfaceSettings,
    SurroundingsSettings, TICK_S, TICK_US, TargetReport, Threat, TrackedAttitude, Tracking, TrafficSettings,
    TrafficWatch, TrailSettings, Trainer, Vehicle, VehicleSettings, Weakness, YawTarget, wrapped,
};
