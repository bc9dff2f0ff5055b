"""`python -m lmpc_quadrotor`: the programs of the package, where its scripts are not on the PATH."""

import argparse
import subprocess
import sys

from . import ArgumentError, __version__
from .files import fmu_path, sitl_path


def _sitl(arguments: list[str]) -> int:
    try:
        return subprocess.call([sitl_path(), *arguments])
    except KeyboardInterrupt:
        return 130


def _fmu(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m lmpc_quadrotor fmu", description="Prints the path of an FMU.")
    parser.add_argument("model", nargs="?", default="quadrotor", choices=["quadrotor", "controller", "plant", "system"])
    parser.add_argument("--version", default="2.0", choices=["2.0", "3.0"], help="version of FMI (default: 2.0)")
    chosen = parser.parse_args(arguments)
    try:
        print(fmu_path(chosen.model, chosen.version))
    except (ArgumentError, FileNotFoundError) as problem:
        parser.error(str(problem))
    return 0


def _view(arguments: list[str]) -> int:
    from .view import main

    return main(arguments)


def _benchmark(arguments: list[str]) -> int:
    from .benchmark import main

    return main(arguments)


COMMANDS = {
    "sitl": (_sitl, "the MAVLink vehicle; takes the flags of lmpc-sitl"),
    "fmu": (_fmu, "prints the path of an FMU"),
    "view": (_view, "writes or serves a page that shows a flight: a table (.csv), a log (.ulg) or a record (.lmpc)"),
    "benchmark": (_benchmark, "measures how fast vehicles fly on this machine"),
}


def main() -> int:
    """Runs one of the programs."""
    if len(sys.argv) > 1 and sys.argv[1] in COMMANDS:
        command, _ = COMMANDS[sys.argv[1]]
        return command(sys.argv[2:])
    if len(sys.argv) > 1 and sys.argv[1] in ("--version", "-V"):
        print(f"lmpc-quadrotor {__version__}")
        return 0
    lines = "\n".join(f"  {name:<10} {text}" for name, (_, text) in COMMANDS.items())
    usage = f"usage: python -m lmpc_quadrotor COMMAND [ARGUMENTS]\n\ncommands:\n{lines}"
    if len(sys.argv) > 1 and sys.argv[1] in ("--help", "-h"):
        print(usage)
        return 0
    problem = f"unknown command {sys.argv[1]!r}" if len(sys.argv) > 1 else "no command"
    print(f"error: {problem}\n{usage}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
