"""The report of `cargo xtask bench`: report.md, report.html and ratio tables, from results.json.

    python report.py results.json FOLDER
"""

import base64
import html
import json
import sys
from pathlib import Path

import charts
from tables import Table, digits, duration, memory, nothing, ratio, small

#: What was tried: what was gained, and what failed. Kept by hand.
ATTEMPTS = Path(__file__).parent.parent / "attempts.md"

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#1d2329}
table{border-collapse:collapse;margin:1em 0;font-size:13px}th,td{padding:.3em .6em;border-bottom:1px solid #d8dce1;text-align:left;
white-space:nowrap}th{background:#f2f4f6}.wide{overflow-x:auto}img{max-width:100%}code{background:#f2f4f6;padding:0 .2em}"""


def control_table(loop: dict) -> Table:
    table = Table(["solver", "start", "at limits: median", "p99", "p99.9", "most", "medians of processes", "ratio: median", "p99",
                   "no limit: median", "worst found", "iterations", "not solved", "cost gap", "violation", "move error", "memory"])
    ours = {each["warm"]: each for each in loop["solvers"] if each["solver"] == "ours"}
    for each in sorted(loop["solvers"], key=lambda each: (each["warm"], each["solver"] != "ours", each["times_ns"]["limited"]["median"] or 0)):
        limited, free, base = each["times_ns"]["limited"], each["times_ns"]["free"], ours[each["warm"]]["times_ns"]["limited"]
        spread = limited["spread"]["median"]
        search = each.get("search")
        table.add(each["solver"], "warm" if each["warm"] else "cold", *(duration(limited[name]) for name in ("median", "p99", "p99_9", "most")),
                  f"{duration(spread[0])} – {duration(spread[1])}", ratio(limited["median"], base["median"]), ratio(limited["p99"], base["p99"]),
                  duration(free["median"]), duration(search["worst_ns"]) if search else "–",
                  max(each["most_iterations"], search["most_iterations"] if search else 0), each["failures"], small(each["cost_gap"]),
                  small(each["violation"]), small(each["move_error"]), memory(each["memory_bytes"]))
    return table


def ours_on(results: dict, loop: str, warm: bool):
    """Our times at limits on a loop."""
    for each in results.get("control") or []:
        if each["name"] == loop:
            return next(entry["times_ns"]["limited"] for entry in each["solvers"] if entry["solver"] == "ours" and entry["warm"] == warm)
    return None


def in_python_table(results: dict, kind: str) -> Table:
    table = Table(["loop", "solver", "start", "moves", "unknowns", "rows", "at limits: median", "p99", "most", "ratio to ours: median", "p99",
                   "not solved"])
    found = [each for each in results.get("in_python") or [] if each["kind"] == kind]
    for each in sorted(found, key=lambda each: (each["loop"], each["moves"], each["warm"], each["times_ns"]["limited"]["median"] or 0)):
        limited, base = each["times_ns"]["limited"], ours_on(results, each["loop"], each["warm"]) or {"median": None, "p99": None}
        table.add(each["loop"], each["solver"], "warm" if each["warm"] else "cold", each["moves"] or "–", each["unknowns"], each["rows"],
                  duration(limited["median"]), duration(limited["p99"]), duration(limited["most"]), ratio(limited["median"], base["median"]),
                  ratio(limited["p99"], base["p99"]), f"{each['failures']} of {each['times_ns']['all']['count']}")
    return table


def engine_table(engine: dict) -> Table:
    table = Table(["simulator", "what it simulates", "step", "order", "per simulated second", "× real time", "ratio"])
    ours = engine.get("ours")
    base = None
    if ours:
        base = ours["closed_loop_ns"]
        order = f"{ours['order']} (Runge–Kutta)"
        for what, name in (("closed loop: plant, rotors, instruments, estimator, shaper, three controllers", "closed_loop_ns"),
                           ("closed loop, raw goal", "raw_goal_ns"), ("closed loop of each of 64 vehicles, on one core", "fleet_ns"),
                           ("plant and rotors alone", "plant_ns")):
            if name not in ours:
                continue  # results of before there was this figure
            table.add("ours", what, duration(ours["step_s"] * 1e9), order, duration(ours[name]), digits(1e9 / ours[name]),
                      ratio(ours[name], base))
    for name, each in sorted((engine.get("peers") or {}).items(), key=lambda item: item[1]["s_per_s"]):
        taken = each["s_per_s"] * 1e9
        table.add(name, each["what"], duration(each["step_s"] * 1e9), each["order"], duration(taken), digits(1e9 / taken), ratio(taken, base))
    return table


def fmu_table(fmu: dict) -> Table:
    table = Table(["FMU", "called from", "step of 1 ms", "with 12 outputs", "instantiate and initialize", "an instance"])
    ours = fmu.get("ours")
    if ours:
        table.add("LmpcQuadrotor", "Rust, as from C", duration(ours["step_ns"]), duration(ours["step_and_outputs_ns"]),
                  duration(ours["initialize_ns"]), memory(ours["memory_bytes"]))
    for key, name in (("ours in FMPy", "LmpcQuadrotor"), ("PythonFMU in FMPy", "a point mass of PythonFMU")):
        if fmu.get(key):
            table.add(name, "FMPy", duration(fmu[key]["step_ns"]), "–", duration(fmu[key]["initialize_ns"]), "–")
    return table


def vehicle_table(sitl: dict) -> Table:
    table = Table(["MAVLink vehicle", "measured"])
    table.add("start of the process to the first heartbeat", f"{digits(sitl['first_heartbeat_ms'])} ms")
    table.add("start of the process to armable", f"{digits(sitl['armable_ms'])} ms, worst {digits(sitl['armable_worst_ms'])} ms")
    table.add("highest speed, no client", f"{digits(sitl['speed_alone'])} × real time")
    table.add("highest speed, ground-station and onboard link", f"{digits(sitl['speed_two_links'])} × real time")
    table.add("memory of a process with one vehicle", memory(sitl["memory_bytes"]))
    table.add("memory of each further vehicle", memory(sitl["memory_per_vehicle_bytes"]))
    table.add("size of the program", memory(sitl["program_bytes"]))
    for key, name in (("thrust_to_motors_ms", "thrust set-point to changed motors"), ("position_to_motors_ms", "position set-point to changed motors")):
        if key in sitl:
            each = sitl[key]
            table.add(f"{name}, sampled every {each['period_ms']} ms", f"median {digits(each['median'])} ms, most {digits(each['most'])} ms")
    return table


def growth_table(growth: list[dict]) -> Table:
    table = Table(["against", "unit", "points: size → cost", "exponent"])
    for each in growth:
        shown = (lambda cost: duration(cost)) if each["unit"] == "ns" else (lambda cost: f"{digits(cost * 1e3)} ms")
        points = ", ".join(f"{point['size']:g} → {shown(point['cost'])}" for point in each["points"])
        table.add(each["against"], each["unit"], points, "–" if nothing(each["exponent"]) else f"{each['exponent']:.2f}")
    return table


def sections(results: dict) -> list:
    """Headings, paragraphs, tables and (name, alternative text, PNG) in order."""
    machine = results["machine"]
    parts = [
        f"{machine['date']}, {machine['processor']}, {machine['cores']} cores, {machine['system']}, Python {machine['python']}. Ours is built "
        f"with the profile {machine['build']}{', measured quickly' if machine['quick'] else ''}. Load of the machine before and after: "
        f"{digits(results['load_before'])} and {digits(results['load_after'])}; above 1 something else ran, and only ratios mean anything. "
        f"The run took {digits(results['took_s'])} s.",
    ]
    if results.get("control"):
        parts += [("h2", "Control step: the programs that fly"),
                  "Each solver has the same samples of the same flights: raw goals up to three times as far as a controller plans. Ours is given the "
                  "sample and poses its program itself; peers are given f and b, and hold H = I and G already. Times are the shortest of "
                  "several passes over each sample, so that quantiles are over samples, not over disturbances; figures are medians of processes. "
                  "Cold forgets the last solution, warm begins with it. “Worst found” is a search over states beyond those of the flights "
                  "by random restarts and climbs along coordinates. The reference is Clarabel at a tolerance of 1e-12.",
                  ("png", "control.png", "Times of the control step", charts.control(results["control"]))]
        for loop in results["control"]:
            parts += [("h3", f"{loop['name']}: {loop['unknowns']} unknowns, {loop['rows']} rows, {loop['limited']} of {loop['samples']} samples at limits"),
                      control_table(loop)]
    if results.get("in_python"):
        parts += [("h3", "The same programs in solvers of the Python registry"),
                  "Times are the solvers' own, their updates included, at a tolerance of 1e-6; quadprog reports none.", in_python_table(results, "dense"),
                  ("h2", "The same task over a full horizon"),
                  "One move and one state per sample, sparse, with the regulator's cost at the end and hard limits at the samples of the shipped "
                  "controllers as far as the horizon goes. The ratio is to our step of the shipped controller at the same state. TinyMPC takes "
                  "intervals only, so it flies the loops of one input; as published it adds rho twice, minimises another cost, and is "
                  "only timed.",
                  in_python_table(results, "horizon")]
    if results.get("engine"):
        parts += [("h2", "Engine"), "One vehicle on one core. What is simulated differs: compare with the column that says so.",
                  engine_table(results["engine"])]
    if results.get("fmu"):
        parts += [("h2", "FMU"), fmu_table(results["fmu"])]
    if results.get("sitl"):
        parts += [("h2", "MAVLink vehicle"), vehicle_table(results["sitl"])]
    if results.get("growth"):
        parts += [("h2", "Growth"), "The exponent is the slope of the least-squares line through the logarithms.",
                  ("png", "growth.png", "Cost against size", charts.growth(results["growth"])), growth_table(results["growth"])]
    if results.get("criterion"):
        kernels = Table(["criterion", "median", "95 % of it"])
        for each in results["criterion"]:
            kernels.add(each["name"], duration(each["median_ns"]), f"{duration(each['least_ns'])} – {duration(each['most_ns'])}")
        parts += [("h2", "Kernels"), "Measured by `cargo bench`.", kernels]
    missing = Table(["missing", "why"])
    for name, why in sorted(results["missing"].items()):
        missing.add(name, why)
    parts += [("h2", "What is missing"), missing, ("h2", "What was tried")]
    parts += [line[2:] for line in ATTEMPTS.read_text(encoding="utf-8").splitlines() if line.startswith("* ")]
    return parts


def write(results: dict, folder: Path) -> list[Path]:
    folder.mkdir(parents=True, exist_ok=True)
    markdown, page = ["# Benchmarks", ""], ["<h1>Benchmarks</h1>"]
    files = []
    for part in sections(results):
        if isinstance(part, Table):
            markdown += [part.markdown(), ""]
            page.append(part.html())
        elif isinstance(part, str):
            markdown += [part, ""]
            page.append(f"<p>{html.escape(part)}</p>")
        elif part[0] == "png":
            _, name, text, data = part
            (folder / name).write_bytes(data)
            files.append(folder / name)
            markdown += [f"![{text}]({name})", ""]
            page.append(f'<img alt="{html.escape(text)}" src="data:image/png;base64,{base64.b64encode(data).decode()}">')
        else:
            level, text = part
            markdown += [f"{'#' * int(level[1])} {text}", ""]
            page.append(f"<{level}>{html.escape(text)}</{level}>")
    (folder / "report.md").write_text("\n".join(markdown), encoding="utf-8")
    (folder / "report.html").write_text(
        f'<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content="width=device-width"><title>Benchmarks</title>'
        f"<style>{STYLE}</style>{''.join(page)}</html>\n", encoding="utf-8")
    return [folder / "report.html", folder / "report.md", *files]


def ratios(results: dict) -> str:
    """What the terminal shows: how many times as long as ours the peers take."""
    table = Table(["loop", "peer", "start", "median", "p99"])
    for loop in results.get("control") or []:
        ours = {each["warm"]: each["times_ns"]["limited"] for each in loop["solvers"] if each["solver"] == "ours"}
        for each in loop["solvers"]:
            if each["solver"] != "ours":
                times, base = each["times_ns"]["limited"], ours[each["warm"]]
                table.add(loop["name"], each["solver"], "warm" if each["warm"] else "cold", ratio(times["median"], base["median"]),
                          ratio(times["p99"], base["p99"]))
    parts = ["Times of peers over ours, at limits", table.markdown()] if table.rows else []
    if results.get("engine"):
        parts += ["", "Simulators", engine_table(results["engine"]).markdown()]
    return "\n".join(parts)


def main() -> None:
    results = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    for file in write(results, Path(sys.argv[2])):
        print(file)


if __name__ == "__main__":
    main()
