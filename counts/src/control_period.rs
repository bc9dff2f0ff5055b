//! A period of the controllers.

use std::hint::black_box;

use quadrotor::Measurement;

use crate::simulated_second::under_way;

/// From one sample of the position controller to the next, µs: beside it samples the altitude controller once and the attitude
/// controller five times.
const PERIOD_US: u64 = 50_000;

/// Controls a vehicle under way that is always measured to be where it is.
pub fn run(times: u32) {
    let (simulation, inputs) = under_way();
    let state = simulation.plant_state();
    let mut measured = Measurement { motion: state.body, rotor_speed_rad_s: state.rotor_speed_rad_s };
    let end_us = simulation.time_us() + PERIOD_US;
    for _ in 0..times {
        let mut control = simulation.control().clone();
        let command = control.advance_to(black_box(end_us), &inputs.control(), &mut measured);
        black_box(command.expect("the inputs are finite"));
    }
}
