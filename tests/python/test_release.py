"""What a release is made of: the container image, the archives, the bills of materials."""

import gzip
import hashlib
import io
import json
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

import assets
import bill
import image

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = b"\x7fELF a program"


@pytest.fixture
def packed(tmp_path) -> bytes:
    (tmp_path / "built").write_bytes(PROGRAM)
    (tmp_path / "LICENSE-MIT").write_text("a licence")
    (tmp_path / "COPYRIGHT").write_text("the licence of musl")
    return packed_from(tmp_path)


def packed_from(folder: Path) -> bytes:
    return image.image(image.layer(folder / "built", folder / "COPYRIGHT", [folder / "LICENSE-MIT"]), "1.2.3", "arm64")


def members(archive: bytes) -> dict[str, tarfile.TarInfo]:
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        return {entry.name: entry for entry in tar.getmembers()}


def content(archive: bytes, name: str) -> bytes:
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        return tar.extractfile(name).read()


def blob(archive: bytes, description: dict) -> bytes:
    """What a description refers to, if it has the digest and the size that are said (OCI image specification 1.1, descriptors)."""
    algorithm, value = description["digest"].split(":")
    found = content(archive, f"blobs/{algorithm}/{value}")
    assert hashlib.sha256(found).hexdigest() == value and len(found) == description["size"]
    return found


def test_the_image_is_an_oci_layout(packed):
    assert json.loads(content(packed, "oci-layout")) == {"imageLayoutVersion": "1.0.0"}
    (reference,) = json.loads(content(packed, "index.json"))["manifests"]
    assert reference["platform"] == {"architecture": "arm64", "os": "linux"}
    manifest = json.loads(blob(packed, reference))
    configuration = json.loads(blob(packed, manifest["config"]))
    (layer,) = manifest["layers"]
    files = gzip.decompress(blob(packed, layer))
    assert configuration["rootfs"]["diff_ids"] == [f"sha256:{hashlib.sha256(files).hexdigest()}"]
    assert configuration["config"]["Entrypoint"] == ["/lmpc-sitl"] and configuration["architecture"] == "arm64"
    entries = members(files)
    assert set(entries) == {"lmpc-sitl", "licenses", "licenses/LICENSE-MIT", "licenses/MUSL.txt", "data"}
    # Its licence wants to be in all copies of musl.
    assert content(files, "licenses/MUSL.txt") == b"the licence of musl"
    assert entries["lmpc-sitl"].mode == 0o755 and content(files, "lmpc-sitl") == PROGRAM
    # The user of the image may write into its folder.
    user = configuration["config"]["User"]
    assert user == f"{entries['data'].uid}:{entries['data'].gid}" and entries["data"].uid != 0


def test_the_image_is_one_that_old_engines_load(packed):
    (listed,) = json.loads(content(packed, "manifest.json"))
    assert listed["RepoTags"] == ["lmpc-sitl:1.2.3"]
    assert {listed["Config"], *listed["Layers"]} <= set(members(packed))


def test_the_same_files_give_the_same_bytes(packed, tmp_path):
    os.utime(tmp_path / "built", (1, 1))
    assert packed_from(tmp_path) == packed
    files = {"folder/lmpc-sitl": PROGRAM, "folder/man/lmpc-sitl.1": b"page"}
    assert assets.tar_gz(files) == assets.tar_gz(dict(reversed(files.items())))
    assert assets.zipped(files) == assets.zipped(dict(reversed(files.items())))


def test_an_image_of_more_than_ten_megabytes_is_refused(tmp_path):
    program, notice = tmp_path / "built", tmp_path / "COPYRIGHT"
    notice.write_text("the licence of musl")
    script = ROOT / "xtask" / "python" / "image.py"
    for size, code in ((9_900_000, 0), (10_000_000, 1)):
        program.write_bytes(bytes(size))
        command = [sys.executable, script, program, "amd64", "1.2.3", tmp_path / f"{size}.tar", notice]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
        assert done.returncode == code and (tmp_path / f"{size}.tar").exists() == (code == 0), done.stderr
    assert "10.00 MB" in done.stderr and "make the program smaller" in done.stderr


@pytest.mark.parametrize("name", ["lmpc-sitl-1.2.3-linux64.tar.gz", "lmpc-sitl-1.2.3-win64.zip"])
def test_an_archive_unpacks_into_a_folder_of_its_name(tmp_path, name):
    (tmp_path / "built").write_bytes(PROGRAM)
    (tmp_path / "page").write_bytes(b"page")
    script = ROOT / "xtask" / "python" / "assets.py"
    command = [sys.executable, script, tmp_path / name, f"lmpc-sitl={tmp_path / 'built'}", f"man/lmpc-sitl.1={tmp_path / 'page'}",
               f"lmpc-sitl.cdx.json={tmp_path / 'page'}"]
    subprocess.run(command, check=True, timeout=60, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    folder = name.removesuffix(".zip").removesuffix(".tar.gz")
    page = (0o644, b"page")
    expected = {f"{folder}/lmpc-sitl": (0o755, PROGRAM), f"{folder}/man/lmpc-sitl.1": page, f"{folder}/lmpc-sitl.cdx.json": page}
    if name.endswith(".zip"):
        with zipfile.ZipFile(tmp_path / name) as archive:
            found = {entry.filename: (entry.external_attr >> 16 & 0o777, archive.read(entry)) for entry in archive.infolist()}
    else:
        archive = (tmp_path / name).read_bytes()
        found = {key: (entry.mode, content(archive, key)) for key, entry in members(archive).items()}
    assert found == expected


def cargo(*arguments) -> str:
    command = [os.environ.get("CARGO", "cargo"), *arguments]
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True, timeout=120).stdout


def test_a_bill_has_what_is_linked_and_nothing_else():
    target = next(line.split()[1] for line in cargo("-vV").splitlines() if line.startswith("host: "))
    metadata = json.loads(cargo("metadata", "--format-version", "1", "--locked", "--filter-platform", target))
    tree = cargo("tree", "--locked", "--package", "sitl", "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}")
    linked = bill.linked(metadata, tree)
    names = {package["id"]: package["name"] for package in metadata["packages"]}
    ours = [names[key] for key in linked]
    assert ours[0] == "sitl" and {"nalgebra", "mavlink", "clap_builder", "quadrotor"} <= set(ours)
    # Tests, macros, tools of the build, and what only other members of the workspace switch on.
    assert not {"proptest", "serde_derive", "cc", "glam", "pyo3"} & set(ours)
    uses = {names[key]: {names[use] for use in used} for key, used in linked.items()}
    assert {"autopilot", "vehicle", "clap"} <= uses["sitl"] and "quadrotor" in uses["vehicle"] and uses["libm"] == set()
    sums = bill.checksums(ROOT / "Cargo.lock")
    assert len(sums) == (ROOT / "Cargo.lock").read_text().count("\nchecksum = ")
    packages = {package["id"]: package for package in metadata["packages"]}
    from_registry = [packages[key] for key in linked if packages[key]["source"]]
    assert len(from_registry) > 50 and all((package["name"], package["version"]) in sums for package in from_registry)
