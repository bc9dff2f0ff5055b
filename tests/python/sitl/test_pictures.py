"""The book's pictures show what flies today. That of the live page is made by its own test."""

import re
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from PIL import Image

import demo_fmu
import flights
import overview
import plots
import vehicle
from pictures import IMAGES, check, difference

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def circle(program, tmp_path_factory):
    """The flight of examples/circle.py: its plot and its log."""
    folder = tmp_path_factory.mktemp("circle")
    flight = vehicle.fly("circle", program, ROOT / "examples", folder)
    assert flight.met, flight.lines
    return flight


def circle_picture(unzipped, program, circle, folder):
    return circle.plot


def mission_picture(unzipped, program, circle, folder):
    flight = vehicle.fly("mission", program, ROOT / "examples", folder)
    assert flight.met, flight.lines
    return flight.plot


def flight_picture(unzipped, program, circle, folder):
    result, _ = demo_fmu.fly(flights.default(), unzipped)
    return overview.draw(demo_fmu.write_csv(result, folder / "default.csv"), circle.log, folder / "overview.png")


def step_picture(unzipped, program, circle, folder):
    result, limits = demo_fmu.fly(flights.step(), unzipped)
    _, axes, _ = plots.draw(flights.step(), result, limits, folder)
    return axes


MADE = {"circle.png": circle_picture, "mission.png": mission_picture, "flight.png": flight_picture, "step.png": step_picture}
#: A photograph of FMPy's page in a browser: compared by its curves.
OF_A_BROWSER = "fmpy.png"
#: Drawn by the tests in a browser.
LIVE_PAGE = "live-page.png"


@pytest.mark.parametrize("name", MADE)
def test_the_picture_is_what_flies(name, unzipped, program, circle, tmp_path):
    check(MADE[name](unzipped, program, circle, tmp_path), name, 0.02)


def test_fmpys_curves_are_the_flight(unzipped):
    """Where the curves are in the photograph: time 0 to 20 s, and in each of three plots two values that have grid lines."""
    result = simulate_fmu(unzipped, stop_time=20.0, output=["position.x", "position.y", "position.z"])
    with Image.open(IMAGES / OF_A_BROWSER) as image:
        red, green, blue = np.moveaxis(np.asarray(image.convert("RGB"), dtype=int), -1, 0)
    curve = (blue - red > 60) & (green > 100)
    left, right = 69, 872
    for name, top, bottom, (zero, other, value) in [
        ("position.x", 28, 145, (139, 55, 4.0)), ("position.y", 169, 285, (280, 196, 4.0)), ("position.z", 309, 425, (315, 420, -10.0)),
    ]:  # fmt: skip
        for time in (1.5, 2.0, 2.5, 3.0, 3.5, 8.0, 15.0):
            column = round(left + (right - left) * time / 20.0)
            rows = np.flatnonzero(curve[top:bottom, column]) + top
            assert rows.size, f"{name} at {time} s: no curve"
            shown = (rows.mean() - zero) / (other - zero) * value
            flown = np.interp(time, result["time"], result[name])
            assert shown == pytest.approx(flown, abs=0.2), f"{name} at {time} s"


def test_every_picture_of_the_book_is_checked():
    shown = {name for page in [ROOT / "README.md", *(ROOT / "book" / "src").rglob("*.md")]
             for name in re.findall(r"!\[[^\]]*\]\([^)]*?([\w-]+\.(?:png|svg|jpg|webp))\)", page.read_text(encoding="utf-8"))}
    assert shown == {file.name for file in IMAGES.iterdir()} == {*MADE, OF_A_BROWSER, LIVE_PAGE}


def test_another_flight_looks_different(tmp_path, unzipped, circle):
    """What the comparison is worth: the step flown by another controller."""
    assert difference(circle.plot, IMAGES / "mission.png") > 0.2
    flight = flights.step()
    flight.start_values["controller.kind"] = 3
    result, limits = demo_fmu.fly(flight, unzipped)
    _, axes, _ = plots.draw(flight, result, limits, tmp_path)
    assert difference(axes, IMAGES / "step.png") > 0.02
