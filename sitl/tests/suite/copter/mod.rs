//! What ArduCopter's own test suite flies, in our words: the same parameters, sticks, commands and bars.

mod arming;
mod fences;
mod flier;
mod missions;
mod modes;
mod proximity;
mod sticks;
mod switches;
mod wind;
