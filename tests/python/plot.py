"""What FMPy shows in a browser: a program that stands in for the browser, and a reader of the page."""

import base64
import json
import re
import sys
import time
import urllib.request
from pathlib import Path

import numpy as np


def environment(page: Path) -> dict[str, str]:
    """Environment variables by which Python's `webbrowser` saves the page in place of opening a window."""
    # With "&" the browser is not waited for: it loads the page from the program that opened it.
    return {"BROWSER": f'"{sys.executable}" "{__file__}" "{page}" %s &'}


def curves(page: Path) -> dict[str, np.ndarray]:
    """The curves of a page by plotly, by the titles of their vertical axes."""
    end = time.monotonic() + 60.0
    while not page.is_file():
        assert time.monotonic() < end, "no page was shown"
        time.sleep(0.05)
    html = page.read_text(encoding="utf-8")
    start = re.search(r'Plotly\.newPlot\(\s*"[^"]*",\s*', html)
    assert start, "the page has no plot"
    decoder = json.JSONDecoder()
    traces, end = decoder.raw_decode(html, start.end())
    layout, _ = decoder.raw_decode(html, re.compile(r"\s*,\s*").match(html, end).end())
    axis = lambda trace: layout[trace.get("yaxis", "y").replace("y", "yaxis")]
    return {axis(trace)["title"]["text"]: _numbers(trace["y"]) for trace in traces}


def _numbers(values) -> np.ndarray:
    if isinstance(values, dict):  # plotly's binary form
        return np.frombuffer(base64.b64decode(values["bdata"]), dtype=values["dtype"])
    return np.array(values)


if __name__ == "__main__":
    target, address = Path(sys.argv[1]), sys.argv[2]
    part = target.with_suffix(".part")
    part.write_bytes(urllib.request.urlopen(address, timeout=60).read())
    part.replace(target)
