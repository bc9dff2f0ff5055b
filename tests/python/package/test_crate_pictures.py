"""The pictures on the front pages of the crates `lmpc` and `quadrotor` are drawn from flights of today.

`RECORD_PICTURES=1` with these tests writes them.
"""

import os
import re

import numpy as np
import pytest
from charts import Chart, Line, svg

from lmpc_quadrotor import Simulation
from lmpc_quadrotor.control import Controller, LaguerreBasis, Limit, LmpcDesign, StateSpace


def climb() -> str:
    """The example of lmpc's README: 10 m with the acceleration, its change and the speed limited."""
    plant = StateSpace.from_continuous([[0, 1], [0, 0]], [[0], [1]], [[1, 0]], sample_time=0.05)
    q, r = plant.output_weights(output=1.0, increment=1.0)
    design = LmpcDesign(plant, q, r, [LaguerreBasis(5, 0.7)], horizon=100)
    limits = [Limit.range("input", 1, range(30)), Limit.range("increment", 1, range(30)),
              Limit("state", [[0.0, 1.0], [0.0, -1.0]], range(1, 31), soft=True)]  # fmt: skip
    controller, x, rows = Controller.laguerre_mpc(design, limits), np.zeros(2), []
    for k in range(281):
        step = controller.step(x, reference=[10.0, 0.0], upper=[1.0, 1.0, 0.2, 0.2, 1.5, 1.5])
        assert step.status == "optimal"
        rows.append((0.05 * k, *x, *step.input))
        x = plant.a @ x + plant.b @ step.input
    time, height, speed, acceleration = np.array(rows)[::4].T
    limit = lambda value: Line(time[[0, -1]], np.full(2, value), "grey", "limit", dashed=True)  # noqa: E731
    return svg("A climb of 10 m under limits of speed and acceleration", [
        Chart("height, m", (0, 5, 10), [Line(time, height, "green", "height")]),
        Chart("speed, m/s", (0, 0.5, 1, 1.5), [Line(time, speed, "blue", "speed"), limit(1.5)]),
        Chart("acceleration, m/s²", (-1, 0, 1), [Line(time, acceleration, "orange", "acceleration"), limit(1.0)]),
    ], range(0, 15, 2), "time, s")  # fmt: skip


def flight() -> str:
    """The example of quadrotor's README: 5 m north, 5 m east and 10 m up."""
    table = Simulation().fly(8.0, step=0.1)
    time = table["time"]
    reference = Line(time, -table["setpoint.position.z"], "grey", "reference, up", dashed=True)
    return svg("The default flight: position, speed and tilt", [
        Chart("position, m", (0, 5, 10), [Line(time, table["position.x"], "blue", "north and east"), Line(time, table["altitude"], "green", "up"), reference]),
        Chart("speed, m/s", (0, 1, 2, 3, 4), [Line(time, table["velocity.x"], "blue", "north and east"), Line(time, -table["velocity.z"], "green", "up")]),
        Chart("tilt command, rad", (-0.25, 0, 0.25), [Line(time, table["tilt_reference.theta"], "blue", "pitch"),
                                                    Line(time, table["tilt_reference.phi"], "orange", "roll", dashed=True)]),
    ], range(9), "time, s")  # fmt: skip


@pytest.mark.parametrize("path, draw", [("lmpc/src/climb.svg", climb), ("quadrotor/src/flight.svg", flight)], ids=["lmpc", "quadrotor"])
def test_the_picture_is_what_flies(repository, path, draw):
    drawn, file = draw(), repository / path
    if os.environ.get("RECORD_PICTURES"):
        file.write_text(drawn)
    numbers = lambda text: np.array([float(number) for number in re.findall(r"-?\d+\.\d", text)])  # noqa: E731
    kept = file.read_text()
    assert re.sub(r"-?\d+\.\d", "", kept) == re.sub(r"-?\d+\.\d", "", drawn), f"{path} is another picture; RECORD_PICTURES=1 draws it"
    # Points by which nobody would see a difference.
    np.testing.assert_allclose(numbers(kept), numbers(drawn), atol=4.0, err_msg=f"{path} no longer shows what flies; RECORD_PICTURES=1 draws it")
    assert "\n\n" not in kept, "Markdown would end the picture there"
