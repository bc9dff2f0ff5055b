//! A first-order lag as an FMI library: the second model of the tests.

#![forbid(unsafe_code)]

mod model;

fmi::export_fmi2!(model::Lag);
