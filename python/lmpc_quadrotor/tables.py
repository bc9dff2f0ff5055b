"""Rows of numbers as structured arrays, whose fields have the names of the variables."""

from collections.abc import Mapping
from functools import cache
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _native

#: What a parameter or an input can be set to.
Value: TypeAlias = float | int | bool | str
Values: TypeAlias = Mapping[str, Any]
Numbers: TypeAlias = npt.NDArray[np.float64]


@cache
def _outputs() -> dict[str, dict[str, Any]]:
    return _native.outputs()


def structured(times: npt.NDArray[np.float64], names: list[str], rows: Numbers) -> npt.NDArray[np.void]:
    """A structured array with a field `time` and one for each name; the last axis of `rows` are the names."""
    fields = [(name, np.int32 if _outputs()[name]["whole"] else np.float64) for name in names]
    table = np.empty(rows.shape[:-1], dtype=[("time", np.float64), *fields])
    table["time"] = times.reshape(times.shape + (1,) * (table.ndim - 1))
    for column, name in enumerate(names):
        table[name] = rows[..., column]
    return table
