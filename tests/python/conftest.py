"""The FMU under test: the one that `cargo xtask test` has built, or LMPC_QUADROTOR_FMU."""

import os
from pathlib import Path

import pytest
from fmpy import extract, read_model_description

from slave import Slave

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def fmu() -> Path:
    path = Path(os.environ.get("LMPC_QUADROTOR_FMU", ROOT / "target" / "fmu" / "LmpcQuadrotor.fmu"))
    if not path.is_file():
        pytest.exit(f"{path} does not exist: run `cargo xtask fmu` first", returncode=2)
    return path


@pytest.fixture(scope="session")
def model_description(fmu):
    return read_model_description(str(fmu))


@pytest.fixture(scope="session")
def unzipped(fmu, tmp_path_factory) -> str:
    """Folder with the extracted FMU: simulating from it saves the extraction."""
    return extract(str(fmu), unzipdir=str(tmp_path_factory.mktemp("fmu")))


@pytest.fixture
def slave(unzipped, model_description):
    """Makes instances, and frees them after the test."""
    made = []

    def make(start_values: dict | None = None) -> Slave:
        """A new instance; ready to step if start values, which may be none at all, are given."""
        made.append(Slave(unzipped, model_description))
        return made[-1] if start_values is None else made[-1].initialize(start_values)

    yield make
    for instance in made:
        instance.free()
