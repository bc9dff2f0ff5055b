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
//!  afterwards       battery, contacts, rotor watch, hold watch, crash watch, touch-down and lift-off
//! ```

mod arming_obstacle;
mod arming_settings;
mod attitude_flight;
mod autostart;
mod battery;
mod battery_pack;
mod boot_fault;
mod button_watch;
mod change_error;
mod circle;
mod circle_pilot;
mod closed_loop;
mod commanded_turn;
mod conduct;
mod crash_settings;
mod crash_watch;
mod decided;
mod descent;
mod failsafe;
mod failsafe_response;
mod failsafe_watch;
mod fence_keeping;
mod fence_margin;
mod fence_watch;
mod flight_times;
mod flip;
mod follow;
mod follow_place;
mod follow_settings;
mod foreign_flight;
mod ground_flight;
mod ground_stations;
mod ground_way;
mod guided_heading;
mod heading_policy;
mod height_hold;
mod hold_watch;
mod home;
mod injection;
mod landed;
mod landing;
mod landing_pilot;
mod lasting;
mod limit_release;
mod log_conduct;
mod machines;
mod manual_control;
mod mission;
mod mission_heading;
mod mission_return;
mod motion;
mod motor_test;
mod notice;
mod obstacle_watch;
mod offboard;
mod orbit;
mod orbit_request;
mod parachute_watch;
mod path_steering;
mod perception;
mod pilot_takeoff;
mod pilot_turn;
mod pilot_watch;
mod plans;
mod precision_landing;
mod precision_settings;
mod proposal;
mod proximity_keeping;
mod pushes;
mod receiver;
mod reference_guide;
mod region;
mod remote_id;
mod reposition;
mod return_goals;
mod return_height;
mod return_home;
mod return_settings;
mod rotor_watch;
mod safety_switch;
#[cfg(test)]
mod scene;
mod set_point;
mod settings;
mod setup;
mod simple_flight;
mod simulated;
mod situation;
mod smart_return;
mod speed_choice;
mod speed_settings;
mod speeds;
mod spline;
mod state;
mod steering;
mod stick_climb;
mod stick_flight;
mod stick_settings;
mod sticks;
mod stream_rates;
mod streamed_motion;
mod surface_tracking;
mod surroundings_settings;
mod takeoff;
mod takeoff_check;
mod takeoff_consent;
mod target;
mod terrain_watch;
mod throw;
mod tick;
mod traffic_watch;
mod trail;
mod trajectory;
mod turning;
mod vibration_watch;
mod weathervane;
mod zigzag;

pub use arming_obstacle::{ArmingObstacle, ArmingSubject};
pub use battery::Battery;
pub use battery_pack::BatteryPack;
pub use change_error::ChangeError;
pub use conduct::Conduct;
pub use failsafe::{
    Action, BatteryActions, BatteryLimits, Cause, Failsafe, FailsafeSettings, FenceDatum, FenceOptions,
    FenceParts, FenceStart, Weakness,
};
pub use fence_watch::FenceRecord;
pub use flight_times::FlightTimes;
pub use follow_settings::{FollowHeading, FollowHeight, FollowSettings};
pub use heading_policy::HeadingPolicy;
pub use home::Home;
pub use landed::LandedState;
pub use log_conduct::LogConduct;
pub use mission::{MissionState, MissionStatus, PlannedLeg};
pub use motion::wrapped;
pub use motor_test::MotorTest;
pub use notice::{Notice, Refusal, Severity};
pub use obstacle_watch::ObstacleWatch;
pub use orbit_request::{OrbitHeading, OrbitRequest, OrbitSettings, OrbitStatus};
pub use precision_landing::{PrecisionLanding, Sighting};
pub use precision_settings::{BeaconBeam, PrecisionSettings};
pub use receiver::{Pilot, Pulses};
pub use remote_id::{BasicId, OperatorId, OperatorPlace, RemoteId, SelfId};
pub use reposition::Reposition;
pub use return_settings::{ReturnGoal, ReturnSettings};
pub use set_point::{AttitudeSetPoint, AxisTarget, PositionSetPoint, SetPoint, YawTarget};
pub use settings::VehicleSettings;
pub use simulated::{Simulated, WIND_FROM_DEG};
pub(crate) use speeds::LEAST_SPEED_M_S;
pub use state::Vehicle;
pub use steering::{SteeringKind, TrackedAttitude};
pub use stick_settings::{StickSettings, Trainer};
pub use sticks::Sticks;
pub use stream_rates::{GroupRates, StreamRates};
pub use surface_tracking::{Surface, SurfaceSettings, Tracking};
pub use surroundings_settings::{Recovery, SurroundingsSettings, TrafficSettings};
pub use target::TargetReport;
pub use tick::{TICK_S, TICK_US};
pub use traffic_watch::{Encounter, Threat, TrafficWatch};
pub use trail::TrailSettings;
pub use weathervane::IntoWind;
