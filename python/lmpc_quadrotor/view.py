"""A page that shows a flight: one HTML file without anything from elsewhere."""

import argparse
import json
import subprocess
import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .files import sitl_path

#: Columns that the page needs, by the names of the FMU's outputs.
_NEEDED = ["time", "position.x", "position.y", "position.z"]
#: Columns that it shows if they are there.
_SHOWN = ["setpoint.position.x", "setpoint.position.y", "setpoint.position.z", "attitude.phi", "attitude.theta", "attitude.psi", "thrust"]
#: More points than this are not seen.
_POINTS = 2000


def flight_page(table: Any, title: str = "Flight") -> str:
    """The page of a flight, from a structured array as `Simulation.fly` and FMPy give it.

    Raises `ValueError` when it has no `time` or `position.x`, `.y`, `.z`.
    """
    names = list(table.dtype.names or [])
    missing = [name for name in _NEEDED if name not in names]
    if missing:
        raise ValueError(f"the flight has no column {', '.join(missing)}; it has {', '.join(names) or 'no names'}")
    every = max(1, -(-len(table) // _POINTS))
    rows = table[::every]
    columns = {name: np.round(rows[name].astype(float), 5).tolist() for name in _NEEDED + [name for name in _SHOWN if name in names]}
    template = (Path(__file__).parent / "view.html").read_text(encoding="utf-8")
    data = json.dumps({"title": title, "columns": columns}).replace("<", "\\u003c")
    return template.replace("/*DATA*/null", data)


def _read(path: Path) -> Any:
    table = np.genfromtxt(path, delimiter=",", names=True, deletechars="", encoding="utf-8", dtype=float)
    return np.atleast_1d(table)


def _serve(path: Path) -> int:
    try:
        return subprocess.call([sitl_path(), "--view-record", str(path)])
    except KeyboardInterrupt:
        return 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Writes the page of a CSV file and opens it if that is asked for, or serves the live page with the file."""
    parser = argparse.ArgumentParser(prog="python -m lmpc_quadrotor view", description="Writes a page that shows a flight.")
    parser.add_argument("file", type=Path, help="CSV file with the columns time and position.x, .y, .z, as FMPy's --output-file writes it")
    parser.add_argument("--output", type=Path, help="page to write (default: FILE.html)")
    parser.add_argument("--open", action="store_true", help="open the page in a browser")
    parser.add_argument("--serve", action="store_true", help="show it in the live page of lmpc-sitl instead, until Ctrl-C; takes ULogs (.ulg), too")
    chosen = parser.parse_args(arguments)
    if chosen.serve:
        return _serve(chosen.file)
    output = chosen.output or chosen.file.with_suffix(".html")
    try:
        output.write_text(flight_page(_read(chosen.file), chosen.file.stem), encoding="utf-8")
    except (OSError, ValueError) as problem:
        print(f"error: {chosen.file}: {problem}", file=sys.stderr)
        return 1
    print(output)
    if chosen.open:
        webbrowser.open(output.resolve().as_uri())
    return 0
