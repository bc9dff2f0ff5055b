"""Tables of the report: rows of text, written as Markdown or HTML."""

import html
import math


class Table:
    def __init__(self, heading: list[str]):
        self.heading, self.rows = heading, []

    def add(self, *cells) -> None:
        assert len(cells) == len(self.heading), (cells, self.heading)
        self.rows.append([str(cell) for cell in cells])

    def markdown(self) -> str:
        lines = [self.heading, ["---"] * len(self.heading), *self.rows]
        return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)

    def html(self) -> str:
        row = lambda cells, tag: "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"
        body = "".join(row(cells, "td") for cells in self.rows)
        return f"<div class=wide><table><thead>{row(self.heading, 'th')}</thead><tbody>{body}</tbody></table></div>"


def nothing(value) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def duration(ns) -> str:
    """With a unit, to three digits."""
    if nothing(ns):
        return "–"
    for size, unit in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if ns >= size:
            return f"{digits(ns / size)} {unit}"
    return f"{digits(ns)} ns"


def memory(count) -> str:
    if nothing(count):
        return "–"
    for size, unit in ((1e6, "MB"), (1e3, "kB")):
        if count >= size:
            return f"{digits(count / size)} {unit}"
    return f"{digits(count)} B"


def digits(value: float) -> str:
    """Three digits, without an exponent."""
    if value == 0:
        return "0"
    return f"{value:.{max(0, 2 - math.floor(math.log10(abs(value))))}f}"


def small(value) -> str:
    return "–" if nothing(value) else "0" if value == 0 else f"{value:.0e}"


def ratio(value, base) -> str:
    return "–" if nothing(value) or nothing(base) or base == 0 else f"{digits(value / base)}×"
