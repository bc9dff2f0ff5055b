"""FMUs that share nothing with the vehicle: a rigid body in C against the standard's headers, which FMPy ships, and one in Python."""

import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import fmpy

FAULTS = {"segfault": 1, "error": 2, "hang": 3, "nan": 4, "exit": 5, "abort": 6, "start": 7}

# Name, causality, unit.
VARIABLES = [
    *[(name, "parameter", unit) for name, unit in [("m", "kg"), ("J.x", "kg.m2"), ("J.y", "kg.m2"), ("J.z", "kg.m2")]],
    *[(name, "parameter", unit) for name, unit in [("start.east", "m"), ("start.north", "m"), ("start.yaw", "degree")]],
    *[(name, "input", unit) for name, unit in [("F", "N"), ("t.x", "N.m"), ("t.y", "N.m"), ("t.z", "N.m")]],
    *[(name, "output", "m") for name in ["east", "north", "up"]],
    *[(name, "output", "m/s") for name in ["v.east", "v.north", "v.up"]],
    *[(name, "output", "degree") for name in ["roll", "pitch", "yaw"]],
    *[(name, "output", "degree/s") for name in ["p", "q", "r"]],
]

UNITS = """
    <Unit name="degree"><BaseUnit rad="1" factor="0.017453292519943295"/></Unit>
    <Unit name="degree/s"><BaseUnit rad="1" s="-1" factor="0.017453292519943295"/></Unit>
    <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
    <Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>"""

# The map is the book's example: what it shows flies.
PAGE = Path(__file__).resolve().parents[3] / "book" / "src" / "vehicle" / "fmu.md"
MAP = PAGE.read_text().split("```toml\n")[1].split("```")[0]


def description(model: str, guid: str, unit_of=lambda name, unit: unit) -> str:
    """The model description of the body."""
    def variable(reference, name, causality, unit):
        variability = ' variability="fixed"' if causality == "parameter" else ""
        start = ' start="0"' if causality != "output" else ""
        unit = unit_of(name, unit)
        return (f'<ScalarVariable name="{name}" valueReference="{reference}" causality="{causality}"{variability}>'
                f'<Real unit="{unit}"{start}/></ScalarVariable>')

    variables = "\n    ".join(variable(number, *row) for number, row in enumerate(VARIABLES))
    outputs = [number for number, (_, causality, _) in enumerate(VARIABLES, 1) if causality == "output"]
    unknowns = "".join(f'<Unknown index="{index}"/>' for index in outputs)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{model}" guid="{guid}">
  <CoSimulation modelIdentifier="{model}" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions>{UNITS}
  </UnitDefinitions>
  <ModelVariables>
    {variables}
  </ModelVariables>
  <ModelStructure><Outputs>{unknowns}</Outputs><InitialUnknowns>{unknowns}</InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""


def in_c(folder: Path, fault: str | None = None, platform: str = "linux64", options: tuple = (), beside: tuple = (), **changes) -> tuple[Path, Path]:
    """Compiles the body, with options of the compiler, and puts libraries beside it. Returns the FMU and its map."""
    folder.mkdir(parents=True, exist_ok=True)
    headers = Path(fmpy.__file__).parent / "c-code"
    source = Path(__file__).parent / "fmu" / "body.c"
    compiler = shutil.which("cc")
    assert compiler, "a C compiler compiles the crates, too"
    number = FAULTS[fault] if fault else 0
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror", f"-DFAULT={number}", *options, f"-I{headers}", source,
                    "-o", folder / "Body.so", "-lm"], check=True)
    file = folder / "Body.fmu"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", description("Body", "{body}", **changes))
        archive.write(folder / "Body.so", f"binaries/{platform}/Body.so")
        for library in beside:
            archive.write(library, f"binaries/{platform}/{library.name}")
    (folder / "map.toml").write_text(MAP)
    return file, folder / "map.toml"


def interpreter_library() -> Path | None:
    """The library of this interpreter, if it has one: FMUs of PythonFMU need it."""
    names = [sysconfig.get_config_var(name) for name in ("LIBDIR", "INSTSONAME")]
    path = Path(*names) if all(names) else None
    return path if path is not None and path.is_file() and ".so" in path.name else None


def in_python(folder: Path) -> tuple[Path, Path]:
    """Builds the body in Python. Returns the FMU and a map that names the interpreter's library."""
    folder.mkdir(parents=True, exist_ok=True)
    source = Path(__file__).parent / "fmu" / "python_body.py"
    subprocess.run([sys.executable, "-m", "pythonfmu", "build", "-f", source, "-d", folder], check=True, capture_output=True)
    map_file = folder / "map.toml"
    map_file.write_text(f'preload = ["{interpreter_library()}"]\n')
    return folder / "PythonBody.fmu", map_file
