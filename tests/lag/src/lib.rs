//! Models of the tests in one FMI library: a first-order lag, with a variable of each kind, and an oscillator, which has vectors.

#![forbid(unsafe_code)]

mod model;
mod oscillator;

fmi::export_fmi2!(model::Lag, oscillator::Oscillator);
fmi::export_fmi3!(model::Lag, oscillator::Oscillator);
