//! The crate `quadrotor` on NumPy arrays: flights and batches of flights, by the names of the FMU's variables.

mod actuation;
mod commands;
mod fleet;
mod inputs;
mod outputs;
mod parameters;
mod saved;
mod simulation;
mod suggestion;
mod vehicle;

use pyo3::prelude::*;

/// Puts the classes and functions into the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<fleet::Fleet>()?;
    module.add_function(wrap_pyfunction!(parameters::parameters, module)?)?;
    module.add_function(wrap_pyfunction!(inputs::inputs, module)?)?;
    module.add_function(wrap_pyfunction!(outputs::outputs, module)?)
}
