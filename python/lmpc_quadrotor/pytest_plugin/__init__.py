"""A pytest plugin: the fixtures `sitl` and `sitl_factory` start a simulated MAVLink vehicle for a test and end it.

Loaded by pytest when the package is installed. It imports no MAVLink library. Tests with annotations take the types from here: `Sitl`
is what `sitl` gives, `SitlFactory` what `sitl_factory` gives.
"""

from .options import pytest_addoption, pytest_configure
from .plugin import SitlFactory, pytest_runtest_makereport, sitl, sitl_factory
from .vehicle import Sitl, SitlError

__all__ = [
    "Sitl",
    "SitlError",
    "SitlFactory",
    "pytest_addoption",
    "pytest_configure",
    "pytest_runtest_makereport",
    "sitl",
    "sitl_factory",
]
