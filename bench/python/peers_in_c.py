"""Compiles the peers that are C libraries, so that a call of theirs costs what a call of ours does."""

import importlib.util
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

#: DAQP is compiled from its source distribution.
DAQP = "daqp==0.11.0"
FLAGS = ["-O3", "-march=native", "-DNDEBUG", "-shared", "-fPIC", "-w"]


def compile_all(sources: Path, out: Path) -> tuple[list[Path], dict[str, str]]:
    """The libraries, and why others are missing."""
    out.mkdir(parents=True, exist_ok=True)
    if compiler() is None:
        return [], {"DAQP, qpOASES, HPIPM": "there is no C compiler"}
    libraries, missing = [], {}
    for name, arguments in (("daqp", daqp), ("qpoases", qpoases), ("hpipm", hpipm)):
        library = out / f"{name}.so"
        try:
            build(sources / f"{name}.c", library, [f"-I{sources}", *arguments(out)])
            libraries.append(library)
        except subprocess.CalledProcessError as failure:
            missing[name] = (failure.stderr or "").strip().splitlines()[-1:][0] if failure.stderr else str(failure)
        except FileNotFoundError as failure:
            missing[name] = str(failure)
    return libraries, missing


def compiler() -> str | None:
    return next((name for name in ("cc", "gcc", "clang") if shutil.which(name)), None)


def build(source: Path, library: Path, options: list) -> None:
    """Compiles a file, with all that its options name, into a library."""
    subprocess.run([compiler() or "cc", *FLAGS, "-o", library, source, *options, "-lm"], check=True, capture_output=True, text=True)


def daqp(out: Path) -> list:
    name, version = DAQP.split("==")
    source = out / f"{name}-{version}"
    if not source.is_dir():
        subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps",
                        "--no-binary", name, "--dest", out, DAQP], check=True, capture_output=True, text=True)
        with tarfile.open(out / f"{name}-{version}.tar.gz") as archive:
            archive.extractall(out, filter="data")
    return [f"-I{source / 'csrc' / 'include'}", *sorted((source / "csrc" / "src").glob("*.c"))]


def acados() -> Path:
    found = importlib.util.find_spec("acados")
    if found is None:
        raise FileNotFoundError("the package comma-deps-acados is not installed")
    return Path(next(iter(found.submodule_search_locations))) / "install"


def qpoases(_: Path) -> list:
    folder = acados()
    return [f"-I{folder / 'include'}", f"-L{folder / 'lib'}", f"-Wl,-rpath,{folder / 'lib'}", "-lqpOASES_e"]


def hpipm(_: Path) -> list:
    folder = acados()
    headers = [f"-I{folder / 'include' / part / 'include'}" for part in ("hpipm", "blasfeo")]
    # The older kind of path is looked at for the libraries of the library, too.
    return [*headers, f"-L{folder / 'lib'}", f"-Wl,--disable-new-dtags,-rpath,{folder / 'lib'}", "-lhpipm", "-lblasfeo"]
