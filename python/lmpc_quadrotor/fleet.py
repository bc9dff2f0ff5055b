"""Many flights at once."""

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from . import _native
from .tables import Numbers, Values, by_name, list_of_names, structured
from .times import microseconds


class Fleet:
    """Many flights side by side, on all cores, without Python's lock.

    Each flight is the one that a `Simulation` with the same parameters and inputs flies, bit for bit, whatever the number of
    threads. A parameter or input is one value for all vehicles, or a sequence with one for each.

    >>> fleet = Fleet(3, {"airframe.mass": [0.6, 0.7, 0.8]}, {"reference.position.z": -2.0})
    >>> table = fleet.fly(3.0, step=0.1, outputs=["altitude"])
    >>> table["altitude"].shape
    (31, 3)

    `count` is 1 to 1 000 000. `threads` is how many flights go on at once; None is one on each core. A flight that diverges stands still where it did:
    see `failed` and `failures`.
    """

    def __init__(
        self,
        count: int,
        parameters: Values | None = None,
        inputs: Values | None = None,
        *,
        actuation: str = "reference",
        threads: int | None = None,
    ) -> None:
        self._native = _native.Fleet(
            count, by_name("parameters", parameters), by_name("inputs", inputs), actuation, threads
        )

    def __len__(self) -> int:
        return len(self._native)

    @property
    def actuation(self) -> str:
        """What the vehicles are asked for: see `Simulation`."""
        return self._native.actuation

    @property
    def times(self) -> Numbers:
        """Time of each flight since its start, s."""
        return self._native.times_us / 1e6

    @property
    def failed(self) -> npt.NDArray[np.bool_]:
        """Which flights could not go on."""
        return self._native.failed

    @property
    def failures(self) -> list[str | None]:
        """Why each flight could not go on; None for those that can."""
        return self._native.failures

    def set(self, inputs: Values) -> None:
        """Sets inputs of all vehicles: they act from now on. Raises `ParameterError`; nothing has changed then."""
        self._native.set_inputs(by_name("inputs", inputs))

    def advance(self, duration: float) -> None:
        """All flights go on for a time, s, under the present inputs. One that diverges does not raise: see `failed`."""
        self._native.advance(microseconds("duration", duration))

    def read(self, names: Iterable[str]) -> Numbers:
        """Some outputs now: a row for each vehicle, a column for each name."""
        return self._native.read(list_of_names("names", names))

    def __getitem__(self, name: str) -> Numbers:
        return self._native.read([name])[:, 0]

    def fly(
        self,
        duration: float,
        step: float = 0.01,
        *,
        outputs: Iterable[str] | None = None,
    ) -> npt.NDArray[np.void]:
        """All flights go on for a time, s. Returns the outputs every `step` s as a structured array by time and vehicle.

        `table["position.x"][:, 3]` is the way north of the fourth vehicle; `time` counts from now.
        """
        names = self._native.output_names() if outputs is None else list_of_names("outputs", outputs)
        times, rows = self._native.record(microseconds("duration", duration), microseconds("step", step, 1), names)
        return structured(times / 1e6, names, rows)

    def restart(self, vehicles: Iterable[int], motions: npt.ArrayLike | None = None) -> None:
        """Some flights begin anew at time 0, under their present inputs, without designing their controllers again.

        `motions` has a row for each of them: 13 numbers as `Simulation.place` takes them. Without it they begin as at first.
        """
        self._native.restart(vehicles, motions)

    def save(self) -> list[bytes]:
        """Each flight as `Simulation.save` saves it; `Simulation.from_saved` goes on with a single one."""
        return self._native.save()

    def restore(self, saved: Sequence[bytes]) -> None:
        """All flights go back, or on, to what `save()` returned."""
        self._native.restore(list(saved))
