//! A pilot's radio: how pulses of its channels are read. What follows from them is the vehicle's matter.
//!
//! ```text
//!  channel    ends, trim, dead zone and direction of a channel; deflections
//!  switch     positions of switches, and when they count
//!  function   what a switch can do, by ArduPilot's numbers
//!  button     buttons on the vehicle that do the same
//!  knob       knobs that change a value in flight
//!  settings   all of it for one vehicle
//! ```

mod button;
mod channel;
mod function;
mod knob;
mod loss;
mod settings;
mod switch;

pub use button::{BUTTONS, Button, ButtonSettings};
pub use channel::Channel;
pub use function::{Function, GIMBAL_AXES, function};
pub use knob::{KNOBS, Knob, Knobs};
pub use loss::RadioLossAction;
pub use settings::{Axes, InputChoice, PX4_SLOTS, RadioFailure, RadioSettings, RudderArming, Switches};
pub use switch::{Debounced, Position, position, sixth};

/// Channels that are received at the most.
pub const CHANNELS: usize = 18;

/// A pulse in the middle, µs.
pub const MIDDLE_US: u16 = 1500;
