"""Tests of the installed Python package, run where no source of it can be imported: `cargo xtask test` installs the wheel."""

import os
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]


@pytest.fixture(scope="session")
def repository() -> Path:
    """Where book and examples are."""
    return Path(os.environ.get("LMPC_QUADROTOR_ROOT", Path(__file__).resolve().parents[3]))
