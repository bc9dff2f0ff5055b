//! What ArduCopter's own test suite flies, in our words: the same parameters, sticks, commands and bars.

mod arming;
mod equipment;
mod estimation;
mod fences;
mod flier;
mod missions;
mod modes;
mod precision;
mod proximity;
mod sticks;
mod switches;
mod wind;
