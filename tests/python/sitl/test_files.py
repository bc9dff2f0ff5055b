"""Files by MAVLink FTP: pymavlink's client and MAVSDK's, up, down and refused; component metadata."""

import json
import os
import struct
import zlib

import pytest
from mavsdk.plugins.component_metadata import ComponentMetadata, MetadataType
from mavsdk.plugins.ftp import Ftp, FtpResult
from pymavlink import mavftp
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mavsdk_vehicle import eventually
from test_program import run

AUTOPILOT = 1


@pytest.fixture
def shared(tmp_path):
    """A folder to be shared, with something in it, beside a secret."""
    root = tmp_path / "shared"
    (root / "below").mkdir(parents=True)
    (root / "hello.txt").write_text("hello")
    (root / "noise.bin").write_bytes(os.urandom(60_000))
    (tmp_path / "secret").write_text("secret")
    (root / "leak").symlink_to(tmp_path / "secret")
    return root


def protocol_crc(content: bytes) -> int:
    """CRC-32 from zero, not inverted."""
    return zlib.crc32(content, 0xFFFFFFFF) ^ 0xFFFFFFFF


def file_client(client):
    """pymavlink's client, which takes a silence for the end of some requests: it need not be a long one here."""
    ftp = mavftp.MAVFTP(client.connection, *client.target)
    ftp.ftp_settings.idle_detection_time = 0.5
    ftp.ftp_settings.read_retry_time, ftp.ftp_settings.retry_time = 0.4, 0.2
    return ftp


def test_wrong_folders_are_refused(program, tmp_path):
    for arguments, code, words in (
        (("--ftp-root", tmp_path / "none"), 4, "cannot read"),
        (("--ftp-write",), 2, "--ftp-root"),
        (("--log-size", "0"), 2, "--log-size: `0` is not a number from 0.1 to 4000"),
        (("--log-dir", "/proc/none"), 4, "cannot write"),
    ):
        result = run(program, "--link", "udpin:0", *arguments)
        assert result.returncode == code and words in result.stderr and "panicked" not in result.stderr, result.stderr


def test_pymavlink_client(start, connect, shared, tmp_path):
    client = connect(start("--ftp-root", str(shared), "--ftp-write", "--speed", "5"))
    ftp = file_client(client)

    def do(command, *arguments, reply=None, expect=mavftp.FtpError.Success):
        result = getattr(ftp, command)(list(arguments))
        result = ftp.process_ftp_reply(reply, timeout=10) if reply else result
        assert result.error_code == expect, f"{command} {arguments}: {result.error_code}"
        return result

    listed = {entry.name: (entry.is_dir, entry.size_b) for entry in do("cmd_list", "/files").directory_listing}
    assert listed == {"below": (True, 0), "hello.txt": (False, 5), "noise.bin": (False, 60_000)}
    here = tmp_path / "here.bin"
    do("cmd_get", "/files/noise.bin", str(here), reply="OpenFileRO")
    assert here.read_bytes() == (shared / "noise.bin").read_bytes()
    do("cmd_put", str(here), "/files/below/copy.bin", reply="put")
    assert (shared / "below" / "copy.bin").read_bytes() == here.read_bytes()
    do("cmd_rename", "/files/below/copy.bin", "/files/moved.bin")
    assert (shared / "moved.bin").exists()
    do("cmd_crc", "/files/moved.bin")
    do("cmd_rm", "/files/moved.bin")
    do("cmd_mkdir", "/files/new")
    do("cmd_mkdir", "/files/new", expect=mavftp.FtpError.FileExists)
    do("cmd_rmdir", "/files/new")
    assert sorted(path.name for path in shared.iterdir()) == ["below", "hello.txt", "leak", "noise.bin"]
    for path in ("/files/leak", "/files/../secret", "/etc/passwd", "/files/below"):
        do("cmd_get", path, str(tmp_path / "no"), reply="OpenFileRO", expect=mavftp.FtpError.FileNotFound)
    do("cmd_rm", "/@PARAM/param.pck", expect=mavftp.FtpError.FileProtected)


def test_mavsdk_client(fly, shared, tmp_path):  # noqa: F811
    ftp = Ftp(fly("--ftp-root", str(shared), "--ftp-write"))

    def wait(begin):
        results = []
        begin(lambda result, progress, _: results.append(result))
        eventually("the end of it", lambda: results and results[-1] != FtpResult.NEXT)
        return results[-1]

    root = ftp.list_directory("/")
    assert {"@PARAM", "metadata", "files"} <= set(root.dirs if hasattr(root, "dirs") else [entry.name for entry in root.entries])
    (tmp_path / "here").mkdir()
    for burst in (False, True):
        assert wait(lambda done: ftp.download_async("/files/noise.bin", str(tmp_path / "here"), burst, done)) == FtpResult.SUCCESS
        assert (tmp_path / "here" / "noise.bin").read_bytes() == (shared / "noise.bin").read_bytes()
    assert wait(lambda done: ftp.download_async("/files/leak", str(tmp_path / "here"), True, done)) == FtpResult.FILE_DOES_NOT_EXIST
    ours = tmp_path / "upload.bin"
    ours.write_bytes(os.urandom(5_000))
    assert wait(lambda done: ftp.upload_async(str(ours), "/files/below", done)) == FtpResult.SUCCESS
    assert (shared / "below" / "upload.bin").read_bytes() == ours.read_bytes()
    assert ftp.are_files_identical(str(ours), "/files/below/upload.bin")
    ftp.rename("/files/below/upload.bin", "/files/up.bin")
    ftp.create_directory("/files/made")
    ftp.remove_directory("/files/made")
    ftp.remove_file("/files/up.bin")
    assert sorted(path.name for path in shared.iterdir()) == ["below", "hello.txt", "leak", "noise.bin"]


def test_component_metadata(start, connect, fly, tmp_path):  # noqa: F811
    client = connect(start("--autopilot", "px4"))
    # This version of the library does not know COMPONENT_METADATA: time, checksum, name.
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 397)
    body = bytes(client.wait("UNKNOWN_397").get_msgbuf())[10:-2]
    told_crc, told_uri = struct.unpack("<I", body[4:8])[0], body[8:].rstrip(b"\0").decode()
    ftp = file_client(client)

    def get(uri):
        assert uri.startswith("mftp:///")
        file = tmp_path / "got.json"
        ftp.cmd_get([uri.removeprefix("mftp://"), str(file)])
        assert ftp.process_ftp_reply("OpenFileRO", timeout=10).error_code == mavftp.FtpError.Success
        return file.read_bytes()

    general = get(told_uri)
    assert protocol_crc(general) == told_crc
    entry = next(entry for entry in json.loads(general)["metadataTypes"] if entry["type"] == 1)
    content = get(entry["uri"])
    assert protocol_crc(content) == entry["fileCrc"]
    described = {parameter["name"]: parameter for parameter in json.loads(content)["parameters"]}
    # Exactly the parameters that there are, as they are.
    client.mav.param_request_list_send(*client.target)
    first = client.wait("PARAM_VALUE", lambda value: value.param_index == 0)
    values = {first.param_id: first}
    while len(values) < first.param_count:
        value = client.wait("PARAM_VALUE", lambda value: value.param_index < value.param_count)
        values[value.param_id] = value
    assert described.keys() == values.keys()
    for name, parameter in described.items():
        assert parameter["type"] == ("Int32" if values[name].param_type == mavlink.MAV_PARAM_TYPE_INT32 else "Float"), name
        assert parameter["shortDesc"] and parameter["min"] < parameter["max"], name
    assert described["MIS_TAKEOFF_ALT"]["units"] == "m" and described["MIS_TAKEOFF_ALT"]["default"] == 2.5
    assert {value["description"] for value in described["COM_OBL_RC_ACT"]["values"]} >= {"Return", "Land"}
    assert [name for name, parameter in described.items() if parameter.get("rebootRequired")] == ["MAV_SYS_ID"]
    # It is the same after a change: ground stations keep it.
    client.set_parameter("MIS_TAKEOFF_ALT", 3.5)
    assert get(entry["uri"]) == content

    metadata = ComponentMetadata(fly())
    seen = []
    metadata.subscribe_metadata_available(lambda update, _: seen.append(update.type))
    metadata.request_autopilot_component()
    eventually("metadata", lambda: MetadataType.PARAMETER in seen)
    assert json.loads(metadata.get_metadata(AUTOPILOT, MetadataType.PARAMETER).json_metadata)["version"] == 1
