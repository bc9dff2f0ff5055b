"""An importer other than FMPy, with its own implementation of the standard, flies the same flight."""

import numpy as np
import pytest
from fmpy import simulate_fmu

STEP = 0.05
DURATION = 6.0
NAMES = ("position.x", "position.y", "position.z", "attitude.psi", "thrust", "rotor.speed[3]")


@pytest.fixture(scope="module")
def expected(unzipped, model_description) -> np.ndarray:
    """The default flight pushed by 0.5 N north, in FMPy."""
    result = simulate_fmu(
        unzipped,
        stop_time=DURATION,
        output_interval=STEP,
        start_values={"disturbance.force.x": 0.5},
        output=NAMES,
        model_description=model_description,
    )
    return np.array([result[name][-1] for name in NAMES])


def test_libcosim(fmu, expected):
    pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform and Python")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(step_size=round(STEP * 1e9))
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=str(fmu), instance_name="quadrotor"))
    references = {v.name.decode(): v.reference for v in execution.slave_variables(slave_index=index)}
    execution.real_initial_value(index, references["disturbance.force.x"], 0.5)
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    assert execution.simulate_until(target_time=round(DURATION * 1e9))
    values = observer.last_real_values(index, [references[name] for name in NAMES])
    np.testing.assert_array_equal(values, expected)


def test_libcosim_chooses_enumerations_by_number(fmu, unzipped, model_description):
    """libcosim knows no enumerations: their numbers are integers of their own."""
    pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform and Python")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(step_size=round(STEP * 1e9))
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=str(fmu), instance_name="quadrotor"))
    references = {v.name.decode(): v.reference for v in execution.slave_variables(slave_index=index)}
    execution.integer_initial_value(index, references["controller.kind_number"], 3)
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    assert execution.simulate_until(target_time=round(2e9))
    (got,) = observer.last_real_values(index, [references["position.x"]])
    (status,) = observer.last_integer_values(index, [references["controller.position.status_number"]])
    flights = {
        kind: simulate_fmu(
            unzipped,
            stop_time=2.0,
            output_interval=STEP,
            start_values={"controller.kind": kind},
            output=["position.x"],
            model_description=model_description,
        )["position.x"][-1]
        for kind in (1, 3)
    }
    assert got == flights[3] != flights[1]
    assert status == 1  # optimal
