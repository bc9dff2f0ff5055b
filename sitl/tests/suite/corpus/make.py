"""Writes frames.txt: frames of pymavlink, one a line (name, hexadecimal bytes), that the fuzzer starts from.

Every message of the common dialect with plausible values, and what clients really send to a vehicle, whole conversations last. Run it with the Python of
target/venv when the dialect or the vehicle's messages grow.
"""

import math
import struct
from pathlib import Path

from pymavlink.dialects.v10 import common as one
from pymavlink.dialects.v20 import common as two

NAN = math.nan
COMMANDS = [
    (400, 1), (400, 0), (400, 1, 21196), (400, 0, 21196), (22, 0, 0, 0, NAN, NAN, NAN, NAN), (22, 0, 0, 0, 0, 0, 0, 10),
    (20,), (21,), (92, 1), (92, 0), (115, 90, 20, 1, 1), (176, 1, 6, 0), (176, 1, 4, 3), (176, 1, 4, 6), (176, 1, 3), (176, 1, 4, 0),
    (178, 1, 5, -1), (178, 2, 2, -1), (179, 1), (179, 0, 0, 0, 0, 47.4, 8.5, 500), (185, 0), (192, -1, 1, 0, NAN, 47.3978, 8.5456, 500),
    (193, 0), (193, 1), (245, 0), (245, 1), (245, 2), (262, 1), (300,), (401,), (410,), (510, 30), (511, 30, 10000), (512, 148),
    (512, 435, 0), (512, 242), (519, 1), (520, 1), (203,), (84, 0), (31000, 1), (420, 1, 1), (42429,), (189,), (5000, 1),
]
MASKS = (0b110111111000, 0b110111000111, 0b101111000000, 0b100111111000, 0b011111000111, 0b100000000000, 0b111000111111, 0xffff)


def plausible(kind: str, name: str, length: int):
    if name == "target_system":
        return 1
    if name == "target_component":
        return 1
    if kind == "char":
        return b"AF_MASS"[:length]
    value = 1.5 if kind in ("float", "double") else 3
    return [value] * length if length else value


def everything(mav):
    for message in two.mavlink_map.values():
        lengths = dict(zip(message.ordered_fieldnames, message.array_lengths))
        kinds = dict(zip(message.fieldnames, message.fieldtypes))
        yield message(*(plausible(kinds[name], name, lengths[name]) for name in message.fieldnames))


def real(mav):
    yield mav.heartbeat_encode(6, 8, 0, 0, 0)
    for command, *parameters in COMMANDS:
        seven = [*parameters, *[0] * (7 - len(parameters))]
        yield mav.command_long_encode(1, 1, command, 0, *seven)
        x, y = (int(v * 1e7) if math.isfinite(v) else -2**31 for v in seven[4:6])
        yield mav.command_int_encode(1, 1, 6, command, 0, 0, *seven[:4], x, y, seven[6])
    for mask in MASKS:
        for frame in (1, 7, 8, 9, 12):
            yield mav.set_position_target_local_ned_encode(0, 1, 1, frame, mask, 3, 2, -5, 1, 0.5, -0.2, 0.1, 0.2, 0, 0.5, 0.1)
        for frame in (5, 6, 11):
            yield mav.set_position_target_global_int_encode(
                0, 1, 1, frame, mask, 473978000, 85456000, 20, 1, 0.5, -0.2, 0.1, 0.2, 0, 0.5, 0.1)
    for mask in (0b111, 0b10000000, 0):
        yield mav.set_attitude_target_encode(0, 1, 1, mask, [1, 0.02, 0, 0], 0.1, 0, 0.1, 0.5)
    for name, value in ((b"AF_MASS", 0.8), (b"COM_OF_LOSS_T", 2.0), (b"SIM_SPEEDUP", 2.0), (b"_HASH_CHECK", 0.0),
                        (b"LIM_SPEED_H", 5.0), (b"C_ATT_N", 4.0), (b"MIS_TAKEOFF_ALT", 5.0), (b"NO_SUCH", 1.0)):
        yield mav.param_set_encode(1, 1, name, value, 9)
        yield mav.param_request_read_encode(1, 1, name, -1)
    yield mav.param_request_read_encode(1, 1, b"", 7)
    yield mav.param_request_list_encode(1, 1)
    yield mav.request_data_stream_encode(1, 1, 0, 4, 1)
    yield mav.set_mode_encode(1, 1, 6 << 16)
    yield mav.manual_control_encode(1, 500, -200, 600, 100, 0)
    yield mav.rc_channels_override_encode(1, 1, 1500, 1600, 1500, 1400, 1500, 1500, 1500, 1500)
    yield mav.ping_encode(1, 2, 0, 0)
    yield mav.timesync_encode(0, 12345)
    yield mav.mission_request_list_encode(1, 1)
    yield mav.mission_count_encode(1, 1, 3)
    for number, item in enumerate((22, 16, 21)):
        yield mav.mission_item_int_encode(1, 1, number, 6, item, 0, 1, 0, 0, 0, NAN, 473978000, 85456000, 10)
    for opcode, data in ((3, b"/"), (4, b"@PARAM/param.pck"), (5, b""), (15, b""), (1, b""), (2, b""), (14, b"x"), (200, b"")):
        payload = struct.pack("<HBBBBBBI", 1, 0, opcode, len(data) or 80, 0, 0, 0, 0) + data
        yield mav.file_transfer_protocol_encode(0, 1, 1, list(payload.ljust(251, b"\0")))


def ftp(session, opcode, data=b"", size=None, offset=0, sequence=1):
    payload = struct.pack("<HBBBBBBI", sequence, session, opcode, len(data) if size is None else size, 0, 0, 0, offset) + data
    return list(payload.ljust(251, b"\0"))


def conversations(mav):
    """Whole transfers and flights, in the order in which a client has them: the fuzzer plays rows of them."""

    def command(number, *parameters):
        return mav.command_long_encode(1, 1, number, 0, *parameters, *[0] * (7 - len(parameters)))

    def upload(kind, *items):
        yield mav.mission_count_encode(1, 1, len(items), kind)
        for number, (item, frame, parameters, place) in enumerate(items):
            x, y, z = place
            yield mav.mission_item_int_encode(
                1, 1, number, frame, item, 0, 1, *parameters, *[0] * (4 - len(parameters)), int(x * 1e7), int(y * 1e7), z, kind)

    def at(north_m, east_m, altitude_m):
        return 47.397742 + north_m / 111_300, 8.545594 + east_m / 75_400, altitude_m

    def download(kind, count):
        yield mav.mission_request_list_encode(1, 1, kind)
        for number in range(count):
            yield mav.mission_request_int_encode(1, 1, number, kind)
        yield mav.mission_ack_encode(1, 1, 0, kind)

    nowhere = (0, 0, 0)
    yield from upload(0, (22, 6, (), at(0, 0, 6)), (178, 2, (1, 5, -1), nowhere), (16, 6, (0.5, 2), at(10, 0, 6)), (201, 6, (), at(5, 5, 0)),
                      (16, 6, (0, 1, 1), at(10, 10, 8)), (115, 2, (90, 30, 1), nowhere), (19, 6, (2, 0, 5), at(0, 10, 8)),
                      (18, 6, (1, 0, 5), at(0, 10, 8)), (93, 2, (1,), nowhere), (112, 2, (1,), nowhere), (114, 2, (3,), nowhere),
                      (177, 2, (2, 1), nowhere), (197, 2, (), nowhere), (20, 2, (), nowhere))
    yield from download(0, 14)
    yield command(400, 1, 21196)
    yield command(300, 0, 0)
    yield mav.mission_set_current_encode(1, 1, 2)
    yield command(224, 4, 1)
    yield command(193, 0)
    yield command(193, 1)
    yield mav.mission_write_partial_list_encode(1, 1, 2, 2)
    yield mav.mission_item_int_encode(1, 1, 2, 6, 16, 0, 1, 0, 1, 0, NAN, *(int(v * 1e7) for v in at(12, 0, 0)[:2]), 7)
    yield mav.mission_request_partial_list_encode(1, 1, 1, 3)
    yield mav.mission_item_encode(1, 1, 0, 3, 22, 0, 1, 0, 0, 0, NAN, 47.3977, 8.5456, 6)
    yield from upload(1, *((5001, 3, (4,), at(*corner, 0)) for corner in ((-40, -40), (-40, 40), (40, 40), (40, -40))),
                      (5004, 3, (6,), at(20, 20, 0)), *((5002, 3, (3,), at(*corner, 0)) for corner in ((-20, 20), (-20, 30), (-10, 20))))
    yield from upload(2, (5100, 3, (), at(5, 5, 10)), (5100, 3, (), at(-5, 5, 10)))
    yield from download(1, 8)
    yield command(207, 1)
    yield command(192, -1, 1, 0, NAN, 47.39793, 8.5459, 500)
    yield command(195, 0, 0, 0, 0, 47.3978, 8.5456, 490)
    yield command(197)
    yield command(20)
    yield command(207, 0)
    yield mav.mission_clear_all_encode(1, 1, 255)
    for unit, kind, instance in ((104, 1, 1), (104, 2, 1), (103, 1, 0), (4, 6, 0), (0, 2, 0), (1, 5, 0), (2, 3, 0), (3, 4, 0), (101, 1, 0), (104, 0, 0)):
        yield command(420, unit, kind, instance)
    for unit in (104, 103, 4, 0, 1, 2, 3, 101):
        yield command(420, unit, 0)
    yield mav.log_request_list_encode(1, 1, 0, 0xFFFF)
    yield mav.log_request_data_encode(1, 1, 1, 0, 2000)
    yield mav.log_request_data_encode(1, 1, 1, 19_990, 0xFFFFFFFF)
    yield mav.log_request_end_encode(1, 1)
    yield mav.log_erase_encode(1, 1)
    number = 0
    for session, opcode, data, size, offset in (
            (0, 2, b"", None, 0), (0, 3, b"/", None, 0), (0, 3, b"/files", None, 0), (0, 9, b"/files/a", None, 0), (0, 6, b"/files/a/b.txt", None, 0),
            (0, 7, b"hello", None, 0), (0, 7, b"there", None, 4_000), (0, 1, b"", None, 0), (0, 4, b"/files/notes.txt", None, 0),
            (0, 5, b"", 80, 0), (0, 15, b"", 239, 0), (0, 14, b"/files/notes.txt", None, 0), (0, 1, b"", None, 0),
            (0, 13, b"/files/notes.txt\0/files/a/c.txt", None, 0), (0, 12, b"/files/a/b.txt", None, 3), (0, 8, b"/files/a/b.txt", None, 0),
            (0, 10, b"/files/a", None, 0), (0, 4, b"/logs/../files/notes.txt", None, 0), (0, 4, b"@PARAM/param.pck?withdefaults=1", None, 0),
            (0, 5, b"", 239, 0), (0, 2, b"", None, 0), (0, 11, b"/plans/mission.waypoints", None, 0), (0, 4, b"/metadata/general.json", None, 0)):
        number += 1
        yield mav.file_transfer_protocol_encode(0, 1, 1, ftp(session, opcode, data, size, offset, number))
    yield command(241, 1)
    yield command(185, 1)


def main() -> None:
    lines = []
    for make in (everything, real, conversations):
        mav = two.MAVLink(None, srcSystem=255, srcComponent=190)
        lines += [f"{message.get_type()} {message.pack(mav).hex()}" for message in make(mav)]
    mav = one.MAVLink(None, srcSystem=254, srcComponent=190)
    for message in (mav.command_long_encode(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0), mav.param_request_list_encode(1, 1),
                    mav.set_mode_encode(1, 1, 6 << 16),
                    mav.set_position_target_local_ned_encode(0, 1, 1, 1, MASKS[0], 1, 2, -3, 0, 0, 0, 0, 0, 0, 0, 0)):
        lines.append(f"{message.get_type()} {message.pack(mav).hex()}")
    (Path(__file__).parent / "frames.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
