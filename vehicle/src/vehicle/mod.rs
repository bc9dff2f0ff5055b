//! The vehicle: state machines over the closed loop. It takes requests in SI units and simulation time.
//!
//! ```text
//!              arm                     take_off / set-point up / stick up
//!  disarmed ─────────► armed, idling ─────────────────────────────────────► flying
//!     ▲   ◄───────────  on the ground  ◄────────────────────────────────────  │
//!     │     disarm, or nothing         touched down                           │
//!     │     happens for a while                                               │
//!     └───────────────────────── forced disarm ───────────────────────────────┘
//!
//!  flying:  Takeoff ──reached──► Hold (ArduPilot: Offboard)
//!           Offboard ──set-points lost──► Hold, Land, Return or Position, as the parameter says
//!           Mission ──last item done──► Hold
//!           Return ──home reached──► descends ──touched down──► disarms
//!           Land ──touched down──► disarms
//!           any ──a rotor lost──► Land, spinning ──touched down──► disarms
//! ```
//!
//! Each machine owns its state, is shown a read-only situation and asks for what it wants in a proposal. None sees another one. One
//! place decides (`state/decision.rs`):
//!
//! ```text
//!  state: situation ──► machine ──► proposal ──► decision: shared state, events of other machines
//! ```
//!
//! The order of a tick:
//!
//! ```text
//!  autostart        arms and starts the mission, if it was asked to
//!  injection        faults that are due
//!  fence watch      breaches, present and predicted
//!  failsafe         cause by cause
//!  while armed      the machine of the mode (takeoff, manual control, offboard, return, mission),
//!                   or the rotor watch while a rotor is lost; then what waits: lost set-points, disarming
//!  closed loop      flies as the steering says; perception looks at the motion
//!  afterwards       rotor watch, hold watch, battery, touch-down and lift-off
//! ```

mod arming_obstacle;
mod autostart;
mod battery;
mod battery_pack;
mod change_error;
mod closed_loop;
mod commanded_turn;
mod conduct;
mod crash_settings;
mod crash_watch;
mod decided;
mod descent;
mod failsafe;
mod failsafe_watch;
mod fence_watch;
mod foreign_flight;
mod hold_watch;
mod home;
mod injection;
mod landed;
mod landing;
mod limit_release;
mod log_conduct;
mod machines;
mod manual_control;
mod mission;
mod motion;
mod motor_test;
mod notice;
mod offboard;
mod path_steering;
mod perception;
mod plans;
mod proposal;
mod reference_guide;
mod region;
mod reposition;
mod return_home;
mod rotor_watch;
#[cfg(test)]
mod scene;
mod set_point;
mod settings;
mod setup;
mod simulated;
mod situation;
mod speeds;
mod state;
mod steering;
mod sticks;
mod takeoff;
mod tick;
mod trajectory;
mod turning;

pub use arming_obstacle::{ArmingObstacle, ArmingSubject};
pub use battery::Battery;
pub use battery_pack::BatteryPack;
pub use change_error::ChangeError;
pub use conduct::Conduct;
pub use failsafe::{
    Action, BatteryActions, BatteryLimits, Cause, Failsafe, FailsafeSettings, FenceOptions, FenceParts,
};
pub use fence_watch::FenceRecord;
pub use home::Home;
pub use landed::LandedState;
pub use log_conduct::LogConduct;
pub use mission::{MissionState, MissionStatus};
pub use motion::wrapped;
pub use motor_test::MotorTest;
pub use notice::{Notice, Refusal, Severity};
pub use reposition::Reposition;
pub use set_point::{AttitudeSetPoint, AxisTarget, PositionSetPoint, SetPoint, YawTarget};
pub use settings::VehicleSettings;
pub use simulated::{Simulated, WIND_FROM_DEG};
pub use state::Vehicle;
pub use steering::{SteeringKind, TrackedAttitude};
pub use sticks::Sticks;
pub use tick::TICK_US;
