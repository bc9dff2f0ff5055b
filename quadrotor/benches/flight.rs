//! Cost of the closed loop: one simulated second, one observation, one redesign.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use quadrotor::{CascadeDesign, Configuration, Inputs, Simulation};

fn flight(criterion: &mut Criterion) {
    let configuration = Configuration::default();
    let inputs = Inputs::default();
    let start = Simulation::new(&configuration, &inputs).expect("the defaults are valid");
    criterion.bench_function("one simulated second", |bencher| {
        bencher.iter(|| {
            let mut simulation = start.clone();
            simulation.advance_to(black_box(1_000_000), &inputs).expect("a flight");
            simulation
        });
    });
    criterion.bench_function("outputs", |bencher| bencher.iter(|| black_box(&start).outputs()));
    criterion.bench_function("design of the cascade", |bencher| {
        bencher.iter(|| CascadeDesign::new(black_box(&configuration)));
    });
}

criterion_group!(benches, flight);
criterion_main!(benches);
