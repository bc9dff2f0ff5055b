"""A stranger's machine: a Python environment with nothing but what the README says to install, in which its programs run as printed."""

import re
import subprocess
import venv
from pathlib import Path

import documents
import pytest

from test_readme_flights import Stand, group_of

# One environment serves all of them.
pytestmark = pytest.mark.alone

ROOT = Path(__file__).resolve().parents[3]
# Only the versions are pinned: what is installed is what the README names.
PINNED = [ROOT / "xtask" / "python" / name for name in ("demo.txt", "requirements.txt")]


def packages(page: str) -> list[str]:
    """What a page says to install."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return sorted({name.strip('"') for line in re.findall(r"pip install ([^`\n]+)", text) for name in line.split()})


@pytest.fixture(scope="module")
def python(tmp_path_factory) -> Path:
    """An interpreter for which the README's packages were installed."""
    folder = tmp_path_factory.mktemp("stranger")
    venv.create(folder, with_pip=True)
    interpreter = folder / "bin" / "python"
    constraints = folder / "versions.txt"
    pins = (line for file in PINNED for line in file.read_text(encoding="utf-8").splitlines() if "==" in line)
    constraints.write_text("\n".join(pins))
    subprocess.run([interpreter, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--prefer-binary",
                    "--constraint", constraints, *packages("README.md")], check=True, timeout=300)
    return interpreter


def test_the_readme_names_its_packages():
    assert packages("README.md") == ["fmpy", "pymavlink"]


def test_the_program_with_the_fmu(python, fmu, tmp_path):
    (block,) = (block for block in documents.of("python", "fmpy") if block.file == "README.md")
    (tmp_path / "LmpcQuadrotor.fmu").symlink_to(fmu)
    done = subprocess.run([python, "-c", block.text], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "warn" not in (done.stdout + done.stderr).lower(), done
    documents.check_output(block, done.stdout)


def test_the_program_that_flies_the_vehicle(python, start):
    (block,) = (block for block in documents.of("python", "pymavlink") if block.file == "README.md")
    Stand(start, group_of(block)).fly(block, python)
