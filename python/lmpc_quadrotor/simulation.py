"""One flight."""

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import numpy.typing as npt

from . import _native
from .tables import Numbers, Value, Values, by_name, list_of_names, structured
from .times import microseconds


class Simulation:
    """One flight: the vehicle under its controllers, as the FMU `LmpcQuadrotor` flies, in the same doubles.

    Parameters, inputs and outputs have the names of the FMU's variables, structured with dots; `lmpc_quadrotor.parameters()`,
    `.inputs()` and `.outputs()` list them with units, ranges and descriptions. Times are in s, counted in whole µs.

    >>> flight = Simulation({"airframe.mass": 0.9}, {"reference.position.z": -2.0})
    >>> table = flight.fly(5.0, step=0.01)
    >>> float(table["altitude"][-1]) > 1.9
    True

    `actuation` is what the vehicle is asked for:

    * "reference": a position and what goes with it (`reference.…`), of the whole cascade;
    * "rates": thrust and body rates (`command.thrust`, `command.body_rate.p`, `.q`, `.r`), of the attitude controller;
    * "rotors": rotor speeds (`rotor.command[1]` to `[4]`), of the plant without controllers.

    Raises `ParameterError`, a `ValueError`, for a name that there is not and a value that is out of range or cannot be flown.
    """

    def __init__(
        self,
        parameters: Values | None = None,
        inputs: Values | None = None,
        *,
        actuation: str = "reference",
    ) -> None:
        self._native = _native.Simulation(by_name("parameters", parameters), by_name("inputs", inputs), actuation)

    @classmethod
    def from_saved(cls, saved: bytes) -> "Simulation":
        """A flight that goes on from what `save()` returned, maybe in another process."""
        flight = cls.__new__(cls)
        flight._native = _native.Simulation.from_saved(saved)
        return flight

    def copy(self) -> "Simulation":
        """The same flight, to go on in another way."""
        flight = Simulation.__new__(Simulation)
        flight._native = self._native.copy()
        return flight

    @property
    def actuation(self) -> str:
        """What the vehicle is asked for."""
        return self._native.actuation

    @property
    def time(self) -> float:
        """Time since the start, s."""
        return self._native.time_us / 1e6

    @property
    def warnings(self) -> list[str]:
        """What you should know about the parameters, a sentence each; empty if all is well."""
        return self._native.warnings

    @property
    def parameters(self) -> dict[str, Value]:
        """All parameters as they fly, a preset applied."""
        return self._native.parameters()

    def set_parameters(self, parameters: Values) -> None:
        """Changes parameters in flight: a payload is dropped by a change of `airframe.mass`.

        Raises `ParameterError` for a name that there is not, a value that is out of range, and parameters of the start
        (`initial.…`); nothing has changed then.
        """
        self._native.set_parameters(by_name("parameters", parameters))

    @property
    def inputs(self) -> dict[str, float]:
        """All inputs; 1 is true."""
        return self._native.inputs()

    def set(self, inputs: Values) -> None:
        """Sets inputs: they act from now on. Raises `ParameterError`; nothing has changed then."""
        self._native.set_inputs(by_name("inputs", inputs))

    @property
    def outputs(self) -> dict[str, float]:
        """All outputs now, by name."""
        return dict(zip(self._native.output_names(), self._native.read().tolist()))

    def read(self, names: Iterable[str]) -> Numbers:
        """Some outputs now, in the order of their names."""
        return self._native.read(list_of_names("names", names))

    def __getitem__(self, name: str) -> float:
        return float(self._native.read([name])[0])

    def advance(self, duration: float) -> None:
        """Flies on for a time, s, under the present inputs. Raises `FlightError` if the motion diverges.

        Ctrl-C ends it where it is; with `actuation="rates"` it takes effect at the end.
        """
        self._native.advance_to(self._native.time_us + microseconds("duration", duration))

    def advance_to(self, time: float) -> None:
        """Flies on to a time, s. Raises `FlightError` if that is past, or the motion diverges."""
        self._native.advance_to(microseconds("time", time))

    def fly(
        self,
        duration: float,
        step: float = 0.01,
        *,
        outputs: Iterable[str] | None = None,
        inputs: Callable[[float], Mapping[str, Value]] | None = None,
    ) -> npt.NDArray[np.void]:
        """Flies on for a time, s, and returns the outputs every `step` s, from now to the end.

        Raises `FlightError` if the motion diverges, and `MemoryError` before it flies if there is no room for the result.

        The result is a structured array with a field `time`, s, and one for each output, or for those named by `outputs`;
        `pandas.DataFrame` takes it as it is. `inputs` is called with the time at the beginning of each step and returns inputs
        to set; without it the present ones stay.
        """
        names = self._native.output_names() if outputs is None else list_of_names("outputs", outputs)
        begin, step_us = self._native.time_us, microseconds("step", step, 1)
        end = begin + microseconds("duration", duration)
        if inputs is None:
            times, rows = self._native.record(end, step_us, names)
            return structured(times / 1e6, names, rows)
        parts: list[Numbers] = []
        instants: list[int] = []
        now = begin
        while now < end:
            self.set(inputs(now / 1e6))
            following = min(now + step_us, end)
            _, rows = self._native.record(following, following - now, names)
            parts.append(rows[:1])
            instants.append(now)
            now = following
        parts.append(self._native.read(names).reshape(1, -1))
        instants.append(now)
        return structured(np.array(instants) / 1e6, names, np.concatenate(parts))

    def place(self, motion: npt.ArrayLike) -> None:
        """Puts the vehicle into another motion, now.

        13 numbers: position and velocity in NED, m and m/s; the quaternion from body to NED, scalar first; body rates, rad/s.
        """
        self._native.place(motion)

    def save(self) -> bytes:
        """Everything there is to the flight: state, parameters and inputs. What goes on from there is the same, bit for bit."""
        return self._native.save()

    def restore(self, saved: bytes) -> None:
        """Goes back, or on, to what `save()` returned."""
        self._native.restore(saved)

    def __getstate__(self) -> bytes:
        return self.save()

    def __setstate__(self, saved: bytes) -> None:
        self._native = _native.Simulation.from_saved(saved)
