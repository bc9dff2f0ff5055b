"""Packs lmpc-sitl for one platform: the program with licences, manual page and completions, as people unpack it there."""

import argparse
import gzip
import io
import sys
import tarfile
import zipfile
from pathlib import Path

#: The same files give the same bytes: times are those of the FMUs, the beginning of 1980.
TIME, TIME_OF_ZIP = 315532800, (1980, 1, 1, 0, 0, 0)


def mode(path: str) -> int:
    """Programs can be run."""
    return 0o755 if Path(path).name in ("lmpc-sitl", "lmpc-sitl.exe") else 0o644


def tar_gz(files: dict[str, bytes]) -> bytes:
    tar = io.BytesIO()
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name, content in sorted(files.items()):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode, entry.mtime = len(content), mode(name), TIME
            archive.addfile(entry, io.BytesIO(content))
    return gzip.compress(tar.getvalue(), 9, mtime=0)


def zipped(files: dict[str, bytes]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            entry = zipfile.ZipInfo(name, TIME_OF_ZIP)
            entry.external_attr = (0o100000 | mode(name)) << 16
            entry.compress_type, entry.create_system = zipfile.ZIP_DEFLATED, 3
            archive.writestr(entry, content)
    return packed.getvalue()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path, help="archive to write: .tar.gz or .zip")
    parser.add_argument("files", nargs="+", metavar="NAME=FILE", help="name in the archive's folder, and the file")
    arguments = parser.parse_args()
    folder = arguments.out.name.removesuffix(".zip").removesuffix(".tar.gz")
    named = (pair.split("=", 1) for pair in arguments.files)
    files = {f"{folder}/{name}": Path(file).read_bytes() for name, file in named}
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_bytes(zipped(files) if arguments.out.suffix == ".zip" else tar_gz(files))
    return 0


if __name__ == "__main__":
    sys.exit(main())
