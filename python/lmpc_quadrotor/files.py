"""The files that come with the package: FMUs and the program of the vehicle."""

import shutil
import sysconfig
from importlib import metadata
from pathlib import Path

from ._native import ArgumentError

#: The FMUs by their short names.
_MODELS = {"quadrotor": "LmpcQuadrotor", "controller": "LmpcController", "plant": "QuadrotorPlant"}


def fmu_path(model: str = "quadrotor", version: str = "2.0") -> str:
    """The path of an FMU, for FMPy and other importers.

    `model` is "quadrotor" (the closed loop), "controller" (the controllers alone), "plant" (the vehicle alone) or "system" (an
    SSP that wires controller and plant). `version` is the one of FMI, "2.0" or "3.0"; the SSP is there for "2.0" only.

    >>> from fmpy import simulate_fmu
    >>> result = simulate_fmu(fmu_path(), stop_time=15)  # doctest: +SKIP
    """
    folder = Path(__file__).parent / "fmu"
    if version not in ("2.0", "3.0"):
        raise ArgumentError(f"version = {version!r}; allowed are '2.0' and '3.0'")
    if model == "system":
        if version != "2.0":
            raise ArgumentError("version = '3.0'; the SSP has FMUs of FMI 2.0: use version='2.0'")
        path = folder / "LmpcQuadrotor.ssp"
    elif model in _MODELS:
        path = (folder if version == "2.0" else folder / "fmi3") / f"{_MODELS[model]}.fmu"
    else:
        raise ArgumentError(f"model = {model!r}; allowed are 'quadrotor', 'controller', 'plant' and 'system'")
    if not path.is_file():
        raise FileNotFoundError(f"{path} is missing: install the package from its wheel, which has the FMUs")
    return str(path)


def sitl_path() -> str:
    """The path of `lmpc-sitl`, the MAVLink vehicle: the one of this package, else one on the PATH."""
    names = ("lmpc-sitl", "lmpc-sitl.exe")
    try:
        for file in metadata.files("lmpc-quadrotor") or []:
            path = Path(str(file.locate()))
            if path.name in names and path.is_file():
                return str(path.resolve())
    except metadata.PackageNotFoundError:
        pass
    for name in names:
        path = Path(sysconfig.get_path("scripts")) / name
        if path.is_file():
            return str(path)
    found = shutil.which("lmpc-sitl")
    if found is None:
        raise FileNotFoundError("lmpc-sitl is missing: install the package from its wheel, which has the program")
    return found
