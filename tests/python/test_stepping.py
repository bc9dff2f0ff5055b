"""The flight does not depend on how the importer splits the time axis."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException


def test_a_flight_is_the_same_at_common_points_of_different_steps(slave):
    fine = slave({"reference.yaw": 0.3}).fly(0.0, 3.0, 0.001)
    for step in (0.003, 0.01, 0.016, 0.05, 0.25, 1.0):
        stride = round(step / 0.001)
        common = fine[stride - 1 :: stride]
        coarse = slave({"reference.yaw": 0.3}).fly(0.0, len(common) * step, step)
        np.testing.assert_array_equal(coarse, common, err_msg=f"step {step}")


@pytest.mark.parametrize("step", [1 / 60, 1 / 3, 1 / 7, 0.0137, 0.0001, 0.9999])
def test_odd_steps_arrive_exactly(slave, model_description, step):
    """Steps that are no multiple of any sample time; the time is added up in floating point."""
    count = min(int(3.0 / step), 600)
    odd = slave({"reference.yaw": 0.3})
    odd.fly(0.0, count * step, step)
    # In one step to the same microsecond, then compare.
    direct = slave({"reference.yaw": 0.3})
    end = round(count * step * 1e6) * 1e-6
    direct.fmu.doStep(currentCommunicationPoint=0.0, communicationStepSize=end)
    # Communication points are whole microseconds inside; speeds are below 10 m/s.
    np.testing.assert_allclose(odd.snapshot(), direct.snapshot(), atol=1e-3)
    position = [name for name in odd.outputs if name.startswith(("position", "setpoint.position"))]
    np.testing.assert_allclose(odd.get(*position), direct.get(*position), atol=1e-5)


def test_thousands_of_added_up_steps_do_not_drift(slave):
    """60 Hz for a minute: 3600 steps whose sum is not 60 exactly."""
    flown = slave({"reference.yaw": 0.3})
    time = 0.0
    for _ in range(3600):
        flown.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=1 / 60)
        time += 1 / 60
    assert time != 60.0
    np.testing.assert_allclose(flown.get("position.x", "position.y", "position.z"), [5.0, 5.0, -10.0], atol=1e-6)


def test_bad_steps_are_refused_and_the_reason_is_logged(slave):
    for step in (0.0, -0.1, float("nan"), float("inf")):
        instance = slave({"reference.yaw": 0.3})
        with pytest.raises(FMICallException):
            instance.fmu.doStep(currentCommunicationPoint=0.0, communicationStepSize=step)
        assert instance.log, step
    instance = slave({"reference.yaw": 0.3})
    with pytest.raises(FMICallException):
        instance.fmu.doStep(currentCommunicationPoint=5.0, communicationStepSize=0.1)
    assert "5" in instance.log[-1][2]
