"""The book's table of failsafes has every cause, and the defaults that the program has."""

import json
import re
import subprocess
from pathlib import Path

PAGE = (Path(__file__).resolve().parents[3] / "book" / "src" / "vehicle" / "failsafes.md").read_text(encoding="utf-8")


def defaults(program, autopilot: str) -> dict:
    done = subprocess.run([program, "--autopilot", autopilot, "--list-parameters=json"], capture_output=True, text=True, timeout=30)
    return {parameter["name"]: parameter["value"] for parameter in json.loads(done.stdout)}


def rows(heading: str) -> list[list[str]]:
    """The cells of the first table after a heading."""
    table = re.search(r"(?:^\|.*\n)+", PAGE.split(heading, 1)[1], re.MULTILINE)[0]
    return [[cell.strip() for cell in line.strip("|\n").split("|")] for line in table.splitlines()[2:]]


def test_every_cause_has_a_row():
    # A test of the vehicle compares the diagram with the causes that there are.
    drawn = {cause for causes in re.findall(r"Flying --> \w+ : (.*)", PAGE) for cause in causes.split(", ")}
    told = set()
    for cause, *_ in rows("# Failsafes"):
        first, *others = cause.split(", ")
        told |= {first} | {f"{first.split()[0]} {other}" for other in others}
    assert told == drawn


def test_defaults_are_those_of_the_program(program):
    present, seen = defaults(program, "px4"), 0
    for _, _, chosen_by, default in rows("# Failsafes"):
        for name, told in zip(re.findall(r"`(\w+)`", chosen_by), default.split(";")):
            number = re.match(r"\s*(-?\d+)", told)
            assert number and present[name] == int(number[1]), (name, told)
            seen += 1
    assert seen >= 8
    ardupilot, seen = defaults(program, "ardupilot"), 0
    for names, values in rows("## ArduPilot's parameters"):
        told = re.findall(r"(-?\d+) [^,;\d]*\(default\)", values)
        # Several parameters in a row: one number for each, or one for all.
        if several := re.search(r"([−\d.]+(?: and [−\d.]+)*) by default", values):
            told = several[1].replace("−", "-").split(" and ")
        present = re.findall(r"`(\w+)`", names)
        for name, number in zip(present, told * len(present) if len(told) == 1 else told):
            assert ardupilot[name] == float(number), (name, values)
            seen += 1
    assert seen >= 14
