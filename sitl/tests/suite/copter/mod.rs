//! What ArduCopter's own test suite flies, in our words: the same parameters, sticks, commands and bars.

mod arming;
mod auto_start;
mod boot;
mod equipment;
mod estimation;
mod fences;
mod flier;
mod gps_input;
mod guided;
mod knobs;
mod missions;
mod modes;
mod payload;
mod pilot;
mod precision;
mod proximity;
mod sticks;
mod surface;
mod switches;
mod telemetry;
mod wind;
