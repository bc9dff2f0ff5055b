"""TinyMPC on the loops of one input, whose limits are intervals, which is what it takes.

As published it adds rho to Q and R in its cache and once more in its set-up, so that it minimises another cost than the one that it is
given. It is timed as published; its moves are therefore not compared. Its state is [x; u(k - 1)], so that it may weigh increments.
"""

import importlib
import time

import numpy as np

from statistics_of import summary


def measured(task: dict, moments, moves: int, limited) -> list[dict]:
    n, p = task["states"], task["inputs"]
    a, b = np.array(task["a"]).reshape(n, n), np.array(task["b"]).reshape(n, p)
    big_a = np.block([[a, b], [np.zeros((p, n)), np.eye(p)]])
    big_b = np.vstack([b, np.eye(p)])
    weights = np.array(task["q"]).reshape(n + p, n + p)
    q = np.diag([weights[n, n], *np.full(n - 1, 1e-3), 1e-3])
    r = np.array(task["r"]).reshape(p, p)
    lower, upper = np.full(n + p, -1e17), np.full(n + p, 1e17)
    for limit in task["limits"]:
        bounds = np.array(limit["upper"])
        rows = np.hstack([np.array(limit["of_state"]).reshape(len(bounds), n), np.array(limit["of_input"]).reshape(len(bounds), p)])
        for row, bound in zip(rows, bounds):
            used = np.flatnonzero(row)
            if len(used) == 1 and row[used[0]] > 0:
                upper[used[0]] = min(upper[used[0]], bound / row[used[0]])
            elif len(used) == 1:
                lower[used[0]] = max(lower[used[0]], bound / row[used[0]])
    solver = importlib.import_module("tinympc").TinyMPC()
    solver.setup(big_a, big_b, q, r, moves, rho=1.0, verbose=False, max_iter=1000, abs_pri_tol=1e-4, abs_dua_tol=1e-4)
    wide = lambda bound, columns: np.tile(np.asarray(bound, dtype=float)[:, None], (1, columns))
    solver.set_bound_constraints(wide(lower, moves), wide(upper, moves), wide(np.full(p, -1e17), moves - 1), wide(np.full(p, 1e17), moves - 1))
    times, failures = [], 0
    for at in moments:
        moment = task["moments"][at]
        solver.set_x0(np.array([*moment["deviation"], *moment["input"]]))
        begin = time.perf_counter_ns()
        solution = solver.solve()
        times.append(float(time.perf_counter_ns() - begin))
        failures += not np.all(np.isfinite(solution["controls"]))
    return [{"loop": task["program"]["name"], "solver": "TinyMPC (wall clock)", "kind": "horizon", "moves": moves, "warm": True,
             "unknowns": moves * (n + 2 * p), "rows": int(np.isfinite(upper).sum()) * 2 * moves, "failures": failures, "most_iterations": 0,
             "times_ns": {"all": summary(times), "limited": summary([t for t, at in zip(times, limited) if at])}}]
