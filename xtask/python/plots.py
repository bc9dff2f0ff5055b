"""Plots of a flight."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

from measures import path, reference_of, tilt, wrapped

COLOURS = {"north": "#0072b2", "east": "#d55e00", "altitude": "#009e73", "heading": "#cc79a7"}
ROTORS = {"front": "#0072b2", "right": "#d55e00", "back": "#56b4e9", "left": "#e69f00"}
TORQUES = {"phi": "#0072b2", "theta": "#d55e00", "psi": "#cc79a7"}
REFERENCE = {"color": "#333333", "linestyle": (0, (5, 3)), "linewidth": 1.2}

#: Only while something is drawn, so that pictures do not depend on what was drawn before.
STYLE = {
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "axes.axisbelow": True,
    "axes.titlesize": 10,
    "legend.framealpha": 0.9,
}


@plt.rc_context(STYLE)
def draw_path(flight, result: np.ndarray, folder: Path) -> Path:
    """Draws the path of a flight and returns the file."""
    return _save(_path_figure(flight, result), folder / f"{flight.name}-path.png")


@plt.rc_context(STYLE)
def draw(flight, result: np.ndarray, limits: dict, folder: Path) -> list[Path]:
    """Draws path, axes and actuators of a flight, and returns the files."""
    return [
        draw_path(flight, result, folder),
        _save(_axes_figure(flight, result), folder / f"{flight.name}-axes.png"),
        _save(_actuators_figure(flight, result, limits), folder / f"{flight.name}-actuators.png"),
    ]


def _save(figure, file: Path) -> Path:
    figure.savefig(file)
    plt.close(figure)
    return file


def _path_figure(flight, result):
    reference, _ = reference_of(flight, result)
    flown = path(result)
    figure = plt.figure(figsize=(7, 6.4))
    axes = figure.add_subplot(projection="3d")
    north, east, altitude = flown.T
    axes.plot(east, north, np.zeros_like(altitude), color="#bbbbbb", linewidth=1.5, label="ground track")
    for point in range(0, len(flown), max(1, len(flown) // 24)):
        axes.plot([east[point]] * 2, [north[point]] * 2, [0, altitude[point]], color="#dddddd", linewidth=0.7)
    axes.plot(east, north, altitude, color=COLOURS["north"], linewidth=2.4, label="flown")
    if np.ptp(reference, axis=0).any():
        axes.plot(reference[:, 1], reference[:, 0], reference[:, 2], label="reference", **REFERENCE)
    else:
        axes.scatter(reference[0, 1], reference[0, 0], reference[0, 2], color=REFERENCE["color"], marker="x", s=90, label="reference")
    axes.scatter(east[0], north[0], altitude[0], color="#333333", s=30, label="start")
    axes.scatter(east[-1], north[-1], altitude[-1], color="#d55e00", s=40, label="end")
    axes.set(xlabel="east, m", ylabel="north, m", zlabel="altitude, m")
    axes.set_zlim(bottom=min(0.0, altitude.min()))
    axes.set_box_aspect((1, 1, 1.25), zoom=0.9)
    axes.view_init(elev=22, azim=-60)
    axes.legend(loc="upper left")
    figure.suptitle(f"{flight.name}: {flight.title}", fontsize=10)
    return figure


def _axes_figure(flight, result):
    reference, yaw_reference = reference_of(flight, result)
    time = result["time"]
    flown = path(result)
    figure, grid = plt.subplots(4, 2, sharex=True, figsize=(10, 9), width_ratios=(3, 2))
    for row, axis in enumerate(("north", "east", "altitude")):
        _value(grid[row, 0], time, flown[:, row], reference[:, row], axis, f"{axis}, m")
        error = flown[:, row] - reference[:, row]
        scale, unit = (1, "m") if np.abs(error).max() > 1 else (1e3, "mm")
        _error(grid[row, 1], time, scale * error, axis, f"error, {unit}")
    yaw = np.unwrap(result["attitude.psi"])
    _value(grid[3, 0], time, np.rad2deg(yaw), np.rad2deg(yaw_reference), "heading", "heading ψ, deg")
    _error(grid[3, 1], time, np.rad2deg(wrapped(yaw - yaw_reference)), "heading", "error, deg")
    grid[0, 0].set_title("flown and reference")
    grid[0, 1].set_title("flown minus reference")
    for axes in grid[-1]:
        axes.set(xlabel="time, s", xlim=(time[0], time[-1]))
    figure.align_ylabels()
    figure.suptitle(f"{flight.name}: {flight.title}", fontsize=10)
    return figure


def _value(axes, time, flown, reference, axis, label):
    axes.plot(time, flown, color=COLOURS[axis], linewidth=1.8, label="flown")
    axes.plot(time, reference, label="reference", **REFERENCE)
    _at_least(axes, np.concatenate([flown, reference]), 0.5)
    axes.set_ylabel(label)
    # Where the curves leave room.
    axes.legend(loc="best")


def _error(axes, time, error, axis, label):
    axes.axhline(0, color="#999999", linewidth=0.8)
    axes.plot(time, error, color=COLOURS[axis], linewidth=1.4)
    _at_least(axes, error, 0.05)
    axes.set_ylabel(label)


def _at_least(axes, values, span):
    """Keeps rounding errors of a quantity that rests from being blown up to the height of the plot."""
    low, high = values.min(), values.max()
    if high - low < span:
        middle = (low + high) / 2
        axes.set_ylim(middle - span / 2, middle + span / 2)


def _actuators_figure(flight, result, limits):
    time = result["time"]
    figure, grid = plt.subplots(4, 1, sharex=True, figsize=(9, 9.5))
    thrust, torque, lean, rotors = grid

    thrust.plot(time, result["thrust"], color="#333333", linewidth=1.6)
    _bounds(thrust, limits["limits.thrust.min"], limits["limits.thrust.max"], "limits.thrust")
    thrust.set_ylabel("thrust F, N")

    for name, symbol in (("phi", "φ (roll)"), ("theta", "θ (pitch)"), ("psi", "ψ (yaw)")):
        torque.plot(time, result[f"torque.{name}"], color=TORQUES[name], linewidth=1.4, label=f"τ {symbol}")
    torque.set_ylabel("torque, N·m")

    for name, symbol in (("phi", "φ (roll)"), ("theta", "θ (pitch)")):
        flown, asked = result[f"attitude.{name}"], result[f"tilt_reference.{name}"]
        lean.plot(time, np.rad2deg(flown), color=TORQUES[name], linewidth=1.6, label=symbol)
        lean.plot(time, np.rad2deg(asked), **{**REFERENCE, "color": TORQUES[name]})
    lean.plot(time, np.rad2deg(tilt(result)), color="#999999", linewidth=1.0, label="tilt")
    limit = np.rad2deg(limits["limits.tilt"])
    _bounds(lean, -limit, limit, "limits.tilt")
    lean.set_ylabel("attitude, deg\n(dashed: asked for)")

    for number, (name, colour) in enumerate(ROTORS.items(), start=1):
        rotors.plot(time, result[f"rotor.speed[{number}]"], color=colour, linewidth=1.3, label=name)
    _bounds(rotors, limits["airframe.rotor.speed_min"], limits["airframe.rotor.speed_max"], "airframe.rotor.speed")
    rotors.set(ylabel="rotor speed, rad/s", xlabel="time, s", xlim=(time[0], time[-1]))

    for axes in grid:
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=5, fontsize=8, frameon=False, borderaxespad=0.2)
    figure.align_ylabels()
    figure.suptitle(f"{flight.name}: {flight.title}", fontsize=10)
    return figure


def _bounds(axes, low, high, name):
    for number, value in enumerate((low, high)):
        axes.axhline(value, color="#aa0000", linewidth=0.9, linestyle=":", label=name if number == 0 else None)
