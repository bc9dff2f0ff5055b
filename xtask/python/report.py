"""The demo's report: pictures of all flights, each with a page that shows the flight in 3D. Browsers open it from disk."""

import os
import subprocess
from dataclasses import dataclass
from html import escape
from pathlib import Path

#: What the pages are made of is in the vehicle's program.
STYLE = """:root { color-scheme: light dark; } body { margin: 0 auto; max-width: 75rem; padding: 1rem; font: 1rem/1.5 system-ui, sans-serif; }
figure { margin: 0.5rem 0; } img { max-width: 100%; height: auto; background: #fff; } a { color: light-dark(#0b57c2, #8ab8ff); }"""


@dataclass(frozen=True)
class Shown:
    """A flight in the report."""

    title: str
    #: A table or a log of the vehicle.
    flown: Path
    pictures: list[Path]


def write(program: Path, flights: list[Shown], folder: Path) -> list[Path]:
    """Writes a page for each flight and an overview that links to them; returns all of them, the overview first."""
    pages = [_page(program, flight.flown) for flight in flights]
    report = folder / "report.html"
    sections = "\n".join(_section(flight, page) for flight, page in zip(flights, pages))
    report.write_text(
        f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>Flights of the demo</title>\n<style>{STYLE}</style>\n<h1>Flights of the demo</h1>\n{sections}\n</html>\n",
        encoding="utf-8")
    return [report, *pages]


def _page(program: Path, flown: Path) -> Path:
    page = flown.with_suffix(".html")
    settings = {name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")}
    subprocess.run([program, "--view-record", flown, "--view-page", page, "--log", "warn"], check=True, timeout=60, env=settings)
    return page


def _section(flight: Shown, page: Path) -> str:
    figures = "\n".join(
        f'<figure><img src="{escape(picture.name)}" alt="{escape(flight.title)}: {escape(picture.stem)}" loading="lazy"></figure>'
        for picture in flight.pictures)
    return f'<h2>{escape(flight.title)}</h2>\n<p><a href="{escape(page.name)}">Watch it in three dimensions</a></p>\n{figures}'
