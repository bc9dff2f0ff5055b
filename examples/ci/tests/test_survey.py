"""Flies the program against a simulated vehicle: calm, in wind, on other airframes, and when a rotor fails."""

import math

import pytest
from survey import Survey


@pytest.fixture
def survey(sitl):
    """The program, connected to a vehicle of its own."""
    program = Survey(sitl.pymavlink)
    yield program
    program.close()


def beside(track, corner):
    """How near the vehicle came to a corner, m."""
    return min(math.dist(position, corner) for position in track)


def check_square(survey):
    side, height = survey.side, survey.height
    for corner in ((side, 0, -height), (side, side, -height), (0, side, -height)):
        assert beside(survey.track, corner) < 3.0, corner
    north, east, _ = survey.track[-1]
    assert math.hypot(north, east) < 0.5


def test_flies_the_square(survey):
    survey.fly()
    check_square(survey)


@pytest.mark.sitl(wind=(6, 270), gusts=1.0, sensors="realistic", seed=4)
def test_flies_the_square_in_wind(survey):
    survey.fly()
    north, east, _ = survey.track[-1]
    assert math.hypot(north, east) < 2.0


@pytest.mark.parametrize("airframe", [pytest.param(name, marks=pytest.mark.sitl(airframe=name)) for name in ("iris", "hummingbird")])
def test_flies_the_square_on(airframe, survey):
    survey.fly()
    check_square(survey)


@pytest.mark.sitl(faults="8:rotor1=off")
def test_a_lost_rotor_does_not_end_in_a_fall(survey):
    survey.fly()
    sinks = [(b[2] - a[2]) for a, b in zip(survey.track, survey.track[1:])]
    assert max(sinks) < 2.0 and survey.track[-1][2] > -1.0
