"""Peers on an emulated Cortex-M4F: their generated code in single precision, along the flights of `bench programs`.

    measure.py PROGRAMS.json OUT_FOLDER [--gcc PREFIX] [--qemu PROGRAM] [--newlib FOLDER]

OSQP solves the program that the shipped controllers solve, warm, to 1e-4. TinyMPC takes intervals only, so it plans 25 moves of the loops
of one input; as published it adds rho to its weights twice, so that its moves are not compared, and it prints a line per step, which is
taken out here. A peer that cannot be generated or compiled is reported missing, with the reason.
"""

import argparse
import contextlib
import io
import json
import pathlib
import shutil
import subprocess
import sys
import unittest.mock

import numpy as np

HERE = pathlib.Path(__file__).parent
SAMPLES = 150
MOVES = 25
PROCESSOR = "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16".split()
# Without bound, in a number that single precision has.
FREE = 1e20


def header(**arrays: np.ndarray) -> str:
    """Constants in C."""
    lines = []
    for name, values in arrays.items():
        rows = ",\n".join("{" + ", ".join(f"(float){float(value)!r}" for value in row) + "}" for row in values)
        lines.append(f"static const float {name}[{len(values)}][{values.shape[1]}] = {{{rows}}};")
    return "\n".join(lines) + "\n"


def osqp_code(task: dict, folder: pathlib.Path) -> tuple[list, int]:
    """Generates code for the shipped program; returns arguments for the compiler and the size of the samples in bytes."""
    import osqp
    from scipy import sparse

    program = task["program"]
    unknowns, rows = program["unknowns"], program["rows"]
    left = sparse.csc_matrix(np.array(program["left"]).reshape(rows, unknowns))
    gradient, upper = (np.array([sample[name] for sample in program["samples"][:SAMPLES]]) for name in ("gradient", "upper"))
    upper = np.minimum(upper, FREE)
    solver = osqp.OSQP()
    settings = {"eps_abs": 1e-4, "eps_rel": 1e-4, "verbose": False}
    solver.setup(sparse.eye(unknowns, format="csc"), gradient[0], left, np.full(rows, -np.inf), upper[0], **settings)
    solver.codegen(str(folder), parameters="vectors", use_float=True, extension_name=None, force_rewrite=True)
    (folder / "samples.h").write_text(f"#define SAMPLES {len(gradient)}\n" + header(gradient=gradient, upper=upper))
    sources = [HERE / "osqp.c", folder / "workspace.c", *sorted((folder / "src").glob("*.c"))]
    return [f"-I{folder}", f"-I{folder}/inc/public", f"-I{folder}/inc/private", *sources], 4 * (gradient.size + upper.size)


def tinympc_code(task: dict, folder: pathlib.Path) -> tuple[list, int]:
    """The same for a full horizon."""
    import tinympc

    n, p = task["states"], task["inputs"]
    a, b = np.array(task["a"]).reshape(n, n), np.array(task["b"]).reshape(n, p)
    weights = np.array(task["q"]).reshape(n + p, n + p)
    # Its state is [x; u(k - 1)], so that it may weigh increments.
    whole_a, whole_b = np.block([[a, b], [np.zeros((p, n)), np.eye(p)]]), np.vstack([b, np.eye(p)])
    q, r = np.diag([weights[n, n], *np.full(n - 1, 1e-3), 1e-3]), np.array(task["r"]).reshape(p, p)
    lower, upper = intervals(task)
    solver = tinympc.TinyMPC()
    solver.setup(whole_a, whole_b, q, r, MOVES, rho=1.0, verbose=False, max_iter=1000, abs_pri_tol=1e-4, abs_dua_tol=1e-4)
    wide = lambda bound, columns: np.tile(np.asarray(bound, dtype=float)[:, None], (1, columns))
    free = np.full(p, FREE)
    solver.set_bound_constraints(wide(lower, MOVES), wide(upper, MOVES), wide(-free, MOVES - 1), wide(free, MOVES - 1))
    # The Python module is not needed.
    with unittest.mock.patch("subprocess.check_call"):
        solver.codegen(str(folder))
    change(folder / "tinympc" / "types.hpp", "typedef double tinytype", "typedef float tinytype")
    change(folder / "tinympc" / "types.hpp", "#include <Eigen.h>", "#include <Eigen/Dense>")
    change(folder / "tinympc" / "admm.cpp", 'std::cout << "Solver converged', '//')
    shutil.rmtree(folder / "include" / "tinympc")
    start = np.array([[*moment["deviation"], *moment["input"]] for moment in task["moments"][:SAMPLES]])
    (folder / "samples.h").write_text(f"#define SAMPLES {len(start)}\n#define STATES {n + p}\n" + header(start=start))
    sources = [HERE / "tinympc.cpp", folder / "src" / "tiny_data.cpp", *(folder / "tinympc" / name for name in ("admm.cpp", "tiny_api.cpp", "rho_benchmark.cpp"))]
    return ["-std=c++17", "-fno-exceptions", "-DEIGEN_NO_DEBUG", f"-I{folder}", f"-I{folder}/include/Eigen", *sources], 4 * start.size


def intervals(task: dict) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest values of [x; u(k - 1)], of limits of one of them."""
    size = task["states"] + task["inputs"]
    lower, upper = np.full(size, -FREE), np.full(size, FREE)
    for limit in task["limits"]:
        bounds = np.array(limit["upper"])
        rows = np.hstack([np.array(limit[name]).reshape(len(bounds), -1) for name in ("of_state", "of_input")])
        for row, bound in zip(rows, bounds):
            used = np.flatnonzero(row)
            if len(used) == 1 and row[used[0]] > 0:
                upper[used[0]] = min(upper[used[0]], bound / row[used[0]])
            elif len(used) == 1:
                lower[used[0]] = max(lower[used[0]], bound / row[used[0]])
    return lower, upper


def change(path: pathlib.Path, what: str, into: str) -> None:
    text = path.read_text()
    if what not in text:
        raise ValueError(f"{path.name} has no {what!r}")
    path.write_text(text.replace(what, into))


def figures(arguments: argparse.Namespace, parts: list, folder: pathlib.Path) -> dict:
    """Compiles a peer, runs it and returns what it reports, with its sizes in bytes."""
    image = folder / "peer.elf"
    compilers = {".c": "gcc", ".cpp": "g++"}
    flags = ["-O3", *PROCESSOR, "-ffunction-sections", "-fdata-sections", f"-I{HERE}", *arguments.flag]
    options = [str(part) for part in parts if not isinstance(part, pathlib.Path)]
    objects = []
    for source in [HERE / "machine.c", *(part for part in parts if isinstance(part, pathlib.Path))]:
        objects.append(str(folder / f"{source.stem}.o"))
        own = [option for option in options if source.suffix == ".cpp" or option.startswith("-I")]
        run([arguments.gcc + compilers[source.suffix], *flags, *own, "-c", str(source), "-o", objects[-1]])
    link = ["-nostartfiles", "--specs=rdimon.specs", "-Wl,--gc-sections", "-Wl,--no-warn-rwx-segments", "-T", str(HERE / "machine.ld")]
    run([arguments.gcc + "g++", *PROCESSOR, *arguments.flag, *link, *objects, "-lm", "-o", str(image)])
    machine = "-M mps2-an386 -icount shift=6 -display none -monitor none -serial none -semihosting-config enable=on,target=native".split()
    said = json.loads(run([arguments.qemu, *machine, "-kernel", str(image)], arguments.limit_s).splitlines()[-1])
    text, data, cleared = (int(number) for number in run([arguments.gcc + "size", str(image)]).splitlines()[-1].split()[:3])
    return {**said, "flash": text, "memory": data + cleared}


def run(command: list, limit_s: float | None = None) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=limit_s)
    if done.returncode:
        raise ChildProcessError((done.stderr.strip().splitlines() or [f"{command[0]} failed"])[0])
    return done.stdout


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--gcc", default="arm-none-eabi-", help="prefix of the compiler's programs")
    parser.add_argument("--qemu", default="qemu-system-arm")
    parser.add_argument("--flag", action="append", default=[], help="a flag for the compiler; can be repeated")
    parser.add_argument("--limit-s", type=float, default=1200.0, help="longest run of a peer, s")
    arguments = parser.parse_args()
    print(f"{'controller':<16} {'solver':<8} {'median':>10} {'99 %':>10} {'worst':>10} {'iterations':>10} {'unsolved':>8} {'flash':>8} {'memory':>8}")
    for task in json.loads(arguments.programs.read_text()):
        name = task["program"]["name"]
        for peer, code in (("OSQP", osqp_code), ("TinyMPC", tinympc_code)):
            if peer == "TinyMPC" and task["inputs"] > 1:
                continue
            folder = (arguments.out / f"{peer}-{name.replace(' ', '-')}").resolve()
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    parts, samples_bytes = code(task, folder)
                    found = figures(arguments, parts, folder)
            except (ImportError, OSError, ValueError, subprocess.TimeoutExpired) as error:
                print(f"{name:<16} {peer:<8} missing: {error}")
                continue
            numbers = [found[key] for key in ("median", "p99", "worst", "iterations")]
            rest = [found["failures"], found["flash"] - samples_bytes, found["memory"]]
            print(f"{name:<16} {peer:<8}", *(f"{number:>10}" for number in numbers), *(f"{number:>8}" for number in rest))
            sys.stdout.flush()


if __name__ == "__main__":
    main()
