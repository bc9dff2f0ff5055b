"""The library's active-set solver beside DAQP (another dual active-set method) and PIQP (an interior-point method)."""

import json
import os
import subprocess
from pathlib import Path

import daqp
import numpy as np
import piqp
import pytest

ROOT = Path(__file__).resolve().parents[2]

KINDS = ("loose", "tight", "repeated", "nearly infeasible", "contradictory", "box", "badly conditioned")


def problem(kind: str, random: np.random.Generator) -> dict:
    """A random program of this kind: min ½ xᵀHx + fᵀx, G x ≤ bounds."""
    unknowns, rows = int(random.integers(1, 17)), int(random.integers(1, 60))
    root = random.normal(size=(unknowns, unknowns))
    h = root @ root.T + 10.0 ** random.uniform(-2, 1) * np.eye(unknowns)
    if kind == "badly conditioned":
        scale = np.diag(10.0 ** random.uniform(-2, 2, unknowns))
        h = scale @ h @ scale
    f = 5.0 * random.normal(size=unknowns)
    g = random.normal(size=(rows, unknowns))
    # A point that keeps all bounds with some room.
    inside = random.normal(size=unknowns)
    room = {"loose": 5.0, "nearly infeasible": 1e-6}.get(kind, 0.3)
    bounds = g @ inside + room * random.uniform(0.1, 1.0, rows)
    if kind == "repeated":
        copies = random.integers(0, rows, rows)
        g = np.vstack([g, g[copies], g[copies] * (1.0 + 1e-9)])
        bounds = np.concatenate([bounds, bounds[copies], bounds[copies]])
    elif kind == "nearly infeasible":
        # Every row has a counterpart: only a thin slab is left.
        g, bounds = np.vstack([g, -g]), np.concatenate([bounds, -(g @ inside) + 1e-6])
    elif kind == "contradictory":
        g, bounds = np.vstack([g, -g[:1]]), np.append(bounds, -bounds[0] - 0.5)
    elif kind == "box":
        g, bounds = np.vstack([np.eye(unknowns), -np.eye(unknowns)]), np.full(2 * unknowns, 0.3)
    return {"h": h.tolist(), "f": f.tolist(), "g": g.tolist(), "bounds": bounds.tolist()}


@pytest.fixture(scope="module")
def solved() -> dict[str, list]:
    """Sixty programs of each kind with the library's answers."""
    folder = Path(os.environ.get("LMPC_QUADROTOR_EXAMPLES", ROOT / "target" / "debug" / "examples"))
    program = folder / "solve_quadratic_programs"
    assert program.exists(), f"{program} does not exist: run `cargo test -p lmpc` first"
    random = np.random.default_rng(2015)
    problems = [(kind, problem(kind, random)) for kind in KINDS for _ in range(60)]
    lines = "".join(json.dumps(each) + "\n" for _, each in problems)
    answers = subprocess.run([program], input=lines, capture_output=True, text=True, check=True, timeout=60)
    pairs: dict[str, list] = {kind: [] for kind in KINDS}
    for (kind, each), line in zip(problems, answers.stdout.splitlines(), strict=True):
        pairs[kind].append(({name: np.array(value) for name, value in each.items()}, json.loads(line)))
    return pairs


def by_daqp(p: dict):
    rows = len(p["bounds"])
    x, _, flag, _ = daqp.solve(p["h"], p["f"], p["g"], p["bounds"], np.full(rows, -1e30), np.zeros(rows, dtype=np.int32))
    return x if flag == 1 else None


def by_piqp(p: dict):
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = 1e-10
    unknowns, rows = len(p["f"]), len(p["bounds"])
    nothing = np.zeros((0, unknowns))
    solver.setup(p["h"], p["f"], nothing, np.zeros(0), p["g"], np.full(rows, -1e30), p["bounds"])
    return solver.result.x if solver.solve() == piqp.PIQP_SOLVED else None


def cost(p: dict, x: np.ndarray) -> float:
    return 0.5 * x @ p["h"] @ x + p["f"] @ x


@pytest.mark.parametrize("solver", [by_daqp, by_piqp])
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "contradictory"])
def test_optimum_is_the_one_that_others_find(solved, kind, solver):
    compared = 0
    for p, answer in solved[kind]:
        assert answer["outcome"] == "Optimal"
        x = np.array(answer["x"])
        # H up to a condition of 1e10 leaves bounds met to fewer digits.
        rounding = 1e-6 if kind == "badly conditioned" else 1e-8
        assert (p["g"] @ x - p["bounds"]).max() <= rounding * (1.0 + np.abs(p["bounds"]).max())
        other = solver(p)
        if other is None:
            # Thin slabs defeat some solvers; ours has kept the bounds, and its own conditions are checked below.
            assert kind == "nearly infeasible"
            continue
        compared += 1
        scale = 1.0 + abs(cost(p, other))
        # What the other gains beyond rounding it may owe to bounds that it violates a little.
        owed = np.abs(np.array(answer["multipliers"])).sum() * max((p["g"] @ other - p["bounds"]).max(), 0.0)
        assert cost(p, x) <= cost(p, other) + 1e-7 * scale + owed
    assert compared > 40


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "contradictory"])
def test_multipliers_prove_the_optimum(solved, kind):
    for p, answer in solved[kind]:
        multipliers, active = np.array(answer["multipliers"]), answer["active"]
        assert (multipliers >= 0.0).all()
        gradient = p["h"] @ answer["x"] + p["f"] + p["g"][active].T @ multipliers
        size = 1.0 + np.abs(p["f"]).max() + np.abs(p["h"]).max() * np.abs(answer["x"]).max()
        assert np.abs(gradient).max() <= 1e-8 * (size + multipliers.sum())


def test_contradictions_are_seen(solved):
    for p, answer in solved["contradictory"]:
        assert answer["outcome"] == "Infeasible"
        assert by_daqp(p) is None
