"""Flies the MAVLink vehicle by the examples, as a user would, and tells whether every flight reached its goal.

Started by `cargo xtask demo`, which builds the vehicle, after the flights of the FMU.
"""

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import flights
import overview
import report
import vehicle
from script import GOAL_MISSED, Script


def main() -> int:
    script = Script(__doc__, "the program lmpc-sitl")
    examples = script.root / "examples"
    for name in vehicle.FLIGHTS:
        script.progress(f"Flying examples/{name}.py")
    with ThreadPoolExecutor() as pool:
        flown = list(pool.map(lambda name: vehicle.fly(name, script.flown, examples, script.out), vehicle.FLIGHTS))
    drawn = [vehicle.draw_log(flight) for flight in flown]
    picture = overview.draw(script.out / "default.csv", vehicle.log_file("circle", script.out), script.out / "overview.png")

    print("\nMAVLink")
    for flight in flown:
        for index, line in enumerate(flight.lines):
            print(f"  {flight.name if index == 0 else '':17}{line}")
        print(f"  {'':17}{'met' if flight.met else 'MISSED'}")
    pages = report.write(script.flown, [*of_fmu(script.out), *map(of_vehicle, flown, drawn)], script.out)
    script.print_files([*(file for files in drawn for file in files), picture, *pages])
    return 0 if all(flight.met for flight in flown) else GOAL_MISSED


def of_fmu(folder: Path) -> list[report.Shown]:
    """The flights of the FMU, which demo_fmu.py has flown before."""
    return [
        report.Shown(f"FMU: {flight.title}", folder / f"{flight.name}.csv", sorted(folder.glob(f"{flight.name}-*.png")))
        for flight in flights.all_flights()
    ]


def of_vehicle(flight: vehicle.Flight, files: list[Path]) -> report.Shown:
    plot, log, drawn = files
    return report.Shown(f"MAVLink vehicle: {flight.name.replace('_', ' ')}", log, [plot, drawn])


if __name__ == "__main__":
    sys.exit(main())
