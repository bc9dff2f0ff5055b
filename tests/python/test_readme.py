"""The README's Python code runs as it is printed."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

README = Path(__file__).resolve().parents[2] / "README.md"


def test_python_code_of_the_readme(fmu, tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    # The others fly the MAVLink vehicle: sitl/test_readme_flights.py.
    (code,) = (block for block in blocks if "fmpy" in block)
    shutil.copy(fmu, tmp_path / "LmpcQuadrotor.fmu")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    reached = [float(number) for number in done.stdout.splitlines()[-1].split()]
    for value, goal in zip(reached, (3.0, 0.0, 20.0), strict=True):
        assert abs(value - goal) < 5e-3, reached
