//! A second of the closed loop.

use std::hint::black_box;

use quadrotor::{Configuration, Inputs, Simulation};

/// The paper's flight one second after its start: under way, tilted, towards a goal.
pub fn under_way() -> (Simulation, Inputs) {
    let inputs = Inputs::default();
    let mut simulation = Simulation::new(&Configuration::default(), &inputs).expect("the defaults fly");
    simulation.advance_to(1_000_000, &inputs).expect("the flight goes on");
    (simulation, inputs)
}

/// Flies its second second.
pub fn run(times: u32) {
    let (start, inputs) = under_way();
    for _ in 0..times {
        let mut simulation = start.clone();
        simulation.advance_to(black_box(2_000_000), &inputs).expect("the flight goes on");
        black_box(&simulation);
    }
}
