//! The controllers alone, with the plant of the engine and with the plant as a model.

mod delayed;
mod master;
mod model;
mod wired;
