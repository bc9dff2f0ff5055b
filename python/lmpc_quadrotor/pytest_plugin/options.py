"""What a vehicle is started with: options of the command line, over which those of a test's marker go."""

from __future__ import annotations

import difflib
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import pytest


@dataclass(frozen=True)
class Options:
    """What a vehicle is started with. Names are those of the flags of lmpc-sitl where there is one."""

    #: Simulated seconds per second, or "max".
    speed: float | str = 20
    #: Preset or TOML file.
    airframe: str | None = None
    #: "px4", "ardupilot" or "generic".
    autopilot: str | None = None
    #: m/s; (m/s, degrees it comes from); or "5,270".
    wind: float | Sequence[float] | str | None = None
    #: Standard deviation, m/s.
    gusts: float | None = None
    #: Such as "12.5:rotor1=off".
    faults: Sequence[str] = ()
    #: "ideal" or "realistic".
    sensors: str | None = None
    #: Seed of everything random.
    seed: int = 1
    #: Latitude, longitude, altitude and maybe heading.
    home: Sequence[float] | str | None = None
    #: Plan to start with.
    mission: str | None = None
    #: MAVLink or dotted names of parameters with their values.
    parameters: dict[str, Any] = field(default_factory=dict)
    #: More flags of lmpc-sitl.
    args: Sequence[str] = ()
    #: Whether to wait until the vehicle can be armed.
    wait_armable: bool = True
    #: How long that may take, s of the wall clock.
    timeout: float = 30.0

    def with_(self, changes: dict[str, Any]) -> Options:
        """With some of them changed. `fault` may be one string, `args` and `parameters` add to those that are there."""
        __tracebackhide__ = True
        names = [one.name for one in fields(self)]
        for name in changes:
            if name not in names:
                close = difflib.get_close_matches(name, names, 1)
                hint = f"did you mean {close[0]}?" if close else f"allowed are {', '.join(names)}"
                raise pytest.UsageError(f"the vehicle has no option {name}; {hint}")
        merged = dict(changes)
        _check(merged)
        if "args" in merged:
            merged["args"] = (*self.args, *_strings("args", merged["args"]))
        if "faults" in merged:
            merged["faults"] = _strings("faults", merged["faults"])
        if "parameters" in merged:
            merged["parameters"] = {**self.parameters, **merged["parameters"]}
        return replace(self, **merged)

    def flags(self) -> list[str]:
        """As flags of lmpc-sitl."""
        flags = ["--speed", str(self.speed), "--seed", str(self.seed)]
        for name in ("airframe", "autopilot", "gusts", "sensors", "mission"):
            value = getattr(self, name)
            if value is not None:
                flags += [f"--{name}", str(value)]
        for name in ("wind", "home"):
            value = getattr(self, name)
            if value is not None:
                flags += [f"--{name}", _commas(value)]
        for fault in self.faults:
            flags += ["--fault", fault]
        for name, value in self.parameters.items():
            flags += ["--set", f"{name}={value}"]
        return [*flags, *self.args]


def _check(changes: dict[str, Any]) -> None:
    """Refuses what could not be written as flags: values themselves are judged by lmpc-sitl."""
    __tracebackhide__ = True
    for name, value in changes.items():
        if name in ("faults", "args") and not isinstance(value, (str, list, tuple)):
            raise pytest.UsageError(f"{name} = {value!r}; expected a list of strings")
        if name == "parameters" and not isinstance(value, dict):
            raise pytest.UsageError(f"parameters = {value!r}; expected names with values, such as {{'MPC_XY_VEL_MAX': 5}}")
        if name == "timeout" and (isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0):
            raise pytest.UsageError(f"timeout = {value!r}; expected a number of seconds above 0")
        if name == "wait_armable" and not isinstance(value, bool):
            raise pytest.UsageError(f"wait_armable = {value!r}; expected True or False")


def _strings(name: str, value: Any) -> tuple[str, ...]:
    if isinstance(value, str):
        return tuple(shlex.split(value)) if name == "args" else (value,)
    return tuple(str(one) for one in value)


def _commas(value: Any) -> str:
    if isinstance(value, (str, int, float)):
        return str(value)
    return ",".join(str(one) for one in value)


#: Options of the command line: name, type and help.
_COMMAND_LINE: list[tuple[str, Any, str]] = [
    ("speed", str, "simulated seconds per second, or max (default: 20)"),
    ("airframe", str, "airframe: a preset or a TOML file"),
    ("autopilot", str, "px4, ardupilot or generic (default: px4)"),
    ("wind", str, "steady wind: m/s, and degrees it comes from, as 5,270"),
    ("gusts", float, "standard deviation of gusts, m/s"),
    ("sensors", str, "ideal or realistic"),
    ("seed", int, "seed of everything random (default: 1)"),
    ("timeout", float, "longest wait until a vehicle can be armed, s (default: 30)"),
]


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the options."""
    group = parser.getgroup("sitl", "simulated vehicle (lmpc-quadrotor); a test's marker goes before these")
    for name, kind, text in _COMMAND_LINE:
        group.addoption(f"--sitl-{name}", dest=f"sitl_{name}", type=kind, help=text)
    group.addoption("--sitl-fault", dest="sitl_faults", action="append", metavar="FAULT", help="fault to inject, as 12.5:rotor1=off; repeatable")
    group.addoption("--sitl-args", dest="sitl_args", help="more flags of lmpc-sitl, as one word of the shell")
    group.addoption("--sitl-artifacts", dest="sitl_artifacts", metavar="DIR", help="folder that keeps logs and records of failed tests")


def pytest_configure(config: pytest.Config) -> None:
    """Registers the marker."""
    config.addinivalue_line(
        "markers",
        "sitl(wind=None, gusts=None, faults=(), airframe=None, autopilot=None, speed=20, sensors=None, seed=1, home=None, mission=None, "
        "parameters={}, args=(), wait_armable=True, timeout=30): what the fixture `sitl` starts the vehicle with",
    )


def of_test(request: pytest.FixtureRequest) -> Options:
    """Those of the command line, and over them those of the test's markers, the nearest last."""
    __tracebackhide__ = True
    config = request.config
    names = [name for name, _, _ in _COMMAND_LINE] + ["faults", "args"]
    given = {name: config.getoption(f"sitl_{name}") for name in names}
    options = Options().with_({name: value for name, value in given.items() if value is not None})
    for marker in reversed(list(request.node.iter_markers("sitl"))):
        if marker.args:
            raise pytest.UsageError(f"{request.node.nodeid}: the marker sitl takes keywords only, as sitl(wind=5)")
        options = options.with_(dict(marker.kwargs))
    return options
