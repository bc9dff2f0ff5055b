"""A quadrotor under a cascade of Laguerre model predictive controllers.

* `Simulation` and `Fleet` fly one vehicle, or many side by side, and give flights as NumPy arrays.
* `lmpc_quadrotor.control` designs controllers for your own linear plant.
* `lmpc_quadrotor.gym` has Gymnasium environments.
* `fmu_path()` finds the FMUs for FMPy; `sitl_path()` the program `lmpc-sitl`, the vehicle on MAVLink.
* A pytest plugin gives the fixtures `sitl` and `sitl_factory`.

World frame NED (north, east, down), body frame FRD (forward, right, down), SI units, angles in rad; altitude is minus z.
"""

from . import control
from ._native import ArgumentError, DesignError, FlightError, ParameterError, __version__, inputs, outputs, parameters
from .files import fmu_path, sitl_path
from .fleet import Fleet
from .simulation import Simulation

__all__ = [
    "ArgumentError",
    "DesignError",
    "Fleet",
    "FlightError",
    "ParameterError",
    "Simulation",
    "__version__",
    "control",
    "fmu_path",
    "inputs",
    "outputs",
    "parameters",
    "sitl_path",
]
