//! Flights by what a motion capture system sees of the true motion.

mod ardupilot;
mod camera;
mod nonsense;
mod px4;
mod refusals;
