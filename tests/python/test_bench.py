"""The benchmark's scripts: statistics, the task over a full horizon, and the report of the kept results. Nothing is timed."""

import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import linalg

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench" / "python"))

import report  # noqa: E402
import statistics_of  # noqa: E402
from horizon import Horizon  # noqa: E402
from tables import Table, digits, duration, memory  # noqa: E402


@pytest.fixture(scope="module")
def results() -> dict:
    return json.loads((ROOT / "bench" / "results" / "results.json").read_text())


def test_quantiles_are_values_that_were_measured():
    values = [float(value) for value in range(1, 1001)]
    assert [statistics_of.quantile(values, share) for share in (0.5, 0.99, 0.999, 1.0)] == [500, 990, 999, 1000]
    assert math.isnan(statistics_of.quantile([], 0.5))


def test_the_median_of_processes_tells_its_spread():
    merged = statistics_of.across([statistics_of.summary([value, 2 * value]) for value in (3.0, 1.0, 2.0)])
    assert (merged["median"], merged["spread"]["median"], merged["most"], merged["processes"]) == (2, [1, 3], 4, 3)


def test_exponents_are_those_of_power_laws():
    assert statistics_of.exponent([(size, 7 * size**1.5) for size in (1, 2, 5, 20)]) == pytest.approx(1.5)
    assert math.isnan(statistics_of.exponent([(1, 1)]))


def test_numbers_have_three_digits_and_units():
    assert [duration(ns) for ns in (7.0, 153.4, 12_345, 1.5e6, 2e9)] == ["7.00 ns", "153 ns", "12.3 µs", "1.50 ms", "2.00 s"]
    assert [memory(count) for count in (999, 4472, 7.1e6, None)] == ["999 B", "4.47 kB", "7.10 MB", "–"]
    assert digits(0) == "0"


def test_cells_are_escaped():
    table = Table(["a|b", "c"])
    table.add("<x>", 1)
    assert "a\\|b" in table.markdown() and "&lt;x&gt;" in table.html()


@pytest.mark.parametrize("moves", [1, 5, 25])
def test_without_limits_a_horizon_with_the_regulators_cost_is_the_regulator(moves):
    """The oracle is scipy's Riccati equation of the augmented model."""
    a, b, c = np.array([[1, 0.1], [0, 1]]), np.array([[0.005], [0.1]]), np.array([[1.0, 0]])
    big_a = np.block([[a, np.zeros((2, 1))], [c @ a, np.eye(1)]])
    big_b = np.vstack([b, c @ b])
    q, r = np.diag([0.0, 0.3, 1.0]), np.array([[0.5]])
    cost = linalg.solve_discrete_are(big_a, big_b, q, r)
    gain = np.linalg.solve(r + big_b.T @ cost @ big_b, big_b.T @ cost @ big_a)
    limit = {"of_state": [0.0, 1.0], "of_input": [0.0], "upper": [1e9], "samples": [0, 1, 2]}
    if moves == 1:
        limit = {"of_state": [0.0, 0.0], "of_input": [1.0], "upper": [1e9], "samples": [0]}
    flat = {name: matrix.ravel().tolist() for name, matrix in {"a": a, "b": b, "c": c, "q": q, "r": r, "terminal": cost}.items()}
    problem = Horizon(flat | {"states": 2, "inputs": 1, "limits": [limit]}, moves)

    # At rest before the set-point moved: the known increment is that of an input that is there already.
    moment = {"deviation": [-1.0, 0.4], "input": [0.2]}
    gradient, equal, upper = problem.at(moment)
    assert len(upper) > 0
    rows = problem.equal.toarray()
    system = np.block([[problem.hessian.toarray(), rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    z = np.linalg.solve(system, np.concatenate([-gradient, equal]))[: problem.size]
    # What the augmented model is at now: the motion of the last sample does not act on what follows but through the velocity.
    before = np.linalg.solve(a, np.array(moment["deviation"]) - b[:, 0] * moment["input"][0])
    increment = np.array(moment["deviation"]) - before
    expected = -gain @ np.array([*increment, moment["deviation"][0]])
    assert problem.first_move(z, moment) == pytest.approx(expected, rel=1e-6)


def test_the_kept_results_make_a_report(results, tmp_path):
    files = report.write(results, tmp_path)
    assert all(file.stat().st_size > 1000 for file in files)
    text = (tmp_path / "report.md").read_text()
    for loop in ("position", "altitude", "roll and pitch", "yaw"):
        assert f"### {loop}:" in text
    for heading in ("Engine", "FMU", "MAVLink vehicle", "Growth", "What is missing", "What was tried"):
        assert f"## {heading}\n" in text, heading
    assert "nan" not in text and "None" not in text
    assert "DAQP" in report.ratios(results)


def test_a_run_without_a_part_makes_a_report(results, tmp_path):
    few = {name: results[name] for name in ("machine", "load_before", "load_after", "took_s", "missing")}
    report.write(few, tmp_path)
    assert "## Engine" not in (tmp_path / "report.md").read_text()
    assert report.ratios(few) == ""
