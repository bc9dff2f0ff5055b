"""Statistics of measured times: quantiles, medians of several processes with their spread, exponents of growth."""

import math


def quantile(values, share: float) -> float:
    """The value that a share of all do not exceed: the nearest rank, so that it is one that was measured."""
    ordered = sorted(values)
    if not ordered:
        return math.nan
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def median(values) -> float:
    return quantile(values, 0.5)


def summary(times) -> dict:
    """Of one process."""
    return {
        "median": quantile(times, 0.5),
        "p99": quantile(times, 0.99),
        "p99_9": quantile(times, 0.999),
        "most": max(times, default=math.nan),
        "count": len(times),
    }


def across(summaries) -> dict:
    """The median of each figure over several processes, and how far they spread: [least, most]."""
    names = [name for name in summaries[0] if name != "count"]
    merged = {name: median([each[name] for each in summaries]) for name in names}
    merged["spread"] = {name: [min(each[name] for each in summaries), max(each[name] for each in summaries)] for name in names}
    merged["count"] = summaries[0]["count"]
    merged["processes"] = len(summaries)
    return merged


def exponent(points) -> float:
    """b of the least-squares line log cost = a + b log size."""
    logs = [(math.log(size), math.log(cost)) for size, cost in points if size > 0 and cost > 0]
    if len(logs) < 2:
        return math.nan
    mean = [sum(each) / len(logs) for each in zip(*logs)]
    above = sum((x - mean[0]) * (y - mean[1]) for x, y in logs)
    below = sum((x - mean[0]) ** 2 for x, _ in logs)
    return above / below if below > 0 else math.nan
