"""A page that shows a flight: the live page of lmpc-sitl and the flight in one self-contained HTML file."""

import argparse
import os
import subprocess
import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from .files import sitl_path

#: Columns that the page needs, by the names of the FMU's outputs.
_NEEDED = ["time", "position.x", "position.y", "position.z"]


def flight_page(table: Any, title: str = "Flight") -> str:
    """The page of a flight, from a structured array as `Simulation.fly` and FMPy give it.

    Raises `ValueError` when it has no `time` or `position.x`, `.y`, `.z`.
    """
    _check(table)
    names = list(table.dtype.names)
    with TemporaryDirectory() as folder:
        flown, page = Path(folder) / "flight.csv", Path(folder) / "flight.html"
        columns = np.column_stack([np.asarray(table[name], dtype=float) for name in names])
        np.savetxt(flown, columns, "%.9g", ",", header=",".join(names), comments="")
        _write(flown, page)
        text = page.read_text(encoding="utf-8")
    return text.replace("flight.csv", title.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;"))


def _check(table: Any) -> None:
    names = list(getattr(getattr(table, "dtype", None), "names", None) or [])
    missing = [name for name in _NEEDED if name not in names]
    if missing:
        raise ValueError(f"the flight has no column {', '.join(missing)}; it has {', '.join(names) or 'no named columns'}")
    if len(table) == 0:
        raise ValueError("the flight has no rows")


def _write(flown: Path, page: Path) -> None:
    """Writes the page. Raises `ValueError` with the error message of the program."""
    settings = {name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")}
    command = [sitl_path(), "--view-record", str(flown), "--view-page", str(page), "--log", "warn"]
    ended = subprocess.run(command, capture_output=True, text=True, env=settings)
    if ended.returncode != 0:
        raise ValueError(ended.stderr.strip().removeprefix("lmpc-sitl: "))


def _serve(path: Path) -> int:
    try:
        return subprocess.call([sitl_path(), "--view-record", str(path)])
    except KeyboardInterrupt:
        return 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Writes the page of a flight and opens it on request, or serves the live page with the flight."""
    parser = argparse.ArgumentParser(prog="python -m lmpc_quadrotor view", description="Writes a page that shows a flight.")
    parser.add_argument("file", type=Path, help="table (.csv, with the columns time and position.x, .y and .z, as FMPy's --output-file writes it), log (.ulg) or record (.lmpc)")
    parser.add_argument("--output", type=Path, help="page to write (default: FILE.html)")
    parser.add_argument("--open", action="store_true", help="open the page in a browser")
    parser.add_argument("--serve", action="store_true", help="serve the page until Ctrl-C instead of writing it")
    chosen = parser.parse_args(arguments)
    if chosen.serve:
        return _serve(chosen.file)
    if not chosen.file.is_file():
        print(f"error: {chosen.file}: there is no such file", file=sys.stderr)
        return 1
    output = chosen.output or chosen.file.with_suffix(".html")
    try:
        _write(chosen.file, output)
    except (OSError, ValueError) as problem:
        # Some messages name the file themselves.
        named = "" if str(chosen.file) in str(problem) else f"{chosen.file}: "
        print(f"error: {named}{problem}", file=sys.stderr)
        return 1
    print(output)
    if chosen.open:
        webbrowser.open(output.resolve().as_uri())
    return 0
