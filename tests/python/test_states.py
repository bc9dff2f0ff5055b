"""Saving, restoring and serializing the state."""

import subprocess
import sys
import textwrap

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

START = {"disturbance.force.y": 0.5, "reference.yaw": 0.4}


def test_restored_flight_is_the_same_bit_for_bit(slave):
    flown = slave(START)
    flown.fly(0.0, 2.003, 0.001)
    state = flown.fmu.getFMUstate()
    first = flown.fly(2.003, 4.003, 0.01)
    flown.fmu.setFMUstate(state)
    again = flown.fly(2.003, 4.003, 0.01)
    flown.fmu.freeFMUstate(state)
    np.testing.assert_array_equal(first, again)


def test_serialized_state_continues_in_another_instance(slave):
    flown = slave(START)
    flown.fly(0.0, 2.003, 0.001)
    state = flown.fmu.getFMUstate()
    data = flown.fmu.serializeFMUstate(state)
    flown.fmu.freeFMUstate(state)
    first = flown.fly(2.003, 4.003, 0.01)

    other = slave({"reference.yaw": -1.0})
    restored = other.fmu.deSerializeFMUstate(data)
    other.fmu.setFMUstate(restored)
    other.fmu.freeFMUstate(restored)
    np.testing.assert_array_equal(first, other.fly(2.003, 4.003, 0.01))


def test_serialized_state_continues_in_another_process(slave, fmu, tmp_path):
    flown = slave(START)
    flown.fly(0.0, 2.0, 0.01)
    state = flown.fmu.getFMUstate()
    (tmp_path / "state").write_bytes(flown.fmu.serializeFMUstate(state))
    flown.fmu.freeFMUstate(state)
    expected = flown.fly(2.0, 4.0, 0.01)

    script = textwrap.dedent(
        """
        import sys
        import numpy as np
        from fmpy import simulate_fmu
        fmu, state, out, *names = sys.argv[1:]
        result = simulate_fmu(fmu, start_time=2.0, stop_time=4.0, output_interval=0.01,
                              fmu_state=open(state, "rb").read())
        np.save(out, np.column_stack([result[name] for name in names]))
        """
    )
    arguments = [str(fmu), str(tmp_path / "state"), str(tmp_path / "result.npy"), *flown.outputs]
    subprocess.run([sys.executable, "-c", script, *arguments], check=True, timeout=120)
    result = np.load(tmp_path / "result.npy")
    np.testing.assert_array_equal(result[1:], expected)


def test_bytes_that_are_no_state_are_refused(slave):
    flown = slave(START)
    flown.fly(0.0, 1.0, 0.1)
    state = flown.fmu.getFMUstate()
    data = flown.fmu.serializeFMUstate(state)
    flown.fmu.freeFMUstate(state)
    random = np.random.default_rng(1)
    flipped = bytearray(data)
    flipped[len(data) // 2] ^= 1
    for bad in (b"", data[:-1], data[: len(data) // 2], data + b"x", bytes(flipped), random.bytes(len(data))):
        instance = slave(START)
        with pytest.raises(FMICallException):
            instance.fmu.deSerializeFMUstate(bad)
        assert instance.log


def test_reset_gives_the_same_flight_again(slave):
    flown = slave()
    # Importers that vary parameters call Reset right after Instantiate.
    flown.fmu.reset()
    flown.initialize(START)
    first = flown.fly(0.0, 3.0, 0.01)
    flown.fmu.reset()
    flown.fmu.reset()
    flown.initialize(START)
    np.testing.assert_array_equal(first, flown.fly(0.0, 3.0, 0.01))
    flown.fmu.terminate()
    flown.fmu.reset()
    # Start values are back to their defaults.
    flown.initialize()
    plain = slave({})
    np.testing.assert_array_equal(flown.fly(0.0, 1.0, 0.01), plain.fly(0.0, 1.0, 0.01))
