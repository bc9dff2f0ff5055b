"""Flies the FMU in FMPy and the MAVLink vehicle from pymavlink, writes tables and plots, and tells whether every flight reached its goal.

Started by `cargo xtask demo`, which builds both and the Python environment.
"""

import argparse
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu

import flights
import measures
import plots
import vehicle

#: Standard acceleration of free fall, m/s².
GRAVITY = 9.80665

#: Exit code when a flight missed its goal.
GOAL_MISSED = 3

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
    arguments = parse_arguments()
    # Progress goes to the other stream: neither may overtake the other.
    sys.stdout.reconfigure(line_buffering=True, encoding="utf-8")
    start = time.monotonic() - arguments.elapsed

    def progress(text: str) -> None:
        print(f"[{time.monotonic() - start:6.1f} s] {text}", file=sys.stderr, flush=True)

    model_description = read_model_description(str(arguments.fmu))
    limits = {v.name: float(v.start) for v in model_description.modelVariables if v.name in LIMITS}
    weight = GRAVITY * limits["airframe.mass"]
    for bound in ("limits.thrust.min", "limits.thrust.max"):
        limits[bound] *= weight
    arguments.out.mkdir(parents=True, exist_ok=True)

    table, files = [], []
    with TemporaryDirectory() as unzipped:
        extract(str(arguments.fmu), unzipdir=unzipped)
        for flight in flights.all_flights():
            progress(f"Flying “{flight.name}”: {flight.title}")
            result = fly(flight, unzipped, model_description)
            errors = measures.measure(flight, flights.GOAL, result, limits["limits.tilt"])
            table.append((flight, errors, flight.checks(errors)))
            files.append(write_csv(result, arguments.out / f"{flight.name}.csv"))
            files += plots.draw(flight, result, limits, arguments.out)
    messages = []
    for name in vehicle.FLIGHTS:
        progress(f"Flying the MAVLink vehicle from examples/{name}.py")
        lines, drawn, met = vehicle.fly(name, arguments.vehicle, arguments.root / "examples", arguments.out)
        messages.append((name, lines, met))
        files += drawn
    progress("Flown")

    print_errors(table)
    print_checks(table)
    print_messages(messages)
    print("\nFiles")
    for file in files:
        print(f"  {shown(file, arguments.root)}")
    met = [check.met for _, _, checks in table for check in checks] + [met for _, _, met in messages]
    return 0 if all(met) else GOAL_MISSED


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("fmu", type=Path, help="the FMU")
    parser.add_argument("vehicle", type=Path, help="the program lmpc-sitl")
    parser.add_argument("out", type=Path, help="folder for tables and plots")
    parser.add_argument("--root", type=Path, default=Path.cwd(), help="folder that printed paths start from")
    parser.add_argument("--elapsed", type=float, default=0.0, help="seconds that the task has taken so far")
    return parser.parse_args()


def fly(flight: flights.Flight, fmu: str, model_description) -> np.ndarray:
    """Simulates a flight in FMPy."""
    return simulate_fmu(
        fmu,
        stop_time=flight.duration,
        output_interval=flights.INTERVAL,
        start_values=flight.start_values,
        input=flight.signals(model_description),
        model_description=model_description,
    )


def write_csv(result: np.ndarray, file: Path) -> Path:
    """Writes all outputs, one row a point, with the names of the variables on top."""
    header = ",".join(result.dtype.names)
    rows = np.column_stack([result[name] for name in result.dtype.names])
    np.savetxt(file, rows, "%.9g", ",", header=header, comments="")
    return file


def print_errors(table) -> None:
    """Errors against the reference, and at the end against the goal."""
    print("\nErrors                  RMS       largest    at the end   overshoot   largest tilt")
    for flight, errors, _ in table:
        for axis in errors.axes:
            heading = axis == "heading"
            scale, unit = (np.rad2deg(1.0), "deg") if heading else (1e3, "mm ")
            overshoot = "" if heading else f"{100 * errors.overshoot[axis]:8.3f} %"
            tilt = f"{np.rad2deg(errors.tilt):10.1f} deg" if axis == errors.axes[0] else ""
            print(
                f"  {flight.name if axis == errors.axes[0] else '':10}{axis:9}"
                f"{scale * errors.rms[axis]:8.3f} {unit}{scale * errors.largest[axis]:9.3f} {unit}"
                f"{scale * errors.final[axis]:10.4f} {unit}{overshoot:>12}{tilt}".rstrip()
            )


def print_checks(table) -> None:
    """Every goal with its bound."""
    print("\nGoals")
    for flight, _, checks in table:
        for check in checks:
            verdict = "met" if check.met else "MISSED"
            print(
                f"  {flight.name:10}{check.what:28}{check.value:10.4f} {check.unit:4}"
                f"at most {check.bound:6.2f} {check.unit:4}{verdict}"
            )


def print_messages(flights) -> None:
    """What the examples have printed."""
    print("\nMAVLink")
    for name, lines, met in flights:
        for index, line in enumerate(lines):
            print(f"  {name if index == 0 else '':17}{line}")
        print(f"  {'':17}{'met' if met else 'MISSED'}")


def shown(file: Path, root: Path) -> str:
    return str(file.relative_to(root) if file.is_relative_to(root) else file)


if __name__ == "__main__":
    sys.exit(main())
