"""What the demo's scripts share: their arguments, progress, and how they print files."""

import argparse
import sys
import time
from pathlib import Path

#: Exit code when a flight missed its goal.
GOAL_MISSED = 3


class Script:
    """Command line and clock of a script that `cargo xtask demo` starts."""

    def __init__(self, description: str, what: str):
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("flown", type=Path, help=what)
        parser.add_argument("out", type=Path, help="folder for tables and plots")
        parser.add_argument("--root", type=Path, default=Path.cwd(), help="folder that printed paths start from")
        parser.add_argument("--elapsed", type=float, default=0.0, help="seconds that the task has taken so far")
        arguments = parser.parse_args()
        self.flown, self.out, self.root = arguments.flown, arguments.out, arguments.root
        self.start = time.monotonic() - arguments.elapsed
        # Progress goes to the other stream: neither may overtake the other.
        sys.stdout.reconfigure(line_buffering=True, encoding="utf-8")
        self.out.mkdir(parents=True, exist_ok=True)

    def progress(self, text: str) -> None:
        print(f"[{time.monotonic() - self.start:6.1f} s] {text}", file=sys.stderr, flush=True)

    def shown(self, file: Path) -> str:
        """A path as a person at the root of the repository would write it."""
        return str(file.relative_to(self.root) if file.is_relative_to(self.root) else file)

    def print_files(self, files) -> None:
        print("\nFiles")
        for file in files:
            print(f"  {self.shown(file)}")
