"""Flies the MAVLink vehicle by the examples, as a user would, and tells whether every flight reached its goal.

Started by `cargo xtask demo`, which builds the vehicle, after the flights of the FMU.
"""

import sys
from concurrent.futures import ThreadPoolExecutor

import overview
import vehicle
from script import GOAL_MISSED, Script


def main() -> int:
    script = Script(__doc__, "the program lmpc-sitl")
    examples = script.root / "examples"
    for name in vehicle.FLIGHTS:
        script.progress(f"Flying examples/{name}.py")
    with ThreadPoolExecutor() as pool:
        flights = list(pool.map(lambda name: vehicle.fly(name, script.flown, examples, script.out), vehicle.FLIGHTS))
    files = [file for flight in flights for file in vehicle.draw_log(flight)]
    picture = overview.draw(script.out / "default.csv", vehicle.log_file("circle", script.out), script.out / "overview.png")

    print("\nMAVLink")
    for flight in flights:
        for index, line in enumerate(flight.lines):
            print(f"  {flight.name if index == 0 else '':17}{line}")
        print(f"  {'':17}{'met' if flight.met else 'MISSED'}")
    script.print_files([*files, picture])
    return 0 if all(flight.met for flight in flights) else GOAL_MISSED


if __name__ == "__main__":
    sys.exit(main())
