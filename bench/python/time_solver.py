"""Times one solver of the Python registry on the loops' tasks and prints a line of JSON: a process of its own, so that one that dies
takes nobody along.

    python time_solver.py TASKS.json SOLVER dense|horizon MOVES
"""

import argparse
import json
import os
import sys

import numpy as np

import hpipm_ocp
import solvers
import tiny
from horizon import Horizon
from osqp_embedded import OsqpEmbedded
from statistics_of import summary

#: Passes over the samples, of which the shortest time of each counts.
PASSES = 3


def dense(task: dict, moments):
    program = task["program"]
    left = np.array(program["left"]).reshape(program["rows"], program["unknowns"])
    lower = np.full(program["rows"], -1e20)
    samples = [(program["samples"][at]["flight"], np.array(program["samples"][at]["gradient"]), lower,
                np.minimum(program["samples"][at]["upper"], 1e19)) for at in moments]
    return np.eye(program["unknowns"]), left, samples


def horizon(task: dict, moments, moves: int):
    problem = Horizon(task, moves)
    left = solvers.sparse.vstack([problem.equal, problem.left], format="csc")
    samples = []
    for at in moments:
        moment = task["moments"][at]
        gradient, equal, upper = problem.at(moment)
        lower = np.concatenate([equal, np.full(len(upper), -1e20)])
        samples.append((moment["flight"], gradient, lower, np.concatenate([equal, upper])))
    return problem.hessian, left, samples


def measured(task: dict, name: str, kind: str, moves: int, quick: bool) -> list[dict]:
    """Cold and warm."""
    stride = max(1, len(task["moments"]) // (60 if quick else 400))
    # Whole stretches of flights, so that a warm start is one.
    block = 20
    moments = [at for at in range(len(task["moments"])) if (at // block) % stride == 0]
    limited = [task["moments"][at]["limited"] for at in moments]
    if name == "tinympc":
        return tiny.measured(task, moments, moves, limited)
    if name == "hpipm":
        return hpipm_ocp.measured(task, moments, moves, limited, 1 if quick else PASSES)
    solver = OsqpEmbedded if name == OsqpEmbedded.__name__ else getattr(solvers, name)
    hessian, left, samples = dense(task, moments) if kind == "dense" else horizon(task, moments, moves)
    found = []
    for warm in (False, True):
        passes = [solvers.run(solver, hessian, left, samples, warm) for _ in range(1 if quick else PASSES)]
        times = [min(each) for each in zip(*(one[0] for one in passes))]
        _, failures, most, _ = passes[0]
        found.append({"loop": task["program"]["name"], "solver": solver.name, "kind": kind, "moves": moves, "warm": warm,
                      "unknowns": hessian.shape[0], "rows": left.shape[0], "failures": failures, "most_iterations": most,
                      "times_ns": {"all": summary(times), "limited": summary([t for t, at in zip(times, limited) if at])}})
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tasks")
    parser.add_argument("solver")
    parser.add_argument("kind", choices=["dense", "horizon"])
    parser.add_argument("moves", type=int)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    with open(arguments.tasks, encoding="utf-8") as file:
        tasks = json.load(file)
    # Libraries may print to the output that the figures go to.
    out = os.dup(1)
    os.dup2(2, 1)
    found = []
    for task in tasks:
        if arguments.solver == "tinympc" and task["inputs"] > 1:
            continue
        try:
            found += measured(task, arguments.solver, arguments.kind, arguments.moves, arguments.quick)
        except ValueError as refusal:
            print(f"{task['program']['name']}: {refusal}", file=sys.stderr)
    os.write(out, (json.dumps(found) + "\n").encode())


if __name__ == "__main__":
    main()
