"""Writes a container image: an OCI image layout in a tar file, from scratch. `docker load`, `podman load` and skopeo take it."""

import argparse
import gzip
import hashlib
import io
import json
import sys
import tarfile
from pathlib import Path

#: Nobody in particular, and not root.
USER = 65532
#: Where clients connect to the container; `--link` overrides it.
PORT = 5760
#: The same sources give the same bytes: times are those of the FMUs, the beginning of 1980.
TIME, TIME_TEXT = 315532800, "1980-01-01T00:00:00Z"
OCI = "application/vnd.oci.image"
#: Name of the C library's licence in the image: copies of musl must carry it.
C_LIBRARY = "MUSL.txt"
#: Most bytes of the files in the image.
MOST = 10_000_000


class Tar:
    """A tar file in memory with fixed times and owners."""

    def __init__(self):
        self.bytes = io.BytesIO()
        self.file = tarfile.open(fileobj=self.bytes, mode="w", format=tarfile.USTAR_FORMAT)

    def add(self, name: str, content: bytes | None, mode: int, owner: int = 0) -> None:
        """A file, or a folder if it has no content."""
        entry = tarfile.TarInfo(name)
        entry.mode, entry.mtime, entry.uid, entry.gid = mode, TIME, owner, owner
        if content is None:
            entry.type = tarfile.DIRTYPE
        else:
            entry.size = len(content)
        self.file.addfile(entry, None if content is None else io.BytesIO(content))

    def done(self) -> bytes:
        self.file.close()
        return self.bytes.getvalue()


def layer(program: Path, c_library: Path, notices: list[Path]) -> bytes:
    """The files of the image: the program, its licences and that of its C library, and a folder for what it writes."""
    tar = Tar()
    tar.add("lmpc-sitl", program.read_bytes(), 0o755)
    tar.add("licenses", None, 0o755)
    for name, notice in sorted({C_LIBRARY: c_library, **{notice.name: notice for notice in notices}}.items()):
        tar.add(f"licenses/{name}", notice.read_bytes(), 0o644)
    tar.add("data", None, 0o777, USER)
    return tar.done()


def digest(content: bytes) -> str:
    return f"sha256:{hashlib.sha256(content).hexdigest()}"


def described(kind: str, content: bytes) -> dict:
    return {"mediaType": f"{OCI}.{kind}", "digest": digest(content), "size": len(content)}


def image(files: bytes, version: str, architecture: str) -> bytes:
    """The image with one layer, as a tar file."""
    packed = gzip.compress(files, 9, mtime=0)
    labels = {
        "org.opencontainers.image.title": "lmpc-sitl",
        "org.opencontainers.image.description": "A simulated quadrotor that MAVLink clients fly",
        "org.opencontainers.image.version": version,
        "org.opencontainers.image.licenses": "MIT OR Apache-2.0",
    }
    configuration = json.dumps({
        "created": TIME_TEXT, "architecture": architecture, "os": "linux",
        "config": {
            "User": f"{USER}:{USER}", "WorkingDir": "/data", "Entrypoint": ["/lmpc-sitl"],
            "Cmd": ["--link", f"tcpin:0.0.0.0:{PORT}"], "ExposedPorts": {f"{PORT}/tcp": {}}, "StopSignal": "SIGTERM",
            "Labels": labels,
        },
        "rootfs": {"type": "layers", "diff_ids": [digest(files)]},
        "history": [{"created": TIME_TEXT, "created_by": "cargo xtask image"}],
    }).encode()
    manifest = json.dumps({
        "schemaVersion": 2, "mediaType": f"{OCI}.manifest.v1+json", "config": described("config.v1+json", configuration),
        "layers": [described("layer.v1.tar+gzip", packed)],
    }).encode()
    name = f"lmpc-sitl:{version}"
    reference = described("manifest.v1+json", manifest) | {
        "platform": {"architecture": architecture, "os": "linux"},
        "annotations": {"org.opencontainers.image.ref.name": version, "io.containerd.image.name": f"docker.io/library/{name}"},
    }
    blob = lambda content: "blobs/sha256/" + digest(content).removeprefix("sha256:")
    # What Docker asked for before it read OCI layouts.
    docker = [{"Config": blob(configuration), "RepoTags": [name], "Layers": [blob(packed)]}]
    tar = Tar()
    tar.add("oci-layout", json.dumps({"imageLayoutVersion": "1.0.0"}).encode(), 0o644)
    tar.add("index.json", json.dumps({
        "schemaVersion": 2, "mediaType": f"{OCI}.index.v1+json", "manifests": [reference],
    }).encode(), 0o644)
    tar.add("manifest.json", json.dumps(docker).encode(), 0o644)
    for folder in ("blobs", "blobs/sha256"):
        tar.add(folder, None, 0o755)
    for content in (configuration, manifest, packed):
        tar.add(blob(content), content, 0o644)
    return tar.done()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--any-size", action="store_true", help=f"also write an image whose files take more than {MOST / 1e6:.0f} MB")
    parser.add_argument("program", type=Path, help="static lmpc-sitl")
    parser.add_argument("architecture", choices=["amd64", "arm64"])
    parser.add_argument("version")
    parser.add_argument("out", type=Path, help="file to write")
    parser.add_argument("c_library", type=Path, help="licence of the C library in the program: musl's COPYRIGHT")
    parser.add_argument("notices", type=Path, nargs="*", help="other licences")
    arguments = parser.parse_args()
    files = layer(arguments.program, arguments.c_library, arguments.notices)
    if len(files) > MOST and not arguments.any_size:
        print(f"error: the files of the image take {len(files) / 1e6:.2f} MB, more than the allowed {MOST / 1e6:.0f} MB: "
              f"make the program smaller ({arguments.program.stat().st_size / 1e6:.2f} MB)", file=sys.stderr)
        return 1
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_bytes(image(files, arguments.version, arguments.architecture))
    return 0


if __name__ == "__main__":
    sys.exit(main())
