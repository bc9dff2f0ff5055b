"""Line charts as SVG for the front pages of the crates, in colours that suit light and dark pages."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

COLOURS = {"blue": "#3d8fd1", "orange": "#e0752d", "green": "#2ba37a", "grey": "#8a8f96"}
WIDTH, LEFT, RIGHT = 640, 70, 500


@dataclass
class Line:
    """A line with its name in the legend; lines of limits and references are dashed."""

    x: np.ndarray
    y: np.ndarray
    colour: str
    name: str
    dashed: bool = False


@dataclass
class Chart:
    """Lines over a common axis of time."""

    title: str
    y_ticks: Iterable[float]
    lines: list[Line]


def svg(description: str, charts: list[Chart], x_ticks: Iterable[float], x_title: str, height: int = 110) -> str:
    """Charts below each other. It has no empty line, at which Markdown would end it."""
    x_ticks, body = list(x_ticks), []
    across = lambda x: LEFT + (RIGHT - LEFT) * (x - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])  # noqa: E731
    for number, chart in enumerate(charts):
        ticks, top = list(chart.y_ticks), 15 + number * (height + 22)
        down = lambda y, top=top, ticks=ticks: top + height * (ticks[-1] - y) / (ticks[-1] - ticks[0])  # noqa: E731
        for tick in ticks:
            body.append(f'<path d="M{LEFT} {down(tick):.1f}H{RIGHT}" stroke="currentColor" stroke-opacity="0.15"/>')
            body.append(f'<text x="{LEFT - 8}" y="{down(tick) + 4:.1f}" text-anchor="end">{tick:g}</text>')
        body.append(f'<text transform="translate(18 {top + height / 2:.0f}) rotate(-90)" text-anchor="middle">{chart.title}</text>')
        for row, line in enumerate(chart.lines):
            dash = ' stroke-dasharray="5 4"' if line.dashed else ""
            points = " ".join(f"{across(x):.1f},{down(y):.1f}" for x, y in zip(line.x, line.y))
            body.append(f'<polyline fill="none" stroke="{COLOURS[line.colour]}" stroke-width="2"{dash} points="{points}"/>')
            y = top + 10 + 18 * row
            body.append(f'<path d="M{RIGHT + 14} {y}h24" stroke="{COLOURS[line.colour]}" stroke-width="2"{dash}/>')
            body.append(f'<text x="{RIGHT + 44}" y="{y + 4}">{line.name}</text>')
    bottom = 15 + len(charts) * (height + 22)
    body += [f'<text x="{across(tick):.1f}" y="{bottom}" text-anchor="middle">{tick:g}</text>' for tick in x_ticks]
    body.append(f'<text x="{(LEFT + RIGHT) / 2:.0f}" y="{bottom + 20}" text-anchor="middle">{x_title}</text>')
    head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {bottom + 28}" width="{WIDTH}" role="img" aria-label="{description}" '
            'font-family="sans-serif" font-size="12" fill="currentColor">')  # fmt: skip
    return "\n".join(["<div>", head, *body, "</svg>", "</div>"]) + "\n"
