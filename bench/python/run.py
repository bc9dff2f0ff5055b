"""Measures ours and peers in one run and writes results.json, report.md, report.html and plots.

`cargo xtask bench` builds what is measured and calls this in an environment with the peers.
"""

import argparse
import datetime
import importlib.metadata
import json
import math
import os
import platform
import random
import shutil
import subprocess
import sys
import tempfile
import time
import traceback
from pathlib import Path

import engines
import fmus
import peers_in_c
import report
import vehicles
from statistics_of import across, exponent, summary

FOLDER = Path(__file__).parent
#: Outputs of the FMU that are read after a step.
OUTPUTS = [f"{name}.{axis}" for name in ("position", "velocity", "acceleration") for axis in "xyz"]
OUTPUTS += ["attitude.phi", "attitude.theta", "attitude.psi"]
#: Of full horizons.
MOVES = (25, 50)


class Run:
    def __init__(self, arguments):
        self.arguments, self.start = arguments, time.monotonic()
        self.missing: dict[str, str] = dict(engines.ABSENT)
        self.missing["Reference FMUs"] = "are not in any package registry"
        self.work = Path(tempfile.mkdtemp(prefix="bench-"))

    def say(self, text: str) -> None:
        print(f"[{time.monotonic() - self.start:6.1f} s] {text}", file=sys.stderr, flush=True)

    def attempt(self, what: str, work):
        """What a part of the run finds; a part that fails is reported and the rest goes on."""
        self.say(what)
        try:
            return work()
        except Exception as failure:  # noqa: BLE001
            detail = failure.stderr if isinstance(failure, subprocess.CalledProcessError) and failure.stderr else str(failure)
            detail = detail if isinstance(detail, str) else detail.decode(errors="replace")
            self.missing[what] = f"{type(failure).__name__}: {detail.strip().splitlines()[-1] if detail.strip() else ''}"
            if self.arguments.traceback:
                traceback.print_exc()
            return None

    def program(self, *arguments, seed: int = 1):
        """A task of the Rust program."""
        out = self.work / "figures.json"
        quick = ["--quick"] if self.arguments.quick else []
        command = [self.arguments.program, *arguments, "--out", out, "--seed", str(seed), *quick]
        subprocess.run(command, check=True, capture_output=True, text=True)
        # Rust writes an infinite time as null.
        return json.loads(out.read_text())

    def control(self, libraries) -> list[dict]:
        peers = [part for library in libraries for part in ("--peer", str(library))]
        count = 1 if self.arguments.quick else 5
        runs = []
        for seed in range(1, count + 1):
            self.say(f"Control step, process {seed} of {count}")
            runs.append(self.program("control", *peers, *(["--judge"] if seed == 1 else []), seed=seed))
        worst = self.attempt("Worst case by search", lambda: self.program("search", *peers)) or []
        return [merged([run[at] for run in runs], worst) for at in range(len(runs[0]))]

    def in_python(self) -> list[dict]:
        """Solvers of the Python registry, each in a process of its own, in random order."""
        tasks = self.work / "tasks.json"
        self.program("programs")
        (self.work / "figures.json").rename(tasks)
        jobs = [(name, "dense", 0) for name in ("Osqp", "OsqpEmbedded", "Piqp", "ProxQp", "Quadprog")]
        horizon = ("Osqp", "OsqpEmbedded", "Piqp", "ProxQp", "Clarabel", "hpipm", "tinympc")
        jobs += [(name, "horizon", moves) for name in horizon for moves in MOVES]
        random.Random(1).shuffle(jobs)
        found = []
        for name, kind, moves in jobs:
            command = [sys.executable, FOLDER / "time_solver.py", tasks, name, kind, str(moves)]
            command += ["--quick"] if self.arguments.quick else []
            what = f"{name} on {'the shipped programs' if kind == 'dense' else f'{moves} moves'}"
            ended = self.attempt(what, lambda: subprocess.run(command, check=True, capture_output=True, text=True, timeout=900))
            if ended:
                found += json.loads(ended.stdout.splitlines()[-1])
        return found

    def engines(self) -> dict:
        ours = self.attempt("Our engine", lambda: self.program("engine"))
        names = list(engines.ENGINES)
        random.Random(2).shuffle(names)
        peers = {}
        for name in names:
            command = [sys.executable, FOLDER / "engines.py", name, "--seconds", "2" if self.arguments.quick else "5"]
            # Some write logs into the folder that they start in.
            ended = self.attempt(f"Engine {name}", lambda: subprocess.run(command, check=True, capture_output=True, text=True,
                                                                          timeout=300, cwd=self.work))
            figures = json.loads(ended.stdout) if ended else None
            if figures:
                peers[name] = figures
            elif ended:
                self.missing[f"Engine {name}"] = (ended.stderr.strip().splitlines() or ["no figures"])[-1]
        return {"ours": ours, "peers": peers}

    def fmu(self) -> dict:
        file, outputs = self.arguments.fmu, [part for name in OUTPUTS for part in ("--output", name)]
        ours = self.attempt("Our FMU from C", lambda: self.program("fmu", str(file), *outputs))
        count = 500 if self.arguments.quick else 5000
        in_python = self.attempt("Our FMU in FMPy", lambda: fmus.steps(file, count))
        point = self.attempt("A plant of PythonFMU in FMPy", lambda: fmus.steps(fmus.point(self.work / "point"), count))
        return {"ours": ours, "ours in FMPy": in_python, "PythonFMU in FMPy": point}

    def measure(self) -> dict:
        only = set(self.arguments.only or [])
        wanted = lambda part: not only or part in only
        results = {"machine": machine(self.arguments), "load_before": os.getloadavg()[0]}
        libraries, missing = peers_in_c.compile_all(FOLDER.parent / "peers", self.arguments.libraries)
        self.missing |= missing
        if wanted("control"):
            results["control"] = self.attempt("Control step", lambda: self.control(libraries)) or []
            results["in_python"] = self.attempt("Solvers in Python", self.in_python) or []
        if wanted("engine"):
            results["engine"] = self.engines()
        if wanted("fmu"):
            results["fmu"] = self.fmu()
        if wanted("sitl"):
            results["sitl"] = self.attempt(
                "MAVLink vehicle", lambda: vehicles.measure(self.arguments.root, self.arguments.sitl, self.arguments.quick))
        if wanted("growth"):
            found = (self.attempt("Growth", lambda: self.program("growth")) or []) + (
                self.attempt("Growth of the fleet", lambda: vehicles.growth(self.arguments.sitl, self.arguments.quick)) or [])
            for each in found:
                each["exponent"] = exponent([(point["size"], point["cost"]) for point in each["points"]])
            results["growth"] = found
        results["criterion"] = criterion(self.arguments.criterion)
        results |= {"missing": self.missing, "load_after": os.getloadavg()[0], "took_s": time.monotonic() - self.start}
        return finite(results)


def merged(runs, worst) -> dict:
    """One loop in several processes."""
    first = runs[0]
    entries = {}
    for run in runs:
        for entry in run["entries"]:
            entries.setdefault((entry["solver"], entry["warm"]), []).append(entry)
    solvers = []
    for (solver, warm), found in entries.items():
        chosen = {"all": lambda limited: True, "limited": bool, "free": lambda limited: not limited}
        times = {name: across([summary([t for t, limited in zip(each["times_ns"], first["limited"]) if t is not None and keep(limited)])
                               for each in found]) for name, keep in chosen.items()}
        same = {name: found[0][name] for name in ("failures", "most_iterations", "cost_gap", "violation", "move_error", "memory_bytes")}
        search = next((each for each in worst if each["name"] == first["name"] and each["solver"] == solver), None)
        solvers.append({"solver": solver, "warm": warm, "times_ns": times, **same, "search": search if not warm else None})
    facts = {name: first[name] for name in ("name", "unknowns", "rows", "samples", "judged")}
    return facts | {"limited": sum(first["limited"]), "solvers": solvers}


def criterion(folder: Path | None) -> list[dict]:
    """What `cargo bench` has measured last."""
    found = []
    for file in sorted(folder.glob("**/new/estimates.json")) if folder and folder.is_dir() else []:
        estimate = json.loads(file.read_text())["median"]
        interval = estimate["confidence_interval"]
        found.append({"name": json.loads((file.parent / "benchmark.json").read_text())["full_id"], "median_ns": estimate["point_estimate"],
                      "least_ns": interval["lower_bound"], "most_ns": interval["upper_bound"]})
    return found


def machine(arguments) -> dict:
    model = next((line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines() if "model name" in line),
                 platform.processor()) if Path("/proc/cpuinfo").is_file() else platform.processor()
    packages = {name: importlib.metadata.version(name) for name in arguments.packages.split(",") if name and installed(name)}
    return {"processor": model, "cores": os.cpu_count(), "system": platform.system(), "python": platform.python_version(),
            "date": datetime.date.today().isoformat(), "build": arguments.build, "quick": arguments.quick, "packages": packages}


def installed(name: str) -> bool:
    try:
        importlib.metadata.version(name)
        return True
    except importlib.metadata.PackageNotFoundError:
        return False


def finite(value):
    """JSON has no numbers that are not finite."""
    if isinstance(value, dict):
        return {name: finite(each) for name, each in value.items()}
    if isinstance(value, list):
        return [finite(each) for each in value]
    if isinstance(value, float):
        return float(f"{value:.6g}") if math.isfinite(value) else None
    return value


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True, help="the Rust program")
    parser.add_argument("--sitl", type=Path, required=True, help="the MAVLink vehicle")
    parser.add_argument("--fmu", type=Path, required=True, help="the FMU of the closed loop")
    parser.add_argument("--root", type=Path, required=True, help="root of the repository")
    parser.add_argument("--out", type=Path, required=True, help="folder of the report")
    parser.add_argument("--libraries", type=Path, required=True, help="folder that C peers are compiled in")
    parser.add_argument("--criterion", type=Path, help="folder of the results of `cargo bench`, to include them")
    parser.add_argument("--packages", default="", help="names of the peers' packages")
    parser.add_argument("--absent", action="append", default=[], help="a package that could not be installed")
    parser.add_argument("--build", default="release", help="how ours was built")
    parser.add_argument("--only", action="append", choices=["control", "engine", "fmu", "sitl", "growth"])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--traceback", action="store_true")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    run = Run(arguments)
    for name in arguments.absent:
        run.missing[name] = "could not be installed from the registry of Python packages"
    try:
        results = run.measure()
    finally:
        shutil.rmtree(run.work, ignore_errors=True)
    (arguments.out / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    report.write(results, arguments.out)
    print(report.ratios(results))


if __name__ == "__main__":
    main()
