"""A pytest plugin: the fixtures `sitl` and `sitl_factory` start a simulated MAVLink vehicle for a test and end it.

Loaded by pytest when the package is installed. It imports neither NumPy nor a MAVLink library.
"""

from .options import pytest_addoption, pytest_configure
from .plugin import pytest_runtest_makereport, sitl, sitl_factory

__all__ = ["pytest_addoption", "pytest_configure", "pytest_runtest_makereport", "sitl", "sitl_factory"]
