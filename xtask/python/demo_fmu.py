"""Flies the FMU in FMPy, writes tables and plots, and tells whether every flight reached its goal.

Started by `cargo xtask demo`, which builds the FMU and the Python environment.
"""

import os
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu

import flights
import measures
import plots
from script import GOAL_MISSED, Script

#: Standard acceleration of free fall, m/s².
GRAVITY = 9.80665

#: Parameters that the plots show as bounds.
LIMITS = (
    "airframe.mass",
    "limits.tilt",
    "limits.thrust.min",
    "limits.thrust.max",
    "airframe.rotor.speed_min",
    "airframe.rotor.speed_max",
)


def main() -> int:
    script = Script(__doc__, "the FMU")
    with TemporaryDirectory() as unzipped:
        extract(str(script.flown), unzipdir=unzipped)
        first, *others = flights.all_flights()
        script.progress(f"Flying “{first.name}”: {first.title}")
        result, limits = fly(first, unzipped)
        script.progress(f"First picture: {script.shown(plots.draw_path(first, result, script.out))}")
        # Each flight has a process of its own: drawing takes longer than flying.
        with ProcessPoolExecutor(os.cpu_count()) as pool:
            jobs = []
            for flight in others:
                script.progress(f"Flying “{flight.name}”: {flight.title}")
                jobs.append(pool.submit(fly_and_evaluate, flight.name, unzipped, script.out))
            rows = [evaluate(first, result, limits, script.out), *(job.result() for job in jobs)]
    print_errors(rows)
    print_checks(rows)
    script.print_files(file for *_, files in rows for file in files)
    return 0 if all(check.met for _, _, checks, _ in rows for check in checks) else GOAL_MISSED


def fly_and_evaluate(name: str, fmu: str, folder: Path):
    """A flight by its name, in any process."""
    (flight,) = (flight for flight in flights.all_flights() if flight.name == name)
    return evaluate(flight, *fly(flight, fmu), folder)


def fly(flight: flights.Flight, fmu: str) -> tuple[np.ndarray, dict]:
    """Simulates a flight in FMPy; also returns the limits that the plots show."""
    model_description = read_model_description(fmu)
    limits = {v.name: float(v.start) for v in model_description.modelVariables if v.name in LIMITS}
    weight = GRAVITY * limits["airframe.mass"]
    for bound in ("limits.thrust.min", "limits.thrust.max"):
        limits[bound] *= weight
    result = simulate_fmu(
        fmu,
        stop_time=flight.duration,
        output_interval=flights.INTERVAL,
        start_values=flight.start_values,
        input=flight.signals(model_description),
        model_description=model_description,
    )
    return result, limits


def evaluate(flight: flights.Flight, result: np.ndarray, limits: dict, folder: Path):
    """Name, errors, checks and files of a flight."""
    errors = measures.measure(flight, flights.GOAL, result, limits["limits.tilt"])
    table = write_csv(result, folder / f"{flight.name}.csv")
    return flight.name, errors, flight.checks(errors), [table, *plots.draw(flight, result, limits, folder)]


def write_csv(result: np.ndarray, file: Path) -> Path:
    """Writes all outputs as a table: one row per point, the first row has the names of the variables."""
    header = ",".join(result.dtype.names)
    rows = np.column_stack([result[name] for name in result.dtype.names])
    np.savetxt(file, rows, "%.9g", ",", header=header, comments="")
    return file


def print_errors(rows) -> None:
    """Errors against the reference, and at the end against the goal."""
    print("\nErrors                  RMS       largest    at the end   overshoot   largest tilt")
    for name, errors, _, _ in rows:
        for axis in errors.axes:
            heading = axis == "heading"
            scale, unit = (np.rad2deg(1.0), "deg") if heading else (1e3, "mm ")
            overshoot = "" if heading else f"{100 * errors.overshoot[axis]:8.3f} %"
            tilt = f"{np.rad2deg(errors.tilt):10.1f} deg" if axis == errors.axes[0] else ""
            print(
                f"  {name if axis == errors.axes[0] else '':10}{axis:9}"
                f"{scale * errors.rms[axis]:8.3f} {unit}{scale * errors.largest[axis]:9.3f} {unit}"
                f"{scale * errors.final[axis]:10.4f} {unit}{overshoot:>12}{tilt}".rstrip()
            )


def print_checks(rows) -> None:
    """Every goal with its bound."""
    print("\nGoals")
    for name, _, checks, _ in rows:
        for check in checks:
            verdict = "met" if check.met else "MISSED"
            print(
                f"  {name:10}{check.what:28}{check.value:10.4f} {check.unit:4}"
                f"at most {check.bound:6.2f} {check.unit:4}{verdict}"
            )


if __name__ == "__main__":
    sys.exit(main())
