"""What an agent is to do."""

from typing import Protocol

import numpy as np

from ..tables import Numbers


class Task(Protocol):
    """Where the vehicles are to be. All positions are relative to the middle of the room, in NED, m."""

    #: How many points ahead an agent sees, beside the present one, and how far they are apart, s.
    preview: int
    interval: float

    def begin(self, generator: np.random.Generator, count: int) -> Numbers:
        """What tells one episode from another: a row for each vehicle that begins one."""
        ...

    def goals(self, episodes: Numbers, times: Numbers) -> Numbers:
        """Where each vehicle is to be at a time of its episode, s: a row for each, of 3 numbers."""
        ...


class Hover:
    """A point at random within 2 m of the middle on each axis, to fly to and stay at."""

    preview: int = 0
    interval: float = 0.0

    def begin(self, generator: np.random.Generator, count: int) -> Numbers:
        return generator.uniform(-2.0, 2.0, (count, 3))

    def goals(self, episodes: Numbers, times: Numbers) -> Numbers:
        return episodes


class Track:
    """A point that moves on a figure of eight, 3 m by 1.5 m, once in 6 to 12 s, begun anywhere on it."""

    preview: int = 4
    interval: float = 0.1

    def begin(self, generator: np.random.Generator, count: int) -> Numbers:
        return np.column_stack(
            [2.0 * np.pi / generator.uniform(6.0, 12.0, count), generator.uniform(0.0, 2.0 * np.pi, count)]
        )

    def goals(self, episodes: Numbers, times: Numbers) -> Numbers:
        angle = episodes[:, 0] * times + episodes[:, 1]
        return np.column_stack([1.5 * np.sin(angle), 0.75 * np.sin(2.0 * angle), 0.5 * np.cos(angle)])


#: By their names.
TASKS: dict[str, type[Hover] | type[Track]] = {"hover": Hover, "track": Track}
