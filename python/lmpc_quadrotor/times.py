"""Seconds as the whole microseconds that the engine counts in."""

import math

from ._native import ArgumentError

#: The engine's clock ends after some 292 000 years.
_MOST = 2**63 - 1


def microseconds(name: str, seconds: float, least: int = 0) -> int:
    """A time or duration in µs."""
    allowed = "0 s or more" if least == 0 else f"{least / 1e6} s or more"
    try:
        finite = math.isfinite(seconds)
    except TypeError:
        raise ArgumentError(f"{name} = {seconds!r}; expected a number, in s") from None
    if finite and round(seconds * 1e6) > _MOST:
        raise ArgumentError(f"{name} = {seconds} s; allowed is {allowed}, up to {_MOST / 1e6:.1e} s")
    if not finite or round(seconds * 1e6) < least:
        raise ArgumentError(f"{name} = {seconds} s; allowed is {allowed}")
    return round(seconds * 1e6)
