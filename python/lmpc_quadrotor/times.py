"""Seconds as the whole microseconds that the engine counts in."""

import math

from ._native import ArgumentError


def microseconds(name: str, seconds: float, least: int = 0) -> int:
    """A time or duration in µs."""
    if not math.isfinite(seconds) or round(seconds * 1e6) < least:
        allowed = "0 s or more" if least == 0 else f"{least / 1e6} s or more"
        raise ArgumentError(f"{name} = {seconds} s; allowed is {allowed}")
    return round(seconds * 1e6)
