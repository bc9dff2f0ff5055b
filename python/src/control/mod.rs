//! The crate `lmpc` on NumPy arrays.

mod bases;
mod controllers;
mod designs;
mod kalman;
mod law;
mod limits;
mod matrices;
mod models;
mod padding;

use pyo3::prelude::*;

/// Puts the classes and functions into the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<models::StateSpace>()?;
    module.add_class::<bases::LaguerreBasis>()?;
    module.add_class::<designs::Dlqr>()?;
    module.add_class::<designs::LmpcDesign>()?;
    module.add_class::<designs::StabilizedDesign>()?;
    module.add_class::<designs::StateSpaceMpcDesign>()?;
    module.add_class::<kalman::KalmanDesign>()?;
    module.add_class::<kalman::KalmanPredictor>()?;
    module.add_class::<limits::Limit>()?;
    module.add_class::<limits::SignalLimit>()?;
    module.add_class::<controllers::Controller>()?;
    module.add_class::<controllers::Step>()?;
    matrices::register(module)
}
