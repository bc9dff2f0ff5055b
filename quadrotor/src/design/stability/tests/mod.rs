//! The judgement held against nonlinear flights, of configurations that it refuses as well.

mod flight;
mod ranges;
mod small_signals;
mod spread;
