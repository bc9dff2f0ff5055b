"""The picture of the product: the paper's flight in the FMU, and a circle that a MAVLink client streams, each beside its reference."""

import csv
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image
from pyulog import ULog

INK, QUIET, FAINT, PANE = "#24292f", "#57606a", "#c5ccd3", "#f6f8fa"
FLOWN, FRONT = "#0072b2", "#d55e00"
REFERENCE = {"color": "#f2b134", "linestyle": (0, (3, 3)), "linewidth": 1.6}
#: Length of a drawn arm, m: several times the real one, so that the attitude can be seen.
ARM = 0.75


@dataclass(frozen=True)
class Flight:
    """A flight as the picture needs it, in north, east, down; m."""

    position: np.ndarray
    reference: np.ndarray
    #: From the body's frame into the world's, one matrix a point.
    rotation: np.ndarray
    #: Points at which the vehicle is drawn.
    places: np.ndarray


@plt.rc_context({"font.size": 9, "text.color": INK, "axes.labelcolor": INK, "xtick.color": QUIET, "ytick.color": QUIET, "grid.color": "#e4e8ec"})
def draw(table: Path, log: Path, picture: Path) -> Path:
    """Draws a flight of the FMU from its table and one of the vehicle from its log."""
    # An opaque card: legible on light and dark pages.
    figure = plt.figure(figsize=(10, 4.9), facecolor="white")
    climb = figure.add_axes((0.0, 0.02, 0.43, 0.88), projection="3d", computed_zorder=False)
    circle = figure.add_axes((0.4, 0.0, 0.58, 0.92), projection="3d", computed_zorder=False)
    _scene(climb, _flight_of_table(table), (5, 5, 10), 0.86)
    _scene(circle, _flight_of_log(log), (4, 8, 5), 1.03)
    circle.legend(loc="upper right", bbox_to_anchor=(1.0, 1.06), frameon=False)
    for x, title, subtitle in (
        (0.03, "FMU in FMPy", "the paper's flight: 5 m north, 5 m east, 10 m up"),
        (0.47, "MAVLink vehicle from pymavlink", "a streamed circle: radius 4 m, 10 s a turn"),
    ):
        figure.text(x, 0.935, title, fontsize=12, fontweight="bold")
        figure.text(x, 0.888, subtitle, color=QUIET)
    figure.savefig(picture, dpi=130)
    plt.close(figure)
    # Few colours: a palette halves the size.
    with Image.open(picture) as drawn:
        drawn.convert("RGB").quantize(128).save(picture, optimize=True)
    return picture


def _flight_of_table(file: Path) -> Flight:
    with file.open(encoding="utf-8") as lines:
        names = next(csv.reader(lines))
        columns = dict(zip(names, np.loadtxt(lines, delimiter=",").T))
    position, reference = (
        np.column_stack([columns[f"{prefix}.{axis}"] for axis in "xyz"]) for prefix in ("position", "setpoint.position"))
    rotation = _of_angles(*(columns[f"attitude.{angle}"] for angle in ("phi", "theta", "psi")))
    return Flight(position, reference, rotation, _evenly(position, 7))


def _flight_of_log(file: Path) -> Flight:
    topics = {dataset.name: dataset.data for dataset in ULog(str(file)).data_list}
    flown, asked, attitude = (
        topics[name] for name in ("vehicle_local_position", "vehicle_local_position_setpoint", "vehicle_attitude"))
    position, reference = (np.column_stack([data[axis] for axis in "xyz"]) for data in (flown, asked))
    at = np.searchsorted(attitude["timestamp"], flown["timestamp"]).clip(max=len(attitude["timestamp"]) - 1)
    rotation = _of_quaternion(*(attitude[f"q[{part}]"][at] for part in range(4)))
    # One turn of the circle, in the middle of it.
    middle, height = np.array([0.0, 4.0]), np.median(position[:, 2])
    turning = np.flatnonzero((np.abs(np.linalg.norm(position[:, :2] - middle, axis=1) - 4) < 0.2)
                             & (np.abs(position[:, 2] - height) < 0.2))
    end = turning[-1]
    turned = np.flatnonzero(flown["timestamp"] >= flown["timestamp"][end] - 10e6)[0]
    return Flight(position, reference, rotation, turned + _evenly(position[turned:end], 9)[:-1])


def _scene(axes, flight: Flight, extent: tuple, zoom: float) -> None:
    """Path, reference, shadow on the ground and the vehicle at some places."""
    north, east, down = flight.position.T
    axes.plot(east, north, 0 * down, color=FAINT, linewidth=2)
    for place in flight.places:
        axes.plot([east[place]] * 2, [north[place]] * 2, [0, -down[place]], color=FAINT, linewidth=0.9)
    axes.plot(east, north, -down, color=FLOWN, linewidth=2.6, label="flown")
    axes.plot(flight.reference[:, 1], flight.reference[:, 0], -flight.reference[:, 2], label="reference", **REFERENCE)
    for place in flight.places:
        _quadrotor(axes, flight.position[place], flight.rotation[place])

    limits = [(min(0.0, low) - 0.8, high + 0.8) for low, high in ((north.min(), extent[0]), (east.min(), extent[1]))]
    axes.set(ylim=limits[0], xlim=limits[1], zlim=(0, extent[2] + 0.5), xlabel="east, m", ylabel="north, m")
    axes.set_zlabel("altitude, m")
    axes.set_box_aspect([np.ptp(limits[1]), np.ptp(limits[0]), extent[2] + 0.5], zoom=zoom)
    axes.view_init(elev=19, azim=-52)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color(PANE)
        axis.set_major_locator(plt.MultipleLocator(2))
    axes.tick_params(pad=0)


def _evenly(position: np.ndarray, count: int) -> np.ndarray:
    """Points at equal distances along a path, its ends included."""
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(position, axis=0), axis=1))])
    return np.searchsorted(along, np.linspace(0, along[-1], count)).clip(max=len(position) - 1)


def _of_angles(phi, theta, psi) -> np.ndarray:
    """Rotations of ZYX angles."""
    (sp, st, ss), (cp, ct, cs) = np.sin([phi, theta, psi]), np.cos([phi, theta, psi])
    return _matrices([
        [ct * cs, sp * st * cs - cp * ss, cp * st * cs + sp * ss],
        [ct * ss, sp * st * ss + cp * cs, cp * st * ss - sp * cs],
        [-st, sp * ct, cp * ct],
    ])


def _of_quaternion(w, x, y, z) -> np.ndarray:
    """Rotations of unit quaternions, scalar first."""
    return _matrices([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def _matrices(rows) -> np.ndarray:
    """From a matrix of series to a series of matrices."""
    return np.moveaxis(np.array(rows, dtype=float), -1, 0)


def _quadrotor(axes, place: np.ndarray, rotation: np.ndarray) -> None:
    """Arms and rotors; the front one is coloured."""
    turn = np.linspace(0, 2 * np.pi, 25)
    ring = 0.42 * ARM * np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    tips = ARM * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])

    def world(points):
        north, east, down = (place + points @ rotation.T).T
        return east, north, -down

    for arm in (tips[[0, 2]], tips[[1, 3]]):
        axes.plot(*world(arm), color=INK, linewidth=1.3)
    for number, tip in enumerate(tips):
        axes.plot(*world(ring + tip), color=FRONT if number == 0 else INK, linewidth=1.6 if number == 0 else 1.1)
