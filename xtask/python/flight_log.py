"""Draws a flight from the vehicle's own log, read by pyulog."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from pyulog import ULog

#: Name and sign of each axis as it is drawn.
AXES = {"x": ("north", 1), "y": ("east", 1), "z": ("up", -1)}
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
REFERENCE = {"color": "#333333", "linestyle": (0, (5, 3)), "linewidth": 1.2}


def draw(file: Path, picture: Path, title: str) -> None:
    """Position and tilt against what was asked, the rotors, and how hard the controllers had to work."""
    topics = {dataset.name: dataset.data for dataset in ULog(str(file)).data_list}
    figure, panels = plt.subplots(4, 1, figsize=(9, 10), sharex=True, layout="constrained")
    _position(panels[0], topics)
    _tilt(panels[1], topics)
    motors = topics["actuator_motors"]
    for index, (rotor, colour) in enumerate(zip(("front", "right", "back", "left"), COLOURS)):
        panels[2].plot(_seconds(motors), 100 * motors[f"control[{index}]"], color=colour, label=rotor)
    panels[2].set_ylabel("rotor thrust, %")
    status = topics["lmpc_status"]
    for controller, colour in zip(("altitude", "position", "attitude"), COLOURS):
        panels[3].plot(_seconds(status), status[f"{controller}_active_constraints"], color=colour, label=controller)
    panels[3].set(ylabel="active limits", xlabel="time of the vehicle, s")
    for panel in panels:
        panel.legend(loc="upper left", bbox_to_anchor=(1, 1))
    figure.suptitle(title)
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _seconds(data) -> np.ndarray:
    return data["timestamp"] / 1e6


def _position(panel, topics) -> None:
    flown, asked = topics["vehicle_local_position"], topics["vehicle_local_position_setpoint"]
    for (axis, (name, sign)), colour in zip(AXES.items(), COLOURS):
        panel.plot(_seconds(flown), sign * flown[axis], color=colour, label=name)
        panel.plot(_seconds(asked), sign * asked[axis], **REFERENCE, label="reference" if axis == "z" else None)
    panel.set_ylabel("position, m")


def _tilt(panel, topics) -> None:
    """Angle of the thrust axis from the vertical: of the attitude, and of the one that was asked for."""
    for topic, quaternion, style in (
        ("vehicle_attitude", "q", {"color": COLOURS[0], "label": "tilt"}),
        ("vehicle_attitude_setpoint", "q_d", {**REFERENCE, "label": "reference"}),
    ):
        data = topics[topic]
        x, y = data[f"{quaternion}[1]"], data[f"{quaternion}[2]"]
        panel.plot(_seconds(data), np.rad2deg(np.arccos(np.clip(1 - 2 * (x**2 + y**2), -1, 1))), **style)
    panel.set_ylabel("tilt, deg")
