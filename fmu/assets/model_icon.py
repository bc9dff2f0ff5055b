"""Draws model.png, the FMU's icon: a quadrotor from above.

Run `python model_icon.py` in an environment with matplotlib after a change here, and commit both files.
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle, FancyBboxPatch

BLUE = "#0072b2"
ORANGE = "#d55e00"
GREY = "#333333"


def main() -> None:
    figure = plt.figure(figsize=(2.56, 2.56), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(-1, 1), ylim=(-1, 1), aspect="equal")
    axes.axis("off")

    # The paper's "+" configuration; the front rotor's colour tells the heading.
    for angle in np.deg2rad([0, 90, 180, 270]):
        x, y = 0.58 * np.cos(angle), 0.58 * np.sin(angle)
        axes.plot([0, x], [0, y], color=GREY, linewidth=9, solid_capstyle="round", zorder=2)
        colour = ORANGE if y > 0.1 else BLUE
        axes.add_patch(Circle((x, y), 0.36, facecolor=colour, alpha=0.3, edgecolor="none", zorder=1))
        axes.add_patch(Circle((x, y), 0.36, facecolor="none", edgecolor=colour, linewidth=4, zorder=3))
        axes.add_patch(Circle((x, y), 0.075, facecolor=GREY, edgecolor="none", zorder=4))
    body = FancyBboxPatch((-0.13, -0.15), 0.26, 0.3, boxstyle="round,pad=0.06", facecolor=GREY, edgecolor="none")
    body.set_zorder(5)
    axes.add_patch(body)

    # A discrete Laguerre function on its back.
    step = np.arange(9)
    axes.vlines(-0.12 + 0.03 * step, -0.12, -0.12 + 0.26 * 0.72**step, color="white", linewidth=2, zorder=6)

    figure.savefig(Path(__file__).with_name("model.png"), transparent=True, metadata={"Software": None})


if __name__ == "__main__":
    main()
