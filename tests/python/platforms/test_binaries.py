"""What the libraries and programs ask of a machine, read by LIEF."""

import re
from pathlib import Path

import lief
import pytest

ROOT = Path(__file__).resolve().parents[3]

#: Parts of the C library.
LINUX_LIBRARIES = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
#: Libraries that every Windows has since version 10. `api-ms-win-…` are names of parts of kernel32.
WINDOWS_LIBRARIES = {"kernel32.dll", "ntdll.dll", "msvcrt.dll", "userenv.dll", "ws2_32.dll", "bcryptprimitives.dll", "advapi32.dll"}
MACHINES = {
    "linux64": lief.Header.ARCHITECTURES.X86_64,
    "win64": lief.Header.ARCHITECTURES.X86_64,
    "aarch64-linux": lief.Header.ARCHITECTURES.ARM64,
}


def exported(library: Path) -> set[str]:
    return {function.name for function in lief.parse(str(library)).exported_functions}


def glibc_versions(binary) -> list[tuple[int, ...]]:
    names = [version.name for requirement in binary.symbols_version_requirement for version in requirement.get_auxiliary_symbols()]
    assert all(name.startswith("GLIBC_") for name in names), names
    return [tuple(map(int, name.removeprefix("GLIBC_").split("."))) for name in names]


def test_only_functions_of_the_standard_are_exported(platform):
    names = exported(platform.library)
    assert {name for name in names if not re.fullmatch(r"fmi[23][A-Z][A-Za-z0-9]+", name)} == set()
    assert {"fmi2Instantiate", "fmi2DoStep", "fmi2GetReal", "fmi2SerializeFMUstate"} <= names
    assert len([name for name in names if name.startswith("fmi2")]) >= 34


def test_all_platforms_export_the_same(built):
    assert len({frozenset(exported(platform.library)) for platform in built.values()}) == 1


@pytest.mark.parametrize("product", ["library", "vehicle"])
def test_only_the_system_is_needed(platform, product):
    binary = lief.parse(str(getattr(platform, product)))
    assert binary.abstract.header.architecture == MACHINES[platform.platform]
    if platform.platform == "win64":
        needed = {library.name.lower() for library in binary.imports}
        assert {name for name in needed if not name.startswith("api-ms-win-")} <= WINDOWS_LIBRARIES
    else:
        assert set(binary.libraries) <= LINUX_LIBRARIES
        assert max(glibc_versions(binary)) <= (2, 17)


def test_the_library_is_small(platform):
    assert platform.compressed < 1_500_000


@pytest.mark.parametrize("product", ["library", "vehicle"])
def test_the_builder_leaves_no_paths(platform, product):
    content = getattr(platform, product).read_bytes()
    for path in (str(ROOT), str(Path.home()) + "/", ".cargo/registry", "/usr/lib/rustlib", "/usr/src/rustc"):
        assert path.encode() not in content, path
