"""Rows of numbers as structured arrays, whose fields have the names of the variables."""

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import ArgumentError

#: What a parameter or an input can be set to.
Value: TypeAlias = float | int | bool | str
Values: TypeAlias = Mapping[str, Any]
Numbers: TypeAlias = npt.NDArray[np.float64]


def by_name(argument: str, given: Values | None) -> dict[str, Any]:
    """Values by name as a dict; empty if left out."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ArgumentError(f"{argument} = {given!r}; expected names with values, such as {{'airframe.mass': 0.9}}")
    for name in given:
        if not isinstance(name, str):
            raise ArgumentError(f"{argument} has the name {name!r}; expected text")
    return dict(given)


def list_of_names(argument: str, given: Iterable[str]) -> list[str]:
    """Names as a list; refuses a single string, which Python would split into letters."""
    if isinstance(given, str):
        raise ArgumentError(f"{argument} = {given!r}; expected a list of names: [{given!r}]")
    try:
        names = list(given)
    except TypeError:
        raise ArgumentError(f"{argument} = {given!r}; expected a list of names") from None
    for name in names:
        if not isinstance(name, str):
            raise ArgumentError(f"{argument} has {name!r}; expected names")
    return names


@cache
def _outputs() -> dict[str, dict[str, Any]]:
    return _native.outputs()


def structured(times: npt.NDArray[np.float64], columns: list[str], rows: Numbers) -> npt.NDArray[np.void]:
    """A structured array with a field `time` and one for each of the columns, which are the last axis of `rows`."""
    fields = [(name, np.int32 if _outputs()[name]["whole"] else np.float64) for name in columns]
    table = np.empty(rows.shape[:-1], dtype=[("time", np.float64), *fields])
    table["time"] = times.reshape(times.shape + (1,) * (table.ndim - 1))
    for column, name in enumerate(columns):
        table[name] = rows[..., column]
    return table
