"""Plots of the report, as PNG in memory."""

import io
import math

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

from tables import nothing  # noqa: E402

OURS, THEIRS = "#0b6e4f", "#8a8f98"


def png(figure) -> bytes:
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=110, bbox_inches="tight", metadata={"Software": None})
    pyplot.close(figure)
    return data.getvalue()


def control(loops: list[dict]) -> bytes:
    """Bars of the cold step at limits: from the median to the 99th percentile, with the worst that was found."""
    figure, axes = pyplot.subplots(1, len(loops), figsize=(3.6 * len(loops), 3.6), squeeze=False)
    for axis, loop in zip(axes[0], loops):
        cold = [each for each in loop["solvers"] if not each["warm"] and not nothing(each["times_ns"]["limited"]["median"])]
        cold.sort(key=lambda each: each["times_ns"]["limited"]["median"], reverse=True)
        for place, each in enumerate(cold):
            times = each["times_ns"]["limited"]
            color = OURS if each["solver"] == "ours" else THEIRS
            axis.plot([times["median"] / 1e3, times["p99"] / 1e3], [place, place], linewidth=7, color=color, solid_capstyle="butt")
            axis.plot(times["median"] / 1e3, place, "o", color=color, markersize=8)
            if each.get("search"):
                axis.plot(each["search"]["worst_ns"] / 1e3, place, "x", color=color, markersize=7)
        axis.set_xscale("log")
        axis.set_yticks(range(len(cold)), [each["solver"].split(" (")[0] for each in cold])
        axis.set_title(f"{loop['name']}: {loop['unknowns']} unknowns, {loop['rows']} rows", fontsize=9)
        axis.set_xlabel("µs")
        axis.grid(axis="x", alpha=0.3, which="both")
    figure.suptitle("A cold step at its limits: median (dot) to 99th percentile (bar), worst found (cross)", fontsize=10)
    figure.tight_layout()
    return png(figure)


def growth(all_growth: list[dict]) -> bytes:
    columns = 3
    rows = math.ceil(len(all_growth) / columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(3.9 * columns, 3.1 * rows), squeeze=False)
    flat = [axis for row in axes for axis in row]
    for axis, each in zip(flat, all_growth):
        sizes, costs = zip(*((point["size"], point["cost"]) for point in each["points"]))
        axis.loglog(sizes, costs, "o", color=OURS)
        slope = each["exponent"]
        if not nothing(slope):
            middle = math.exp(sum(math.log(cost) for cost in costs) / len(costs))
            center = math.exp(sum(math.log(size) for size in sizes) / len(sizes))
            axis.loglog(sizes, [middle * (size / center) ** slope for size in sizes], "-", color=THEIRS, label=f"exponent {slope:.2f}")
            axis.legend(fontsize=8)
        axis.set_xlabel(each["against"], fontsize=8)
        axis.set_ylabel(each["unit"], fontsize=7)
        axis.grid(alpha=0.3, which="both")
    for axis in flat[len(all_growth):]:
        axis.set_visible(False)
    figure.tight_layout()
    return png(figure)
