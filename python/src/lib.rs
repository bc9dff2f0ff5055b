//! The native module of the Python package `lmpc-quadrotor`: the control library and the engine on NumPy arrays.
//!
//! `control` has the crate `lmpc`, `flight` the crate `quadrotor`. What is done with arrays, names and files in Python is beside it, in
//! `python/lmpc_quadrotor`.

mod arguments;
mod arrays;
mod control;
mod errors;
mod flight;
mod interruption;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::register(module)?;
    control::register(module)?;
    flight::register(module)
}
