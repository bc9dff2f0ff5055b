"""Records as a program other than the vehicle's reads and writes them: each line ends with the CRC-32 of all bytes before it."""

import zlib
from pathlib import Path


def entries(record: Path) -> list[str]:
    """Lines without their checksums, which must be right."""
    texts, before = [], b""
    for line in record.read_bytes().splitlines(keepends=True):
        text, checksum = line.rstrip(b"\n").rsplit(b" ", 1)
        assert zlib.crc32(before + text + b" ") == int(checksum, 16), line
        before += line
        texts.append(text.decode())
    return texts


def write(record: Path, texts: list[str]) -> None:
    """Writes lines with their checksums."""
    content = b""
    for text in texts:
        content += text.encode() + b" "
        content += b"%08x\n" % zlib.crc32(content)
    record.write_bytes(content)
