"""The fixtures, and what a failed test leaves behind."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from collections.abc import Callable, Generator
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeAlias

import pytest

from .options import of_test
from .vehicle import Sitl, SitlError

#: Whether a part of a test has failed.
_FAILED = pytest.StashKey[bool]()
#: Last lines of the output that a report shows.
_LINES = 40

#: What `sitl_factory` is: starts a vehicle with the options of the marker, changed by keywords.
SitlFactory: TypeAlias = Callable[..., Sitl]


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Remembers that a test has failed, until its vehicles have ended."""
    report = yield
    if report.failed:
        item.stash[_FAILED] = True
    return report


@pytest.fixture
def sitl_factory(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Generator[SitlFactory, None, None]:
    """Starts vehicles: `sitl_factory(wind=5, seed=3)` has the options of the marker `sitl`, changed by its keywords."""
    vehicles: list[Sitl] = []
    item = request.node

    def start(**options: Any) -> Sitl:
        __tracebackhide__ = True
        folder = tmp_path_factory.mktemp(f"sitl_{_plain(item.name)[:40]}", numbered=True)
        vehicle = Sitl(of_test(request).with_(options), folder)
        vehicles.append(vehicle)
        item.user_properties += [("sitl_seed", vehicle.seed), ("sitl_record", str(vehicle.record))]
        return vehicle

    yield start
    for vehicle in vehicles:
        vehicle.stop()
    problems = [f"{problem}:\n{vehicle.output()}" for vehicle in vehicles if (problem := vehicle.problem())]
    if problems or item.stash.get(_FAILED, False):
        artifacts = request.config.getoption("sitl_artifacts")
        for number, vehicle in enumerate(vehicles):
            record = _keep(vehicle, Path(artifacts) / _plain(item.nodeid) / f"vehicle{number}") if artifacts else vehicle.record
            item.add_report_section("teardown", f"sitl vehicle {number}", _report(vehicle, record))
    if problems:
        raise SitlError("\n".join(problems))


@pytest.fixture
def sitl(sitl_factory: SitlFactory) -> Sitl:
    """A vehicle that can be armed, on ports of its own; the marker `sitl` and the options `--sitl-…` say which."""
    __tracebackhide__ = True
    return sitl_factory()


def _plain(name: str) -> str:
    """A name that a folder can have on any system."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name).strip("_.")


def _replay(vehicle: Sitl, record: Path) -> str:
    return shlex.join([vehicle.command[0], "--replay", str(record)])


def _keep(vehicle: Sitl, folder: Path) -> Path:
    """Copies what a vehicle has left into a folder, and returns its record there."""
    if folder.exists():
        shutil.rmtree(folder)
    shutil.copytree(vehicle.folder, folder, ignore=shutil.ignore_patterns("ready.json", "*.lock"))
    record = folder.resolve() / vehicle.record.name
    (folder / "replay.txt").write_text(f"lmpc-sitl --replay {record.name}\n")
    facts = {"seed": vehicle.seed, "digest": vehicle.digest, "command": vehicle.command, "options": asdict(vehicle.options)}
    (folder / "vehicle.json").write_text(json.dumps(facts, indent=2, default=str) + "\n")
    return record


def _report(vehicle: Sitl, record: Path) -> str:
    lines = vehicle.output().splitlines()
    logs = "".join(f"flight log: {log}\n" for log in sorted(record.parent.rglob("*.ulg")))
    return (
        f"seed: {vehicle.seed}\n"
        f"record: {record}\n"
        f"{logs}"
        f"flight digest: {vehicle.digest or 'unknown: the program has not ended by itself'}\n"
        f"replay bit for bit: {_replay(vehicle, record)}\n"
        f"last lines of the output ({record.parent / vehicle.log.name}):\n" + "\n".join(lines[-_LINES:]) + "\n"
    )
