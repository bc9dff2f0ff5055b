//! The plant alone, as the simulator of an external autopilot.
//!
//! ```text
//!                 HIL_SENSOR 250 Hz, HIL_GPS 10 Hz, HIL_STATE_QUATERNION
//!   autopilot ◄──────────────────────────────────────────────────────── rig: rotors, rigid body, instruments
//!   (TCP client)────────────────────────────────────────────────────► (TCP server)
//!                 HIL_ACTUATOR_CONTROLS
//! ```
//!
//! Until the first controls come, simulation time runs at the asked pace and no faster than the wall clock, for an
//! autopilot's start needs it to pass. From then on autopilot and plant are in lock-step, if the controls say so: a step
//! is made when the controls for the sensors of the step before have come.

mod actuator_controls;
mod client;
mod instruments;
mod messages;
mod mount;
mod mounting;
mod rig;
mod settings;
mod simulator;

pub use actuator_controls::ActuatorControls;
pub use mount::Mount;
pub use rig::{Rig, STEP_US};
pub use settings::HilSettings;
pub use simulator::Simulator;
