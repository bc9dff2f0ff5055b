"""FMUs in FMPy: ours beside a plant of PythonFMU, one call per millisecond from Python."""

import subprocess
import sys
import time
from pathlib import Path

#: A falling point mass under a thrust: the least that a plant does.
POINT = '''
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Point(Fmi2Slave):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.thrust, self.height, self.speed = 9.81, 0.0, 0.0
        self.register_variable(Real("thrust", causality=Fmi2Causality.input))
        self.register_variable(Real("height", causality=Fmi2Causality.output))

    def do_step(self, time, step):
        self.speed += (self.thrust - 9.81) * step
        self.height += self.speed * step
        return True
'''


def point(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "point.py").write_text(POINT)
    subprocess.run([sys.executable, "-m", "pythonfmu", "build", "-f", "point.py"], cwd=folder, check=True, capture_output=True)
    return folder / "Point.fmu"


def steps(file: Path, count: int) -> dict:
    """ns per step of 1 ms, and ns to instantiate and initialize."""
    from fmpy import extract, instantiate_fmu, read_model_description

    folder, description = extract(file), read_model_description(file)

    def initialized():
        fmu = instantiate_fmu(folder, description, fmi_type="CoSimulation")
        fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        return fmu

    first = initialized()
    begin = time.perf_counter_ns()
    fmu = initialized()
    made = time.perf_counter_ns() - begin
    taken = []
    for repetition in range(3):
        begin = time.perf_counter_ns()
        for step in range(count):
            fmu.doStep((repetition * count + step) * 1e-3, 1e-3)
        taken.append((time.perf_counter_ns() - begin) / count)
    del first
    return {"step_ns": sorted(taken)[1], "initialize_ns": made}
