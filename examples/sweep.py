"""A Monte Carlo study over parameters of the FMU: thousands of flights with FMPy on Dask.

    cargo xtask fmu
    python examples/sweep.py --flights 1000

Flies on all cores of this machine, or with `--scheduler tcp://HOST:8786` on a Dask cluster, whose workers need FMPy and NumPy, but
neither this file nor the FMU: both are sent to them. It needs

    pip install fmpy "dask[distributed]" pyarrow matplotlib

Each flight has a number, from which its parameters follow: `--seed 1` and number 17 give the same flight on every machine. Results
are written in batches to OUTPUT/flights/*.parquet. An interrupted study goes on where it stopped: call it again. A flight that fails
is a row with the FMU's message, not the end of the study.

What is varied: `--vary NAME=LOW:HIGH`, uniformly, any Real parameter or input of the FMU. With percent signs the bounds are shares of
the start value that the FMU says: `--vary airframe.mass=85%:120%`. Without it mass, inertia, side force, motor lag and the goal are
varied.
"""

import argparse
import json
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

#: What is varied without --vary.
DEFAULT = (
    "airframe.mass=85%:120%",
    "airframe.inertia.x=80%:130%",
    "airframe.inertia.y=80%:130%",
    "airframe.rotor.time_constant=50%:150%",
    "disturbance.force.x=-1:1",
    "disturbance.force.y=-1:1",
    "reference.position.x=-10:10",
    "reference.position.y=-10:10",
    "reference.position.z=-15:-5",
)
#: What is kept of a flight, and how the picture names it.
FIGURES = {
    "settling_time_s": "settling time, s",
    "overshoot_m": "overshoot, m",
    "final_error_m": "final error, m",
    "largest_speed_m_s": "largest speed, m/s",
    "largest_tilt_rad": "largest tilt, rad",
}
#: A flight has arrived when it stays so close to its goal, m.
NEAR = 0.05
OBSERVED = [
    *(f"position.{axis}" for axis in "xyz"),
    *(f"velocity.{axis}" for axis in "xyz"),
    "attitude.phi",
    "attitude.theta",
]


def drawn(varied: list, seed: int, number: int) -> dict[str, float]:
    """The parameters of a flight."""
    generator = np.random.default_rng([seed, number])
    return {name: float(generator.uniform(low, high)) for name, low, high in varied}


def measures(flight: np.ndarray, goal: np.ndarray) -> dict[str, float]:
    """What is kept of a flight: figures in SI units."""
    column = lambda kind: np.stack([flight[f"{kind}.{axis}"] for axis in "xyz"], axis=1)  # noqa: E731
    position, speed = column("position"), np.linalg.norm(column("velocity"), axis=1)
    error = np.linalg.norm(position - goal, axis=1)
    way = goal - position[0]
    length = np.linalg.norm(way)
    along = (position - position[0]) @ way / max(length, 1e-9)
    tilt = np.arccos(np.clip(np.cos(flight["attitude.phi"]) * np.cos(flight["attitude.theta"]), -1.0, 1.0))
    late = np.flatnonzero(error > NEAR)
    last = late[-1] + 1 if late.size else 0
    return {
        "settling_time_s": float(flight["time"][last]) if last < len(flight) else float("nan"),
        "overshoot_m": float(max(along.max() - length, 0.0)),
        "final_error_m": float(error[-1]),
        "largest_speed_m_s": float(speed.max()),
        "largest_tilt_rad": float(tilt.max()),
    }


def fly(fmu: bytes, varied: list, seed: int, duration: float, numbers: range) -> list[dict]:
    """Flies some flights in this process. Runs on the workers."""
    import tempfile  # noqa: PLC0415 - a worker has these imports only, not this file's
    from pathlib import Path  # noqa: PLC0415

    from fmpy import extract, read_model_description, simulate_fmu  # noqa: PLC0415

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.fmu"
        path.write_bytes(fmu)
        model = read_model_description(str(path))
        unzipped = extract(str(path), unzipdir=str(Path(folder) / "unzipped"))
        start = {v.name: float(v.start) for v in model.modelVariables if v.name.startswith("reference.position.")}
        rows = []
        for number in numbers:
            values = drawn(varied, seed, number)
            row = {"flight": number, **values, "message": ""}
            said: list[str] = []
            try:
                flight = simulate_fmu(
                    unzipped,
                    model_description=model,
                    stop_time=duration,
                    start_values=values,
                    output=OBSERVED,
                    logger=lambda *said_now: said.append(said_now[-1].decode(errors="replace")),
                )
                goal = np.array([values.get(name, start[name]) for name in sorted(start)])
                row |= measures(flight, goal)
            except Exception as error:  # noqa: BLE001 - whatever ends a flight belongs to its row
                row["message"] = said[-1] if said else str(error)
            rows.append(row)
        return rows


class Study:
    """What is asked for, and the folder of its results."""

    def __init__(self, arguments: argparse.Namespace):
        self.fmu = arguments.fmu.read_bytes()
        self.varied = intervals(arguments.vary or list(map(varied, DEFAULT)), arguments.fmu)
        self.seed, self.duration = arguments.seed, arguments.duration
        self.flights, self.batch = arguments.flights, arguments.batch
        self.folder = arguments.output
        self.settings = {
            "fmu": guid(arguments.fmu),
            "varied": [list(row) for row in self.varied],
            "seed": self.seed,
            "duration": self.duration,
            "batch": self.batch,
        }

    def open(self) -> None:
        """Makes the folder, or checks that it belongs to this study."""
        known = self.folder / "study.json"
        (self.folder / "flights").mkdir(parents=True, exist_ok=True)
        if known.exists() and (there := json.loads(known.read_text())) != self.settings:
            differing = ", ".join(key for key in self.settings if there.get(key) != self.settings[key])
            sys.exit(f"error: {self.folder} holds another study (different: {differing}); choose another --output")
        known.write_text(json.dumps(self.settings, indent=1))

    def path(self, begin: int) -> Path:
        """Where a batch lies."""
        return self.folder / "flights" / f"{begin:07}.parquet"

    def missing(self) -> list[range]:
        """The batches that have not been flown."""
        begins = range(0, self.flights, self.batch)
        batches = (range(begin, min(begin + self.batch, self.flights)) for begin in begins)
        return [batch for batch in batches if self.rows_of(batch.start) < len(batch)]

    def rows_of(self, begin: int) -> int:
        """How many flights of a batch are there: a larger study may want more of its last one."""
        import pyarrow.parquet as parquet

        path = self.path(begin)
        return parquet.read_metadata(path).num_rows if path.exists() else 0

    def keep(self, batch: range, rows: list[dict]) -> None:
        """Writes a batch, whole or not at all."""
        import pyarrow
        import pyarrow.parquet as parquet

        keys = ["flight", *(name for name, *_ in self.varied), *FIGURES, "message"]
        table = pyarrow.table({key: [row.get(key, float("nan")) for row in rows] for key in keys})
        part = self.path(batch.start).with_suffix(".part")
        parquet.write_table(table, part)
        part.replace(self.path(batch.start))


def guid(fmu: Path) -> str:
    """What tells one FMU from another."""
    from fmpy import read_model_description

    return read_model_description(str(fmu)).guid


def run(study: Study, client) -> None:
    """Flies what is missing, and says how far it is."""
    from dask.distributed import as_completed

    missing = study.missing()
    flights = sum(map(len, missing))
    if flights < study.flights:
        print(f"{study.flights - flights} of {study.flights} flights are there already")
    fmu = client.scatter(study.fmu, broadcast=True)
    batches = {
        client.submit(fly, fmu, study.varied, study.seed, study.duration, batch, pure=False): batch for batch in missing
    }
    begun, flown = time.monotonic(), 0
    for future in as_completed(batches):
        batch = batches.pop(future)
        study.keep(batch, future.result())
        future.release()
        flown += len(batch)
        elapsed = time.monotonic() - begun
        left = elapsed / flown * (flights - flown)
        print(f"{flown} of {flights} flights, {flown / elapsed:.0f} a second, {left:.0f} s left", flush=True)


def summarize(study: Study) -> None:
    """Prints percentiles, and draws each figure over the parameter that it depends on most."""
    import pyarrow.dataset as dataset

    table = dataset.dataset(study.folder / "flights", format="parquet").to_table().sort_by("flight")
    failed = [message for message in table["message"].to_pylist() if message]
    print(f"{table.num_rows} flights, {len(failed)} failed" + (f", the first with: {failed[0]}" if failed else ""))
    columns = {name: np.array(table[name]) for name in table.column_names if name != "message"}
    print(f"{'':20}{'median':>10}{'95 %':>10}{'largest':>10}")
    for name in FIGURES:
        known = columns[name][np.isfinite(columns[name])]
        if known.size:
            median, most, largest = np.percentile(known, [50, 95, 100])
            print(f"{name:20}{median:10.3f}{most:10.3f}{largest:10.3f}")
    draw(study, columns)


def draw(study: Study, columns: dict[str, np.ndarray]) -> None:
    """Writes sweep.png."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(FIGURES), figsize=(3.4 * len(FIGURES), 3.4), layout="constrained")
    for axis, name in zip(axes, FIGURES):
        known = np.isfinite(columns[name])
        values = columns[name][known]
        parameters = {parameter: np.abs(columns[parameter][known]) for parameter, *_ in study.varied}
        strength = {parameter: dependence(given, values) for parameter, given in parameters.items()}
        parameter = max(strength, key=strength.get)
        axis.scatter(columns[parameter][known], values, s=4, alpha=0.5)
        axis.set_xlabel(parameter)
        axis.set_title(FIGURES[name])
        axis.grid(alpha=0.3)
    figure.savefig(study.folder / "sweep.png", dpi=120)
    print(f"wrote {study.folder / 'sweep.png'}")


def dependence(given: np.ndarray, values: np.ndarray) -> float:
    """Magnitude of the correlation of ranks; 0 where there is none to speak of."""
    if len(values) < 3 or np.ptp(values) == 0.0 or np.ptp(given) == 0.0:
        return 0.0
    rank = lambda numbers: np.argsort(np.argsort(numbers))  # noqa: E731
    return float(abs(np.corrcoef(rank(given), rank(values))[0, 1]))


def varied(text: str) -> tuple[str, float, float, bool]:
    """NAME=LOW:HIGH, and whether the bounds are shares of the start value."""
    try:
        name, interval = text.split("=")
        bounds = interval.split(":")
        relative = all(bound.endswith("%") for bound in bounds)
        low, high = (float(bound.removesuffix("%")) / 100 if relative else float(bound) for bound in bounds)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not NAME=LOW:HIGH, for example airframe.mass=0.6:0.8 or airframe.mass=85%:120%"
        ) from None
    if not low <= high:
        raise argparse.ArgumentTypeError(f"{text!r}: {low} is above {high}")
    return name, low, high, relative


def count(text: str) -> int:
    """A positive integer."""
    if not (text.isdigit() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive integer")
    return int(text)


def intervals(asked: list[tuple[str, float, float, bool]], path: Path) -> list[tuple[str, float, float]]:
    """Names with lowest and highest values. Rejects what the FMU does not have, before anything is flown."""
    from fmpy import read_model_description

    variables = read_model_description(str(path)).modelVariables
    known = {v.name: v for v in variables if v.type == "Real" and v.causality in ("parameter", "input")}
    found = []
    for name, low, high, relative in asked:
        if name not in known:
            sys.exit(f"error: --vary {name}: the FMU has no Real parameter or input of this name")
        start = float(known[name].start)
        if relative and start == 0.0:
            sys.exit(f"error: --vary {name}: its start value is 0, which has no shares; give the bounds without percent signs")
        # A share of a negative value turns the interval round.
        found.append((name, *(sorted((low * start, high * start)) if relative else (low, high))))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description="Monte Carlo study over parameters of the FMU on Dask.")
    parser.add_argument("fmu", type=Path, nargs="?", default=Path("target/fmu/LmpcQuadrotor.fmu"))
    parser.add_argument("--flights", type=count, default=1000)
    parser.add_argument(
        "--vary", type=varied, action="append", metavar="NAME=LOW:HIGH", help="can be repeated; LOW%%:HIGH%% are shares of the start value"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--duration", type=float, default=15.0, help="of each flight, s")
    parser.add_argument("--batch", type=count, default=25, help="flights of one task and of one file")
    parser.add_argument("--output", type=Path, default=Path("sweep"), help="folder of the results")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", type=count, default=os.cpu_count(), help="processes on this machine")
    where.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, for example tcp://10.0.0.1:8786")
    arguments = parser.parse_args()
    if not arguments.fmu.is_file():
        sys.exit(f"error: {arguments.fmu} does not exist; build it with: cargo xtask fmu")

    study = Study(arguments)
    study.open()
    from dask.distributed import Client

    scratch = tempfile.mkdtemp()
    try:
        if arguments.scheduler:
            client = Client(arguments.scheduler, timeout="20s")
        else:
            client = Client(
                n_workers=arguments.workers,
                threads_per_worker=1,
                dashboard_address=None,
                local_directory=scratch,
            )
        with client:
            run(study, client)
    except OSError as error:
        sys.exit(f"error: no Dask scheduler at {arguments.scheduler}: {error}")
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    summarize(study)


if __name__ == "__main__":
    main()
