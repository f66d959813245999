"""PNG files, written without an image library."""

import struct
import zlib

GREY, RGB = 0, 2


def write_png(path, size, rows, depth=8, colour=RGB):
    """Writes `rows`: the samples of each row after a zero, the number of its filter."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", *size, depth, colour, 0, 0, 0)
    chunks = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))


def write_plain_png(path, size, rgb):
    """Writes an image of one colour."""
    width, height = size
    write_png(path, size, (b"\0" + bytes(rgb) * width) * height)
